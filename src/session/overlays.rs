use glam::Vec3;

use crate::document::Arm;
use crate::kinematics::chain_ik::Method;
use crate::kinematics::skeleton::{JointId, SkeletonPose};
use crate::kinematics::twist::TransportedFrame;
use crate::rig::Crowd;

/// What a picture shows beside the document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlays {
    /// In seconds.
    pub time: f64,
    /// Joints that are selected; the last one is the one that is worked on.
    pub selection: Vec<JointId>,
    /// The joint that the pointer is on.
    pub hovered: Option<JointId>,
    /// The skeleton as solvers in a race have it.
    pub ghosts: Vec<SolverGhost>,
    /// What was carried along with the Pointer, from which transport would measure the elbow.
    pub transported: Option<TransportedFrame>,
    /// Where the hand or the selected joint's tip is at every frame, in the world.
    pub trail: Vec<Vec3>,
    pub onion_skins: Vec<OnionSkin>,
    /// What is shown in the rig's place.
    pub crowd: Option<Crowd>,
}

/// The rig as it stands somewhat before or after.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnionSkin {
    pub arm: Arm,
    pub pose: SkeletonPose,
    /// Whether it is before.
    pub past: bool,
    /// How well it is seen: 1 is nearest in time.
    pub opacity: f32,
}

/// A skeleton as a solver has it.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverGhost {
    pub method: Method,
    pub pose: SkeletonPose,
}
