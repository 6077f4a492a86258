use std::path::PathBuf;
use std::sync::Arc;

use crate::document::{Arm, Bake, Document, Theme};
use crate::io::Progress;
use crate::kinematics::skeleton::JointId;
use crate::session::arm::edits;
use crate::session::files::action::{FileAction, FileContents, PathDialog};
use crate::session::outcome::{Consequence, Effect, Outcome};
use crate::session::preferences::{FrameBudget, Navigation, Preferences};

/// Changes dialogs, messages or preferences.
#[derive(Clone, Debug, PartialEq)]
pub enum ShellAction {
    /// Opens a dialog.
    OpenDialog(Dialog),
    /// Closes the dialog.
    CloseDialog,
    /// Shows a message.
    Report(String),
    /// Shows an error.
    Fail(String),
    /// Removes the message, whose moment is over.
    ClearMessage,
    /// Copies the arm's pose to the clipboard, as a line for `ik-arm solve`.
    CopyPose,
    /// Sets the theme.
    SetTheme(Theme),
    /// Sets the mouse buttons that move the camera.
    SetNavigation(Navigation),
    /// Sets the time for a frame while something moves.
    SetFrameBudget(FrameBudget),
}

/// The open dialog and the message in the status bar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shell {
    dialog: Option<Dialog>,
    /// True if the system's file dialog is open.
    choosing: bool,
    message: Option<Message>,
}

impl ShellAction {
    /// Applies an action; `preferences` are the present ones.
    pub(super) fn apply(self, arm: Option<&Arm>, preferences: Preferences) -> Outcome {
        match self {
            Self::OpenDialog(dialog) => Consequence::OpenDialog(Box::new(dialog)).into(),
            Self::CloseDialog => Consequence::CloseDialog.into(),
            Self::Report(message) => Outcome::say(message),
            Self::Fail(why) => Outcome::fail(why),
            Self::ClearMessage => Consequence::Message(None).into(),
            Self::CopyPose => match arm {
                Some(arm) => Outcome::say("Pose copied as a line for ik-arm solve")
                    .and(Effect::CopyText(edits::pose_line(arm))),
                None => Outcome::say("Only the pose of the arm can be copied"),
            },
            Self::SetTheme(theme) => {
                Consequence::Prefer(Preferences { theme, ..preferences }).into()
            }
            Self::SetNavigation(navigation) => {
                Consequence::Prefer(Preferences { navigation, ..preferences }).into()
            }
            Self::SetFrameBudget(frame_budget) => {
                Consequence::Prefer(Preferences { frame_budget, ..preferences }).into()
            }
        }
    }
}

impl Shell {
    /// The open dialog.
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// True if the system's file dialog is open.
    pub fn is_choosing(&self) -> bool {
        self.choosing
    }

    /// The message in the status bar; `None` before the first message and after an edit, which
    /// clears it.
    pub fn message(&self) -> Option<&str> {
        self.message.as_ref().map(Message::text)
    }

    /// True if [`Self::message`] is an error.
    pub fn has_failed(&self) -> bool {
        self.message.as_ref().is_some_and(Message::is_error)
    }

    /// True if a modal dialog of the program or a file dialog of the system is open.
    pub fn is_asking(&self) -> bool {
        self.choosing || self.dialog.as_ref().is_some_and(Dialog::is_modal)
    }

    pub(super) fn open_dialog(&mut self, dialog: Dialog) {
        self.dialog = Some(dialog);
    }

    /// Closes the dialog and returns it; `None` if none is open.
    pub(super) fn take_dialog(&mut self) -> Option<Dialog> {
        self.dialog.take()
    }

    pub(super) fn set_choosing(&mut self, choosing: bool) {
        self.choosing = choosing;
    }

    pub(super) fn set_message(&mut self, message: Option<Message>) {
        self.message = message;
    }

    /// Removes a message about the pose at the time that has passed.
    pub(super) fn leave_moment(&mut self) {
        self.message.take_if(|message| message.is_of_moment());
    }
}

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
