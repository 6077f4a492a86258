use crate::document::Theme;
use crate::session::dialog::{Dialog, Message};
use crate::session::limb::ShownLimb;
use crate::session::outcome::{Consequence, Effect, Outcome};
use crate::session::preferences::{FrameBudget, Navigation, Preferences};
use crate::session::solve_line;

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
    /// Copies the pose of the shown limb to the clipboard, as a line for `ik-arm solve`.
    CopyPose,
    /// Sets the theme.
    SetTheme(Theme),
    /// Sets the mouse buttons that move the camera.
    SetNavigation(Navigation),
    /// Sets the time for a frame while something moves.
    SetFrameBudget(FrameBudget),
    /// Lets solver runs start from the FK pose, instead of from the frame before.
    RunFromFk(bool),
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
    pub(super) fn apply(self, limb: Option<&ShownLimb>, preferences: Preferences) -> Outcome {
        match self {
            Self::OpenDialog(dialog) => Consequence::OpenDialog(Box::new(dialog)).into(),
            Self::CloseDialog => Consequence::CloseDialog.into(),
            Self::Report(message) => Outcome::say(message),
            Self::Fail(why) => Outcome::fail(why),
            Self::ClearMessage => Consequence::Message(None).into(),
            Self::CopyPose => match limb {
                Some(limb) => Outcome::say("Pose copied as a line for ik-arm solve")
                    .and(Effect::CopyText(solve_line::of(&limb.frames))),
                None => Outcome::say("There is no limb whose pose could be copied"),
            },
            Self::SetTheme(theme) => {
                Consequence::Prefer(Preferences { theme, ..preferences }).into()
            }
            Self::SetNavigation(navigation) => {
                Consequence::Prefer(Preferences { navigation, ..preferences }).into()
            }
            Self::RunFromFk(runs_from_fk) => {
                Outcome::from(Consequence::Prefer(Preferences { runs_from_fk, ..preferences }))
                    .and(Consequence::Refresh)
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
