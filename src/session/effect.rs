use std::path::PathBuf;

use super::export::Export;
use super::path_dialog::PathDialog;

/// A request of the session to the program around it.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Copies a text to the clipboard.
    CopyText(String),
    /// Draws the session into a file.
    SavePicture(String),
    /// Starts an export.
    Export(Export),
    /// Opens the system's dialog.
    ChoosePath(PathDialog),
    /// Reads a file.
    Open {
        /// The file.
        path: PathBuf,
        /// The name of the skeleton, for files with several.
        skeleton: Option<String>,
    },
    /// Writes the document.
    Save(PathBuf),
    /// Ends the program.
    Quit,
}
