use std::path::{Path, PathBuf};

use super::dialog::Dialog;
use super::effect::Effect;
use super::message::Message;
use super::path_dialog::PathDialog;
use super::pose_line;
use super::preferences::Preferences;
use super::session::Session;
use super::shell_action::ShellAction;
use crate::document::RigKind;

/// Dialogs, messages and preferences.
impl Session {
    /// The open dialog.
    pub fn dialog(&self) -> Option<&Dialog> {
        self.shell.dialog()
    }

    /// Whether a modal dialog of the program or a file dialog of the system is open.
    pub fn is_asking(&self) -> bool {
        self.shell.is_choosing() || self.shell.dialog().is_some_and(Dialog::is_modal)
    }

    /// Whether the system's file dialog is open.
    pub fn is_choosing(&self) -> bool {
        self.shell.is_choosing()
    }

    pub(super) fn open_dialog(&mut self, dialog: Dialog) {
        // Only the dialogs for saving keep the action that waits for the document to be saved.
        let is_saving = match &dialog {
            Dialog::Path(dialog) => matches!(dialog, PathDialog::SaveAs { .. }),
            Dialog::Replace { back, .. } => matches!(back, PathDialog::SaveAs { .. }),
            Dialog::FileChanged { .. } => true,
            _ => false,
        };
        if !is_saving {
            self.files.take_after_save();
        }
        self.shell.set_choosing(false);
        self.shell.open_dialog(dialog);
    }

    pub(super) fn close_dialog(&mut self) {
        self.shell.set_choosing(false);
        match self.shell.take_dialog() {
            Some(Dialog::Replace { back, .. }) => self.shell.open_dialog(back.into()),
            Some(Dialog::Bake { job: Some(job), .. }) => {
                job.progress.cancel();
                self.say("Bake cancelled");
            }
            _ => {
                self.files.take_after_save();
                self.files.take_remark();
            }
        }
    }

    /// Opens the program's own dialog, because the system has no file dialog. If a dialog of the
    /// program is open already, asks to type the path there.
    pub(super) fn ask_in_program(&mut self, dialog: PathDialog) {
        if self.shell.dialog().is_some() {
            self.shell.set_choosing(false);
            self.fail("the system has no file dialog: type the path");
        } else {
            self.open_dialog(dialog.into());
        }
    }

    /// Resolves a path typed into `dialog`. A relative path of an export or a picture is in the
    /// folder of the last export or picture; any other is in the document's folder.
    pub fn full_path(&self, dialog: &PathDialog, typed: &Path) -> PathBuf {
        let in_folder = |folder: &Path| folder.join(typed);
        let full = match dialog {
            PathDialog::Export(_) | PathDialog::SavePicture { .. } => {
                // The folder of the last export may be gone, or was never there.
                let exported = self.files.export_folder().filter(|folder| folder.is_dir());
                exported.or(self.files.document_folder()).map(in_folder)
            }
            PathDialog::SaveAs { .. } => self.files.document_folder().map(in_folder),
            // A file that exists relative to the current folder takes precedence.
            PathDialog::Open { .. } | PathDialog::LocateSkin { .. } if !typed.exists() => {
                self.files.document_folder().map(in_folder)
            }
            PathDialog::Open { .. } | PathDialog::LocateSkin { .. } => None,
        };
        full.unwrap_or_else(|| typed.to_owned())
    }

    /// The folder in which a path typed into `dialog` lies, also before anything is typed.
    pub fn folder_of(&self, dialog: &PathDialog) -> PathBuf {
        let typed = dialog.path();
        let any = Path::new("untitled");
        let typed = if typed.as_os_str().is_empty() { any } else { typed };
        let full = self.full_path(dialog, typed);
        let full = std::path::absolute(&full).unwrap_or(full);
        full.parent().map(Path::to_owned).unwrap_or_default()
    }

    /// The folder of the last export or picture; `None` before the first.
    pub fn export_folder(&self) -> Option<&Path> {
        self.files.export_folder()
    }

    /// Sets the folder of the last export or picture, as saved by an earlier run of the program.
    pub fn set_export_folder(&mut self, folder: Option<PathBuf>) {
        self.files.set_export_folder(folder);
    }

    /// The user's preferences, such as theme, navigation and open panels.
    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// The message in the status bar; `None` before the first message and after an edit, which
    /// clears it.
    pub fn message(&self) -> Option<&str> {
        self.shell.message().map(Message::text)
    }

    /// Whether [`Session::message`] is an error.
    pub fn has_failed(&self) -> bool {
        self.shell.message().is_some_and(Message::is_error)
    }

    pub(super) fn say(&mut self, text: impl Into<String>) {
        self.shell.set_message(Message::new(text));
    }

    /// Shows an error in the status bar, with its first letter capitalized.
    pub(super) fn fail(&mut self, why: impl AsRef<str>) {
        self.shell.set_message(Message::error(why.as_ref()));
    }

    pub(super) fn apply_shell(&mut self, action: ShellAction) -> Option<Effect> {
        match action {
            ShellAction::OpenDialog(dialog) => self.open_dialog(dialog),
            ShellAction::CloseDialog => self.close_dialog(),
            ShellAction::Report(message) => self.say(message),
            ShellAction::Fail(why) => self.fail(why),
            ShellAction::ClearMessage => self.shell.clear_message(),
            ShellAction::CopyPose if self.rig() == RigKind::Skeleton => {
                self.say("Only the pose of the arm can be copied");
            }
            ShellAction::CopyPose => {
                self.say("Pose copied as a line for ik-arm solve");
                return Some(Effect::CopyText(pose_line::of(self.arm())));
            }
            ShellAction::SetTheme(theme) => self.preferences.theme = theme,
            ShellAction::SetNavigation(navigation) => self.preferences.navigation = navigation,
            ShellAction::SetFrameBudget(budget) => self.preferences.frame_budget = budget,
        }
        None
    }
}
