//! The arm in a session: pinned hand, twist references, FK and IK, hand orientation, keys.

mod always;
mod cases;
mod keyed;
mod plants;

use glam::Vec3;
use ik_arm::document::TwistReferenceKind;
use ik_arm::kinematics::two_bone::TwoBonePose;
use ik_arm::session::{Action, Session};
use proptest::prelude::*;

/// Any kind of twist reference.
pub fn references() -> impl Strategy<Value = TwistReferenceKind> {
    (0..TwistReferenceKind::ALL.len()).prop_map(|index| TwistReferenceKind::ALL[index])
}

/// New session with actions applied.
pub fn session(actions: impl IntoIterator<Item = impl Into<Action>>) -> Session {
    let mut session = Session::default();
    for action in actions {
        session.apply(action);
    }
    session
}

/// Bits of the components, for exact comparisons.
pub fn bits(point: Vec3) -> [u32; 3] {
    point.to_array().map(f32::to_bits)
}

/// Angle in f64, exact for small angles, unlike the arc cosine.
pub fn angle(a: Vec3, b: Vec3) -> f64 {
    let [a, b] = [a, b].map(Vec3::as_dvec3);
    a.cross(b).length().atan2(a.dot(b))
}

/// Largest distance between elbows and hands of two poses, in units of the default arm's length.
pub fn apart(a: &TwoBonePose, b: &TwoBonePose) -> f32 {
    a.elbow.distance(b.elbow).max(a.hand.distance(b.hand)) / 500.0
}
