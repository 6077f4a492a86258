use std::path::{Path, PathBuf};

use super::export::Export;
use super::file_action::FileAction;
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
