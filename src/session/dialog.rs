use std::path::PathBuf;

use super::bake_action::BakeJob;
use super::file_action::FileAction;
use super::file_contents::FileContents;
use super::path_dialog::PathDialog;
use crate::document::{Bake, Document};
use crate::kinematics::skeleton::JointId;

/// A dialog above the panels. All dialogs except the statistics are modal: they take all keyboard
/// and mouse input.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialog {
    /// Version, graphics adapter and licence.
    About,
    /// Keyboard and mouse shortcuts.
    Shortcuts,
    /// Terms of the user interface and their meanings.
    Glossary,
    /// Frame times; not modal.
    Statistics,
    /// Offers to open the document that an earlier run of the program left unsaved.
    Recover {
        /// The unsaved document.
        document: Box<Document>,
        /// The document's file; `None` if it had none.
        file: Option<PathBuf>,
    },
    /// Asks before an action that would lose unsaved changes.
    Unsaved {
        /// The action that waits for the answer.
        then: Box<FileAction>,
    },
    /// Asks before the document's file is overwritten, which another program has changed.
    FileChanged {
        /// The document's file.
        path: PathBuf,
    },
    /// Asks before quitting while an export runs.
    Exporting,
    /// Asks before a file is overwritten.
    Replace {
        /// The file to overwrite.
        path: PathBuf,
        /// The action that overwrites the file.
        then: Box<FileAction>,
        /// The dialog in which the path was chosen; Cancel opens it again.
        back: PathDialog,
    },
    /// Asks for a path.
    Path(PathDialog),
    /// Asks which of a file's skeletons and animations to open.
    ChooseContents(Box<FileContents>),
    /// Asks for the name of a joint.
    Rename {
        /// The joint to rename.
        joint: JointId,
        /// The name as typed so far.
        name: String,
    },
    /// Asks for the settings of a bake, then shows its progress.
    Bake {
        /// The settings.
        settings: Bake,
        /// The running bake; `None` before it starts. Closing the dialog cancels it.
        job: Option<BakeJob>,
    },
    /// Asks whether the children of deleted joints are kept.
    DeleteJoints {
        /// The joints to delete.
        joints: Vec<JointId>,
    },
}

impl Dialog {
    /// Whether the dialog takes all keyboard and mouse input.
    pub fn is_modal(&self) -> bool {
        *self != Self::Statistics
    }
}

impl From<PathDialog> for Dialog {
    fn from(dialog: PathDialog) -> Self {
        Self::Path(dialog)
    }
}
