use std::path::Path;

use super::export::Export;

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
