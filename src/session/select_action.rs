use super::arm_figure::ArmFigure;
use super::arm_joint::ArmJoint;
use super::body_part::BodyPart;
use super::key::Key;
use crate::document::Channel;
use crate::kinematics::skeleton::{JointId, RotationAxis};

/// Changes the selection or the copied keys.
#[derive(Clone, Debug, PartialEq)]
pub enum SelectAction {
    /// Selects these joints and no others; the last of them becomes the active joint.
    Joints(Vec<JointId>),
    /// Sets the part of a body under the mouse; `None` if there is none.
    Hover(Option<BodyPart>),
    /// Lets an angle of a joint swing in the view; `None` stops it.
    Wiggle(Option<(JointId, RotationAxis)>),
    /// Selects a joint of the arm, or none.
    ArmJoint(Option<ArmJoint>),
    /// Lights up a line of the arm's figures in the view; `None` stops it.
    Figure(Option<ArmFigure>),
    /// Selects these keys and no others.
    Keys(Vec<Key>),
    /// Selects these channels and no others.
    Channels(Vec<Channel>),
    /// Copies the selected keys.
    CopyKeys,
}
