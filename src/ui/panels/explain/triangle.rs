//! The triangle of shoulder, elbow and hand in the plane of the arm, to scale.

use core::f32::consts::TAU;

use egui::{
    Color32, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, pos2, vec2,
};

use super::drawing::{FigureLine, Labels, Lit, Place, around, beside};
use crate::document::Arm;
use crate::kinematics::two_bone::TwoBonePose;
use crate::session::{ArmFigure, Session};
use crate::ui::style;

const HEIGHT: f32 = 184.0;
/// Room for labels at the sides, and above and below.
const MARGINS: Vec2 = vec2(44.0, 34.0);
/// Radius of the arcs of the angles, in points.
const ARC: f32 = 18.0;
/// Half of the angle that each compass arc takes, in radians.
const COMPASS: f32 = 0.2;

pub(super) fn ui(ui: &mut Ui, session: &Session, lit: &mut Lit) {
    let (arm, pose) = (session.arm(), session.pose());
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    response.widget_info(|| {
        let text = format!(
            "Triangle: upper limb {}, lower limb {}, distance {}, angle at the shoulder {:.1} degrees, angle at the elbow {:.1} degrees",
            arm.format_length(arm.bones.upper() * pose.stretch),
            arm.format_length(arm.bones.lower() * pose.stretch),
            arm.format_length(pose.distance),
            pose.shoulder_angle().to_degrees(),
            pose.elbow_angle().to_degrees(),
        );
        WidgetInfo::labeled(Role::Image, true, text)
    });
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 6.0, ui.visuals().extreme_bg_color);
    let drawing = TriangleDrawing::new(ui, rect, arm, pose);
    let lines = drawing.figure_lines();
    lit.paint(&painter, ui, &lines);
    let labels = drawing.paint(&painter, ui);
    lit.point(&response, &lines, &labels);
    response.on_hover_text("The arm in its own plane, to scale");
}

/// Screen positions and colours of the triangle. `foot` is the point of the Pointer nearest to the
/// elbow, and `angle` is θ_e in radians.
struct TriangleDrawing {
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
}

impl TriangleDrawing {
    fn new(ui: &Ui, rect: Rect, arm: &Arm, pose: &TwoBonePose) -> Self {
        let (left, right) = (pose.along.min(0.0), pose.distance.max(pose.along));
        let inside = rect.shrink2(MARGINS);
        // All poses of an arm have the same scale, so that the triangle grows with D; only a
        // triangle that would not fit has a smaller scale.
        let widest = (right - left).max(arm.bones.outer_limit() * 0.7);
        let scale = (inside.width() / widest).min(inside.height() / pose.out.max(1e-9));
        let middle = (left + right) / 2.0;
        let place = |along: f32, out: f32| {
            pos2(inside.center().x + (along - middle) * scale, inside.bottom() - out * scale)
        };
        let palette = style::palette(ui);
        Self {
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
        }
    }

    /// The lines that light up, and that the mouse can point at.
    fn figure_lines(&self) -> [FigureLine; 7] {
        let Self { shoulder, elbow, hand, foot, .. } = *self;
        [
            (ArmFigure::Upper, vec![shoulder, elbow]),
            (ArmFigure::Lower, vec![elbow, hand]),
            // A part of the line of D: the first one counts.
            (ArmFigure::Along, vec![shoulder, foot]),
            (ArmFigure::Distance, vec![shoulder, hand]),
            (ArmFigure::Out, vec![foot, elbow]),
            (ArmFigure::ShoulderAngle, arc(shoulder, ARC, 0.0, -self.angle)),
            (ArmFigure::ElbowAngle, self.elbow_arc()),
        ]
        .map(|(figure, points)| FigureLine { figure, points })
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

    /// Paints lines and labels, and returns where the labels are.
    fn paint(&self, painter: &Painter, ui: &Ui) -> Vec<(Rect, ArmFigure)> {
        let thin = Stroke::new(1.0, self.weak);
        painter.extend(Shape::dashed_line(&[self.elbow, self.foot], thin, 3.0, 3.0));
        painter.line_segment([self.shoulder, self.hand], Stroke::new(1.5, self.text));
        self.paint_compass(painter);
        self.paint_angles(painter);
        painter.line_segment([self.shoulder, self.elbow], Stroke::new(4.0, self.upper));
        painter.line_segment([self.elbow, self.hand], Stroke::new(4.0, self.lower));
        for joint in [self.shoulder, self.elbow, self.hand] {
            painter.circle(joint, 4.5, ui.visuals().extreme_bg_color, Stroke::new(2.0, self.text));
        }
        self.write(painter, ui)
    }

    /// Paints the circles around shoulder and hand where they cross: the elbow.
    fn paint_compass(&self, painter: &Painter) {
        for (points, colour) in self.compass().into_iter().zip([self.upper, self.lower]) {
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
        painter.add(Shape::line(arc(self.shoulder, ARC, 0.0, -self.angle), stroke));
        painter.add(Shape::line(self.elbow_arc(), stroke));
    }

    /// Writes each label at the first of its positions that is clear of lines and other labels.
    /// Labels without such a position are left out, except those of the sides.
    fn write(&self, painter: &Painter, ui: &Ui) -> Vec<(Rect, ArmFigure)> {
        let mut labels = Labels::new(painter, ui, self.lines());
        let (shoulder, elbow, hand, foot) = (self.shoulder, self.elbow, self.hand, self.foot);
        labels.write_always("Upper d_1", self.upper, ArmFigure::Upper, &beside(shoulder, elbow));
        labels.write_always("Lower d_2", self.lower, ArmFigure::Lower, &beside(elbow, hand));
        labels.write_always("Distance D", self.text, ArmFigure::Distance, &beside(hand, shoulder));
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
        labels.write("Shoulder θ_e", self.accent, ArmFigure::ShoulderAngle, &in_angle);
        let (start, turn) = self.at_elbow();
        let at_elbow = around(elbow, ARC, start + 0.5 * turn);
        let above = [(-1.0, -14.0), (1.0, -14.0), (-1.0, -24.0), (1.0, -24.0)];
        let above = above
            .map(|(side, up)| Place { at: elbow + vec2(side * 12.0, up), away: vec2(side, 0.0) });
        let at_elbow = [at_elbow, above.to_vec()].concat();
        labels.write("Elbow φ", self.accent, ArmFigure::ElbowAngle, &at_elbow);
        let heights = [beside(elbow, foot), beside(foot, elbow)].concat();
        labels.write("Out o_e", self.weak, ArmFigure::Out, &heights);
        let lengths = [0.5, 0.35, 0.65].map(|part| foot + (shoulder - foot) * part);
        let lengths =
            [4.0, 18.0].map(|down| lengths.map(|at| Place { at: at + below * down, away: below }));
        labels.write("Along h_e", self.weak, ArmFigure::Along, &lengths.concat());
        labels.written()
    }

    /// The lines that labels keep clear of.
    fn lines(&self) -> Vec<[Pos2; 2]> {
        let Self { shoulder, elbow, hand, foot, .. } = *self;
        let sides = [[shoulder, elbow], [elbow, hand], [shoulder, hand], [elbow, foot]];
        let ends = self.compass().map(|points| [points[0], points[points.len() - 1]]);
        [sides.as_slice(), &ends].concat()
    }
}

/// Points of an arc around a point. Angles are in radians, clockwise from the right.
fn arc(centre: Pos2, radius: f32, start: f32, turn: f32) -> Vec<Pos2> {
    const STEPS: u8 = 24;
    let part = |step: u8| f32::from(step) / f32::from(STEPS);
    (0..=STEPS).map(|step| centre + radius * Vec2::angled(start + part(step) * turn)).collect()
}
