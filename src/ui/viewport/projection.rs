//! Projection from world to screen.

use egui::{Pos2, Rect, Vec2, vec2};
use glam::Vec3;

use crate::document::{Camera, Projection, Ray};

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
