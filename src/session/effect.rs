use std::path::PathBuf;

use super::export::Export;
use super::path_dialog::PathDialog;
use crate::document::Bake;
use crate::io::OpenOptions;

/// A request from the session to the program around it.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Copies a text to the clipboard.
    CopyText(String),
    /// Draws the viewport and saves the picture to a path.
    SavePicture(String),
    /// Starts a bake of the document.
    Bake(Bake),
    /// Starts an export.
    Export(Export),
    /// Opens the system's file dialog in place of one of the program's.
    ChoosePath(PathDialog),
    /// Reads a file.
    Open {
        /// The file.
        path: PathBuf,
        /// Choice of one of several skeletons and animations.
        options: OpenOptions,
    },
    /// Reads the mesh of the document's skin from a file.
    LocateSkin(PathBuf),
    /// Saves the document to a file.
    Save(PathBuf),
    /// Ends the program.
    Quit,
}
