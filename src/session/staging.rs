use glam::Vec3;

use crate::document::Arm;
use crate::kinematics::skeleton::{Pose, Skeleton};
use crate::kinematics::solve::Method;
use crate::kinematics::swivel::Carried;

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
    /// What was carried along with the Pointer, from which transport would measure the elbow.
    pub carried: Option<Carried>,
    /// Where the hand or the selected joint's tip is at every frame, in the world.
    pub trail: Vec<Vec3>,
    pub onion_skins: Vec<OnionSkin>,
}

/// The rig as it stands somewhat before or after.
#[derive(Clone, Debug, PartialEq)]
pub struct OnionSkin {
    pub arm: Arm,
    pub pose: Pose,
    /// Whether it is before.
    pub past: bool,
    /// How well it is seen: 1 is nearest in time.
    pub opacity: f32,
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
