use crate::kinematics::skeleton::{JointId, SkeletonPose};

/// Buffers for intermediate results.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    pub pose: SkeletonPose,
    /// Distance of each joint from its root.
    pub distances: Vec<f32>,
    /// Number of bones above each joint.
    pub depths: Vec<usize>,
    /// Whether each joint has no child.
    pub are_leaves: Vec<bool>,
    /// Joints with labels.
    pub labelled: Vec<JointId>,
}
