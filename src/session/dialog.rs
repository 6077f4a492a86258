use std::path::{Path, PathBuf};

use super::{Export, FileAction, Session};
use crate::document::Document;
use crate::kinematics::skeleton::JointId;

/// A window over the others. All but the statistics take the keyboard and the mouse.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialog {
    About,
    Shortcuts,
    /// Frame times, beside the work.
    Statistics,
    /// Offers the document that an earlier run of the program left unsaved.
    Recover {
        document: Box<Document>,
        file: Option<PathBuf>,
    },
    /// Asks before an action that would lose unsaved changes.
    Unsaved {
        then: Box<FileAction>,
    },
    /// Asks before quitting while an export runs.
    Exporting,
    /// Asks before a file is overwritten; `back` is the dialog that the path comes from.
    Replace {
        path: PathBuf,
        then: Box<FileAction>,
        back: Box<Dialog>,
    },
    /// Asks for a path, which is shown as it is typed.
    SavePicture {
        path: String,
    },
    /// Asks what to export, and how.
    Export(Export),
    /// Asks for a path; `problem` says why the last one could not be opened.
    Open {
        path: String,
        problem: Option<String>,
    },
    /// Asks for a path; `problem` says why the last one could not be written.
    SaveAs {
        path: String,
        problem: Option<String>,
    },
    /// Asks which of a file's skeletons to open.
    ChooseSkeleton {
        path: PathBuf,
        names: Vec<String>,
    },
    /// Asks for a joint's name, which is shown as it is typed.
    Rename {
        joint: JointId,
        name: String,
    },
    /// Asks whether the children of deleted joints stay.
    DeleteJoints {
        joints: Vec<JointId>,
    },
}

impl Dialog {
    pub fn open() -> Self {
        Self::Open { path: String::new(), problem: None }
    }

    pub fn save_as() -> Self {
        Self::SaveAs { path: "ik-arm.json".to_owned(), problem: None }
    }

    pub fn save_picture() -> Self {
        Self::SavePicture { path: "ik-arm.png".to_owned() }
    }

    /// The path that it asks for, as typed so far.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::SavePicture { path } | Self::Open { path, .. } | Self::SaveAs { path, .. } => {
                Some(Path::new(path))
            }
            Self::Export(export) => Some(&export.path),
            _ => None,
        }
    }

    /// Whether nothing behind it answers.
    pub fn is_modal(&self) -> bool {
        *self != Self::Statistics
    }
}

impl Session {
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// Whether a dialog, ours or the system's, has the keyboard: nothing behind it answers.
    pub fn is_asking(&self) -> bool {
        self.choosing || self.dialog.as_ref().is_some_and(Dialog::is_modal)
    }

    /// Whether the system's file dialog has been asked for and has not answered.
    pub fn is_choosing(&self) -> bool {
        self.choosing
    }

    pub(super) fn open_dialog(&mut self, dialog: Dialog) {
        // What waits for the document to be saved waits for no other question.
        let is_saving = match &dialog {
            Dialog::SaveAs { .. } => true,
            Dialog::Replace { back, .. } => matches!(**back, Dialog::SaveAs { .. }),
            _ => false,
        };
        if !is_saving {
            self.then = None;
        }
        self.choosing = false;
        self.dialog = Some(dialog);
    }

    pub(super) fn close_dialog(&mut self) {
        self.choosing = false;
        match self.dialog.take() {
            Some(Dialog::Replace { back, .. }) => self.dialog = Some(*back),
            _ => self.then = None,
        }
    }

    /// The system has no file dialog: ours asks, or says so where it is open already.
    pub(super) fn ask_ourselves(&mut self, dialog: Dialog) {
        if self.dialog.is_some() {
            self.choosing = false;
            self.fail("this system has no file dialog: type the path");
        } else {
            self.open_dialog(dialog);
        }
    }

    /// The path that is typed into a dialog; a relative one is in the folder that was used last.
    pub fn full_path(&self, dialog: &Dialog, typed: &Path) -> PathBuf {
        let in_folder = |folder: &Path| folder.join(typed);
        let full = match dialog {
            Dialog::Export(_) | Dialog::SavePicture { .. } => {
                self.export_folder.as_deref().or(self.document_folder()).map(in_folder)
            }
            Dialog::SaveAs { .. } => self.document_folder().map(in_folder),
            // A path of the command line's folder is meant where there is such a file.
            Dialog::Open { .. } if !typed.exists() => self.document_folder().map(in_folder),
            _ => None,
        };
        full.unwrap_or_else(|| typed.to_owned())
    }

    /// Where the document is, or the last one that was opened or saved.
    fn document_folder(&self) -> Option<&Path> {
        let last = self.file.as_ref().or(self.recent.first())?;
        last.parent().filter(|folder| folder.is_absolute())
    }

    /// The folder of the last export or picture.
    pub fn export_folder(&self) -> Option<&Path> {
        self.export_folder.as_deref()
    }

    /// Remembers the folder of an earlier session.
    pub fn set_export_folder(&mut self, folder: Option<PathBuf>) {
        self.export_folder = folder;
    }

    pub(super) fn remember_export_folder(&mut self, path: &Path) {
        let full = std::path::absolute(path).ok();
        if let Some(folder) = full.as_deref().and_then(Path::parent) {
            self.export_folder = Some(folder.to_owned());
        }
    }
}
