//! The triangle of shoulder, elbow and hand: a drawing to scale in the plane of the limb, its
//! quantities, where they place the elbow, and the law of cosines beside the solver's form.

use core::f32::consts::TAU;

use egui::{
    Color32, Painter, Pos2, Rect, RichText, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2,
};
use glam::Vec3;

use super::figures::{
    FigureLabels, FigureLine, FormulaRow, Lit, Place, arc, around, beside, degrees, formula,
    length, pair, point, table,
};
use crate::rig::LimbPart;
use crate::session::{LimbFigure, Session, ShownLimb};
use crate::ui::style;
use crate::ui::widgets::text::capitalized;
use crate::words::LimbWords;

const HEIGHT: f32 = 156.0;
/// Room for labels at the sides, and above and below.
const MARGINS: Vec2 = vec2(44.0, 34.0);
/// Radius of the arcs of the angles, in points.
const ARC: f32 = 18.0;
/// Half of the angle that each compass arc takes, in radians.
const COMPASS: f32 = 0.2;

pub(super) fn ui(ui: &mut Ui, session: &Session, limb: &ShownLimb, lit: &mut Lit) {
    let pose = limb.frames.pose();
    let LimbWords { base, middle, .. } = limb.words;
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    response.widget_info(|| {
        let [upper, lower] = sides(limb);
        let [upper, lower, distance] =
            [upper, lower, pose.distance].map(|it| limb.lengths().show(it));
        let [at_base, at_middle] =
            [pose.shoulder_angle(), pose.elbow_angle()].map(f32::to_degrees);
        let text = format!(
            "Triangle: upper limb {upper}, lower limb {lower}, distance {distance}, angle at the {base} {at_base:.1} degrees, angle at the {middle} {at_middle:.1} degrees",
        );
        WidgetInfo::labeled(Role::Image, true, text)
    });
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 6.0, ui.visuals().extreme_bg_color);
    let drawing = TriangleDrawing::new(ui, rect, session, limb);
    let lines = drawing.figure_lines();
    lit.paint(&painter, ui, &lines);
    let labels = drawing.paint(&painter, ui);
    lit.point(&response, &lines, &labels);
    response.on_hover_text("The limb in its own plane, to scale, on the side that the view shows");
}

/// Lengths of the Upper and the Lower limb, with their stretch.
fn sides(limb: &ShownLimb) -> [f32; 2] {
    let bones = limb.frames.bones();
    [bones.upper(), bones.lower()].map(|length| length * limb.frames.pose().stretch)
}

/// How a triangle is turned over, so that hand and elbow are on the sides where the view shows them.
#[derive(Clone, Copy)]
struct Flip {
    centre: Pos2,
    /// 1 or −1 for each direction on screen.
    signs: Vec2,
}

impl Flip {
    fn as_seen(session: &Session, limb: &ShownLimb, centre: Pos2) -> Self {
        let view = session.camera().projection(1.0);
        let [shoulder, elbow, hand] =
            [LimbPart::Root, LimbPart::Elbow, LimbPart::Hand].map(|part| limb.frames.origin(part));
        let on_screen = |way: Vec3| vec2(way.dot(view.right), way.dot(view.up));
        let [to_elbow, to_hand] = [elbow, hand].map(|end| on_screen(end - shoulder));
        // The hand of an upright limb is at the right, so that a leg that walks does not turn over with
        // each step.
        let is_left = -to_hand.x > to_hand.y.abs();
        let is_above = (to_hand.x * to_elbow.y - to_hand.y * to_elbow.x < 0.0) == is_left;
        let sign = |is_positive: bool| if is_positive { 1.0 } else { -1.0 };
        Self { centre, signs: vec2(sign(!is_left), sign(is_above)) }
    }

    fn point(self, at: Pos2) -> Pos2 {
        self.centre + (at - self.centre) * self.signs
    }

    fn points(self, points: &[Pos2]) -> Vec<Pos2> {
        points.iter().map(|at| self.point(*at)).collect()
    }

    fn places(self, places: &[Place]) -> Vec<Place> {
        let flipped =
            |place: &Place| Place { at: self.point(place.at), away: place.away * self.signs };
        places.iter().map(flipped).collect()
    }
}

/// Positions and colours of the triangle with the hand at the right and the elbow above, which `flip`
/// brings to their places on screen. `foot` is the point of the Pointer nearest to the elbow, and
/// `angle` is θ_e in radians.
struct TriangleDrawing {
    flip: Flip,
    shoulder: Pos2,
    elbow: Pos2,
    hand: Pos2,
    foot: Pos2,
    angle: f32,
    text: Color32,
    weak: Color32,
    upper: Color32,
    lower: Color32,
    accent: Color32,
    words: LimbWords,
}

impl TriangleDrawing {
    fn new(ui: &Ui, rect: Rect, session: &Session, limb: &ShownLimb) -> Self {
        let pose = limb.frames.pose();
        let (left, right) = (pose.along.min(0.0), pose.distance.max(pose.along));
        let inside = rect.shrink2(MARGINS);
        // All poses of a limb have the same scale, so that the triangle grows with D; only a
        // triangle that would not fit has a smaller scale.
        let widest = (right - left).max(limb.frames.bones().outer_limit() * 0.7);
        let scale = (inside.width() / widest).min(inside.height() / pose.out.max(1e-9));
        let middle = (left + right) / 2.0;
        let place = |along: f32, out: f32| {
            inside.center() + vec2(along - middle, 0.5 * pose.out - out) * scale
        };
        let palette = style::palette(ui);
        Self {
            flip: Flip::as_seen(session, limb, inside.center()),
            shoulder: place(0.0, 0.0),
            elbow: place(pose.along, pose.out),
            hand: place(pose.distance, 0.0),
            foot: place(pose.along, 0.0),
            angle: pose.shoulder_angle(),
            text: ui.visuals().text_color(),
            weak: ui.visuals().weak_text_color(),
            upper: style::colour(palette.upper),
            lower: style::colour(palette.lower),
            accent: style::colour(palette.accent),
            words: limb.words,
        }
    }

    /// The lines that light up, and that the mouse can point at.
    fn figure_lines(&self) -> [FigureLine; 7] {
        let Self { shoulder, elbow, hand, foot, .. } = *self;
        [
            (LimbFigure::Upper, vec![shoulder, elbow]),
            (LimbFigure::Lower, vec![elbow, hand]),
            // A part of the line of D: the first one counts.
            (LimbFigure::Along, vec![shoulder, foot]),
            (LimbFigure::Distance, vec![shoulder, hand]),
            (LimbFigure::Out, vec![foot, elbow]),
            (LimbFigure::ShoulderAngle, arc(shoulder, ARC, 0.0, -self.angle)),
            (LimbFigure::ElbowAngle, self.elbow_arc()),
        ]
        .map(|(figure, points)| FigureLine { figure, points: self.flip.points(&points) })
    }

    /// The direction from the elbow to the shoulder, and the turn from there to the hand, in
    /// radians clockwise from the right.
    fn at_elbow(&self) -> (f32, f32) {
        let [to_shoulder, to_hand] =
            [self.shoulder, self.hand].map(|end| (end - self.elbow).angle());
        let turn = (to_hand - to_shoulder + TAU).rem_euclid(TAU);
        (to_shoulder, if turn > 0.5 * TAU { turn - TAU } else { turn })
    }

    fn elbow_arc(&self) -> Vec<Pos2> {
        let (start, turn) = self.at_elbow();
        arc(self.elbow, ARC, start, turn)
    }

    /// True if the elbow is so near the Pointer that its height and the circles through it would be a
    /// knot of lines.
    fn is_flat(&self) -> bool {
        self.elbow.distance(self.foot) < 1.2 * ARC
    }

    /// Paints lines and labels, and returns where the labels are.
    fn paint(&self, painter: &Painter, ui: &Ui) -> Vec<(Rect, LimbFigure)> {
        let thin = Stroke::new(1.0, self.weak);
        let [shoulder, elbow, hand, foot] =
            [self.shoulder, self.elbow, self.hand, self.foot].map(|at| self.flip.point(at));
        painter.line_segment([shoulder, hand], Stroke::new(1.5, self.text));
        if !self.is_flat() {
            painter.extend(Shape::dashed_line(&[elbow, foot], thin, 3.0, 3.0));
            self.paint_compass(painter);
        }
        self.paint_angles(painter);
        painter.line_segment([shoulder, elbow], Stroke::new(4.0, self.upper));
        painter.line_segment([elbow, hand], Stroke::new(4.0, self.lower));
        for joint in [shoulder, elbow, hand] {
            painter.circle(joint, 4.5, ui.visuals().extreme_bg_color, Stroke::new(2.0, self.text));
        }
        self.write(painter, ui)
    }

    /// Paints the circles around shoulder and hand where they cross: the elbow.
    fn paint_compass(&self, painter: &Painter) {
        for (points, colour) in self.compass().into_iter().zip([self.upper, self.lower]) {
            let points = self.flip.points(&points);
            painter.add(Shape::line(points, Stroke::new(1.0, colour.gamma_multiply(0.6))));
        }
    }

    /// Arcs of the circles around shoulder and hand that cross at the elbow.
    fn compass(&self) -> [Vec<Pos2>; 2] {
        [self.shoulder, self.hand].map(|centre| {
            let spoke = self.elbow - centre;
            arc(centre, spoke.length(), spoke.angle() - COMPASS, 2.0 * COMPASS)
        })
    }

    fn paint_angles(&self, painter: &Painter) {
        let stroke = Stroke::new(1.5, self.accent);
        let at_shoulder = arc(self.shoulder, ARC, 0.0, -self.angle);
        for arc in [at_shoulder, self.elbow_arc()] {
            painter.add(Shape::line(self.flip.points(&arc), stroke));
        }
    }

    /// Writes each label at the first of its positions that is clear of lines and other labels.
    /// Labels without such a position are left out, except those of the sides.
    fn write(&self, painter: &Painter, ui: &Ui) -> Vec<(Rect, LimbFigure)> {
        let lines = self.lines().map(|ends| ends.map(|at| self.flip.point(at)));
        let mut labels = FigureLabels::new(painter, ui, lines.collect());
        let seen = |places: &[Place]| self.flip.places(places);
        let (shoulder, elbow, hand, foot) = (self.shoulder, self.elbow, self.hand, self.foot);
        labels.write_always(
            "Upper d_1",
            self.upper,
            LimbFigure::Upper,
            &seen(&beside(shoulder, elbow)),
        );
        labels.write_always(
            "Lower d_2",
            self.lower,
            LimbFigure::Lower,
            &seen(&beside(elbow, hand)),
        );
        // Near the hand, since the angle at the shoulder is written beneath the shoulder.
        let along = beside(hand, shoulder + 0.28 * (hand - shoulder));
        labels.write_always("Distance D", self.text, LimbFigure::Distance, &seen(&along));
        let angle = self.angle.min(TAU / 4.0);
        let in_angle = [38.0, 46.0, 56.0].into_iter().flat_map(|radius| {
            [0.5, 0.65, 0.8, 0.35].map(|part| Place {
                at: shoulder + radius * Vec2::angled(-part * angle),
                away: Vec2::ZERO,
            })
        });
        let below = vec2(0.0, 1.0);
        let beneath = [6.0, 20.0].map(|down| Place { at: shoulder + below * down, away: below });
        let left = vec2(-1.0, 0.0);
        let beside_it = Place { at: shoulder + left * 10.0, away: left };
        let in_angle: Vec<_> = in_angle.chain(beneath).chain([beside_it]).collect();
        let at_base = format!("{} θ_e", capitalized(self.words.base));
        labels.write(&at_base, self.accent, LimbFigure::ShoulderAngle, &seen(&in_angle));
        let (start, turn) = self.at_elbow();
        let at_elbow = around(elbow, ARC, start + 0.5 * turn);
        let beside_it =
            [(12.0, -14.0), (12.0, -24.0), (24.0, -4.0), (24.0, 6.0)].map(|(out, up)| {
                [-1.0, 1.0]
                    .map(|side| Place { at: elbow + vec2(side * out, up), away: vec2(side, 0.0) })
            });
        let above = [8.0, 26.0, 34.0].map(|up| Place { at: elbow - below * up, away: -below });
        let others = at_elbow.into_iter().chain(beside_it.concat());
        // Nothing but the arc is below the middle joint of a flat triangle, and the label has to be apart
        // from that of the distance.
        let at_elbow: Vec<_> = match self.is_flat() {
            true => above.into_iter().chain(others).collect(),
            false => others.chain(above).collect(),
        };
        let at_middle = format!("{} φ", capitalized(self.words.middle));
        labels.write(&at_middle, self.accent, LimbFigure::ElbowAngle, &seen(&at_elbow));
        if self.is_flat() {
            return labels.written();
        }
        let heights = [beside(elbow, foot), beside(foot, elbow)].concat();
        labels.write("Height o_e", self.weak, LimbFigure::Out, &seen(&heights));
        let lengths = [0.5, 0.35, 0.65].map(|part| foot + (shoulder - foot) * part);
        let lengths =
            [4.0, 18.0].map(|down| lengths.map(|at| Place { at: at + below * down, away: below }));
        labels.write("Along h_e", self.weak, LimbFigure::Along, &seen(&lengths.concat()));
        labels.written()
    }

    /// The lines that labels keep clear of.
    fn lines(&self) -> impl Iterator<Item = [Pos2; 2]> {
        let Self { shoulder, elbow, hand, foot, .. } = *self;
        let mut lines = vec![[shoulder, elbow], [elbow, hand], [shoulder, hand]];
        if !self.is_flat() {
            lines.push([elbow, foot]);
            lines.extend(self.compass().map(|points| [points[0], points[points.len() - 1]]));
        }
        lines.extend(self.elbow_arc().windows(2).map(|ends| [ends[0], ends[1]]));
        lines.into_iter()
    }
}

/// Shows the quantities of the triangle.
pub(super) fn quantities(ui: &mut Ui, limb: &ShownLimb, lit: &mut Lit) {
    table(ui, "triangle", &quantity_rows(limb), lit);
}

/// Shows the positions of Cursor and elbow.
pub(super) fn positions(ui: &mut Ui, limb: &ShownLimb, lit: &mut Lit) {
    let pose = limb.frames.pose();
    let LimbWords { middle, end, .. } = limb.words;
    let in_socket = Vec3::new(pose.along, pose.out, 0.0);
    let cursor =
        format!("x_c, y_c and z_c: the Cursor in Root space; where FK has a part, the {end}");
    let socket = "h_e along the Pointer and o_e away from it";
    let elbow =
        format!("x_e, y_e and z_e: the {middle} in Root space, turned there by Socket and Limb");
    let names = ["{} in Socket", "{} e"].map(|name| name.replace("{}", &capitalized(middle)));
    let pointed = point(limb, limb.frames.pointed_at());
    pair(ui, lit, LimbFigure::Cursor, ["Cursor c", &cursor], pointed);
    pair(ui, lit, LimbFigure::Out, [&names[0], socket], point(limb, in_socket));
    pair(ui, lit, LimbFigure::Elbow, [&names[1], &elbow], point(limb, pose.elbow));
}

fn quantity_rows(limb: &ShownLimb) -> [FormulaRow; 8] {
    let pose = limb.frames.pose();
    let LimbWords { base, middle, .. } = limb.words;
    let [upper, lower] = sides(limb);
    let row = |symbol: &str, formula, value, meaning: &str, figure| FormulaRow {
        symbol: symbol.to_owned(),
        formula,
        value,
        meaning: meaning.to_owned(),
        figure,
    };
    let length = |it| length(limb, it);
    [
        row("Upper d_1", "", length(upper), "Length of the Upper limb", Some(LimbFigure::Upper)),
        row("Lower d_2", "", length(lower), "Length of the Lower limb", Some(LimbFigure::Lower)),
        row("Sum L", "d_1 + d_2", length(upper + lower), "Reach of the straight limb", None),
        row(
            "Difference δ",
            "d_1 − d_2",
            length(upper - lower),
            "Difference of the limb lengths; its size is the inner limit",
            None,
        ),
        row(
            "Along h_e",
            "(D + δ L / D) / 2",
            length(pose.along),
            &format!("Distance of the {middle} along the Pointer"),
            Some(LimbFigure::Along),
        ),
        row(
            "Height o_e",
            "√((d_1 − h_e)(d_1 + h_e))",
            length(pose.out),
            &format!("Height of the {middle} above the Pointer: twice the triangle's area over D"),
            Some(LimbFigure::Out),
        ),
        row(
            &format!("{} θ_e", capitalized(base)),
            "atan2(o_e, h_e)",
            degrees(pose.shoulder_angle()),
            &format!("Angle at the {base}, between Pointer and Upper limb"),
            Some(LimbFigure::ShoulderAngle),
        ),
        row(
            &format!("{} angle φ", capitalized(middle)),
            "",
            degrees(pose.elbow_angle()),
            &format!("Inner angle at the {middle}: 180° straight, 0° folded"),
            Some(LimbFigure::ElbowAngle),
        ),
    ]
}

pub(super) fn law_of_cosines(ui: &mut Ui, limb: &ShownLimb, lit: &mut Lit) {
    let [upper, lower] = sides(limb);
    let [d1, d2, d] = [upper, lower, limb.frames.pose().distance].map(|it| length(limb, it));
    let Some(cosine) = Cosine::new(limb) else {
        let LimbWords { base, end, .. } = limb.words;
        ui.label(format!("The {end} is at the {base}: there is no triangle."));
        return;
    };
    lit.row(ui, LimbFigure::ShoulderAngle, |ui| {
        let lines = ui.vertical(|ui| {
            ui.weak("Written out");
            formula(ui, "d_2² = d_1² + D² − 2 d_1 D cos θ_e");
            ui.weak("Filled in");
            formula(ui, &format!("{d2}² = {d1}² + {d}² − 2 · {d1} · {d} cos θ_e"));
            let [cos, angle] = [cosine.cosine, cosine.by_cosine.to_degrees()];
            formula(ui, &format!("cos θ_e = {cos:.4}, so θ_e = {angle:.1}°"));
        });
        lines.response.rect
    });
    ui.add_space(4.0);
    ui.weak("The solver's form");
    formula(ui, "h_e = (D + δ L / D) / 2");
    formula(ui, "d_1 − h_e = (L − D)(D − δ) / (2 D)");
    formula(ui, "o_e = √((d_1 − h_e)(d_1 + h_e))");
    formula(ui, "θ_e = atan2(o_e, h_e)");
    ui.add_space(4.0);
    ui.label(
        "Near a straight or folded limb the cosine hardly changes with the angle, so a rounded cosine \
         gives a wrong angle and the elbow trembles. The solver's form subtracts lengths, never their squares.",
    );
    let [theirs, ours] = [cosine.error_of_cosine(), cosine.error_of_solver()].map(micro_degrees);
    ui.label("Error in this pose, in millionths of a degree:");
    egui::Grid::new("errors").num_columns(2).spacing(egui::vec2(10.0, 2.0)).show(ui, |ui| {
        for (name, value) in [("By the cosine", theirs), ("By the solver", ours)] {
            ui.label(name);
            ui.label(RichText::new(value).monospace());
            ui.end_row();
        }
    });
}

/// The angle at the shoulder in radians, computed in three ways.
struct Cosine {
    cosine: f32,
    by_cosine: f32,
    by_solver: f32,
    /// In 64-bit numbers, from the same sides.
    exact: f64,
}

impl Cosine {
    /// `None` for a hand at the shoulder.
    fn new(limb: &ShownLimb) -> Option<Self> {
        let ([upper, lower], pose) = (sides(limb), limb.frames.pose());
        let distance = pose.distance;
        let cosine =
            (upper * upper + distance * distance - lower * lower) / (2.0 * upper * distance);
        cosine.is_finite().then(|| Self {
            cosine,
            by_cosine: cosine.clamp(-1.0, 1.0).acos(),
            by_solver: pose.shoulder_angle(),
            exact: exact_angle(upper.into(), lower.into(), distance.into()),
        })
    }

    fn error_of_cosine(&self) -> f64 {
        (f64::from(self.by_cosine) - self.exact).abs()
    }

    fn error_of_solver(&self) -> f64 {
        (f64::from(self.by_solver) - self.exact).abs()
    }
}

/// The angle between the sides `upper` and `distance` of a triangle whose third side is `lower`:
/// twice the arctangent that Kahan's formula for the area gives. A triangle that does not close is
/// straight or folded.
fn exact_angle(upper: f64, lower: f64, distance: f64) -> f64 {
    let sum = (upper + distance + lower) * (upper + distance - lower).max(0.0);
    let difference = (lower - (upper - distance)) * (lower + (upper - distance));
    2.0 * difference.max(0.0).sqrt().atan2(sum.sqrt())
}

fn micro_degrees(radians: f64) -> String {
    format!("{:.1}", radians.to_degrees() * 1e6)
}
