use std::collections::BTreeSet;

use glam::Vec3;

use crate::document::Channel;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::spline::Knot;

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

/// Sizes of the arm on an arm of [thickness](crate::rig::LimbFrames::thickness) 1.
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

/// A joint of the arm that can be selected in the viewport, which shows its handles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArmJoint {
    /// The shoulder, with handles that move the Root.
    Root,
    /// The elbow, with the ring of the Socket twist.
    Elbow,
    /// The hand, with the rings of its orientation.
    Hand,
}

/// The way in which the arm is posed: by FK or by IK.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseMode {
    /// IK (hand → joint angles): the Cursor poses the arm.
    Hand,
    /// FK (joint angles → hand): the joint angles pose the arm.
    Angles,
}

/// A line of a limb's figures and formulas, which lights up in the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimbFigure {
    /// The axes of the Root.
    Root,
    /// The axes of the Limb.
    Limb,
    /// The axes of the Socket.
    Socket,
    /// The Upper limb, d_1 long.
    Upper,
    /// The Lower limb, d_2 long.
    Lower,
    /// The Cursor's x_c, y_c and z_c; without IK, those of the hand.
    Cursor,
    /// The yaw θ_z of the Pointer.
    Yaw,
    /// The horizontal distance h_c from the Root to the Cursor.
    Level,
    /// The pitch θ_y of the Pointer.
    Pitch,
    /// The distance D from shoulder to hand.
    Distance,
    /// The distance h_e of the elbow along the Pointer.
    Along,
    /// The distance o_e of the elbow from the Pointer.
    Out,
    /// The angle θ_e at the shoulder.
    ShoulderAngle,
    /// The angle φ at the elbow.
    ElbowAngle,
    /// The elbow's x_e, y_e and z_e.
    Elbow,
}

impl LimbFigure {
    /// All lines.
    pub const ALL: [Self; 15] = [
        Self::Root,
        Self::Limb,
        Self::Socket,
        Self::Upper,
        Self::Lower,
        Self::Cursor,
        Self::Yaw,
        Self::Level,
        Self::Pitch,
        Self::Distance,
        Self::Along,
        Self::Out,
        Self::ShoulderAngle,
        Self::ElbowAngle,
        Self::Elbow,
    ];
}

/// A key: its channel and its time, in seconds.
pub type Key = (Channel, f64);

/// Copied keys with their channels. Their times are those after the first key, in seconds.
pub(super) type Clipboard = Vec<(Channel, Knot<Vec3>)>;

/// The selected keys and channels before an edit of the joints, whose numbers they name.
#[derive(Clone, Debug)]
pub(super) struct SelectedKeys {
    pub keys: Vec<Key>,
    pub channels: BTreeSet<Channel>,
}
