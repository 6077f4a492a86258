//! Files for other programs, made from a document: motions, tables, meshes, pictures.
//!
//! An export may take long. [`export`] works on its own document and graphics device, reports its
//! progress, gives way between steps, and can be cancelled. A file or sequence of files is written
//! completely or not at all.

mod format;
mod pictures;

use std::path::Path;

pub use crate::io::ExportOptions;
pub use format::{ExportError, ExportFormat, FormatError, existing};

use crate::document::Document;
use crate::io::{self, Exported, Progress};
use format::{ExportContent, NumberedName};

/// Writes a document to a file whose extension selects the [`ExportFormat`], and returns notes on
/// what the format cannot hold.
///
/// # Errors
///
/// Fails if the export is cancelled, the format is unknown or cannot hold the document, or the file
/// cannot be written. At `path` there is then no file, or the file that was there before.
pub async fn export(
    document: &Document,
    path: &Path,
    options: &ExportOptions,
    progress: &Progress,
) -> Result<Vec<String>, ExportError> {
    let ExportFormat { content, .. } = ExportFormat::of(path)?;
    progress.step(0, 1).await?;
    let Exported { bytes, notes } = match (content, NumberedName::new(path)) {
        (ExportContent::PictureSequence, Some(name)) => {
            return pictures::sequence(document, path, &name, options, progress).await;
        }
        (ExportContent::AnimatedPicture, _) => {
            return pictures::animation(document, path, options, progress).await;
        }
        (ExportContent::Picture | ExportContent::PictureSequence, _) => {
            pictures::still(document, options, progress).await?
        }
        (ExportContent::Written(write), _) => write(document, options, progress).await?,
    };
    io::write(path, &bytes)?;
    Ok(notes)
}
