//! Other joint angles to start from.

use glam::Vec3;

use crate::diagnosis::Start;
use crate::skeleton::{Joint, JointId, Limit, Skeleton};

/// The present angles of all joints above a tip, each changed a little and within its limits. The
/// signs alternate along the chain, so that a straight chain bends and folds back.
pub(super) fn bent(skeleton: &Skeleton, joint: JointId) -> Start {
    /// Change of each angle, in radians.
    const BEND: f32 = 0.2;
    let turn = |index: usize, joint: &Joint| {
        let side = if index.is_multiple_of(2) { BEND } else { -BEND };
        let mut angles = joint.rotation;
        for axis in 0..3 {
            let (to, back) = (joint.rotation[axis] + side, joint.rotation[axis] - side);
            let is_free =
                |angle| joint.limits[axis].is_none_or(|it| angle >= it.min && angle <= it.max);
            angles[axis] = if is_free(to) || !is_free(back) { to } else { back };
        }
        joint.clamped(angles)
    };
    Start { is_bend: true, angles: turned(skeleton, joint, turn) }
}

/// The middle of all limits, and the bind pose of angles without limits.
pub(super) fn middle(skeleton: &Skeleton, joint: JointId) -> Start {
    let middle = |limit: Option<Limit>| limit.map_or(0.0, |it| 0.5 * it.min + 0.5 * it.max);
    let turn = |_, joint: &Joint| Vec3::from_array(joint.limits.map(middle));
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
