use crate::kinematics::skeleton::{Pose, Skeleton};
use crate::kinematics::solve::Method;

/// What a picture shows beside the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Staging {
    /// In seconds.
    pub time: f64,
    /// Joints that are selected; the last one is the one that is worked on.
    pub selection: Vec<usize>,
    /// The joint that the pointer is on.
    pub pointed: Option<usize>,
    /// The skeleton as solvers in a race have it.
    pub ghosts: Vec<Ghost>,
}

/// A skeleton as a solver has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Ghost {
    pub method: Method,
    pub pose: Pose,
}

impl Ghost {
    pub(super) fn new(method: Method, skeleton: &Skeleton) -> Self {
        Self { method, pose: skeleton.pose() }
    }
}
