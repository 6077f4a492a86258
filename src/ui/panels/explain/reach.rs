//! The page Reach: a bar, a plot of hand distance against Cursor distance, and the same step of the
//! hand with the limb bent and nearly straight.

use egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, RichText, Role, Sense, Shape, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};
use egui_plot::{
    AxisHints, HLine, Line, LineStyle, MarkerShape, PlotBounds, PlotPoints, PlotResponse, PlotUi,
    Points, VLine,
};

use crate::document::{LengthFormat, ShownLength};
use crate::kinematics::soft_reach::{HandDistance, ReachLimits, SoftReach};
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::LimbFrames;
use crate::session::ShownLimb;
use crate::ui::style;
use crate::ui::widgets::{plot, text, text::capitalized};
use crate::words::LimbWords;

/// Draws the inner limit, the reachable range and the Cursor along a bar from the limb's base.
pub(in crate::ui) fn meter(ui: &mut Ui, limb: &ShownLimb) {
    const HEIGHT: f32 = 44.0;
    const BAR: f32 = 8.0;
    const BEYOND: f32 = 1.25;
    let frames = &limb.frames;
    let ReachLimits { inner, outer } = frames.limits;
    let decimals = text::decimals_of_cell(limb.lengths().cell());
    let shown = |length: f32| ShownLength { length, decimals }.to_string();
    let (what, distance) = if frames.uses_ik() {
        ("Cursor".to_owned(), frames.posed.cursor.length())
    } else {
        (capitalized(limb.words.end), frames.pose().distance)
    };
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let bar = egui::Rect::from_min_size(
        rect.left_top() + vec2(6.0, 10.0),
        vec2(rect.width() - 12.0, BAR),
    );
    let place =
        |distance: f32| bar.left() + bar.width() * (distance / (outer * BEYOND)).clamp(0.0, 1.0);
    let visuals = ui.visuals();
    let accent = style::accent(ui);
    let painter = ui.painter();
    painter.rect_filled(bar, 4.0, visuals.widgets.inactive.bg_fill);
    let within = egui::Rect::from_x_y_ranges(place(inner)..=place(outer), bar.top()..=bar.bottom());
    painter.rect_filled(within, 2.0, accent.gamma_multiply(0.55));
    let cursor = place(distance);
    painter.circle_filled(egui::pos2(cursor, bar.center().y), 6.0, visuals.strong_text_color());
    painter.circle_filled(egui::pos2(cursor, bar.center().y), 3.0, visuals.panel_fill);
    let font = egui::FontId::proportional(12.0);
    let written = |at: f32, anchor, text: String| {
        let at = egui::pos2(at, bar.bottom() + 6.0);
        painter.text(at, anchor, text, font.clone(), visuals.weak_text_color());
    };
    // On a short bar the two numbers would overlap.
    let apart = place(outer) - place(inner) > 60.0;
    if apart && inner > 0.0 {
        written(place(inner), egui::Align2::CENTER_TOP, shown(inner));
    }
    written(place(outer), egui::Align2::CENTER_TOP, shown(outer));
    let [distance, inner, outer] = [distance, inner, outer].map(|it| limb.lengths().show(it));
    let end = limb.words.end;
    let summary = format!("{what} at {distance}; the {end} reaches from {inner} to {outer}");
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Label, true, format!("Reach: {summary}"))
    });
    response.on_hover_text(summary);
}

const HEIGHT: f32 = 168.0;
const POINTS: u16 = 240;
/// Softness of the example curve, if softness is off.
const EXAMPLE_SOFTNESS: f32 = 0.5;
/// Stretch factor of the example curve, if stretch is off.
const EXAMPLE_STRETCH: f32 = 1.5;

pub(in crate::ui) fn curve(ui: &mut Ui, limb: &ShownLimb) {
    let (frames, words) = (&limb.frames, limb.words);
    let curves = ReachCurve::all(ui, frames.posed.ik.soft_reach);
    ui.weak(format!("Up: {} distance · across: Cursor distance", words.end));
    let shown = show(ui, limb, &curves);
    let said = reading(frames, words, frames.posed.cursor.length());
    let name = format!("Reach curve: {said}");
    shown.response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    if let Some(at) = shown.response.hover_pos() {
        let over = shown.transform.value_from_position(at).x * outer(frames);
        let reading = reading(frames, words, (over.max(0.0) as f32).min(f32::MAX));
        shown.response.on_hover_text_at_pointer(reading);
    }
    ui.horizontal_wrapped(|ui| curves.iter().for_each(|curve| legend(ui, curve)));
    ui.label(said);
    ui.weak(note(frames.posed.ik.soft_reach));
    if frames.posed.influence < 1.0 {
        ui.weak("Shown for IK alone, without the FK blend");
    }
}

/// A curve of hand distance against Cursor distance, both as fractions of L, the length of the
/// straight limb.
struct ReachCurve {
    name: String,
    soft_reach: SoftReach,
    is_own: bool,
    colour: Color32,
    style: LineStyle,
}

impl ReachCurve {
    /// The three curves: soft limits off, softness, and stretch. A setting that is off in `own`
    /// has an example value.
    fn all(ui: &Ui, own: SoftReach) -> [Self; 3] {
        let (softness, stretch, angle) = (own.softness(), own.max_stretch(), own.min_elbow_angle());
        let softer = if softness > 0.0 { softness } else { EXAMPLE_SOFTNESS };
        let longer = if stretch > 1.0 { stretch } else { EXAMPLE_STRETCH };
        let with = |softness, stretch| SoftReach::new(softness, stretch, angle).unwrap_or(own);
        let palette = style::palette(ui);
        let curve = |name: String, soft_reach: SoftReach, colour, style| {
            let is_own = soft_reach == own;
            Self { name, soft_reach, is_own, colour, style }
        };
        [
            curve("off".to_owned(), with(0.0, 1.0), ui.visuals().text_color(), LineStyle::Solid),
            curve(
                format!("soft {softer:.2}"),
                with(softer, 1.0),
                style::colour(palette.accent),
                LineStyle::Dashed { length: 7.0 },
            ),
            curve(
                format!("stretch {longer:.2}"),
                with(softness, longer),
                style::colour(palette.lower),
                LineStyle::Dotted { spacing: 5.0 },
            ),
        ]
    }

    fn width(&self) -> f32 {
        if self.is_own { 2.2 } else { 1.5 }
    }
}

/// The longest distance of the hand without stretch, L if limits allow it: the unit of the plot.
fn outer(limb: &LimbFrames) -> f64 {
    f64::from(limb.range.outer)
}

fn show(ui: &mut Ui, limb: &ShownLimb, curves: &[ReachCurve]) -> PlotResponse<()> {
    let frames = &limb.frames;
    let outer = outer(frames);
    let least = f64::from(frames.range.inner) / outer;
    let longest = curves.iter().map(|curve| curve.soft_reach.max_stretch()).fold(1.0, f32::max);
    // Capped so that the limits stay readable.
    let most = f64::from(longest.min(4.0)) + 0.2;
    let decimals = text::decimals_of_cell(limb.lengths().cell());
    let length =
        move |part: f64| ShownLength { length: (part * outer) as f32, decimals }.to_string();
    let limits = if least > 0.05 { vec![least, 1.0] } else { vec![1.0] };
    let ticks = limits.clone();
    let weak = ui.visuals().weak_text_color();
    // The limb's own curve, the widest, is drawn first, so that it does not cover the others.
    let (own, others): (Vec<_>, Vec<_>) = curves.iter().partition(|curve| curve.is_own);
    let lines: Vec<_> = own.iter().chain(&others).map(|curve| curve.line(frames, most)).collect();
    let dot = ReachMarker::new(frames, most);
    let text = ui.visuals().strong_text_color();
    plot::still("reach curve", HEIGHT)
        .label_formatter(|_| None)
        .show_grid(false)
        .custom_x_axes(vec![plot::axis(ui, AxisHints::new_x(), length)])
        .custom_y_axes(vec![plot::axis(ui, AxisHints::new_y(), length).min_thickness(34.0)])
        .x_grid_spacer(move |_| plot::marks(&ticks))
        .y_grid_spacer(move |_| plot::marks(&limits))
        .show(ui, |plot| {
            plot::show(plot, PlotBounds::from_min_max([0.0, 0.0], [most, most - 0.08]));
            let thin = Stroke::new(1.0, weak.gamma_multiply(0.5));
            for at in [least, 1.0] {
                plot.vline(VLine::new("limit", at).stroke(thin));
                plot.hline(HLine::new("limit", at).stroke(thin));
            }
            lines.into_iter().for_each(|line| plot.line(line));
            dot.show(plot, text);
        })
}

impl ReachCurve {
    fn line(&self, limb: &LimbFrames, most: f64) -> Line<'static> {
        let outer = outer(limb);
        let point = |step| {
            let cursor = most * f64::from(step) / f64::from(POINTS);
            let distance = (cursor * outer) as f32;
            let actual = self.soft_reach.hand_distance_within(limb.range, distance).distance;
            [cursor, f64::from(actual) / outer]
        };
        let points: PlotPoints<'_> = (0..=POINTS).map(point).collect();
        Line::new(&self.name, points).color(self.colour).width(self.width()).style(self.style)
    }
}

/// The mark of the current pose on the curve.
struct ReachMarker {
    at: [f64; 2],
    shape: MarkerShape,
}

impl ReachMarker {
    /// The mark of the limb's Cursor; an arrow at the right edge of the plot if the Cursor is
    /// farther than `most`, in units of L.
    fn new(limb: &LimbFrames, most: f64) -> Self {
        let cursor = limb.posed.cursor.length().min(f32::MAX);
        let part = f64::from(cursor) / outer(limb);
        let hand = limb.posed.ik.soft_reach.hand_distance_within(limb.range, cursor);
        let actual = f64::from(hand.distance) / outer(limb);
        let shape = if part > most { MarkerShape::Right } else { MarkerShape::Circle };
        Self { at: [part.min(most - 0.04), actual.min(most - 0.14)], shape }
    }

    fn show(&self, plot: &mut PlotUi<'_>, colour: Color32) {
        let dot = |radius| Points::new("now", vec![self.at]).shape(self.shape).radius(radius);
        plot.points(dot(5.0).color(colour));
    }
}

/// Shows the legend entry of a curve.
fn legend(ui: &mut Ui, curve: &ReachCurve) {
    ui.spacing_mut().item_spacing.x = 5.0;
    let (rect, _) = ui.allocate_exact_size(vec2(22.0, 12.0), Sense::hover());
    let ends = [rect.left_center(), rect.right_center()];
    let stroke = Stroke::new(curve.width(), curve.colour);
    match curve.style {
        LineStyle::Solid => drop(ui.painter().line_segment(ends, stroke)),
        LineStyle::Dashed { length } => {
            ui.painter().extend(Shape::dashed_line(&ends, stroke, length, length * 0.6));
        }
        LineStyle::Dotted { spacing } => {
            ui.painter().extend(Shape::dotted_line(&ends, curve.colour, spacing, curve.width()));
        }
    }
    let text = RichText::new(&curve.name).size(12.0);
    ui.label(if curve.is_own { text.strong() } else { text });
    ui.add_space(4.0);
}

/// Describes the hand distance and the slope of the curve at a Cursor distance.
fn reading(limb: &LimbFrames, words: LimbWords, cursor: f32) -> String {
    let cursor = cursor.min(f32::MAX);
    let hand = limb.posed.ik.soft_reach.hand_distance_within(limb.range, cursor);
    let HandDistance { distance, slope, .. } = hand;
    let decimals = LengthFormat::of_limb(limb.bones()).decimals();
    let [cursor, distance] = [cursor, distance].map(|length| ShownLength { length, decimals });
    format!("Cursor at {cursor}: {} at {distance}, slope {slope:.2}", words.end)
}

/// A sentence that says which curves are examples.
fn note(own: SoftReach) -> &'static str {
    match (own.softness() > 0.0, own.max_stretch() > 1.0) {
        (false, false) => "Soft limits are off; the dashed curves show what they would do",
        (true, false) => "Softness is on; the dotted curve shows what stretch would do",
        (false, true) => "Stretch is on; the dashed curve shows what softness would do",
        (true, true) => "Softness and stretch are on",
    }
}

const STEP_HEIGHT: f32 = 92.0;
/// Room for joints at the sides, and for the line of text below the arm.
const MARGINS: [f32; 2] = [8.0, 24.0];
/// Length of the step, as a fraction of the range of the hand's distances.
const STEP: f32 = 0.05;
/// Where in this range the step ends, from 0 to 1, by its name.
const ENDS: [(&str, f32); 2] = [("Bent", 0.7), ("Nearly straight", 1.0)];

pub(super) fn same_step(ui: &mut Ui, limb: &ShownLimb) {
    let steps = ENDS.map(|(name, end)| SameStep::new(limb, name, end));
    let highest =
        steps.iter().flat_map(|step| step.poses).map(|pose| pose.out).fold(1e-9, f32::max);
    for step in &steps {
        drawing(ui, step, highest);
    }
}

/// Two poses of a limb, before and after a step of the hand away from its base.
struct SameStep<'a> {
    limb: &'a ShownLimb,
    name: &'static str,
    step: f32,
    poses: [TwoBonePose; 2],
}

impl<'a> SameStep<'a> {
    /// The step that ends at a part of the range of the hand's distances, with hard limits.
    fn new(limb: &'a ShownLimb, name: &'static str, end: f32) -> Self {
        let bones = limb.frames.bones();
        let pose = limb.frames.pose();
        let ReachLimits { inner, outer } = limb.frames.range;
        let range = outer - inner;
        let at = |part: f32| bones.solve_at(pose.pointer, inner + part * range, pose.twist);
        Self { limb, name, step: STEP * range, poses: [at(end - STEP), at(end)] }
    }

    /// Distance that the elbow moves in the plane of the limb.
    fn elbow(&self) -> f32 {
        let [before, after] = &self.poses;
        (after.along - before.along).hypot(after.out - before.out)
    }

    fn text(&self) -> String {
        let lengths = self.limb.lengths();
        let [step, elbow] = [self.step, self.elbow()].map(|length| lengths.show(length));
        let LimbWords { middle, end, .. } = self.limb.words;
        format!("{}: {end} {step}, {middle} {elbow}", self.name)
    }
}

/// Draws both poses in a scale in which `highest`, a distance of the elbow from the Pointer, fits.
fn drawing(ui: &mut Ui, step: &SameStep<'_>, highest: f32) {
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), STEP_HEIGHT), Sense::hover());
    let text = step.text();
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &text));
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 6.0, ui.visuals().extreme_bg_color);
    let at = rect.left_bottom() + vec2(MARGINS[0], -5.0);
    painter.text(
        at,
        Align2::LEFT_BOTTOM,
        text,
        FontId::proportional(12.0),
        ui.visuals().text_color(),
    );
    let [before, after] = corners(rect, step, highest);
    paint_pose(ui, &painter, before, 0.35);
    paint_pose(ui, &painter, after, 1.0);
    let moved = Stroke::new(3.0, style::accent(ui));
    painter.line_segment([before[1], after[1]], moved);
    painter.line_segment([before[2], after[2]], moved);
    let LimbWords { middle, end, .. } = step.limb.words;
    let tooltip = format!("Compare how far the same step of the {end} moves the {middle}");
    response.on_hover_text(tooltip);
}

/// Shoulder, elbow and hand of both poses on screen.
fn corners(rect: Rect, step: &SameStep<'_>, highest: f32) -> [[Pos2; 3]; 2] {
    let inside = Rect::from_min_max(
        rect.min + vec2(MARGINS[0], MARGINS[0]),
        rect.max - vec2(MARGINS[0], MARGINS[1]),
    );
    let outer = step.limb.frames.bones().outer_limit();
    let scale = (inside.width() / outer).min(inside.height() / highest);
    step.poses.map(|pose| {
        let place = |along: f32, out: f32| {
            pos2(inside.left() + along * scale, inside.bottom() - out * scale)
        };
        [place(0.0, 0.0), place(pose.along, pose.out), place(pose.distance, 0.0)]
    })
}

fn paint_pose(ui: &Ui, painter: &Painter, [shoulder, elbow, hand]: [Pos2; 3], opacity: f32) {
    let palette = style::palette(ui);
    let [upper, lower] = [palette.upper, palette.lower]
        .map(|colour| Stroke::new(2.5, style::colour(colour).gamma_multiply(opacity)));
    painter.line_segment([shoulder, elbow], upper);
    painter.line_segment([elbow, hand], lower);
}
