use std::path::Path;

use super::file::DocumentFields;
use crate::document::Document;
use crate::io::error::SaveError;
use crate::io::json_style::to_styled_json;
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

/// Writes a document to a file, whole or not at all.
///
/// # Errors
///
/// Fails if the folder or the file cannot be written, or a number of the document is not finite.
pub fn save(document: &Document, path: &Path) -> Result<(), SaveError> {
    Ok(write(path, to_json(document)?.as_bytes())?)
}
