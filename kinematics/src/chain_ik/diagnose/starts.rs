//! Other joint angles to start from.

use glam::Vec3;

use crate::diagnosis::Start;
use crate::skeleton::{Joint, JointId, RotationAxis, Skeleton};

/// The present angles of all joints above a tip, each changed a little and within its limits. The
/// signs alternate along the chain, so that a straight chain bends and folds back.
pub(super) fn bent(skeleton: &Skeleton, joint: JointId) -> Start {
    /// Change of each angle, in radians.
    const BEND: f32 = 0.2;
    let turn = |index: usize, joint: &Joint| {
        let side = if index.is_multiple_of(2) { BEND } else { -BEND };
        let mut angles = joint.rotation;
        for axis in RotationAxis::ALL {
            let angle = &mut angles[axis.index()];
            let (to, back) = (*angle + side, *angle - side);
            let is_free = |angle| joint.limits.allows(axis, angle);
            *angle = if is_free(to) || !is_free(back) { to } else { back };
        }
        joint.limits.project(angles)
    };
    Start { is_bend: true, angles: turned(skeleton, joint, turn) }
}

/// The middle of all limits, and the bind pose of angles without limits.
pub(super) fn middle(skeleton: &Skeleton, joint: JointId) -> Start {
    let turn = |_, joint: &Joint| joint.limits.middle();
    Start { is_bend: false, angles: turned(skeleton, joint, turn) }
}

/// New angles of all joints above a tip that may turn.
fn turned(
    skeleton: &Skeleton,
    joint: JointId,
    turn: impl Fn(usize, &Joint) -> Vec3,
) -> Vec<(JointId, Vec3)> {
    let free = skeleton.ancestors(joint).filter(|joint| !skeleton[*joint].locked);
    free.enumerate().map(|(index, joint)| (joint, turn(index, &skeleton[joint]))).collect()
}
