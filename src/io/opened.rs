use super::error::Remark;
use crate::document::Document;
use crate::kinematics::skeleton::JointId;

/// A document read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Opened {
    /// The document.
    pub document: Document,
    /// Oddities in the file that did not keep it from being opened.
    pub warnings: Vec<Remark>,
    /// For each joint in the file's order, its index in the document's skeleton.
    pub order: Vec<JointId>,
    /// The names of the file's skeletons, one of which is the document's; empty where skeletons
    /// have no names.
    pub skeletons: Vec<String>,
}
