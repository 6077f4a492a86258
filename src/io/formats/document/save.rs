use std::path::Path;

use super::file::DocumentFields;
use crate::document::Document;
use crate::io::error::{OpenError, SaveError};
use crate::io::json_style::to_styled_json;
use crate::io::skin_file::with_relative_skin;
use crate::io::write::write;

/// Converts a document to the text of a file. Reading this text returns the same document, bit for
/// bit.
///
/// # Errors
///
/// Fails if a number of the document is not finite.
pub fn to_json(document: &Document) -> Result<String, serde_json::Error> {
    to_styled_json(&DocumentFields::new(document))
}

/// Writes a document to a file, whole or not at all. The file of its skin's mesh is named by its path from
/// the folder of the document.
///
/// # Errors
///
/// Fails if the folder or the file cannot be written, the document is too large to be opened again, or a
/// number of it is not finite.
pub fn save(document: &Document, path: &Path) -> Result<(), SaveError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let document = with_relative_skin(document, folder);
    let text = to_json(&document)?;
    if text.len() as u64 > OpenError::MAX_BYTES {
        return Err(SaveError::TooLarge { got: text.len() as u64 >> 20 });
    }
    Ok(write(path, text.as_bytes())?)
}
