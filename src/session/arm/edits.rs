use glam::Vec3;

use crate::document::{Arm, Channel, Cursor, Document, HandSpace, TwistReferenceKind};
use crate::kinematics::angle::wrapped;
use crate::kinematics::soft_reach::SoftReach;
use crate::kinematics::two_bone::TwoBone;
use crate::session::outcome::{Consequence, Outcome};
use crate::session::parts::PoseMode;
use crate::session::session::Session;

/// A change of the arm.
#[derive(Clone, Debug, PartialEq)]
pub enum ArmEdit {
    /// Moves the Cursor to a point in Root space.
    SetHand(Vec3),
    /// Sets the Socket twist in radians, wrapped to [0, 2π).
    SetTwist(f32),
    /// Moves the shoulder to a point in world space.
    SetRoot(Vec3),
    /// Pins the hand to a point in world space.
    SetPin(Vec3),
    /// Pins the hand to the world, or unpins it; the hand does not move.
    PinHand(bool),
    /// Changes the twist reference; the elbow does not move.
    SetTwistReference(TwistReferenceKind),
    /// Moves the pole, towards which the elbow points, to a point in Root space.
    SetPole(Vec3),
    /// Sets softness, maximum stretch and minimum elbow angle.
    SetSoftReach(SoftReach),
    /// Sets the blend from FK (0) to IK (1).
    SetInfluence(f32),
    /// Switches to FK or IK; the pose does not change.
    SwitchPoseMode(PoseMode),
    /// Sets the FK angles of the shoulder about x, y and z in radians.
    SetShoulder(Vec3),
    /// Sets the FK bend of the elbow in radians.
    SetBend(f32),
    /// Sets the angles of the hand about x, y and z in radians, in the present [`HandSpace`].
    SetHandOrientation(Vec3),
    /// Changes the space of the hand's angles; the hand does not turn.
    SetHandSpace(HandSpace),
    /// Sets the length of the upper limb.
    SetUpper(f32),
    /// Sets the length of the lower limb.
    SetLower(f32),
}

impl ArmEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::SetHand(_) | Self::SetPin(_) => "Move hand",
            Self::SetTwist(_) => "Set Socket twist",
            Self::SetRoot(_) => "Move shoulder",
            Self::PinHand(true) => "Pin hand",
            Self::PinHand(false) => "Unpin hand",
            Self::SetTwistReference(_) => "Change twist reference",
            Self::SetPole(_) => "Move pole",
            Self::SetSoftReach(_) => "Change soft reach",
            Self::SetInfluence(_) => "Blend FK and IK",
            Self::SwitchPoseMode(PoseMode::Hand) => "Switch to IK",
            Self::SwitchPoseMode(PoseMode::Angles) => "Switch to FK",
            Self::SetShoulder(_) => "Turn shoulder",
            Self::SetBend(_) => "Bend elbow",
            Self::SetHandOrientation(_) | Self::SetHandSpace(_) => "Turn hand",
            Self::SetUpper(_) | Self::SetLower(_) => "Change length",
        }
    }

    pub(in crate::session) fn apply(self, session: &Session) -> Outcome {
        let arm = *session.arm();
        match self {
            Self::SetHand(hand) => set_point(session, "hand", hand, Arm::set_cursor),
            Self::SetPin(pin) => set_point(session, "hand", pin, |arm, pin| {
                arm.cursor = Cursor { in_world: pin, is_pinned: true, ..arm.cursor };
            }),
            Self::SetRoot(root) => set_point(session, "shoulder", root, |arm, it| arm.root = it),
            Self::SetPole(pole) => set_point(session, "pole", pole, |arm, pole| arm.pole = pole),
            Self::SetShoulder(angles) => {
                set_point(session, "shoulder angles", angles, |arm, it| arm.fk.shoulder = it)
            }
            Self::SetHandOrientation(angles) => {
                set_point(session, "hand angles", angles, |arm, angles| {
                    arm.hand_orientation.angles = angles;
                })
            }
            Self::SetTwist(twist) if twist.is_finite() => {
                replace(session, Arm { twist: wrapped(twist), ..arm })
            }
            Self::SetTwist(twist) => {
                Outcome::fail(format!("The Socket twist must be finite, got {twist}"))
            }
            Self::SetBend(bend) => set_bend(session, bend),
            Self::SetInfluence(influence) if (0.0..=1.0).contains(&influence) => {
                replace(session, Arm { influence, ..arm })
            }
            Self::SetInfluence(influence) => {
                Outcome::fail(format!("The IK influence must be from 0 to 1, got {influence}"))
            }
            Self::PinHand(pinned) => replace(session, arm.with_pinned(pinned)),
            Self::SetSoftReach(soft_reach) => replace(session, Arm { soft_reach, ..arm }),
            Self::SetTwistReference(reference) => set_twist_reference(session, reference),
            Self::SwitchPoseMode(mode) => switch_pose_mode(session, mode),
            Self::SetHandSpace(space) => Outcome::write(session.shown().with_hand_space(space)),
            Self::SetUpper(upper) => set_lengths(session, upper, arm.bones.lower()),
            Self::SetLower(lower) => set_lengths(session, arm.bones.upper(), lower),
        }
    }
}

/// Replaces the arm; its solve state (facing, transported frame, roll) continues from the present
/// arm.
pub(in crate::session) fn replace(session: &Session, arm: Arm) -> Outcome {
    let shown = session.shown();
    let arm = arm.transported_from(&shown.arm).with_solve_state();
    Outcome::write(Document { arm, ..shown.clone() })
}

fn set_point(session: &Session, name: &str, point: Vec3, set: fn(&mut Arm, Vec3)) -> Outcome {
    if !point.is_finite() {
        return Outcome::fail(format!("The {name} must be finite, got {point}"));
    }
    let mut arm = *session.arm();
    set(&mut arm, point);
    replace(session, arm)
}

fn set_bend(session: &Session, bend: f32) -> Outcome {
    if !bend.is_finite() {
        return Outcome::fail(format!("The elbow's bend must be finite, got {bend}"));
    }
    let mut arm = *session.arm();
    arm.fk.bend = bend;
    replace(session, arm)
}

fn set_lengths(session: &Session, upper: f32, lower: f32) -> Outcome {
    match TwoBone::new(upper, lower) {
        Ok(bones) => replace(session, Arm { bones, ..*session.arm() }),
        Err(error) => Outcome::fail(format!("the {error}")),
    }
}

/// Changes the twist reference of the arm and of all keys of the twist; the elbow does not move. If
/// the converted keys give the shown twist at the playhead, there is no unkeyed edit.
fn set_twist_reference(session: &Session, reference: TwistReferenceKind) -> Outcome {
    let was_overridden = session.history().is_overridden(Channel::Twist);
    let forget = (!was_overridden).then_some(Consequence::ForgetTwistLikeKeys);
    Outcome::write(session.shown().with_twist_reference(reference)).and(forget)
}

/// Switches to FK or IK. The pose does not change, unless the soft limits exclude it.
fn switch_pose_mode(session: &Session, mode: PoseMode) -> Outcome {
    let arm = match mode {
        PoseMode::Hand => session.arm().switched_to_ik(),
        PoseMode::Angles => session.arm().switched_to_fk(),
    };
    replace(session, arm).and(Consequence::SayIfArmMoved(Box::new(*session.pose())))
}
