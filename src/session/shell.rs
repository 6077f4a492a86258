use super::dialog::Dialog;
use super::message::Message;
use super::path_dialog::PathDialog;

/// The open dialog and the message in the status bar.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Shell {
    dialog: Option<Dialog>,
    /// Whether the system's file dialog is open.
    choosing: bool,
    message: Option<Message>,
}

impl Shell {
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// The open dialog, if it asks for a path.
    pub fn path_dialog(&self) -> Option<&PathDialog> {
        match self.dialog() {
            Some(Dialog::Path(dialog)) => Some(dialog),
            _ => None,
        }
    }

    pub fn is_choosing(&self) -> bool {
        self.choosing
    }

    pub fn message(&self) -> Option<&Message> {
        self.message.as_ref()
    }

    pub fn open_dialog(&mut self, dialog: Dialog) {
        self.dialog = Some(dialog);
    }

    /// Closes the dialog and returns it; `None` if none is open.
    pub fn take_dialog(&mut self) -> Option<Dialog> {
        self.dialog.take()
    }

    pub fn set_choosing(&mut self, choosing: bool) {
        self.choosing = choosing;
    }

    pub fn set_message(&mut self, message: Message) {
        self.message = Some(message);
    }

    /// Removes a message about the pose at the time that has passed.
    pub fn leave_moment(&mut self) {
        self.message.take_if(|message| message.is_of_moment());
    }

    pub fn clear_message(&mut self) {
        self.message = None;
    }
}
