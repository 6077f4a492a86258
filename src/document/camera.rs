use core::f32::consts::{FRAC_PI_2, PI};

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::projection::Projection;
use crate::kinematics::angle;

/// An orbit camera with a level horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Point in the world that is in the middle of the picture; the camera orbits around it.
    pub target: Vec3,
    /// Angle of the eye about +y in radians. At 0 the camera is in front and looks along −z, at π/2
    /// it is on the right and looks along −x.
    pub yaw: f32,
    /// Angle of the eye above the horizon in radians, from −π/2 to π/2.
    pub pitch: f32,
    /// Distance from the eye to the target. At the target, an orthographic picture is as wide as a
    /// perspective one.
    pub distance: f32,
    /// True for an orthographic projection, false for a perspective one.
    pub orthographic: bool,
}

/// A view along one of the world's axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisView {
    /// From the front, along −z.
    Front,
    /// From the back, along +z.
    Back,
    /// From the right, along −x.
    Right,
    /// From the left, along +x.
    Left,
    /// From the top, along −y.
    Top,
    /// From the bottom, along +y.
    Bottom,
}

impl Camera {
    /// Vertical field of view of a perspective picture, in radians.
    pub const FIELD_OF_VIEW: f32 = 40.0 * PI / 180.0;
    /// Distance from the eye to the near plane of a perspective picture, as a fraction of
    /// `distance`.
    const NEAR: f32 = 0.01;
    /// Minimum and maximum distance from eye to target.
    const DISTANCES: (f32, f32) = (1e-4, 1e8);
    /// Depth that an orthographic picture shows before and behind the target, as a multiple of
    /// `distance`.
    const ORTHOGRAPHIC_DEPTH: f32 = 200.0;
    /// Factor by which the radius of a framed sphere is enlarged to leave a margin around the
    /// sphere.
    const MARGIN: f32 = 1.2;

    /// True if all numbers are finite, the pitch is within ±π/2 and the distance is above 0.
    pub fn is_valid(&self) -> bool {
        let looks = self.target.is_finite() && self.yaw.is_finite();
        let is_upright = (-FRAC_PI_2..=FRAC_PI_2).contains(&self.pitch);
        looks && is_upright && self.distance.is_finite() && self.distance > 0.0
    }

    /// Projection for a picture with aspect ratio `aspect`, its width / height.
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

    /// Unit vectors in the world from the target towards the eye, the right and the top of the
    /// picture.
    pub fn basis(&self) -> (Vec3, Vec3, Vec3) {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        let back = Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
        let right = Vec3::new(cos_yaw, 0.0, -sin_yaw);
        (back, right, back.cross(right))
    }

    /// Orbits around the target by angles in radians. The result is a perspective camera.
    #[must_use]
    pub fn orbited(self, yaw: f32, pitch: f32) -> Self {
        Self {
            yaw: angle::wrapped(self.yaw + yaw),
            pitch: (self.pitch + pitch).clamp(-FRAC_PI_2, FRAC_PI_2),
            orthographic: false,
            ..self
        }
    }

    /// Pans so that a point at the target's depth moves in the picture from `from` to `to`, both in
    /// the picture coordinates of [`Projection`].
    #[must_use]
    pub fn panned(self, from: Vec2, to: Vec2, aspect: f32) -> Self {
        let (across, upwards) = self.half_extent(aspect);
        let moved = from - to;
        Self { target: self.target + across * moved.x + upwards * moved.y, ..self }
    }

    /// Multiplies the distance by `factor`. The point at the target's depth that the picture shows
    /// at `at`, in the picture coordinates of [`Projection`], stays there.
    #[must_use]
    pub fn zoomed(self, factor: f32, at: Vec2, aspect: f32) -> Self {
        let (nearest, farthest) = Self::DISTANCES;
        let distance = (self.distance * factor).clamp(nearest, farthest);
        let (across, upwards) = self.half_extent(aspect);
        let approach = 1.0 - distance / self.distance;
        Self { target: self.target + (across * at.x + upwards * at.y) * approach, distance, ..self }
    }

    /// Centres a sphere and fits it into the picture. The direction of view stays.
    #[must_use]
    pub fn framing(self, centre: Vec3, radius: f32, aspect: f32) -> Self {
        let half_angle = (Self::FIELD_OF_VIEW / 2.0).tan() * aspect.min(1.0);
        let (nearest, farthest) = Self::DISTANCES;
        let distance = (radius * Self::MARGIN / half_angle).clamp(nearest, farthest);
        Self { target: centre, distance, ..self }
    }

    /// The orthographic camera of an axis view, with the same target and distance.
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

    /// Interpolates to the camera `end`; the yaw takes the shorter way around. A `fraction` of 0 is
    /// this camera, 1 and above is `end`.
    #[must_use]
    pub fn interpolated(self, end: Self, fraction: f32) -> Self {
        if fraction >= 1.0 {
            return end;
        }
        let yaw = angle::nearest(end.yaw, self.yaw);
        Self {
            target: self.target.lerp(end.target, fraction),
            yaw: self.yaw + (yaw - self.yaw) * fraction,
            pitch: self.pitch + (end.pitch - self.pitch) * fraction,
            distance: self.distance * (end.distance / self.distance).powf(fraction),
            orthographic: self.orthographic && end.orthographic,
        }
    }

    /// Vectors in the world from the target to the right and to the upper edge of the picture.
    fn half_extent(&self, aspect: f32) -> (Vec3, Vec3) {
        let (_, right, up) = self.basis();
        let half_height = (Self::FIELD_OF_VIEW / 2.0).tan() * self.distance;
        (right * half_height * aspect, up * half_height)
    }
}

impl Default for Camera {
    /// A three-quarter view from the front right.
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
    fn a_ray_passes_through_the_point_that_is_projected() {
        for camera in cameras() {
            let projection = camera.projection(ASPECT);
            for point in [Vec3::ZERO, Vec3::new(100.0, 60.0, -80.0), Vec3::new(-90.0, 10.0, 120.0)]
            {
                let at = projection.project(point).expect("in front of the eye");
                let ray = projection.ray(at);
                let off = (point - ray.origin).cross(ray.direction.normalize()).length();
                assert!(off < 1e-2, "{camera:?} misses {point} by {off}");
            }
        }
    }

    #[test]
    fn depth_falls_with_distance_and_stays_between_one_and_zero() {
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
    fn panning_keeps_the_grabbed_point_under_the_mouse() {
        for camera in cameras() {
            let (from, to) = (Vec2::new(-0.3, 0.2), Vec2::new(0.5, -0.6));
            let (across, up) = camera.half_extent(ASPECT);
            let grabbed = camera.target + across * from.x + up * from.y;
            let seen = camera.panned(from, to, ASPECT).projection(ASPECT).project(grabbed);
            assert!(seen.expect("visible").distance(to) < 1e-4);
        }
    }

    #[test]
    fn zooming_keeps_the_point_under_the_mouse() {
        for camera in cameras() {
            let at = Vec2::new(0.4, -0.7);
            let (across, up) = camera.half_extent(ASPECT);
            let under = camera.target + across * at.x + up * at.y;
            for factor in [0.3, 0.9, 4.0] {
                let seen = camera.zoomed(factor, at, ASPECT).projection(ASPECT).project(under);
                assert!(seen.expect("visible").distance(at) < 1e-4);
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
                    let seen = projection.project(centre + side * radius).expect("visible");
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
