//! A ring; a drag of the ring rotates about one axis.

use core::f32::consts::TAU;

use egui::{Color32, Painter, Pos2, Shape, Stroke};
use glam::Vec3;

use super::screen::{ScreenProjection, to_segment};
use crate::session::{Grip, GripRing};

/// Radius of a ring in points.
pub(in crate::ui) const RADIUS: f32 = 56.0;
/// Radius of a ring in points around a point with arrows: outside their names.
pub(in crate::ui) const OUTER_RADIUS: f32 = 104.0;
/// Maximum distance in points at which the mouse hits a ring.
const HIT: f32 = 7.0;
/// Number of line segments of the ring.
const STEPS: usize = 64;

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
        let mut points = Vec::with_capacity(STEPS + 1);
        let mut near = Vec::with_capacity(STEPS + 1);
        for step in 0..=STEPS {
            let (sin, cos) = (step as f32 / STEPS as f32 * TAU).sin_cos();
            let aside = u * cos + v * sin;
            points.push(place(aside)?);
            near.push(screen.depth(centre + aside) <= screen.depth(centre) + 0.05 * u.length());
        }
        Some(Self { grip, points, near })
    }

    /// The handle of the ring nearest to a screen position; `None` if every ring is farther than
    /// `HIT`.
    pub fn at(rings: &[Self], mouse: Pos2) -> Option<Grip> {
        Self::nearest(rings, mouse).map(|(_, grip)| grip)
    }

    /// As [`Self::at`], with the distance of the ring in points.
    pub fn nearest(rings: &[Self], mouse: Pos2) -> Option<(f32, Grip)> {
        rings
            .iter()
            .map(|ring| (ring.distance(mouse), ring.grip))
            .filter(|(distance, _)| *distance <= HIT)
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
