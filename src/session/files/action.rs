use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::document::Document;
use crate::io::{Example, FileAnimation, OpenOptions, Opened, Progress};
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
        /// Further contents of the file; `None` for a document of this program.
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
    /// Copies a link that carries the document to the clipboard.
    CopyLink,
    /// Opens a new document with the arm.
    New,
    /// Opens a new document with a figure: two legs and two arms, each with a target.
    NewFigure,
    /// Opens a new document with one root joint.
    NewEmpty,
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

    /// True if the action saves the document.
    pub(in crate::session) fn saves_document(&self) -> bool {
        let asks = |dialog: &PathDialog| matches!(dialog, PathDialog::SaveAs { .. });
        match self {
            Self::Save | Self::SaveAs(_) | Self::SaveAnd(_) => true,
            Self::AskPath(dialog) => asks(dialog),
            _ => false,
        }
    }

    /// True if the action changes, replaces or closes the open document.
    pub(in crate::session) fn concerns_document(&self) -> bool {
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

    /// True if the action replaces or closes the open document.
    pub(in crate::session) fn leaves_document(&self) -> bool {
        matches!(
            self,
            Self::Opened { .. }
                | Self::OpenExample(_)
                | Self::New
                | Self::NewFigure
                | Self::NewEmpty
                | Self::Recover { .. }
                | Self::Quit
        )
    }
}

/// The skeletons and animations of a file, of which one each is open.
#[derive(Clone, Debug, PartialEq)]
pub struct FileContents {
    /// The file.
    pub path: PathBuf,
    /// The choices with which the file was opened.
    pub options: OpenOptions,
    /// Names of the skeletons.
    pub skeletons: Vec<String>,
    /// The animations.
    pub animations: Vec<FileAnimation>,
    /// Index of the open animation; `None` without animations.
    pub animation: Option<usize>,
}

impl FileContents {
    /// The contents of a file that was opened with `options`.
    pub fn new(path: PathBuf, options: OpenOptions, opened: &Opened) -> Self {
        Self {
            path,
            options,
            skeletons: opened.skeletons.clone(),
            animations: opened.animations.clone(),
            animation: opened.animation,
        }
    }

    /// True if the user is asked what to open: there is a choice, and none was made.
    pub fn asks(&self) -> bool {
        self.options == OpenOptions::default() && self.has_choice()
    }

    /// True if the file has several skeletons or animations to choose from.
    pub fn has_choice(&self) -> bool {
        self.skeletons.len() > 1 || self.animations.len() > 1
    }
}

/// Settings of an export; the file extension chooses the format.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    /// The file to write.
    pub path: PathBuf,
    /// Frames per second.
    pub frame_rate: f64,
    /// Width and height of pictures, in pixels.
    pub size: (u32, u32),
}

/// An export that runs on a thread of its own.
#[derive(Clone, Debug)]
pub struct ExportJob {
    /// The file to write.
    pub path: PathBuf,
    /// Progress of the export, and the flag that cancels the export.
    pub progress: Arc<Progress>,
}

/// Equal for clones of the same job, whatever its progress.
impl PartialEq for ExportJob {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.progress, &other.progress)
    }
}

/// A dialog that asks for a path: one of the program's own, which the system's file dialog may
/// replace.
#[derive(Clone, Debug, PartialEq)]
pub enum PathDialog {
    /// Asks where to save a picture.
    SavePicture {
        /// The path as typed so far.
        path: String,
    },
    /// Asks for the path, format and settings of an export.
    Export(Export),
    /// Asks for a file to open.
    Open {
        /// The path as typed so far.
        path: String,
        /// Error of the previous attempt; `None` before the first attempt.
        problem: Option<String>,
    },
    /// Asks where to save the document.
    SaveAs {
        /// The path as typed so far.
        path: String,
        /// Error of the previous attempt; `None` before the first attempt.
        problem: Option<String>,
    },
    /// Asks for the file of the skin's mesh.
    LocateSkin {
        /// The path as typed so far.
        path: String,
        /// Error of the previous attempt; `None` before the first attempt.
        problem: Option<String>,
    },
}

impl PathDialog {
    /// The dialog that asks for a file to open.
    pub fn open() -> Self {
        Self::Open { path: String::new(), problem: None }
    }

    /// True if the dialog asks for a file to read; false for one to write.
    pub fn reads_file(&self) -> bool {
        matches!(self, Self::Open { .. } | Self::LocateSkin { .. })
    }

    /// The path as typed so far.
    pub fn path(&self) -> &Path {
        match self {
            Self::SavePicture { path }
            | Self::Open { path, .. }
            | Self::SaveAs { path, .. }
            | Self::LocateSkin { path, .. } => Path::new(path),
            Self::Export(export) => &export.path,
        }
    }
}
