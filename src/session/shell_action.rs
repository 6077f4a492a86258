use super::dialog::Dialog;
use super::preferences::{FrameBudget, Navigation};
use crate::document::Theme;

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
