//! The triangle of shoulder, elbow and hand in the plane of the arm, to scale.

use core::f32::consts::TAU;

use egui::{
    Align2, Color32, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::document::Arm;
use crate::kinematics::two_bone::TwoBonePose;
use crate::ui::style;
use crate::ui::widgets::symbol;

const HEIGHT: f32 = 170.0;
const MARGIN: f32 = 26.0;
const SIZE: f32 = 14.0;

pub(in crate::ui) fn ui(ui: &mut Ui, arm: &Arm, pose: &TwoBonePose) {
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    response.widget_info(|| {
        let text = format!(
            "Triangle: d 1 {}, d 2 {}, D {}, theta e {:.1} degrees",
            arm.format_length(arm.bones.upper() * pose.stretch),
            arm.format_length(arm.bones.lower() * pose.stretch),
            arm.format_length(pose.distance),
            pose.shoulder_angle().to_degrees(),
        );
        WidgetInfo::labeled(Role::Image, true, text)
    });
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 6.0, ui.visuals().extreme_bg_color);
    TriangleDrawing::new(ui, rect, arm, pose).paint(&painter, ui);
    response.on_hover_text("The arm in its own plane, to scale");
}

/// Screen positions and colours.
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
        let inside = rect.shrink(MARGIN);
        // One scale for all poses of an arm, so that a growing D grows; smaller only where the
        // triangle would not fit.
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

    fn paint(&self, painter: &Painter, ui: &Ui) {
        let thin = Stroke::new(1.0, self.weak);
        painter.extend(Shape::dashed_line(&[self.elbow, self.foot], thin, 3.0, 3.0));
        painter.line_segment([self.shoulder, self.hand], Stroke::new(1.5, self.text));
        self.paint_angle(painter);
        painter.line_segment([self.shoulder, self.elbow], Stroke::new(4.0, self.upper));
        painter.line_segment([self.elbow, self.hand], Stroke::new(4.0, self.lower));
        for joint in [self.shoulder, self.elbow, self.hand] {
            painter.circle(joint, 4.5, ui.visuals().extreme_bg_color, Stroke::new(2.0, self.text));
        }
        self.write(painter, ui);
    }

    fn paint_angle(&self, painter: &Painter) {
        const RADIUS: f32 = 24.0;
        const STEPS: usize = 24;
        let arc = (0..=STEPS).map(|step| {
            let angle = self.angle * step as f32 / STEPS as f32;
            self.shoulder + RADIUS * vec2(angle.cos(), -angle.sin())
        });
        painter.add(Shape::line(arc.collect(), Stroke::new(1.5, self.accent)));
    }

    fn write(&self, painter: &Painter, ui: &Ui) {
        let middle = |a: Pos2, b: Pos2| a + (b - a) / 2.0;
        let beside = |from: Pos2, to: Pos2| {
            let along = (to - from).normalized();
            middle(from, to) + vec2(along.y, -along.x) * 12.0
        };
        let write = |at: Pos2, text: &str, colour: Color32| {
            let galley = ui.fonts_mut(|fonts| fonts.layout_job(symbol::layout(text, SIZE, colour)));
            let min = Align2::CENTER_CENTER.anchor_size(at, galley.size()).min;
            painter.galley(min, galley, colour);
        };
        write(beside(self.shoulder, self.elbow), "d_1", self.upper);
        write(beside(self.elbow, self.hand), "d_2", self.lower);
        let half = self.angle.min(TAU / 4.0) / 2.0;
        write(self.shoulder + 38.0 * vec2(half.cos(), -half.sin()), "θ_e", self.accent);
        let below = vec2(0.0, 13.0);
        write(middle(self.shoulder, self.hand) + below, "D", self.text);
        // Hidden with their lines in a straight or folded arm.
        if (self.elbow - self.foot).length() > 24.0 {
            write(middle(self.elbow, self.foot) + vec2(12.0, 0.0), "o_e", self.weak);
            let clear =
                (middle(self.shoulder, self.foot) - middle(self.shoulder, self.hand)).length();
            if clear > 24.0 {
                write(middle(self.shoulder, self.foot) + below, "h_e", self.weak);
            }
        }
    }
}
