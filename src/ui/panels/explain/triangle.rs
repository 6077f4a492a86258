//! The triangle of shoulder, elbow and hand in the plane of the arm, to scale.

use core::f32::consts::TAU;
use std::sync::Arc;

use egui::{
    Color32, Galley, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, pos2,
    vec2,
};

use crate::document::Arm;
use crate::kinematics::two_bone::TwoBonePose;
use crate::ui::style;
use crate::ui::widgets::symbol;

const HEIGHT: f32 = 184.0;
/// Room for labels at the sides, and above and below.
const MARGINS: Vec2 = vec2(44.0, 34.0);
const SIZE: f32 = 13.0;
/// Radius of the arc of θ_e, in points.
const ARC: f32 = 18.0;

pub(in crate::ui) fn ui(ui: &mut Ui, arm: &Arm, pose: &TwoBonePose) {
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    response.widget_info(|| {
        let text = format!(
            "Triangle: upper limb {}, lower limb {}, distance {}, angle at the shoulder {:.1} degrees",
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
        const STEPS: usize = 24;
        let arc = (0..=STEPS).map(|step| {
            let angle = self.angle * step as f32 / STEPS as f32;
            self.shoulder + ARC * vec2(angle.cos(), -angle.sin())
        });
        painter.add(Shape::line(arc.collect(), Stroke::new(1.5, self.accent)));
    }

    /// Writes each label at the first of its positions that is clear of lines and other labels. Labels
    /// without such a position are left out, except those of the sides.
    fn write(&self, painter: &Painter, ui: &Ui) {
        let room = painter.clip_rect().shrink(3.0);
        let mut labels = Labels { painter, ui, room, lines: self.lines(), written: Vec::new() };
        let (shoulder, elbow, hand, foot) = (self.shoulder, self.elbow, self.hand, self.foot);
        labels.write_always("Upper d_1", self.upper, &beside(shoulder, elbow));
        labels.write_always("Lower d_2", self.lower, &beside(elbow, hand));
        labels.write_always("Distance D", self.text, &beside(hand, shoulder));
        let angle = self.angle.min(TAU / 4.0);
        let in_angle = [38.0, 46.0, 56.0].into_iter().flat_map(|radius| {
            [0.5, 0.65, 0.8, 0.35].map(|part| Place {
                at: shoulder + radius * Vec2::angled(-part * angle),
                away: Vec2::ZERO,
            })
        });
        let below = vec2(0.0, 1.0);
        let beneath = Place { at: shoulder + below * 6.0, away: below };
        let in_angle: Vec<_> = in_angle.chain([beneath]).collect();
        labels.write("Angle θ_e", self.accent, &in_angle);
        let heights = [beside(elbow, foot), beside(foot, elbow)].concat();
        labels.write("Out o_e", self.weak, &heights);
        let lengths = [0.5, 0.35, 0.65].map(|part| foot + (shoulder - foot) * part);
        let lengths =
            [4.0, 18.0].map(|down| lengths.map(|at| Place { at: at + below * down, away: below }));
        labels.write("Along h_e", self.weak, &lengths.concat());
    }

    fn lines(&self) -> [[Pos2; 2]; 4] {
        let Self { shoulder, elbow, hand, foot, .. } = *self;
        [[shoulder, elbow], [elbow, hand], [shoulder, hand], [elbow, foot]]
    }
}

/// A place for a label: beside a point, on the side in the direction `away`; centred on it for 0.
#[derive(Clone, Copy)]
struct Place {
    at: Pos2,
    away: Vec2,
}

impl Place {
    fn rect(self, size: Vec2) -> Rect {
        let extent = self.away.x.abs() * size.x + self.away.y.abs() * size.y;
        Rect::from_center_size(self.at + self.away * extent * 0.5, size)
    }
}

/// Places to the left of a line, seen from its first point: near its middle first.
fn beside(from: Pos2, to: Pos2) -> Vec<Place> {
    const GAP: f32 = 6.0;
    let along = (to - from).normalized();
    let away = vec2(along.y, -along.x);
    let parts = [0.5, 0.35, 0.65, 0.2, 0.8];
    parts.map(|part| Place { at: from + (to - from) * part + away * GAP, away }).to_vec()
}

/// Labels of a drawing, beside its lines.
struct Labels<'a> {
    painter: &'a Painter,
    ui: &'a Ui,
    /// The rectangle that labels stay in.
    room: Rect,
    lines: [[Pos2; 2]; 4],
    written: Vec<Rect>,
}

impl Labels<'_> {
    /// Writes a label at the first clear place, if there is one.
    fn write(&mut self, text: &str, colour: Color32, places: &[Place]) {
        let galley = self.galley(text, colour);
        let rects = places.iter().map(|place| place.rect(galley.size()));
        if let Some(rect) = rects.into_iter().find(|rect| self.is_clear(*rect)) {
            self.paint(rect, galley, colour);
        }
    }

    /// Writes a label at the first clear place, or else at the first one, moved into the room.
    fn write_always(&mut self, text: &str, colour: Color32, places: &[Place]) {
        let galley = self.galley(text, colour);
        let mut rects = places.iter().map(|place| place.rect(galley.size()));
        let Some(first) = rects.clone().next() else { return };
        let rect = rects.find(|rect| self.is_clear(*rect)).unwrap_or_else(|| self.moved_in(first));
        self.paint(rect, galley, colour);
    }

    fn moved_in(&self, rect: Rect) -> Rect {
        let inwards = (self.room.min - rect.min).max(Vec2::ZERO);
        rect.translate(inwards + (self.room.max - rect.max).min(Vec2::ZERO))
    }

    fn galley(&self, text: &str, colour: Color32) -> Arc<Galley> {
        self.ui.fonts_mut(|fonts| fonts.layout_job(symbol::layout(text, SIZE, colour)))
    }

    fn paint(&mut self, rect: Rect, galley: Arc<Galley>, colour: Color32) {
        self.painter.galley(rect.min, galley, colour);
        self.written.push(rect);
    }

    fn is_clear(&self, rect: Rect) -> bool {
        let rect = rect.expand(2.0);
        let is_crossed = |[from, to]: &[Pos2; 2]| {
            const STEPS: usize = 64;
            (0..=STEPS)
                .any(|step| rect.contains(*from + (*to - *from) * (step as f32 / STEPS as f32)))
        };
        self.room.contains_rect(rect)
            && !self.lines.iter().any(is_crossed)
            && !self.written.iter().any(|other| other.expand2(vec2(6.0, 0.0)).intersects(rect))
    }
}
