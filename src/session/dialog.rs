use std::path::PathBuf;
use std::sync::Arc;

use super::files::action::{FileAction, FileContents, PathDialog};
use crate::document::{Bake, Document};
use crate::io::{ExampleGroup, Progress};
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
    /// Pictures of the built-in examples of a group.
    Examples(ExampleGroup),
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
    /// The dialog for a bake of the document, with default settings.
    pub fn bake(document: &Document) -> Self {
        Self::Bake { settings: Bake::of_timeline(document), job: None }
    }

    /// True if the dialog takes all keyboard and mouse input.
    pub fn is_modal(&self) -> bool {
        *self != Self::Statistics
    }
}

impl From<PathDialog> for Dialog {
    fn from(dialog: PathDialog) -> Self {
        Self::Path(dialog)
    }
}

/// A bake that runs on a thread of its own.
#[derive(Clone, Debug)]
pub struct BakeJob {
    /// Progress of the bake, and the flag that cancels it.
    pub progress: Arc<Progress>,
}

/// Equal for clones of the same job, whatever its progress.
impl PartialEq for BakeJob {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.progress, &other.progress)
    }
}

/// The text in the status bar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Message {
    text: String,
    is_error: bool,
    /// True if the message is about the pose at the current time, and goes when the time changes.
    is_of_moment: bool,
}

impl Message {
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_error: false, is_of_moment: false }
    }

    /// A message about the pose at the current time.
    pub fn of_moment(text: impl Into<String>) -> Self {
        Self { is_of_moment: true, ..Self::new(text) }
    }

    pub fn is_of_moment(&self) -> bool {
        self.is_of_moment
    }

    /// An error message; the first letter of `why` becomes a capital.
    pub fn error(why: &str) -> Self {
        let mut letters = why.chars();
        let first = letters.next().map(|letter| letter.to_uppercase().to_string());
        let text = format!("{}{}", first.unwrap_or_default(), letters.as_str());
        Self { text, is_error: true, is_of_moment: false }
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    pub fn is_error(&self) -> bool {
        self.is_error
    }
}
