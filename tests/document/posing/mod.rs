//! The arm in a session: pinned hand, twist references, FK and IK, hand orientation, keys.

mod always;
mod cases;
mod keyed;
mod plants;

use crate::common::arm::Step;
use glam::Vec3;
use ik_arm::document::TwistReferenceKind;
use ik_arm::kinematics::two_bone::TwoBonePose;
use ik_arm::session::Session;
use proptest::prelude::*;

/// Any kind of twist reference.
pub fn references() -> impl Strategy<Value = TwistReferenceKind> {
    (0..TwistReferenceKind::ALL.len()).prop_map(|index| TwistReferenceKind::ALL[index])
}

/// New session with actions applied.
pub fn session(actions: impl IntoIterator<Item = impl Into<Step>>) -> Session {
    let mut session = Session::default();
    for action in actions {
        action.into().apply(&mut session);
    }
    session
}

/// Bits of the components, for exact comparisons.
pub fn bits(point: Vec3) -> [u32; 3] {
    point.to_array().map(f32::to_bits)
}

/// Largest distance between elbows and hands of two poses, in units of the default arm's length.
pub fn apart(a: &TwoBonePose, b: &TwoBonePose) -> f32 {
    a.elbow.distance(b.elbow).max(a.hand.distance(b.hand)) / 500.0
}
