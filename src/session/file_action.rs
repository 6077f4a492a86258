use std::path::PathBuf;

use super::export::{Export, ExportJob};
use super::file_contents::FileContents;
use super::path_dialog::PathDialog;
use crate::document::Document;
use crate::io::{Example, OpenOptions, Opened};
use crate::rig::{MeshSkin, SkinFile, SkinFileError};

/// Opens, saves, exports and quits.
#[derive(Clone, Debug, PartialEq)]
pub enum FileAction {
    /// Asks for a path in the system's file dialog, or in the given dialog of the program if the
    /// system has none.
    AskPath(PathDialog),
    /// Opens the system's file dialog in place of the program's open dialog for a path.
    ChoosePath,
    /// The system's file dialog was closed without a path.
    ChoseNothing,
    /// Opens the given dialog of the program, because the system has no file dialog.
    NoSystemDialog(PathDialog),
    /// Opens a file.
    Open {
        /// The file.
        path: PathBuf,
        /// Choice of one of several skeletons and animations.
        options: OpenOptions,
    },
    /// Replaces the document and clears the history.
    Opened {
        /// The new document.
        document: Box<Document>,
        /// The file that Save overwrites; `None` if Save must ask for a path.
        file: Option<PathBuf>,
        /// What else the file has; `None` for a document of this program.
        contents: Option<Box<FileContents>>,
    },
    /// Reports why a file cannot be opened.
    NotOpened {
        /// The file.
        path: PathBuf,
        /// The error.
        why: String,
    },
    /// Reads the mesh of the skin from a file.
    LocateSkin(PathBuf),
    /// Replaces the mesh of the skin by that of a file, or reports why the file cannot be read.
    SkinLocated {
        /// The file.
        path: PathBuf,
        /// The file that the skin had when this one was chosen.
        before: Option<SkinFile>,
        /// The skin with the mesh of the file.
        read: Box<Result<MeshSkin, SkinFileError>>,
    },
    /// Saves to the document's file; asks for a path if it has none.
    Save,
    /// Saves to another file.
    SaveAs(PathBuf),
    /// The document was saved to this file.
    Saved(PathBuf),
    /// Reports why the document was not saved.
    NotSaved {
        /// The file.
        path: PathBuf,
        /// The error.
        why: String,
    },
    /// Saves the document, then applies the action that would otherwise have lost changes.
    SaveAnd(Box<FileAction>),
    /// Applies an action even though it loses unsaved changes.
    Discard(Box<FileAction>),
    /// Opens the document that an earlier run of the program left unsaved.
    Recover {
        /// The unsaved document.
        document: Box<Document>,
        /// The file that Save overwrites; `None` if Save must ask for a path.
        file: Option<PathBuf>,
    },
    /// Discards the document that an earlier run left unsaved.
    DeclineRecovery,
    /// Leaves the skeleton as it is in its file, although z seems to point up there.
    DeclineTurn,
    /// Opens an example.
    OpenExample(Example),
    /// Opens a new document, which shows the arm.
    New,
    /// Opens a new document with a skeleton of one root joint.
    NewSkeleton,
    /// Saves a picture of the viewport to a path.
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
    /// Shows the document of the file at `path`, which was read with `options`.
    pub fn opened(path: PathBuf, options: OpenOptions, opened: Opened) -> Self {
        let is_own = opened.skeletons.is_empty();
        let of_file = || Box::new(FileContents::new(path.clone(), options, &opened));
        let contents = (!is_own).then(of_file);
        // Save must not overwrite a file of another program.
        let file = is_own.then_some(path);
        Self::Opened { document: Box::new(opened.document), file, contents }
    }

    /// Whether the action saves the document.
    pub(super) fn saves_document(&self) -> bool {
        let asks = |dialog: &PathDialog| matches!(dialog, PathDialog::SaveAs { .. });
        match self {
            Self::Save | Self::SaveAs(_) | Self::SaveAnd(_) => true,
            Self::AskPath(dialog) => asks(dialog),
            _ => false,
        }
    }

    /// Whether the action changes, replaces or closes the open document.
    pub(super) fn concerns_document(&self) -> bool {
        let reads = matches!(
            self,
            Self::NotOpened { .. }
                | Self::Saved(_)
                | Self::NotSaved { .. }
                | Self::Discard(_)
                | Self::LocateSkin(_)
                | Self::SkinLocated { .. }
        );
        reads || self.leaves_document()
    }

    /// Whether the action replaces or closes the open document.
    pub(super) fn leaves_document(&self) -> bool {
        matches!(
            self,
            Self::Opened { .. }
                | Self::OpenExample(_)
                | Self::New
                | Self::NewSkeleton
                | Self::Recover { .. }
                | Self::Quit
        )
    }
}
