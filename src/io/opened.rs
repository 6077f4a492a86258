use super::error::Remark;
use super::file_animation::FileAnimation;
use crate::document::Document;
use crate::kinematics::skeleton::JointId;

/// A document read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Opened {
    /// The document.
    pub document: Document,
    /// Warnings about a file that could be opened all the same.
    pub warnings: Vec<Remark>,
    /// For each joint in the file's order, its index in the document's skeleton.
    pub order: Vec<JointId>,
    /// The names of the file's skeletons, one of which was opened; empty for this program's own
    /// format, in which the one skeleton has no name.
    pub skeletons: Vec<String>,
    /// The animations of a glTF file; empty for other formats.
    pub animations: Vec<FileAnimation>,
    /// Index of the animation that was read; `None` if there is none.
    pub animation: Option<usize>,
}
