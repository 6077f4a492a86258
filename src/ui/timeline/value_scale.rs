//! The scales of the values in the graph editor, one for angles, one for lengths and one for
//! ratios, and their axes, one at the left and one at the right; a channel's curve.

use egui::{
    Align2, Color32, Event, Id, Pos2, Rangef, Rect, Role, Sense, Stroke, TextStyle, Ui, WidgetInfo,
    pos2,
};
use egui_plot::LineStyle;

use super::rows::VALUES;
use super::time_scale::{WHEEL, wheel_steps};
use crate::document::{Channel, Quantity};

use crate::ui::widgets::text;

/// Part of the height that is left free above and below the curves.
const ROOM: f64 = 0.12;

/// The unit of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ValueKind {
    Angle,
    Length,
    /// A number without a unit.
    Ratio,
}

impl ValueKind {
    pub const ALL: [Self; 3] = [Self::Angle, Self::Length, Self::Ratio];

    pub fn of(channel: Channel) -> Self {
        match (channel, channel.quantity()) {
            (Channel::Stretch(_), _) => Self::Ratio,
            (_, Quantity::Angle | Quantity::Rotation) => Self::Angle,
            (_, Quantity::Point | Quantity::Length) => Self::Length,
            (_, Quantity::Fraction | Quantity::Number | Quantity::Numbers | Quantity::Switch) => {
                Self::Ratio
            }
        }
    }

    /// Displayed values per value: degrees per radian for angles.
    pub fn factor(self) -> f64 {
        match self {
            Self::Angle => 180.0 / core::f64::consts::PI,
            Self::Length | Self::Ratio => 1.0,
        }
    }

    /// Name and sign of the unit, in a document with these metres in a unit.
    pub fn unit(self, metres_per_unit: f32) -> (&'static str, &'static str) {
        match (self, metres_per_unit) {
            (Self::Angle, _) => ("degrees", "deg"),
            (Self::Length, 1.0) => ("metres", "m"),
            (Self::Length, 0.01) => ("centimetres", "cm"),
            (Self::Length, 0.001) => ("millimetres", "mm"),
            (Self::Length, _) => ("units of the scene", "units"),
            (Self::Ratio, _) => ("parts of the whole", "0–1"),
        }
    }

    fn index(self) -> usize {
        match self {
            Self::Angle => 0,
            Self::Length => 1,
            Self::Ratio => 2,
        }
    }
}

/// The displayed values at the bottom and the top of the plot, for each [`ValueKind`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ValueScales([(f64, f64); 3]);

/// Scales that the user has set, for these curves.
#[derive(Clone, PartialEq)]
struct StoredScales {
    channels: Vec<Channel>,
    scales: ValueScales,
}

impl ValueScales {
    /// The scales that show all displayed values of each kind.
    pub fn fitting<I: Iterator<Item = f64>>(values: impl Fn(ValueKind) -> I) -> Self {
        Self(ValueKind::ALL.map(|kind| fitted(values(kind))))
    }

    /// With the zeros of both axes at one height, for which each range becomes at most twice as long.
    /// Unchanged if there is one axis alone, or one of them has no zero.
    pub fn with_level_zeros(mut self, sides: AxisSides) -> Self {
        let (Some(left), Some(right)) = (sides.left, sides.right) else { return self };
        let [one, other] = [left, right].map(|kind| self.part(kind, 0.0));
        let (lower, upper) = (one.min(other), one.max(other));
        if lower <= 0.0 || upper >= 1.0 {
            return self;
        }
        // The height at which both ranges grow by the same factor, 1 − lower + upper.
        let zero = upper / (1.0 - lower + upper);
        for kind in [left, right] {
            let (low, high) = self.range(kind);
            let span = (-low / zero).max(high / (1.0 - zero));
            self.0[kind.index()] = (-zero * span, (1.0 - zero) * span);
        }
        self
    }

    /// The scales that the user has set for the curves of `channels`; `None` if there are none.
    pub fn load(ui: &Ui, channels: &[Channel]) -> Option<Self> {
        let stored = ui.data(|data| data.get_temp::<StoredScales>(id()))?;
        (stored.channels == channels).then_some(stored.scales)
    }

    /// Removes the scales that the user has set, so that all curves are shown again.
    pub fn fit(ui: &Ui) {
        ui.data_mut(|data| data.remove::<StoredScales>(id()));
    }

    /// Zooms by Ctrl+wheel about the mouse in `area`, and pans by `is_panning`, which is vertical
    /// only after a zoom. Stores changed scales for the curves of `channels`.
    pub fn follow_input(&mut self, ui: &Ui, area: Rect, channels: &[Channel], is_panning: bool) {
        let before = *self;
        let Some(mouse) = ui.input(|input| input.pointer.latest_pos()) else { return };
        if is_panning && Self::load(ui, channels).is_some() {
            let up = f64::from(ui.input(|input| input.pointer.delta().y) / area.height().max(1.0));
            self.change(|low, high| (low + up * (high - low), high + up * (high - low)));
        }
        if ui.rect_contains_pointer(area) {
            let height = f64::from((area.bottom() - mouse.y) / area.height().max(1.0));
            for event in ui.input(|input| input.events.clone()) {
                if let Event::MouseWheel { unit, delta, modifiers, .. } = event
                    && modifiers.command
                {
                    let factor = WHEEL.powf(-f64::from(wheel_steps(unit, delta).y));
                    self.change(|low, high| {
                        let still = low + height * (high - low);
                        (still + (low - still) * factor, still + (high - still) * factor)
                    });
                }
            }
        }
        if *self != before {
            let stored = StoredScales { channels: channels.to_vec(), scales: *self };
            ui.data_mut(|data| data.insert_temp(id(), stored));
        }
    }

    /// Changes the bottom and top of all scales, as far as they stay finite and apart.
    fn change(&mut self, change: impl Fn(f64, f64) -> (f64, f64)) {
        /// Greatest value, and least distance between top and bottom relative to them.
        const LIMITS: (f64, f64) = (1e30, 1e-6);
        for scale in &mut self.0 {
            let (low, high) = change(scale.0, scale.1);
            let size = low.abs().max(high.abs());
            if size < LIMITS.0 && high - low > LIMITS.1 * size.max(LIMITS.1) {
                *scale = (low, high);
            }
        }
    }

    /// The displayed values at the bottom and the top of the plot.
    pub fn range(self, kind: ValueKind) -> (f64, f64) {
        self.0[kind.index()]
    }

    pub fn points_per_value(self, kind: ValueKind, height: f32) -> f64 {
        let (low, high) = self.range(kind);
        f64::from(height) / (high - low)
    }

    /// Part of the way from the bottom to the top of the plot at which a displayed value is.
    pub fn part(self, kind: ValueKind, value: f64) -> f64 {
        let (low, high) = self.range(kind);
        (value - low) / (high - low)
    }

    /// Screen y of a displayed value in a plot over `ys`.
    pub fn y(self, kind: ValueKind, value: f64, ys: Rangef) -> f32 {
        ys.max - (self.part(kind, value) * f64::from(ys.span())) as f32
    }
}

/// A range with all values, and free room on both sides.
fn fitted(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > high {
        return (0.0, 1.0);
    }
    let least = (ROOM * (high - low)).max(1e-6 * low.abs().max(high.abs())).max(1e-6);
    // A constant value lies in the middle.
    let room = if high - low < least { 0.5 * least + 0.5 } else { least };
    (low - room, high + room)
}

fn id() -> Id {
    Id::unique("timeline value scales")
}

/// The curve of one component of a channel.
pub(super) struct ChannelCurve {
    pub channel: Channel,
    /// Component of the channel's values: 0, 1 or 2.
    pub axis: usize,
    pub kind: ValueKind,
    pub name: String,
    pub colour: Color32,
    pub style: LineStyle,
    /// Times in seconds and displayed values of the samples.
    pub line: Vec<[f64; 2]>,
    /// Times in seconds and displayed values of the keys.
    pub knots: Vec<[f64; 2]>,
}

/// Minimum distance in points between labels.
const BETWEEN: f32 = 20.0;
/// Distance in points between the plot and the labels.
const GAP: f32 = 5.0;

/// The kinds of values that have an axis, at the left and at the right. Angles are at the left and
/// lengths at the right; ratios take a side that is free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui::timeline) struct AxisSides {
    pub left: Option<ValueKind>,
    pub right: Option<ValueKind>,
}

impl AxisSides {
    pub fn new(has: impl Fn(ValueKind) -> bool) -> Self {
        let given = |kind| Some(kind).filter(|kind| has(*kind));
        let [angle, length, ratio] = ValueKind::ALL.map(given);
        match (angle, length) {
            (Some(_), Some(_)) => Self { left: angle, right: length },
            (one, None) | (None, one) => match one {
                Some(_) => Self { left: one, right: ratio },
                None => Self { left: ratio, right: None },
            },
        }
    }
}

/// Draws lines through the plot at round values, and the axes beside it.
pub(in crate::ui::timeline) fn axes(
    ui: &Ui,
    scales: ValueScales,
    sides: AxisSides,
    plot: Rect,
    metres_per_unit: f32,
    curves: &[ChannelCurve],
) {
    let font = TextStyle::Small.resolve(ui.style());
    let colours = (ui.visuals().text_color(), ui.visuals().weak_text_color());
    let write = |at: Pos2, align: Align2, text: String, colour: Color32| {
        ui.painter().text(at, align, text, font.clone(), colour);
    };
    for (kind, is_left) in [(sides.left, true), (sides.right, false)] {
        let Some(kind) = kind else { continue };
        let (x, align) = if is_left {
            (plot.left() - GAP, egui::Align::Max)
        } else {
            (plot.right() + GAP, egui::Align::Min)
        };
        let (name, unit) = kind.unit(metres_per_unit);
        let top = Align2([align, egui::Align::Min]);
        let unit_font = TextStyle::Body.resolve(ui.style());
        let unit_colour = shared_colour(curves, kind).unwrap_or(colours.0);
        ui.painter().text(pos2(x, plot.top() + 2.0), top, unit, unit_font, unit_colour);
        let marks = marks(scales.range(kind), plot.height());
        for mark in marks.values() {
            let y = scales.y(kind, mark, plot.y_range());
            if is_left {
                let line = ui.visuals().widgets.noninteractive.bg_stroke.color.gamma_multiply(0.5);
                ui.painter().with_clip_rect(plot).hline(plot.x_range(), y, Stroke::new(1.0, line));
            }
            // The unit stands above the labels.
            if y > plot.top() + BETWEEN && y < plot.bottom() - 6.0 {
                let label = Align2([align, egui::Align::Center]);
                let colour = shared_colour(curves, kind).unwrap_or(colours.1);
                write(pos2(x, y), label, written(mark, marks.step), colour);
            }
        }
        let rect = if is_left {
            Rect::from_min_max(pos2(plot.left() - VALUES, plot.top()), plot.left_bottom())
        } else {
            Rect::from_min_max(plot.right_top(), pos2(plot.right() + VALUES, plot.bottom()))
        };
        let response = ui.interact(rect, Id::unique(("timeline axis", is_left)), Sense::click());
        response.widget_info(|| {
            WidgetInfo::labeled(Role::Label, true, format!("Axis in {name} ({unit})"))
        });
        if response.double_clicked() {
            ValueScales::fit(ui);
            ui.request_repaint();
        }
        response
            .on_hover_text(format!("Values in {name}. Ctrl+wheel zooms, double-click shows all"));
    }
}

/// The colour of all curves of a kind; `None` if they differ.
fn shared_colour(curves: &[ChannelCurve], kind: ValueKind) -> Option<Color32> {
    let mut colours = curves.iter().filter(|curve| curve.kind == kind).map(|curve| curve.colour);
    let first = colours.next()?;
    colours.all(|colour| colour == first).then_some(first)
}

/// Round values within a range.
#[derive(Clone, Copy)]
struct Marks {
    first: f64,
    step: f64,
    count: usize,
}

fn marks((low, high): (f64, f64), height: f32) -> Marks {
    let step = round_step((high - low) * f64::from((BETWEEN / height.max(1.0)).min(1.0)));
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first + 1.0).clamp(0.0, 1_000.0) as usize;
    Marks { first, step, count }
}

impl Marks {
    fn values(self) -> impl Iterator<Item = f64> {
        (0..self.count).map(move |index| (self.first + index as f64) * self.step)
    }
}

/// Formats a value with enough decimals to distinguish it from a label that is `step` away.
fn written(value: f64, step: f64) -> String {
    let power = step.max(1e-6).log10().floor();
    let is_quarter = (step / 10_f64.powf(power) - 2.5).abs() < 1e-6;
    let digits = if is_quarter { 1.0 - power } else { -power };
    text::fixed(value, digits.max(0.0) as usize)
}

/// The smallest number that is at least `step` and is 1, 2, 2.5 or 5 times a power of ten.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.max(1e-30).log10().floor());
    let steps = [1.0, 2.0, 2.5, 5.0].map(|times| times * power);
    steps.into_iter().find(|it| *it >= step).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::{AxisSides, ValueKind, ValueScales};

    const SIDES: AxisSides =
        AxisSides { left: Some(ValueKind::Angle), right: Some(ValueKind::Length) };

    #[test]
    fn zeros_of_both_axes_are_level_and_all_values_stay_in_view() {
        for (angles, lengths) in
            [((-10.0, 30.0), (-4.0, 1.0)), ((-1.0, 99.0), (-99.0, 1.0)), ((-2.0, 2.0), (-1.0, 3.0))]
        {
            let before = ValueScales([angles, lengths, (0.0, 1.0)]);
            let after = before.with_level_zeros(SIDES);
            let [one, other] =
                [ValueKind::Angle, ValueKind::Length].map(|kind| after.part(kind, 0.0));
            assert!((one - other).abs() < 1e-12, "{one} {other}");
            for kind in [ValueKind::Angle, ValueKind::Length] {
                let ((low, high), (least, greatest)) = (before.range(kind), after.range(kind));
                assert!(least <= low + 1e-9 && greatest >= high - 1e-9);
                assert!(greatest - least <= 2.0 * (high - low));
            }
        }
    }

    #[test]
    fn an_axis_without_a_zero_keeps_its_scale() {
        let scales = ValueScales([(-10.0, 30.0), (900.0, 1_100.0), (0.0, 1.0)]);
        assert_eq!(scales.with_level_zeros(SIDES), scales);
        let alone = AxisSides { right: None, ..SIDES };
        assert_eq!(scales.with_level_zeros(alone), scales);
    }
}
