use glam::Vec3;

use crate::skeleton::JointId;

/// A target for the tip of a joint's bone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TipTarget {
    /// The joint whose tip is to reach the target.
    pub joint: JointId,
    /// Position of the target in the world.
    pub point: Vec3,
    /// Weight relative to other targets, above 0.
    pub weight: f32,
}
