use crate::kinematics::skeleton::{JointId, SkeletonPose};

/// Buffers for intermediate results of a [`SceneBuilder`](super::SceneBuilder).
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    pub pose: SkeletonPose,
    pub fk_pose: SkeletonPose,
    /// For each joint the influence of the targets that turn it.
    pub influences: Vec<f32>,
    /// Distance of each joint from its root along offsets, in skeleton space.
    pub distances: Vec<f32>,
    /// Number of bones above each joint, not counting bones of zero length.
    pub depths: Vec<usize>,
    /// Whether each joint has no child.
    pub are_leaves: Vec<bool>,
    /// Joints that get a label.
    pub labelled: Vec<JointId>,
}
