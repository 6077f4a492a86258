use crate::kinematics::skeleton::JointId;

/// A part of a body in the viewport, which lights up under the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyPart {
    /// The ball of the arm's shoulder.
    Root,
    /// The Upper limb of the arm.
    UpperLimb,
    /// The Lower limb of the arm, with the ball of the elbow.
    LowerLimb,
    /// The hand of the arm.
    Hand,
    /// The bone of a joint, or the skin that it moves.
    Joint(JointId),
}

impl BodyPart {
    /// The joint of a skeleton; `None` for a part of the arm.
    pub fn joint(self) -> Option<JointId> {
        match self {
            Self::Joint(joint) => Some(joint),
            Self::Root | Self::UpperLimb | Self::LowerLimb | Self::Hand => None,
        }
    }
}

impl From<JointId> for BodyPart {
    fn from(joint: JointId) -> Self {
        Self::Joint(joint)
    }
}

/// Sizes of the arm on an arm of [thickness](crate::rig::ArmRig::thickness) 1.
impl BodyPart {
    /// Radius of the balls of shoulder and elbow: as large as the ends of the limbs, so that no gap
    /// shows when the elbow bends.
    pub const JOINT_BALL: f32 = 33.0;
    /// Radius of the ball of the wrist.
    pub const WRIST_BALL: f32 = 22.0;
    /// Distance from the wrist to the tip of the middle finger.
    pub const HAND: f32 = 105.0;
    /// Radius of the shape that the mouse hits around the fingers.
    pub(super) const FINGERS: f32 = 24.0;
}
