//! The same step of the hand with the arm bent and nearly straight, each as two poses laid over each
//! other. Soft limits play no part: this is the triangle alone.

use egui::{Align2, FontId, Painter, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::document::Arm;
use crate::kinematics::soft_reach::{ReachLimits, SoftReach};
use crate::kinematics::two_bone::TwoBonePose;
use crate::session::Session;
use crate::ui::style;

const HEIGHT: f32 = 92.0;
/// Room for joints at the sides, and for the line of text below the arm.
const MARGINS: [f32; 2] = [8.0, 24.0];
/// Length of the step, as a fraction of the range of the hand's distances.
const STEP: f32 = 0.05;
/// Where in this range the step ends, from 0 to 1, by its name.
const ENDS: [(&str, f32); 2] = [("Bent", 0.7), ("Nearly straight", 1.0)];

pub(super) fn ui(ui: &mut Ui, session: &Session) {
    let steps = ENDS.map(|(name, end)| SameStep::new(session.arm(), name, end));
    let highest =
        steps.iter().flat_map(|step| step.poses).map(|pose| pose.out).fold(1e-9, f32::max);
    for step in &steps {
        drawing(ui, step, highest);
    }
}

/// Two poses of the arm, before and after a step of the hand away from the shoulder.
struct SameStep<'a> {
    arm: &'a Arm,
    name: &'static str,
    step: f32,
    poses: [TwoBonePose; 2],
}

impl<'a> SameStep<'a> {
    /// The step that ends at a part of the range of the hand's distances.
    fn new(arm: &'a Arm, name: &'static str, end: f32) -> Self {
        let hard = Arm { influence: 1.0, soft_reach: SoftReach::default(), ..*arm };
        let ReachLimits { inner, outer } = hard.reach_limits();
        let direction = arm.pose().pointer.direction;
        let pose = |part: f32| {
            let mut posed = hard;
            posed.set_cursor(direction * (inner + part * (outer - inner)));
            posed.pose()
        };
        let step = STEP * (outer - inner);
        Self { arm, name, step, poses: [pose(end - STEP), pose(end)] }
    }

    /// Distance that the elbow moves in the plane of the arm.
    fn elbow(&self) -> f32 {
        let [before, after] = &self.poses;
        (after.along - before.along).hypot(after.out - before.out)
    }

    fn text(&self) -> String {
        let [step, elbow] = [self.step, self.elbow()].map(|length| self.arm.format_length(length));
        format!("{}: hand {step}, elbow {elbow}", self.name)
    }
}

/// Draws both poses in a scale in which `highest`, a distance of the elbow from the Pointer, fits.
fn drawing(ui: &mut Ui, step: &SameStep<'_>, highest: f32) {
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
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
    response.on_hover_text("Compare how far the same step of the hand moves the elbow");
}

/// Shoulder, elbow and hand of both poses on screen.
fn corners(rect: Rect, step: &SameStep<'_>, highest: f32) -> [[Pos2; 3]; 2] {
    let inside = Rect::from_min_max(
        rect.min + vec2(MARGINS[0], MARGINS[0]),
        rect.max - vec2(MARGINS[0], MARGINS[1]),
    );
    let outer = step.arm.bones.outer_limit();
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
