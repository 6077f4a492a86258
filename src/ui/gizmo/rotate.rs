//! A ring that turns an angle, as large on screen wherever it is.

use core::f32::consts::TAU;

use egui::{Color32, Painter, Pos2, Shape, Stroke};

use super::shape::to_segment;
use crate::session::{Grip, Ring};
use crate::ui::viewport::projection::ScreenProjection;

/// In points.
const RADIUS: f32 = 56.0;
const HIT: f32 = 7.0;
const STEPS: usize = 64;

/// Where a ring is in the picture.
pub(in crate::ui) struct RotateRing {
    pub grip: Grip,
    points: Vec<Pos2>,
    /// Whether a point is on the side of the eye.
    near: Vec<bool>,
}

impl RotateRing {
    /// Nothing if its middle is behind the eye.
    pub fn new(picture: &ScreenProjection, grip: Grip, ring: Ring) -> Option<Self> {
        let Ring { centre, axis } = ring;
        let radius = RADIUS * picture.units_per_point(centre);
        let (u, v) = axis.any_orthonormal_pair();
        let mut points = Vec::with_capacity(STEPS + 1);
        let mut near = Vec::with_capacity(STEPS + 1);
        for step in 0..=STEPS {
            let (sin, cos) = (step as f32 / STEPS as f32 * TAU).sin_cos();
            let aside = (u * cos + v * sin) * radius;
            points.push(picture.place(centre)? + picture.direction(aside, centre));
            near.push(picture.depth(centre + aside) <= picture.depth(centre) + 0.05 * radius);
        }
        Some(Self { grip, points, near })
    }

    /// Of several, the one under a point of the screen.
    pub fn at(rings: &[Self], pointer: Pos2) -> Option<Grip> {
        rings
            .iter()
            .map(|ring| (ring.distance(pointer), ring))
            .filter(|(distance, _)| *distance <= HIT)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, ring)| ring.grip)
    }

    fn distance(&self, pointer: Pos2) -> f32 {
        let near = self.points.windows(2).zip(&self.near).filter(|(_, near)| **near);
        near.map(|(ends, _)| to_segment(pointer, ends[0], ends[1])).fold(f32::INFINITY, f32::min)
    }

    /// The half that is behind the middle is faint.
    pub fn paint(&self, painter: &Painter, colour: Color32, stands_out: bool) {
        let width = if stands_out { 3.5 } else { 2.0 };
        for (ends, near) in self.points.windows(2).zip(&self.near) {
            let colour = if *near { colour } else { colour.gamma_multiply(0.2) };
            painter.add(Shape::line_segment([ends[0], ends[1]], Stroke::new(width, colour)));
        }
    }
}
