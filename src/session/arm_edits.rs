use glam::Vec3;

use super::pose_mode::PoseMode;
use super::session::Session;
use crate::document::{Arm, Channel, Document, TwistReferenceKind};
use crate::kinematics::angle::wrapped;
use crate::kinematics::two_bone::TwoBone;

/// Edits of the arm.
impl Session {
    pub(super) fn set_point(&mut self, name: &str, point: Vec3, set: fn(&mut Arm, Vec3)) {
        if point.is_finite() {
            let mut arm = *self.arm();
            set(&mut arm, point);
            self.replace_arm(arm);
        } else {
            self.fail(format!("The {name} must be finite, got {point}"));
        }
    }

    pub(super) fn set_root(&mut self, root: Vec3) {
        self.set_point("shoulder", root, |arm, root| arm.root = root);
    }

    pub(super) fn set_twist(&mut self, twist: f32) {
        if twist.is_finite() {
            self.replace_arm(Arm { twist: wrapped(twist), ..*self.arm() });
        } else {
            self.fail(format!("The Socket twist must be finite, got {twist}"));
        }
    }

    pub(super) fn set_lengths(&mut self, upper: f32, lower: f32) {
        match TwoBone::new(upper, lower) {
            Ok(bones) => self.replace_arm(Arm { bones, ..*self.arm() }),
            Err(error) => self.fail(format!("the {error}")),
        }
    }

    /// Changes the twist reference of the arm and of all keys of the twist; the elbow does not move.
    pub(super) fn set_twist_reference(&mut self, twist_reference: TwistReferenceKind) {
        const SAME: f32 = 1e-4;
        let was_overridden = self.is_overridden(Channel::Twist);
        self.shell.clear_message();
        self.commit(self.shown().with_twist_reference(twist_reference));
        // If the converted keys give the shown twist at the playhead, there is no unkeyed edit.
        let twist = |document: &Document| Channel::Twist.value(document).unwrap_or_default().x;
        let keyed = twist(self.document().at(self.time()).document());
        let apart = wrapped(keyed - twist(self.shown()) + SAME);
        if !was_overridden && apart < 2.0 * SAME && self.document().keys.has(Channel::Twist) {
            self.editing.forget_override(Channel::Twist);
            self.shell.clear_message();
            self.refresh();
        }
    }

    pub(super) fn set_influence(&mut self, influence: f32) {
        if (0.0..=1.0).contains(&influence) {
            self.replace_arm(Arm { influence, ..*self.arm() });
        } else {
            self.fail(format!("The IK influence must be from 0 to 1, got {influence}"));
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
            self.fail(format!("The elbow's bend must be finite, got {bend}"));
        }
    }

    pub(super) fn set_hand_orientation(&mut self, angles: Vec3) {
        self.set_point("hand angles", angles, |arm, angles| arm.hand_orientation.angles = angles);
    }

    /// Switches to FK or IK. The pose does not change, unless the soft limits exclude it.
    pub(super) fn switch_pose_mode(&mut self, mode: PoseMode) {
        const MOVED: f32 = 1e-3;
        let before = *self.pose();
        match mode {
            PoseMode::Hand => self.replace_arm(self.arm().switched_to_ik()),
            PoseMode::Angles => self.replace_arm(self.arm().switched_to_fk()),
        }
        let moved =
            self.pose().elbow.distance(before.elbow).max(self.pose().hand.distance(before.hand));
        if moved > MOVED * self.arm().bones.outer_limit() {
            self.say("The arm moved: its soft limits exclude the pose");
        }
    }

    /// Replaces the arm; its solve state (facing, transported frame, roll) continues from the present arm.
    pub(super) fn replace_arm(&mut self, arm: Arm) {
        self.shell.clear_message();
        let arm = arm.transported_from(self.arm()).with_solve_state();
        self.commit(Document { arm, ..self.shown().clone() });
    }
}
