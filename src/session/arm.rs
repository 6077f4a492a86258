use core::f32::consts::TAU;

use glam::Vec3;

use super::drag::Way;
use super::{Drag, Grip, Handle, PointDrag, Session};
use crate::document::{Arm, Document, Ray};
use crate::kinematics::two_bone::TwoBone;

/// What actions do to the arm.
impl Session {
    pub(super) fn set_point(&mut self, name: &str, point: Vec3, field: fn(&mut Arm) -> &mut Vec3) {
        if point.is_finite() {
            let mut arm = *self.arm();
            *field(&mut arm) = point;
            self.replace_arm(arm);
        } else {
            self.message = Some(format!("The {name} must be at finite numbers, not {point}"));
        }
    }

    pub(super) fn set_elbow_spin(&mut self, spin: f32) {
        if spin.is_finite() {
            self.replace_arm(Arm { elbow_spin: spin.rem_euclid(TAU), ..*self.arm() });
        } else {
            self.message = Some(format!("The elbow spin must be a finite number, not {spin}"));
        }
    }

    pub(super) fn set_lengths(&mut self, upper: f32, lower: f32) {
        match TwoBone::new(upper, lower) {
            Ok(bones) => self.replace_arm(Arm { bones, ..*self.arm() }),
            Err(error) => self.message = Some(format!("The {error}")),
        }
    }

    /// Every change of the arm comes through here: where it faces is kept.
    pub(super) fn replace_arm(&mut self, arm: Arm) {
        self.message = None;
        let arm = Arm { facing: arm.pose().facing, ..arm };
        self.commit(Document { arm, ..self.shown.clone() });
    }

    /// The hand is taken where it is seen, or its cursor if that is out of reach and nearer to the
    /// pointer. A cursor out of reach comes to a hand that is taken, which leaves the pose as it is.
    pub(super) fn grab_hand(&mut self, handle: Handle, ray: Ray, forward: Vec3) {
        let (arm, hand) = (*self.arm(), self.pose.hand);
        let aside = |point: Vec3| (arm.root + point - ray.origin).cross(ray.direction).length();
        let is_at_hand = handle == Handle::Free && aside(hand) < aside(arm.cursor);
        let start = if is_at_hand { hand } else { arm.cursor };
        let drag = PointDrag::new(handle, start, arm.root, forward, ray);
        self.begin_edit(Some(Drag { grip: Grip::Hand(handle), way: Way::Point(drag) }));
    }
}
