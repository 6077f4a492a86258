//! The screen that gizmos are painted on: projection from world to screen, distances and colours,
//! and the lines of a locked axis and of aims.

use core::f32::consts::TAU;

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, TextStyle, Ui, Vec2, vec2};
use glam::Vec3;

use crate::document::{Camera, Overlay, Projection, Ray};
use crate::kinematics::chain_ik::Ellipsoid;
use crate::rig::LimbPart;
use crate::session::{Constraint, Drag, Session};
use crate::ui::{panels, style};

/// Converts world points to screen positions in points, and screen positions to rays in the world.
pub(in crate::ui) struct ScreenProjection {
    pub rect: Rect,
    pub projection: Projection,
}

impl ScreenProjection {
    pub fn new(rect: Rect, camera: &Camera) -> Self {
        Self { rect, projection: camera.projection(rect.aspect_ratio()) }
    }

    pub fn place(&self, point: Vec3) -> Option<Pos2> {
        let at = self.projection.project(point)?;
        Some(self.rect.center() + vec2(at.x, -at.y) * self.rect.size() / 2.0)
    }

    pub fn ray(&self, at: Pos2) -> Ray {
        self.projection.ray(self.normalised(at))
    }

    /// The screen position in normalised coordinates: −1 to 1 across the viewport, with y up.
    pub fn normalised(&self, at: Pos2) -> glam::Vec2 {
        let from_centre = (at - self.rect.center()) / (self.rect.size() / 2.0);
        glam::Vec2::new(from_centre.x, -from_centre.y)
    }

    pub fn units_per_point(&self, at: Vec3) -> f32 {
        self.projection.half_height_at(at) / (self.rect.height() / 2.0)
    }

    /// Distance of a world point from the eye along the view direction.
    pub fn depth(&self, point: Vec3) -> f32 {
        (point - self.projection.eye).dot(self.projection.forward)
    }

    /// Screen vector, in points, of a world vector at the world point `at`, without perspective.
    pub fn direction(&self, vector: Vec3, at: Vec3) -> Vec2 {
        let [right, up] = [self.projection.right, self.projection.up].map(Vec3::normalize);
        vec2(vector.dot(right), -vector.dot(up)) / self.units_per_point(at)
    }
}

pub(in crate::ui) fn bright(colour: Color32) -> Color32 {
    colour.lerp_to_gamma(Color32::WHITE, 0.35)
}

/// Draws a circle that is also seen on a body of its own colour: on a halo of the sky's.
pub(in crate::ui) fn circle(painter: &Painter, ui: &Ui, at: Pos2, radius: f32, stroke: Stroke) {
    let halo = style::colour(style::palette(ui).sky_bottom).gamma_multiply(0.55);
    painter.circle_stroke(at, radius, Stroke::new(stroke.width + 2.0, halo));
    painter.circle_stroke(at, radius, stroke);
}

/// Distance in points from a screen position to a line segment; infinite if an end of the segment
/// is not finite, as behind the eye.
pub(in crate::ui) fn to_segment(at: Pos2, from: Pos2, to: Pos2) -> f32 {
    if !(from.is_finite() && to.is_finite()) {
        return f32::INFINITY;
    }
    let along = to - from;
    let part = if along.length_sq() > 0.0 {
        ((at - from).dot(along) / along.length_sq()).clamp(0.0, 1.0)
    } else {
        0.0
    };
    at.distance(from + along * part)
}

/// Draws a line along the locked axis, or two along those of the locked plane, through the point
/// that is dragged.
pub(in crate::ui) fn locked_axis(
    painter: &Painter,
    ui: &Ui,
    screen: &ScreenProjection,
    session: &Session,
) {
    let Some(drag) = session.history().drag().and_then(Drag::point) else { return };
    let Some(constraint) = drag.constraint() else { return };
    let is_free = |axis: usize| match constraint {
        Constraint::Axis(free) => axis == free,
        Constraint::Plane(normal) => axis != normal,
    };
    let colours = style::palette(ui).axes;
    for axis in (0..3).filter(|axis| is_free(*axis)) {
        let stroke = Stroke::new(1.5, style::colour(colours[axis]));
        line(painter, screen, drag.at(), Vec3::AXES[axis], stroke);
    }
}

/// Draws the two bones of the limb that a page is about over the skin that hides them, in the colours
/// that they have there.
pub(in crate::ui) fn limb_of_page(
    painter: &Painter,
    ui: &Ui,
    screen: &ScreenProjection,
    session: &Session,
) {
    let display = session.shown().display;
    let has_skin = session.rig().skin.is_some() && display.shows(Overlay::Skin);
    let is_hidden = has_skin && !display.shows_bones_in_skin();
    let Some(limb) = session.limb_of_page().filter(|_| is_hidden) else { return };
    let joints = [LimbPart::Root, LimbPart::Elbow, LimbPart::Hand];
    let places = joints.map(|part| screen.place(limb.frames.origin(part)));
    let [Some(base), Some(middle), Some(end)] = places else { return };
    let palette = style::palette(ui);
    let [upper, lower] = [palette.upper, palette.lower].map(style::colour);
    painter.line_segment([base, middle], Stroke::new(3.0, upper));
    painter.line_segment([middle, end], Stroke::new(3.0, lower));
    for (at, colour) in [(base, upper), (middle, lower)] {
        painter.circle_filled(at, 4.0, colour);
    }
}

/// Writes the names of joints that aim beside the points that they aim at, below the handles of the
/// selected one, and draws faint lines to these points. A joint that is selected or under the mouse has
/// its line in the scene.
pub(in crate::ui) fn aims(
    painter: &Painter,
    ui: &Ui,
    screen: &ScreenProjection,
    session: &Session,
) {
    /// Distance of a name from its point.
    const GAP: f32 = 16.0;
    const BELOW_HANDLES: f32 = 40.0;
    /// Radius of the ring at a point.
    const RING: f32 = 11.0;
    let pose = &session.posed().evaluated_skeleton().solved;
    let selected = session.selection().active();
    for target in session.rig().targets.iter().filter(|target| target.is_posing()) {
        let Some(line) = target.aim_line_in_world(pose) else { continue };
        let ends = line.map(|end| screen.place(end));
        let [Some(from), Some(to)] = ends else { continue };
        let is_selected = selected == Some(target.joint);
        if !is_selected && session.selection().hovered() != Some(target.joint) {
            let accent = style::colour(style::palette(ui).accent).gamma_multiply(0.5);
            let ends = [from, to + (from - to).normalized() * RING];
            painter.extend(Shape::dashed_line(&ends, Stroke::new(1.0, accent), 5.0, 4.0));
        }
        let has_name = session.shown().display.shows(Overlay::Labels);
        if let Some(joint) = session.rig().skeleton.joint(target.joint).filter(|_| has_name) {
            let text = panels::target_name(target, &joint.name).into_owned();
            let font = TextStyle::Body.resolve(ui.style());
            let text = painter.layout_no_wrap(text, font, ui.visuals().text_color());
            let half = 0.5 * text.size().y;
            let left = to - vec2(GAP + text.size().x, half);
            let below = |down: f32| to + vec2(-0.5 * text.size().x, down);
            // On the side that is not the joint's, if there is room.
            let has_room = left.x > painter.clip_rect().left();
            let at = match is_selected {
                true => below(BELOW_HANDLES),
                false if to.x >= from.x => to + vec2(GAP, -half),
                false if has_room => left,
                false => below(GAP),
            };
            painter.galley(at, text, ui.visuals().text_color());
        }
    }
}

/// Draws where the dragged point of a body can go while all that its targets hold stays: a line, the
/// outline of a plane or three outlines of a space, as long as the point can be fast there. Nothing
/// for a point that can go everywhere as well.
pub(in crate::ui) fn freedom(
    painter: &Painter,
    ui: &Ui,
    screen: &ScreenProjection,
    session: &Session,
) {
    /// Radius of the longest outline on screen, in points.
    const RADIUS: f32 = 56.0;
    const POINTS: u16 = 48;
    let limit = session.history().drag().and_then(Drag::limit);
    let Some(Ellipsoid { centre, axes, values, .. }) = limit.map(|limit| limit.freedom) else {
        return;
    };
    if values[0] <= 0.0 {
        return;
    }
    let stroke = Stroke::new(1.5, style::accent(ui));
    let longest = RADIUS * screen.units_per_point(centre);
    let reach = [0, 1, 2].map(|axis| axes[axis] * (longest * values[axis] / values[0]));
    if values[1] == 0.0 {
        let ends = [centre - reach[0], centre + reach[0]].map(|end| screen.place(end));
        if let [Some(from), Some(to)] = ends {
            painter.line_segment([from, to], stroke);
        }
    }
    for (one, other) in [(0, 1), (0, 2), (1, 2)] {
        if values[one] == 0.0 || values[other] == 0.0 {
            continue;
        }
        let at = |point: u16| {
            let (sin, cos) = (TAU * f32::from(point) / f32::from(POINTS)).sin_cos();
            screen.place(centre + cos * reach[one] + sin * reach[other])
        };
        let outline: Option<Vec<Pos2>> = (0..=POINTS).map(at).collect();
        painter.extend(outline.map(|outline| Shape::line(outline, stroke)));
    }
}

/// Draws a line in world space to both sides of a point, as far as it is before the eye.
fn line(painter: &Painter, screen: &ScreenProjection, at: Vec3, along: Vec3, stroke: Stroke) {
    /// Length to each side, in heights of the view.
    const FARTHEST: f32 = 20.0;
    const HALVINGS: i32 = 12;
    let Some(here) = screen.place(at) else { return };
    let height = screen.units_per_point(at) * screen.rect.height();
    for direction in [along, -along] {
        let lengths = (0..HALVINGS).map(|halving| FARTHEST * 0.5_f32.powi(halving) * height);
        let ends = lengths.filter_map(|length| screen.place(at + direction * length));
        if let Some(end) = ends.into_iter().next() {
            painter.line_segment([here, end], stroke);
        }
    }
}
