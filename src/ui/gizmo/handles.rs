//! Handles of constant size on screen.

use core::f32::consts::TAU;

use egui::{Align2, Color32, FontId, Painter, Pos2, Shape, Stroke, Ui, Vec2};
use glam::Vec3;

use super::screen::{ScreenProjection, bright, circle, to_segment};
use crate::session::{Grip, GripRing, PointHandle};
use crate::ui::style;

/// Length in points of an arrow that is normal to the view direction.
const LENGTH: f32 = 80.0;
/// Distances in points from the centre to the near and the far edges of a square.
const SQUARE: (f32, f32) = (24.0, 42.0);
/// Distances in points from the mouse to the centre at which the squares are seen fully and no longer.
const SQUARES_SEEN: (f32, f32) = (90.0, 130.0);
/// Maximum distance in points at which the mouse hits an arrow.
const HIT: f32 = 10.0;
/// Radius in points, around the centre, of the handle that moves the point freely.
const FREE_RADIUS: f32 = 14.0;

/// An arrow is hidden if it is shorter on screen than this fraction of `LENGTH`.
const SHORTEST: f32 = 0.25;
/// A square is hidden if its area on screen is below this fraction of its full area.
const NARROWEST: f32 = 0.2;

const NAMES: [&str; 3] = ["X", "Y", "Z"];

/// Screen positions of the handles of one point.
pub(in crate::ui) struct TranslateHandles {
    centre: Pos2,
    /// The hand, if it serves as a second handle of the Cursor; it can be away from the Cursor.
    hand: Option<Pos2>,
    /// Vectors on screen, in points, from the centre to the tips of the x, y and z arrows.
    arrows: [Vec2; 3],
}

impl TranslateHandles {
    /// Handles around the world point `cursor`; `hand` is a second point by which `cursor` can be
    /// dragged. `None` if `cursor` is behind the eye.
    pub fn new(screen: &ScreenProjection, cursor: Vec3, hand: Option<Vec3>) -> Option<Self> {
        let centre = screen.place(cursor)?;
        let unit = LENGTH * screen.units_per_point(cursor);
        let mut arrows = [Vec2::ZERO; 3];
        for (arrow, axis) in arrows.iter_mut().zip(Vec3::AXES) {
            // Projected without perspective, because arrows towards the eye would be endless.
            *arrow = screen.direction(axis * unit, cursor);
        }
        Some(Self { centre, hand: hand.and_then(|hand| screen.place(hand)), arrows })
    }

    /// The handle at a screen position; `None` if there is no handle.
    pub fn at(&self, mouse: Pos2) -> Option<PointHandle> {
        if let Some(free) = self.free_at(mouse) {
            return Some(free);
        }
        if let Some(axis) = (0..3).find(|axis| self.on_square(*axis, mouse)) {
            return Some(PointHandle::Plane(axis));
        }
        (0..3)
            .filter(|axis| self.arrow_shows(*axis))
            .map(|axis| (self.to_arrow(axis, mouse), axis))
            .filter(|(distance, _)| *distance <= HIT)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, axis)| PointHandle::Axis(axis))
    }

    /// The handle at a screen position if only the point itself has a handle, without arrows and
    /// squares; `None` if there is no handle.
    fn free_at(&self, mouse: Pos2) -> Option<PointHandle> {
        let on_free = |centre: Pos2| centre.distance(mouse) <= FREE_RADIUS;
        let is_hit = on_free(self.centre) || self.hand.is_some_and(on_free);
        is_hit.then_some(PointHandle::Free)
    }

    /// Draws the handles, highlights the hovered or dragged one, and fades the others during a
    /// drag.
    pub fn paint(
        &self,
        painter: &Painter,
        ui: &Ui,
        pointed: Option<PointHandle>,
        dragged: Option<PointHandle>,
    ) {
        let axes = style::palette(ui).axes.map(style::colour);
        let look = |handle: PointHandle, colour: Color32| match (dragged, pointed) {
            (Some(dragged), _) if dragged == handle => bright(colour),
            (Some(_), _) => colour.gamma_multiply(0.25),
            (None, Some(pointed)) if pointed == handle => bright(colour),
            _ => colour,
        };
        let squares = self.strength_of_squares(ui, dragged);
        for (axis, colour) in axes.into_iter().enumerate() {
            if self.square_shows(axis) && squares > 0.0 {
                let colour = look(PointHandle::Plane(axis), colour).gamma_multiply(squares);
                let fill = colour.gamma_multiply(0.35);
                let corners = self.square(axis).to_vec();
                painter.add(Shape::convex_polygon(corners, fill, Stroke::new(1.5, colour)));
            }
        }
        for (axis, colour) in axes.into_iter().enumerate() {
            if self.arrow_shows(axis) {
                let colour = look(PointHandle::Axis(axis), colour);
                self.paint_arrow(painter, axis, colour, ui.visuals().panel_fill);
            }
        }
        let ring = ui.visuals().strong_text_color();
        let free = look(PointHandle::Free, ring.gamma_multiply(0.85));
        circle(painter, ui, self.centre, FREE_RADIUS - 2.0, Stroke::new(1.5, free));
        if let Some(hand) = self.hand.filter(|hand| hand.distance(self.centre) > FREE_RADIUS) {
            circle(painter, ui, hand, FREE_RADIUS - 2.0, Stroke::new(1.5, free));
        }
    }

    /// From 0 to 1: squares are drawn only near the mouse, because they would crowd the point.
    fn strength_of_squares(&self, ui: &Ui, dragged: Option<PointHandle>) -> f32 {
        if matches!(dragged, Some(PointHandle::Plane(_))) {
            return 1.0;
        }
        let Some(mouse) = ui.input(|input| input.pointer.latest_pos()) else { return 0.0 };
        let (full, none) = SQUARES_SEEN;
        ((none - mouse.distance(self.centre)) / (none - full)).clamp(0.0, 1.0)
    }

    /// Draws an arrow with a rim in the colour of the letter, so that it is seen before a limb of its own
    /// colour.
    fn paint_arrow(&self, painter: &Painter, axis: usize, colour: Color32, letter: Color32) {
        const HEAD: f32 = 12.0;
        const DISC: f32 = 7.0;
        const RIM: f32 = 1.5;
        let arrow = self.arrows[axis];
        let direction = arrow.normalized();
        let tip = self.centre + arrow;
        let neck = tip - direction * HEAD;
        let start = self.centre + direction * FREE_RADIUS;
        let rim = letter.gamma_multiply(f32::from(colour.a()) / 255.0);
        let aside = direction.rot90() * HEAD * 0.42;
        let head = vec![tip, neck + aside, neck - aside];
        painter.line_segment([start, neck], Stroke::new(2.5 + 2.0 * RIM, rim));
        painter.add(Shape::convex_polygon(head.clone(), rim, Stroke::new(2.0 * RIM, rim)));
        painter.line_segment([start, neck], Stroke::new(2.5, colour));
        painter.add(Shape::convex_polygon(head, colour, Stroke::NONE));
        // On a disc, so that the letter can be read before a limb.
        let beyond = tip + direction * (DISC + 3.0);
        painter.circle(beyond, DISC, colour, Stroke::new(RIM, rim));
        let font = FontId::proportional(11.0);
        painter.text(beyond, Align2::CENTER_CENTER, NAMES[axis], font, letter);
    }

    fn arrow_shows(&self, axis: usize) -> bool {
        self.arrows[axis].length() > LENGTH * SHORTEST
    }

    /// The directions on screen of the two sides of the square that is normal to `axis`; a side
    /// that is normal to the view direction has length 1.
    fn sides(&self, axis: usize) -> (Vec2, Vec2) {
        (self.arrows[(axis + 1) % 3] / LENGTH, self.arrows[(axis + 2) % 3] / LENGTH)
    }

    fn square_shows(&self, axis: usize) -> bool {
        let (u, v) = self.sides(axis);
        (u.x * v.y - u.y * v.x).abs() > NARROWEST
    }

    fn square(&self, axis: usize) -> [Pos2; 4] {
        let (u, v) = self.sides(axis);
        let (near, far) = SQUARE;
        [(near, near), (far, near), (far, far), (near, far)]
            .map(|(along_u, along_v)| self.centre + u * along_u + v * along_v)
    }

    fn on_square(&self, axis: usize, mouse: Pos2) -> bool {
        if !self.square_shows(axis) {
            return false;
        }
        // The mouse in the square's skewed coordinates, by Cramer's rule.
        let (u, v) = self.sides(axis);
        let at = mouse - self.centre;
        let area = u.x * v.y - u.y * v.x;
        let along_u = (at.x * v.y - at.y * v.x) / area;
        let along_v = (u.x * at.y - u.y * at.x) / area;
        let (near, far) = SQUARE;
        let inside = near..=far;
        inside.contains(&along_u) && inside.contains(&along_v)
    }

    fn to_arrow(&self, axis: usize, mouse: Pos2) -> f32 {
        let arrow = self.arrows[axis];
        let at = mouse - self.centre;
        let part = (at.dot(arrow) / arrow.length_sq()).clamp(0.0, 1.15);
        (at - arrow * part).length()
    }
}

/// Radius of a ring in points.
pub(in crate::ui) const RADIUS: f32 = 56.0;
/// Radius of a ring in points around a point with arrows: outside their names.
pub(in crate::ui) const OUTER_RADIUS: f32 = 104.0;
/// Maximum distance in points at which the mouse hits a ring.
const RING_HIT: f32 = 7.0;
/// Number of line segments of the ring.
const RING_STEPS: usize = 64;

/// Screen positions of a ring.
pub(in crate::ui) struct RotateRing {
    pub grip: Grip,
    points: Vec<Pos2>,
    /// For each point, whether it is on the half of the ring that faces the eye.
    near: Vec<bool>,
}

impl RotateRing {
    /// Screen positions of `ring` with a constant `radius` on screen, in points; `None` if its
    /// centre is behind the eye.
    pub fn new(screen: &ScreenProjection, grip: Grip, ring: GripRing, radius: f32) -> Option<Self> {
        let GripRing { centre, axis } = ring;
        let radius = radius * screen.units_per_point(centre);
        let (u, v) = axis.any_orthonormal_pair();
        let middle = screen.place(centre)?;
        Self::sampled(screen, grip, centre, [u * radius, v * radius], |aside| {
            Some(middle + screen.direction(aside, centre))
        })
    }

    /// Screen positions of `ring` with the size at which it goes through `point` of the world;
    /// `None` if a part of it is behind the eye.
    pub fn through(
        screen: &ScreenProjection,
        grip: Grip,
        ring: GripRing,
        point: Vec3,
    ) -> Option<Self> {
        let GripRing { centre, axis } = ring;
        let radius = point - centre;
        Self::sampled(screen, grip, centre, [radius, axis.cross(radius)], |aside| {
            screen.place(centre + aside)
        })
    }

    /// Samples the ring around `centre` with two perpendicular radii; `place` gives the screen
    /// position of an offset from the centre.
    fn sampled(
        screen: &ScreenProjection,
        grip: Grip,
        centre: Vec3,
        [u, v]: [Vec3; 2],
        place: impl Fn(Vec3) -> Option<Pos2>,
    ) -> Option<Self> {
        let mut points = Vec::with_capacity(RING_STEPS + 1);
        let mut near = Vec::with_capacity(RING_STEPS + 1);
        for step in 0..=RING_STEPS {
            let (sin, cos) = (step as f32 / RING_STEPS as f32 * TAU).sin_cos();
            let aside = u * cos + v * sin;
            points.push(place(aside)?);
            near.push(screen.depth(centre + aside) <= screen.depth(centre) + 0.05 * u.length());
        }
        Some(Self { grip, points, near })
    }

    /// The handle of the ring nearest to a screen position; `None` if every ring is farther than
    /// `RING_HIT`.
    pub fn at(rings: &[Self], mouse: Pos2) -> Option<Grip> {
        Self::nearest(rings, mouse).map(|(_, grip)| grip)
    }

    /// As [`Self::at`], with the distance of the ring in points.
    pub fn nearest(rings: &[Self], mouse: Pos2) -> Option<(f32, Grip)> {
        rings
            .iter()
            .map(|ring| (ring.distance(mouse), ring.grip))
            .filter(|(distance, _)| *distance <= RING_HIT)
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn distance(&self, mouse: Pos2) -> f32 {
        let near = self.points.windows(2).zip(&self.near).filter(|(_, near)| **near);
        near.map(|(ends, _)| to_segment(mouse, ends[0], ends[1])).fold(f32::INFINITY, f32::min)
    }

    /// Draws the ring; the far half is faint.
    pub fn paint(&self, painter: &Painter, colour: Color32, stands_out: bool) {
        let width = if stands_out { 3.5 } else { 2.0 };
        for (ends, near) in self.points.windows(2).zip(&self.near) {
            let colour = if *near { colour } else { colour.gamma_multiply(0.2) };
            painter.add(Shape::line_segment([ends[0], ends[1]], Stroke::new(width, colour)));
        }
    }
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use crate::ui::gizmo::handles::*;

    fn handles() -> TranslateHandles {
        let arrows = [Vec2::new(70.0, 20.0), Vec2::new(0.0, -78.0), Vec2::new(-60.0, 35.0)];
        TranslateHandles { centre: pos2(400.0, 300.0), hand: None, arrows }
    }

    #[test]
    fn each_part_is_hit_where_it_is_drawn() {
        let handles = handles();
        assert_eq!(handles.at(handles.centre), Some(PointHandle::Free));
        for axis in 0..3 {
            let arrow = handles.arrows[axis];
            assert_eq!(handles.at(handles.centre + arrow * 0.85), Some(PointHandle::Axis(axis)));
            let [a, _, c, _] = handles.square(axis);
            assert_eq!(handles.at(a + (c - a) / 2.0), Some(PointHandle::Plane(axis)));
        }
        assert_eq!(handles.at(pos2(600.0, 100.0)), None);
    }

    #[test]
    fn an_arrow_along_the_view_and_a_square_edge_on_cannot_be_hit() {
        let mut handles = handles();
        handles.arrows[2] = Vec2::new(3.0, 1.0);
        assert_ne!(
            handles.at(handles.centre + Vec2::new(3.0, 1.0) * 6.0),
            Some(PointHandle::Axis(2))
        );
        handles.arrows = [Vec2::new(80.0, 0.0), Vec2::new(0.0, -80.0), Vec2::ZERO];
        for axis in [0, 1] {
            let [a, _, c, _] = handles.square(axis);
            assert_ne!(handles.at(a + (c - a) / 2.0), Some(PointHandle::Plane(axis)));
        }
    }

    #[test]
    fn a_hand_away_from_its_cursor_can_be_taken_too() {
        let handles = TranslateHandles { hand: Some(pos2(100.0, 100.0)), ..handles() };
        assert_eq!(handles.at(pos2(108.0, 100.0)), Some(PointHandle::Free));
    }
}
