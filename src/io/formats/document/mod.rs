//! The program's own format: JSON, described in docs/files.md field by field.
//!
//! serde parses the text to [fields](file::DocumentFields), where `None` stands for a field that
//! the file leaves out. The fields are converted to a document: missing fields get defaults, and
//! [ranges are checked](check). Saving converts the document to fields, and serde writes the fields
//! as text.

mod arm;
mod check;
mod file;
mod follow_path;
mod keys;
mod mesh_skin;
mod skeleton;
mod skin;
mod targets;

use std::path::{Path, PathBuf};

use crate::document::{Document, RigKind, Skin};
use crate::io::error::{OpenError, SaveError};
use crate::io::json::to_styled_json;
use crate::io::json::{FieldWarnings, JsonObject};
use crate::io::opened::{OpenOptions, Opened};
use crate::io::source::Source;
use crate::io::write::write;
use crate::rig::{SkinFile, SkinSource};
use file::{DocumentFields, Header};
pub use keys::KeyFields;

/// The key by which a file is recognized.
pub const KEY: &str = "format";

/// Reads a document. The mesh of a skin that is in a file of its own is still to be read.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    if let Some(name) = &options.skeleton {
        let (file, name) = (source.name().to_owned(), name.clone());
        return Err(OpenError::NoSkeleton { file, name, names: Vec::new() });
    }
    // If the header is invalid, reading all fields fails, too, and its error names the exact field.
    if let Ok(JsonObject(header)) = source.parse::<JsonObject<Header>>(|_| {}) {
        header.check().map_err(|error| source.error(&error))?;
    }
    let mut warnings = FieldWarnings::default();
    let JsonObject(fields) = source.parse::<JsonObject<DocumentFields>>(|field| {
        warnings.push(field, "unknown field, ignored");
    })?;
    let has_camera = fields.has_camera();
    let mut document = fields.document(&mut warnings).map_err(|error| source.error(&error))?;
    if !has_camera && !options.without_camera && document.rig == RigKind::Skeleton {
        document.camera = document.framing_camera();
    }
    Ok(Opened {
        order: document.skeleton().ids().collect(),
        document,
        warnings: source.warnings(&warnings),
        skeletons: Vec::new(),
        animations: Vec::new(),
        animation: None,
    })
}

/// Converts a document to the text of a file. Reading this text returns the same document, bit for
/// bit.
///
/// # Errors
///
/// Fails if a number of the document is not finite.
pub fn to_json(document: &Document) -> Result<String, serde_json::Error> {
    to_styled_json(&DocumentFields::new(document))
}

/// Writes a document to a file, whole or not at all. The file of its skin's mesh is named by its
/// path from the folder of the document.
///
/// # Errors
///
/// Fails if the folder or the file cannot be written, the document is too large to be opened again,
/// or a number of it is not finite.
pub fn save(document: &Document, path: &Path) -> Result<(), SaveError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let document = with_relative_skin(document, folder);
    let text = to_json(&document)?;
    if text.len() as u64 > OpenError::MAX_BYTES {
        return Err(SaveError::TooLarge { got: text.len() as u64 >> 20 });
    }
    Ok(write(path, text.as_bytes())?)
}

/// The document with the path of its skin's file relative to `folder`, if both exist and that is
/// possible; otherwise absolute.
fn with_relative_skin(document: &Document, folder: &Path) -> Document {
    let mut document = document.clone();
    if let Some(Skin { source: SkinSource::Mesh(skin), .. }) = &mut document.skeleton_rig.skin {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        // Without links and `..`, whose folders would be others from the document's own folder.
        let relative = |file: &SkinFile| -> Option<PathBuf> {
            pathdiff::diff_paths(file.path.canonicalize().ok()?, folder.canonicalize().ok()?)
        };
        let relative = |file: &SkinFile| relative(file).unwrap_or_else(|| file.path.clone());
        *skin = skin.with_path(relative);
    }
    document
}
