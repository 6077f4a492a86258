//! The Pointer's two angles: the Cursor seen from above and from the side, as right triangles.

use egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo,
    vec2,
};
use glam::Vec3;

use super::figures::{
    FigureLabels, FigureLine, FormulaRow, Lit, arc, around, beside, degrees, length, table,
};
use crate::session::{LimbFigure, ShownLimb};
use crate::ui::style;
use crate::words::LimbWords;

const HEIGHT: f32 = 140.0;
/// Room for labels at the sides, and above and below.
const MARGINS: Vec2 = vec2(30.0, 26.0);
/// Radius of the arcs of the angles, in points.
const ARC: f32 = 18.0;

pub(super) fn ui(ui: &mut Ui, limb: &ShownLimb, lit: &mut Lit) {
    drawing(ui, limb, lit);
    table(ui, "pointer", &rows(limb), lit);
}

/// Shows both triangles side by side, in one scale.
fn drawing(ui: &mut Ui, limb: &ShownLimb, lit: &mut Lit) {
    let (pose, cursor) = (limb.frames.pose(), limb.frames.pointed_at());
    let level = cursor.x.hypot(cursor.z);
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, description(limb, cursor)));
    let (left, right) = rect.split_left_right_at_fraction(0.5);
    let (left, right) = (left.with_max_x(left.right() - 2.0), right.with_min_x(right.left() + 2.0));
    let scale = scale(limb, left.size() - 2.0 * MARGINS, cursor, level);
    let above = RightTriangle {
        title: "From above",
        // The y axis points at the viewer; z points down.
        legs: scale * vec2(cursor.x, cursor.z),
        figures: [LimbFigure::Cursor, LimbFigure::Cursor, LimbFigure::Level, LimbFigure::Yaw],
        names: ["x_c", "z_c", "h_c", "θ_z"],
        angle: pose.yaw(),
    };
    let beside = RightTriangle {
        title: "From the side",
        legs: scale * vec2(level, -cursor.y),
        figures: [LimbFigure::Level, LimbFigure::Cursor, LimbFigure::Distance, LimbFigure::Pitch],
        names: ["h_c", "y_c", "|c|", "θ_y"],
        angle: -pose.pitch(),
    };
    for (triangle, rect) in [(above, left), (beside, right)] {
        triangle.show(ui, rect, &response, lit);
    }
    response.on_hover_text("Where the Cursor is from the Root, to scale");
}

fn description(limb: &ShownLimb, cursor: Vec3) -> String {
    let [x, y, z] = cursor.to_array().map(|it| length(limb, it));
    let level = length(limb, cursor.x.hypot(cursor.z));
    format!("Cursor from above: x {x}, z {z}, level {level}; from the side: level {level}, y {y}")
}

/// Points per unit of length. A Cursor near the shoulder is not enlarged, so that it looks near.
fn scale(limb: &ShownLimb, room: Vec2, cursor: Vec3, level: f32) -> f32 {
    let least = 0.4 * limb.frames.bones().outer_limit();
    let wide = level.max(least);
    let high = cursor.y.abs().max(cursor.z.abs()).max(0.5 * least);
    (room.x / wide).min(room.y / high)
}

/// A right triangle with a corner at the shoulder.
struct RightTriangle {
    title: &'static str,
    /// From the shoulder to the right angle, and from there to the Cursor; in points.
    legs: Vec2,
    /// Legs, hypotenuse and angle.
    figures: [LimbFigure; 4],
    names: [&'static str; 4],
    /// From the first axis to the hypotenuse, clockwise on the screen.
    angle: f32,
}

impl RightTriangle {
    fn show(&self, ui: &Ui, rect: Rect, response: &egui::Response, lit: &mut Lit) {
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 6.0, ui.visuals().extreme_bg_color);
        let weak = ui.visuals().weak_text_color();
        let title = rect.left_top() + vec2(6.0, 4.0);
        painter.text(title, Align2::LEFT_TOP, self.title, FontId::proportional(11.0), weak);
        let shoulder = rect.center() + vec2(0.0, 6.0) - 0.5 * self.legs;
        let (corner, cursor) = (shoulder + vec2(self.legs.x, 0.0), shoulder + self.legs);
        let lines = self.lines(shoulder, corner, cursor);
        lit.paint(&painter, ui, &lines);
        self.paint(&painter, ui, &lines);
        let labels = self.write(&painter, ui, shoulder, corner, cursor);
        lit.point(response, &lines, &labels);
    }

    fn lines(&self, shoulder: Pos2, corner: Pos2, cursor: Pos2) -> [FigureLine; 4] {
        let [first, second, hypotenuse, angle] = self.figures;
        [
            (first, vec![shoulder, corner]),
            (second, vec![corner, cursor]),
            (hypotenuse, vec![shoulder, cursor]),
            (angle, arc(shoulder, ARC, 0.0, self.angle)),
        ]
        .map(|(figure, points)| FigureLine { figure, points })
    }

    fn paint(&self, painter: &Painter, ui: &Ui, lines: &[FigureLine; 4]) {
        let [text, weak, accent] = colours(ui);
        let [first, second, hypotenuse, arc] = lines;
        for leg in [first, second] {
            painter.extend(Shape::dashed_line(&leg.points, Stroke::new(1.0, weak), 3.0, 3.0));
        }
        painter.line(hypotenuse.points.clone(), Stroke::new(2.0, text));
        painter.line(arc.points.clone(), Stroke::new(1.5, accent));
        for end in &hypotenuse.points {
            painter.circle(*end, 3.5, ui.visuals().extreme_bg_color, Stroke::new(1.5, text));
        }
    }

    fn write(
        &self,
        painter: &Painter,
        ui: &Ui,
        shoulder: Pos2,
        corner: Pos2,
        cursor: Pos2,
    ) -> Vec<(Rect, LimbFigure)> {
        let [text, weak, accent] = colours(ui);
        let sides = [(shoulder, corner), (corner, cursor), (shoulder, cursor)];
        let mut lines = sides.map(|(from, to)| [from, to]).to_vec();
        // Labels keep clear of the circles at the ends, too.
        lines.extend([shoulder, cursor].map(|end| [end - vec2(5.0, 0.0), end + vec2(5.0, 0.0)]));
        let mut labels = FigureLabels::new(painter, ui, lines);
        for (nth, colour) in [(2, text), (0, weak), (1, weak)] {
            let (from, to) = sides[nth];
            let both = [beside(from, to), beside(to, from)].concat();
            labels.write(self.names[nth], colour, self.figures[nth], &both);
        }
        let around = around(shoulder, ARC, 0.5 * self.angle);
        labels.write(self.names[3], accent, self.figures[3], &around);
        labels.written()
    }
}

/// Colours of the text, of what is quieter, and of angles.
fn colours(ui: &Ui) -> [Color32; 3] {
    [ui.visuals().text_color(), ui.visuals().weak_text_color(), style::accent(ui)]
}

fn rows(limb: &ShownLimb) -> [FormulaRow; 4] {
    let (pose, cursor) = (limb.frames.pose(), limb.frames.pointed_at());
    let LimbWords { base, end, .. } = limb.words;
    let is_hard = limb.frames.posed.ik.soft_reach.is_hard();
    [
        FormulaRow {
            symbol: "Yaw θ_z".to_owned(),
            formula: "atan2(z_c, x_c)",
            value: degrees(pose.yaw()),
            meaning: "Angle of the Pointer about the Root's y, from x towards z".to_owned(),
            figure: Some(LimbFigure::Yaw),
        },
        FormulaRow {
            symbol: "Level h_c".to_owned(),
            formula: "hypot(x_c, z_c)",
            value: length(limb, cursor.x.hypot(cursor.z)),
            meaning: "Level distance from the Root to the Cursor (x_c, y_c, z_c)".to_owned(),
            figure: Some(LimbFigure::Level),
        },
        FormulaRow {
            symbol: "Pitch θ_y".to_owned(),
            formula: "atan2(y_c, h_c)",
            value: degrees(pose.pitch()),
            meaning: "Angle of the Pointer above the Root's xz-plane".to_owned(),
            figure: Some(LimbFigure::Pitch),
        },
        FormulaRow {
            symbol: "Distance D".to_owned(),
            formula: if is_hard { "|c|, limited" } else { "|c|, softened" },
            value: length(limb, pose.distance),
            meaning: format!("Distance from {base} to {end}: the Cursor's, within the limits"),
            figure: Some(LimbFigure::Distance),
        },
    ]
}
