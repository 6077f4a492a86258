use super::key::Key;
use crate::document::Channel;
use crate::kinematics::skeleton::JointId;

/// Changes the selection or the copied keys.
#[derive(Clone, Debug, PartialEq)]
pub enum SelectAction {
    /// Selects these joints and no others; the last one is the active one.
    Joints(Vec<JointId>),
    /// Sets the joint under the mouse.
    Hover(Option<JointId>),
    /// Selects these keys and no others.
    Keys(Vec<Key>),
    /// Selects these channels and no others.
    Channels(Vec<Channel>),
    /// Copies the selected keys.
    CopyKeys,
}
