use core::f32::consts::PI;

use glam::Vec3;

use crate::document::Ray;
use crate::kinematics::angle;
use crate::session::drag::point::DragInput;

/// The drag of a ring, which changes an angle by the mouse's turn about the ring's axis. The angle
/// is computed from the state at the press, never from its previous value.
#[derive(Clone, Debug, PartialEq)]
pub struct TurnDrag {
    ring: GripRing,
    /// Angle at the press, in radians.
    start: f32,
    pressed: Ray,
    now: DragInput,
    /// Turn of the mouse and offset of the angle, in radians, when precision was last switched on
    /// or off; `None` if it never was.
    precision: Option<(f32, f32)>,
    /// Turn of the mouse around the ring since the press, in radians, including whole turns.
    around: f32,
    typed: String,
    last: f32,
}

/// A circle around a joint, in world space; dragging it turns the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GripRing {
    /// Centre.
    pub centre: Vec3,
    /// Axis, a unit vector: angles are counterclockwise about it.
    pub axis: Vec3,
}

impl TurnDrag {
    const PRECISION: f32 = 0.1;
    const SNAP: f32 = 5.0 * PI / 180.0;
    const PRECISE_SNAP: f32 = PI / 180.0;

    pub(in crate::session) fn new(ring: GripRing, start: f32, ray: Ray) -> Self {
        let now = DragInput { ray, precise: false, snap: false };
        Self {
            ring,
            start,
            pressed: ray,
            now,
            precision: None,
            around: 0.0,
            typed: String::new(),
            last: start,
        }
    }

    /// The offset as typed, in degrees; empty while the mouse sets the offset.
    pub fn typed(&self) -> &str {
        &self.typed
    }

    /// Angle in radians by which the ring was turned since the press, not clamped to the joint's
    /// limits.
    pub fn turned(&self) -> f32 {
        self.turned_to(self.last)
    }

    /// Angle in radians from the angle at the press to `angle`.
    pub fn turned_to(&self, angle: f32) -> f32 {
        (angle - self.start).clamp(f32::MIN, f32::MAX)
    }

    pub(in crate::session) fn set_typed(&mut self, typed: String) {
        self.typed = typed;
    }

    pub(in crate::session) fn set_input(&mut self, input: DragInput) {
        if input.precise != self.now.precise {
            self.precision = Some((self.around, self.offset()));
        }
        self.now = input;
        let around = self.ring.angle_between(self.pressed, input.ray);
        if around.is_finite() {
            self.around = angle::nearest(around, self.around);
        }
    }

    /// Computes the dragged angle in radians, not clamped to the joint's limits.
    pub(in crate::session) fn angle(&mut self) -> f32 {
        if !self.typed.is_empty() {
            let degrees = self.typed.parse().ok().filter(|degrees: &f32| degrees.is_finite());
            self.last = self.start + degrees.unwrap_or(0.0).to_radians();
            return self.last;
        }
        let to = self.start + self.offset();
        let step = if self.now.precise { Self::PRECISE_SNAP } else { Self::SNAP };
        let to = if self.now.snap { (to / step).round() * step } else { to };
        self.last = to.clamp(f32::MIN, f32::MAX);
        self.last
    }

    fn offset(&self) -> f32 {
        let Some((around, offset)) = self.precision else {
            return self.around;
        };
        let factor = if self.now.precise { Self::PRECISION } else { 1.0 };
        offset + (self.around - around) * factor
    }
}

impl GripRing {
    /// Sine of the angle between the axis and the picture; below it, a ring counts as seen edge-on.
    const EDGE_ON: f32 = 0.1;

    /// The angle around the ring from one ray to another, in radians in (−π, π].
    fn angle_between(&self, from: Ray, to: Ray) -> f32 {
        if self.axis.dot(to.direction.normalize_or_zero()).abs() < Self::EDGE_ON {
            return self.rolled(from, to);
        }
        let met = |ray: Ray| Some(ray.meets_plane(self.centre, self.axis)? - self.centre);
        let (Some(from), Some(to)) = (met(from), met(to)) else {
            return 0.0;
        };
        self.axis.dot(from.cross(to)).atan2(from.dot(to))
    }

    /// The turn in radians of a ring that is seen edge-on: the ratio of the distance that the mouse
    /// moves along the ring to the mouse's distance from the centre at the press.
    fn rolled(&self, from: Ray, to: Ray) -> f32 {
        let Some(tangent) = from.direction.cross(self.axis).try_normalize() else {
            return 0.0;
        };
        let facing = from.direction.normalize_or_zero();
        let at = |ray: Ray| ray.meets_plane(self.centre, facing).map(|met| met - self.centre);
        let (Some(from), Some(to)) = (at(from), at(to)) else {
            return 0.0;
        };
        let radius = from.length().max(to.distance(from) * 1e-3);
        if radius > 0.0 { (to - from).dot(tangent) / radius } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::document::{Camera, Projection};

    fn ring(axis: Vec3) -> (GripRing, Projection) {
        (GripRing { centre: Vec3::new(10.0, 20.0, -5.0), axis }, Camera::default().projection(1.6))
    }

    /// A ray from the camera through the point at `angle` on the ring.
    fn through(ring: GripRing, projection: &Projection, radius: f32, angle: f32) -> Ray {
        let (u, v) = ring.axis.any_orthonormal_pair();
        let (u, v) = if u.cross(v).dot(ring.axis) > 0.0 { (u, v) } else { (v, u) };
        let at = ring.centre + (u * angle.cos() + v * angle.sin()) * radius;
        projection.ray(projection.project(at).expect("in the picture"))
    }

    #[test]
    fn a_ring_turns_by_the_angle_of_the_mouse_past_whole_turns() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.0, 0.8)] {
            let (ring, projection) = ring(axis);
            let mut drag = TurnDrag::new(ring, 0.25, through(ring, &projection, 60.0, 0.0));
            for step in 1..=100 {
                let angle = step as f32 * 0.1;
                let ray = through(ring, &projection, 60.0, angle);
                drag.set_input(DragInput { ray, precise: false, snap: false });
                let turned = drag.angle();
                assert!((turned - 0.25 - angle).abs() < 1e-3, "{turned} at {angle} about {axis}");
            }
        }
    }

    #[test]
    fn a_ring_seen_edge_on_rolls() {
        let (ring, projection) = ring(Vec3::ZERO);
        let ring = GripRing { axis: projection.up.normalize(), ..ring };
        let near = ring.centre - projection.forward * 60.0;
        let at = projection.project(near).expect("seen");
        let mut drag = TurnDrag::new(ring, 0.0, projection.ray(at + Vec2::new(0.02, 0.0)));
        let mut last = 0.0;
        for step in 1..20 {
            let ray = projection.ray(at + Vec2::new(0.02 + step as f32 * 0.01, 0.0));
            drag.set_input(DragInput { ray, precise: false, snap: false });
            let angle = drag.angle();
            assert!((angle - last).abs() < 2.0 && angle.is_finite(), "{angle} after {last}");
            last = angle;
        }
        assert!(last.abs() > 0.1);
    }

    #[test]
    fn snapping_precision_and_typed_degrees_are_as_for_points() {
        let (ring, projection) = ring(Vec3::Z);
        let ray = |angle| through(ring, &projection, 60.0, angle);
        let mut drag = TurnDrag::new(ring, 0.0, ray(0.0));
        drag.set_input(DragInput { ray: ray(0.52), precise: false, snap: true });
        assert!((drag.angle().to_degrees() - 30.0).abs() < 1e-3);
        drag.set_input(DragInput { ray: ray(0.52), precise: true, snap: false });
        let coarse = drag.angle();
        drag.set_input(DragInput { ray: ray(0.72), precise: true, snap: false });
        assert!((drag.angle() - coarse - 0.02).abs() < 1e-3);
        drag.set_typed("-90".to_owned());
        assert!((drag.angle().to_degrees() + 90.0).abs() < 1e-3);
    }
}
