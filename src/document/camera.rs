use core::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Mat4, Vec2, Vec3, Vec4};

/// Where the scene is looked at from: a point looked at, and an orbit around it whose horizon is
/// always level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The point in the middle of the picture, in the world.
    pub target: Vec3,
    /// Radians about +y; 0 looks along −z from the front, π/2 along −x from the right.
    pub yaw: f32,
    /// Radians above the horizon, within ±π/2.
    pub pitch: f32,
    /// From eye to target. Orthographic pictures show what a perspective one shows at the target.
    pub distance: f32,
    pub orthographic: bool,
}

/// The six views along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisView {
    Front,
    Back,
    Right,
    Left,
    Top,
    Bottom,
}

/// A camera with the shape of its picture: takes points of the world into the picture and back.
///
/// Picture coordinates are normalised: x from −1 (left) to 1 (right), y from −1 (bottom) to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    pub clip_from_world: Mat4,
    /// The eye (perspective), or the point in its place on the central ray (orthographic).
    pub eye: Vec3,
    /// Unit vector into the picture.
    pub forward: Vec3,
    /// From the middle of the picture to its right edge, at distance 1 in perspective.
    pub right: Vec3,
    /// From the middle of the picture to its upper edge, at distance 1 in perspective.
    pub up: Vec3,
    pub orthographic: bool,
}

/// A half line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: Vec3,
    /// Not normalised.
    pub direction: Vec3,
}

impl Camera {
    /// The vertical angle of a perspective picture.
    pub const FIELD_OF_VIEW: f32 = 40.0 * PI / 180.0;
    /// What a point must be beyond to be seen, as a part of the distance to the target.
    const NEAR: f32 = 0.01;
    /// How near and far the eye can go, from the smallest rig to the largest.
    const DISTANCES: (f32, f32) = (1e-4, 1e8);
    /// How much depth an orthographic picture has, before and behind the target, in distances.
    const ORTHOGRAPHIC_DEPTH: f32 = 200.0;
    /// Room around what is framed.
    const MARGIN: f32 = 1.2;

    /// Whether it looks from somewhere at something: finite numbers, a pitch within ±π/2, a distance
    /// above 0.
    pub fn is_valid(&self) -> bool {
        let looks = self.target.is_finite() && self.yaw.is_finite();
        let is_upright = (-FRAC_PI_2..=FRAC_PI_2).contains(&self.pitch);
        looks && is_upright && self.distance.is_finite() && self.distance > 0.0
    }

    pub fn projection(&self, aspect: f32) -> Projection {
        let (back, right, up) = self.basis();
        let half_height = (Self::FIELD_OF_VIEW / 2.0).tan();
        let span = if self.orthographic { half_height * self.distance } else { half_height };
        let eye = self.target + back * self.distance;
        let (right_span, up_span) = (right * span * aspect, up * span);

        // Rows of a matrix that takes a world point to clip space with depth running from 1 at the
        // near plane to 0 at infinity: floats are dense at 0, so depth stays precise far away.
        let row = |axis: Vec3, scale: f32| (axis * scale).extend(-axis.dot(eye) * scale);
        let x = row(right, 1.0 / (span * aspect));
        let y = row(up, 1.0 / span);
        let (z, w) = if self.orthographic {
            let per_unit = 0.5 / (Self::ORTHOGRAPHIC_DEPTH * self.distance);
            let z = row(back, per_unit) + Vec4::W * (0.5 + self.distance * per_unit);
            (z, Vec4::W)
        } else {
            (Vec4::W * self.distance * Self::NEAR, row(-back, 1.0))
        };
        Projection {
            clip_from_world: Mat4::from_cols(x, y, z, w).transpose(),
            eye,
            forward: -back,
            right: right_span,
            up: up_span,
            orthographic: self.orthographic,
        }
    }

    /// Unit vectors towards the eye, the right and the top of the picture.
    pub fn basis(&self) -> (Vec3, Vec3, Vec3) {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        let back = Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
        let right = Vec3::new(cos_yaw, 0.0, -sin_yaw);
        (back, right, back.cross(right))
    }

    /// Turned around the target by angles; an orbit is always in perspective.
    #[must_use]
    pub fn orbited(self, yaw: f32, pitch: f32) -> Self {
        Self {
            yaw: (self.yaw + yaw).rem_euclid(TAU),
            pitch: (self.pitch + pitch).clamp(-FRAC_PI_2, FRAC_PI_2),
            orthographic: false,
            ..self
        }
    }

    /// JointRemap sideways so that what was at `from` in the picture, at the target's depth, is at `to`.
    #[must_use]
    pub fn panned(self, from: Vec2, to: Vec2, aspect: f32) -> Self {
        let (across, upwards) = self.half_extent(aspect);
        let moved = from - to;
        Self { target: self.target + across * moved.x + upwards * moved.y, ..self }
    }

    /// `factor` times as far away, with what is at `at` in the picture staying there.
    #[must_use]
    pub fn zoomed(self, factor: f32, at: Vec2, aspect: f32) -> Self {
        let (nearest, farthest) = Self::DISTANCES;
        let distance = (self.distance * factor).clamp(nearest, farthest);
        let (across, upwards) = self.half_extent(aspect);
        let towards = 1.0 - distance / self.distance;
        Self { target: self.target + (across * at.x + upwards * at.y) * towards, distance, ..self }
    }

    /// Looks at a sphere from where it looks now, near enough that the sphere fills the picture.
    #[must_use]
    pub fn framing(self, centre: Vec3, radius: f32, aspect: f32) -> Self {
        let half_angle = (Self::FIELD_OF_VIEW / 2.0).tan() * aspect.min(1.0);
        let (nearest, farthest) = Self::DISTANCES;
        let distance = (radius * Self::MARGIN / half_angle).clamp(nearest, farthest);
        Self { target: centre, distance, ..self }
    }

    #[must_use]
    pub fn along(self, view: AxisView) -> Self {
        let (yaw, pitch) = match view {
            AxisView::Front => (0.0, 0.0),
            AxisView::Back => (PI, 0.0),
            AxisView::Right => (FRAC_PI_2, 0.0),
            AxisView::Left => (-FRAC_PI_2, 0.0),
            AxisView::Top => (0.0, FRAC_PI_2),
            AxisView::Bottom => (0.0, -FRAC_PI_2),
        };
        Self { yaw, pitch, orthographic: true, ..self }
    }

    /// Part of the way to another camera, turning the shorter way around.
    #[must_use]
    pub fn towards(self, end: Self, part: f32) -> Self {
        if part >= 1.0 {
            return end;
        }
        let turn = (end.yaw - self.yaw + PI).rem_euclid(TAU) - PI;
        Self {
            target: self.target.lerp(end.target, part),
            yaw: self.yaw + turn * part,
            pitch: self.pitch + (end.pitch - self.pitch) * part,
            distance: self.distance * (end.distance / self.distance).powf(part),
            orthographic: self.orthographic && end.orthographic,
        }
    }

    /// From the target to the right and the upper edge of the picture.
    fn half_extent(&self, aspect: f32) -> (Vec3, Vec3) {
        let (_, right, up) = self.basis();
        let half_height = (Self::FIELD_OF_VIEW / 2.0).tan() * self.distance;
        (right * half_height * aspect, up * half_height)
    }
}

impl Default for Camera {
    /// Three quarters from the front right.
    fn default() -> Self {
        Self {
            target: Vec3::new(115.0, 75.0, 20.0),
            yaw: 33.0_f32.to_radians(),
            pitch: 20.0_f32.to_radians(),
            distance: 1050.0,
            orthographic: false,
        }
    }
}

impl Projection {
    /// Where a point of the world is in the picture; nothing if it is behind the eye.
    pub fn project(&self, point: Vec3) -> Option<Vec2> {
        let clip = self.clip_from_world * point.extend(1.0);
        (clip.w > 0.0 && clip.z <= clip.w).then(|| clip.truncate().truncate() / clip.w)
    }

    /// The half line that a point of the picture stands for.
    pub fn ray(&self, at: Vec2) -> Ray {
        let aside = self.right * at.x + self.up * at.y;
        if self.orthographic {
            Ray { origin: self.eye + aside, direction: self.forward }
        } else {
            Ray { origin: self.eye, direction: self.forward + aside }
        }
    }

    /// Half the picture's height in units of the world, at a point's depth.
    pub fn half_height_at(&self, point: Vec3) -> f32 {
        let span = self.up.length();
        if self.orthographic { span } else { span * (point - self.eye).dot(self.forward) }
    }
}

impl Ray {
    /// Where it meets the plane through `point`, if it does so ahead of its origin and before numbers
    /// end.
    pub fn meets_plane(&self, point: Vec3, normal: Vec3) -> Option<Vec3> {
        let along = (point - self.origin).dot(normal) / self.direction.dot(normal);
        let met = self.origin + self.direction * along;
        (along >= 0.0 && met.is_finite()).then_some(met)
    }

    /// How far along the line through `point` in unit direction `axis` the ray comes nearest to
    /// it, if it does so ahead of its origin and before numbers end.
    pub fn nearest_on_line(&self, point: Vec3, axis: Vec3) -> Option<f32> {
        let normal = axis.cross(self.direction).cross(axis);
        let along_ray = (point - self.origin).dot(normal) / self.direction.dot(normal);
        let met = self.origin + self.direction * along_ray;
        let along = (met - point).dot(axis);
        (along_ray >= 0.0 && along.is_finite()).then_some(along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASPECT: f32 = 1.6;

    fn cameras() -> impl Iterator<Item = Camera> {
        let side = |yaw: f32, pitch: f32, orthographic| Camera {
            target: Vec3::new(20.0, -30.0, 5.0),
            yaw,
            pitch,
            distance: 700.0,
            orthographic,
        };
        (0..12).flat_map(move |i| {
            let (yaw, pitch) = (i as f32 * 0.6, (i as f32 - 6.0) * 0.25);
            [side(yaw, pitch, false), side(yaw, pitch, true)]
        })
    }

    #[test]
    fn a_ray_passes_through_the_point_that_projects_to_its_place() {
        for camera in cameras() {
            let projection = camera.projection(ASPECT);
            for point in [Vec3::ZERO, Vec3::new(100.0, 60.0, -80.0), Vec3::new(-90.0, 10.0, 120.0)]
            {
                let at = projection.project(point).expect("before the eye");
                let ray = projection.ray(at);
                let off = (point - ray.origin).cross(ray.direction.normalize()).length();
                assert!(off < 1e-2, "{camera:?} misses {point} by {off}");
            }
        }
    }

    #[test]
    fn depth_falls_with_distance_and_stays_between_one_and_nothing() {
        for camera in cameras() {
            let projection = camera.projection(ASPECT);
            let depth = |along: f32| {
                let clip = projection.clip_from_world
                    * (projection.eye + projection.forward * along).extend(1.0);
                clip.z / clip.w
            };
            let depths = [10.0, 500.0, 700.0, 5_000.0, 50_000.0].map(depth);
            assert!(depths.is_sorted_by(|a, b| a > b), "{depths:?}");
            assert!(depths.iter().all(|d| (0.0..=1.0).contains(d)), "{depths:?}");
        }
    }

    #[test]
    fn panning_keeps_the_grabbed_point_under_the_pointer() {
        for camera in cameras() {
            let (from, to) = (Vec2::new(-0.3, 0.2), Vec2::new(0.5, -0.6));
            let (across, up) = camera.half_extent(ASPECT);
            let grabbed = camera.target + across * from.x + up * from.y;
            let seen = camera.panned(from, to, ASPECT).projection(ASPECT).project(grabbed);
            assert!(seen.expect("seen").distance(to) < 1e-4);
        }
    }

    #[test]
    fn zooming_keeps_the_point_under_the_pointer() {
        for camera in cameras() {
            let at = Vec2::new(0.4, -0.7);
            let (across, up) = camera.half_extent(ASPECT);
            let under = camera.target + across * at.x + up * at.y;
            for factor in [0.3, 0.9, 4.0] {
                let seen = camera.zoomed(factor, at, ASPECT).projection(ASPECT).project(under);
                assert!(seen.expect("seen").distance(at) < 1e-4);
            }
        }
    }

    #[test]
    fn a_framed_sphere_is_inside_the_picture() {
        for camera in cameras() {
            let (centre, radius) = (Vec3::new(-300.0, 80.0, 900.0), 250.0);
            for aspect in [0.5, 1.0, 2.4] {
                let projection = camera.framing(centre, radius, aspect).projection(aspect);
                let (_, right, up) = camera.basis();
                for side in [right, -right, up, -up] {
                    let seen = projection.project(centre + side * radius).expect("seen");
                    assert!(seen.abs().max_element() < 1.0, "{seen} of {aspect}");
                }
            }
        }
    }

    #[test]
    fn axis_views_look_along_their_axis_with_y_up_where_it_can_be() {
        let back = |view| Camera::default().along(view).basis().0;
        let close = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-6, "{a} is not {b}");
        close(back(AxisView::Front), Vec3::Z);
        close(back(AxisView::Back), -Vec3::Z);
        close(back(AxisView::Right), Vec3::X);
        close(back(AxisView::Left), -Vec3::X);
        close(back(AxisView::Top), Vec3::Y);
        close(back(AxisView::Bottom), -Vec3::Y);
        close(Camera::default().along(AxisView::Top).basis().2, -Vec3::Z);
    }
}
