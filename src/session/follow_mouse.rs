use glam::Vec3;

use crate::kinematics::skeleton::JointId;
use crate::rig::TargetSpace;

/// Heads that follow the mouse: a drag without a button. While time passes, the targets of the heads
/// swim after the mouse, and keys record their way, so that the tails follow it by the document alone.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FollowMouse {
    /// The mouse on the level of the heads, in world space; `None` until it is in the view.
    pub at: Option<Vec3>,
    pub heads: Vec<FollowingHead>,
    /// Time at which the recording began, in seconds.
    pub start: f64,
}

/// A head with its target's home.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FollowingHead {
    pub joint: JointId,
    pub space: TargetSpace,
    /// The home relative to the middle of all homes, in world space.
    pub beside: Vec3,
}
