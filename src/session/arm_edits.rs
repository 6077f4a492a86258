use glam::{Mat3, Vec3};

use super::drag::DragKind;
use super::drag::{Drag, Grip};
use super::point_drag::{PointDrag, PointHandle};
use super::pose_mode::PoseMode;
use super::session::Session;
use super::turn_drag::{GripRing, TurnDrag};
use crate::document::{Arm, Channel, Document, Ray, TwistReferenceKind};
use crate::kinematics::angle::wrapped;
use crate::kinematics::euler;
use crate::kinematics::two_bone::TwoBone;

/// What actions do to the arm.
impl Session {
    pub(super) fn set_point(&mut self, name: &str, point: Vec3, set: fn(&mut Arm, Vec3)) {
        if point.is_finite() {
            let mut arm = *self.arm();
            set(&mut arm, point);
            self.replace_arm(arm);
        } else {
            self.fail(format!("The {name} must be at finite numbers, not {point}"));
        }
    }

    pub(super) fn set_twist(&mut self, spin: f32) {
        if spin.is_finite() {
            self.replace_arm(Arm { twist: wrapped(spin), ..*self.arm() });
        } else {
            self.fail(format!("The elbow spin must be a finite number, not {spin}"));
        }
    }

    pub(super) fn set_lengths(&mut self, upper: f32, lower: f32) {
        match TwoBone::new(upper, lower) {
            Ok(bones) => self.replace_arm(Arm { bones, ..*self.arm() }),
            Err(error) => self.fail(format!("the {error}")),
        }
    }

    /// The elbow stays where it is, at the keys of its spin too.
    pub(super) fn set_twist_reference(&mut self, twist_reference: TwistReferenceKind) {
        const SAME: f32 = 1e-4;
        let was_held = self.is_overridden(Channel::Twist);
        self.shell.clear_message();
        self.commit(self.shown().with_twist_reference(twist_reference));
        // At a key the keys, measured anew, say the same.
        let spin = |document: &Document| Channel::Twist.value(document).unwrap_or_default().x;
        let keyed = spin(&self.document().evaluate(self.time()));
        let apart = wrapped(keyed - spin(self.shown()) + SAME);
        if !was_held && apart < 2.0 * SAME && self.document().keys.has(Channel::Twist) {
            self.editing.forget_override(Channel::Twist);
            self.shell.clear_message();
            self.refresh();
        }
    }

    pub(super) fn set_influence(&mut self, weight: f32) {
        if (0.0..=1.0).contains(&weight) {
            self.replace_arm(Arm { influence: weight, ..*self.arm() });
        } else {
            self.fail(format!("The IK weight must be from 0 to 1, not {weight}"));
        }
    }

    pub(super) fn set_pole(&mut self, pole: Vec3) {
        self.set_point("pole", pole, |arm, pole| arm.pole = pole);
    }

    pub(super) fn set_shoulder(&mut self, angles: Vec3) {
        self.set_point("shoulder angles", angles, |arm, angles| arm.fk.shoulder = angles);
    }

    pub(super) fn set_bend(&mut self, bend: f32) {
        if bend.is_finite() {
            let mut arm = *self.arm();
            arm.fk.bend = bend;
            self.replace_arm(arm);
        } else {
            self.fail(format!("The elbow's bend must be a finite number, not {bend}"));
        }
    }

    /// The pose stays, unless a soft limit keeps the hand from where it is.
    pub(super) fn switch_to(&mut self, lead: PoseMode) {
        const MOVED: f32 = 1e-3;
        let before = *self.pose();
        match lead {
            PoseMode::Hand => self.replace_arm(self.arm().switched_to_ik()),
            PoseMode::Angles => self.replace_arm(self.arm().switched_to_fk()),
        }
        let moved =
            self.pose().elbow.distance(before.elbow).max(self.pose().hand.distance(before.hand));
        if moved > MOVED * self.arm().bones.outer_limit() {
            self.say("The arm has moved: its soft limits do not let it be there");
        }
    }

    /// Every change of the arm comes through here: what its next pose goes on from is kept.
    pub(super) fn replace_arm(&mut self, arm: Arm) {
        self.shell.clear_message();
        let arm = arm.transported_from(self.arm()).with_solve_state();
        self.commit(Document { arm, ..self.shown().clone() });
    }

    /// The hand is taken where it is seen, or its cursor if that is out of reach and nearer to the
    /// pointer. A cursor out of reach comes to a hand that is taken, which leaves the pose as it is.
    pub(super) fn grab_hand(&mut self, handle: PointHandle, ray: Ray, forward: Vec3) {
        let (arm, hand) = (*self.arm(), self.pose().hand);
        if !arm.uses_ik() {
            return;
        }
        let aside = |point: Vec3| (arm.root + point - ray.origin).cross(ray.direction).length();
        let is_led = handle == PointHandle::Free && arm.influence == 1.0;
        let is_at_hand = is_led && aside(hand) < aside(arm.cursor_in_root());
        let start = if is_at_hand { hand } else { arm.cursor_in_root() };
        let drag = PointDrag::new(handle, start, arm.root, forward, ray).with_step(self.snap());
        self.begin_edit(Some(Drag { grip: Grip::Hand(handle), kind: DragKind::Point(drag) }));
    }

    pub(super) fn grab_pole(&mut self, handle: PointHandle, ray: Ray, forward: Vec3) {
        let arm = *self.arm();
        if arm.twist_reference == TwistReferenceKind::Pole {
            let drag = PointDrag::new(handle, arm.pole, arm.root, forward, ray);
            let drag = drag.with_step(self.snap());
            self.begin_edit(Some(Drag { grip: Grip::Pole(handle), kind: DragKind::Point(drag) }));
        }
    }

    pub(super) fn grab_arm_ring(&mut self, grip: Grip, ray: Ray) {
        let fk = self.arm().fk;
        let start = match grip {
            Grip::Shoulder(axis) => fk.shoulder[axis],
            _ => fk.bend,
        };
        if let Some(ring) = self.arm_ring(grip) {
            let kind = DragKind::Turn(TurnDrag::new(ring, start, ray));
            self.begin_edit(Some(Drag { grip, kind }));
        }
    }

    /// What one of the arm's own angles turns about, in the world, while they lead: the shoulder's
    /// about x, y or z, or the elbow's bend.
    pub fn arm_ring(&self, grip: Grip) -> Option<GripRing> {
        let arm = self.arm();
        if arm.uses_ik() {
            return None;
        }
        let angles = arm.fk.shoulder;
        let yaw = Mat3::from_rotation_y(angles.y);
        let axis = match grip {
            Grip::Shoulder(1) => Vec3::Y,
            Grip::Shoulder(2) => yaw.z_axis,
            Grip::Shoulder(_) => (yaw * Mat3::from_rotation_z(angles.z)).x_axis,
            // A growing bend turns the lower limb the other way about the hinge.
            Grip::Bend => -euler::rotation(angles).z_axis.as_vec3(),
            _ => return None,
        };
        let centre = if grip == Grip::Bend { arm.root + self.pose().elbow } else { arm.root };
        Some(GripRing { centre, axis })
    }
}
