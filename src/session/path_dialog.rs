use std::path::Path;

use super::export::Export;

/// A dialog that asks for a path: one of the program's own, or the system's in its place.
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
        /// The error of the last attempt.
        problem: Option<String>,
    },
    /// Asks where to save the document.
    SaveAs {
        /// The path as typed so far.
        path: String,
        /// The error of the last attempt.
        problem: Option<String>,
    },
}

impl PathDialog {
    /// Asks for a file to open.
    pub fn open() -> Self {
        Self::Open { path: String::new(), problem: None }
    }

    /// Asks where to save a new document.
    pub fn save_as() -> Self {
        Self::SaveAs { path: "ik-arm.json".to_owned(), problem: None }
    }

    /// Asks where to save a picture.
    pub fn save_picture() -> Self {
        Self::SavePicture { path: "ik-arm.png".to_owned() }
    }

    /// The path as typed so far.
    pub fn path(&self) -> &Path {
        match self {
            Self::SavePicture { path } | Self::Open { path, .. } | Self::SaveAs { path, .. } => {
                Path::new(path)
            }
            Self::Export(export) => &export.path,
        }
    }
}
