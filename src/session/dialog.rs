use std::path::PathBuf;

use super::file_action::FileAction;
use super::path_dialog::PathDialog;
use crate::document::Document;
use crate::kinematics::skeleton::JointId;

/// A window over the others. All but the statistics are modal: they take the keyboard and the mouse.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialog {
    /// Version, graphics adapter and licence.
    About,
    /// Keyboard and mouse shortcuts.
    Shortcuts,
    /// Frame times; not modal.
    Statistics,
    /// Offers the document that an earlier run of the program left unsaved.
    Recover {
        /// The unsaved document.
        document: Box<Document>,
        /// The file it was read from.
        file: Option<PathBuf>,
    },
    /// Asks before an action that would lose unsaved changes.
    Unsaved {
        /// The action.
        then: Box<FileAction>,
    },
    /// Asks before quitting while an export runs.
    Exporting,
    /// Asks before a file is overwritten.
    Replace {
        /// The file.
        path: PathBuf,
        /// The action that overwrites it.
        then: Box<FileAction>,
        /// The dialog that the path was typed into; it opens again on Cancel.
        back: PathDialog,
    },
    /// Asks for a path.
    Path(PathDialog),
    /// Asks which of a file's skeletons to open.
    ChooseSkeleton {
        /// The file.
        path: PathBuf,
        /// Names of its skeletons.
        names: Vec<String>,
    },
    /// Asks for the name of a joint.
    Rename {
        /// The joint.
        joint: JointId,
        /// The name as typed so far.
        name: String,
    },
    /// Asks whether the children of deleted joints are kept.
    DeleteJoints {
        /// The joints to delete.
        joints: Vec<JointId>,
    },
}

impl Dialog {
    /// Whether it takes the keyboard and the mouse.
    pub fn is_modal(&self) -> bool {
        *self != Self::Statistics
    }
}

impl From<PathDialog> for Dialog {
    fn from(dialog: PathDialog) -> Self {
        Self::Path(dialog)
    }
}
