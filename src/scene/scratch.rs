use crate::kinematics::skeleton::SkeletonPose;

/// Room for what a scene works out while it is made, and no picture shows: kept, so that it is not
/// taken anew for every picture. What is left in it makes no two scenes differ.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    pub pose: SkeletonPose,
    /// How far each joint is from its root.
    pub distances: Vec<f32>,
    /// How many bones are above each joint.
    pub depths: Vec<usize>,
    /// Whether nothing hangs from a joint.
    pub are_leaves: Vec<bool>,
    /// The joints that are named.
    pub named: Vec<usize>,
}

impl PartialEq for Scratch {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
