use std::path::PathBuf;

use super::export::{Export, ExportJob};
use super::path_dialog::PathDialog;
use crate::document::Document;
use crate::io::Example;

/// Opens, saves, exports and quits.
#[derive(Clone, Debug, PartialEq)]
pub enum FileAction {
    /// Asks for a path in the system's dialog, or in this one where the system has none.
    AskPath(PathDialog),
    /// Opens the system's dialog for the path that the open dialog asks for.
    ChoosePath,
    /// The system's dialog was closed without a path.
    ChoseNothing,
    /// The system has no dialog; this one is opened instead.
    NoSystemDialog(PathDialog),
    /// Opens a file.
    Open {
        /// The file.
        path: PathBuf,
        /// The name of the skeleton, for files with several.
        skeleton: Option<String>,
    },
    /// Replaces the document and clears the history.
    Opened {
        /// The new document.
        document: Box<Document>,
        /// The file it was read from.
        file: Option<PathBuf>,
    },
    /// Reports why a file cannot be opened.
    NotOpened {
        /// The file.
        path: PathBuf,
        /// The error.
        why: String,
    },
    /// Saves to the document's file; asks for a path if it has none.
    Save,
    /// Saves to another file.
    SaveAs(PathBuf),
    /// The document was saved.
    Saved(PathBuf),
    /// Reports why the document was not saved.
    NotSaved {
        /// The file.
        path: PathBuf,
        /// The error.
        why: String,
    },
    /// Saves, then applies the action that would have lost changes.
    SaveAnd(Box<FileAction>),
    /// Applies an action that loses changes.
    Discard(Box<FileAction>),
    /// Opens the document that an earlier run of the program left unsaved.
    Recover {
        /// The unsaved document.
        document: Box<Document>,
        /// The file it was read from.
        file: Option<PathBuf>,
    },
    /// Discards the document that an earlier run left unsaved.
    DeclineRecovery,
    /// Opens an example.
    OpenExample(Example),
    /// Opens a skeleton of one root joint.
    NewSkeleton,
    /// Saves a picture to a path.
    SavePicture(String),
    /// Starts an export.
    Export(Export),
    /// An export has started.
    ExportStarted(ExportJob),
    /// Cancels the export.
    CancelExport,
    /// An export has ended, with a message or an error.
    ExportEnded(Result<String, String>),
    /// Cancels the export and quits.
    StopExportAndQuit,
    /// Quits.
    Quit,
}

impl FileAction {
    /// Whether the open document is replaced or closed.
    pub(super) fn leaves_document(&self) -> bool {
        matches!(
            self,
            Self::Open { .. }
                | Self::OpenExample(_)
                | Self::NewSkeleton
                | Self::Recover { .. }
                | Self::Quit
        )
    }
}
