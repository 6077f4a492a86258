//! Files for other programs, made from a document: motions, tables, meshes, pictures.
//!
//! An export may take long. [`export`] is meant for a thread of its own: it works on its own
//! document and graphics device, reports its progress, and can be cancelled. A file or sequence of
//! files is written completely or not at all.

mod error;
mod format;
mod frame_writers;
mod numbered_name;
mod options;
mod pictures;

use std::path::Path;

pub use error::ExportError;
pub use format::{Format, FormatError, existing};
pub use options::ExportOptions;

use numbered_name::NumberedName;

use crate::document::Document;
use crate::io::{self, Exported, Progress};

/// Writes a document to a file whose extension selects the [`Format`], and returns notes on what
/// the format cannot hold.
///
/// # Errors
///
/// Fails if the export is cancelled, the format is unknown or cannot hold the document, or the file
/// cannot be written. At `path` there is then no file, or the file that was there before.
pub fn export(
    document: &Document,
    path: &Path,
    options: &ExportOptions,
    progress: &Progress,
) -> Result<Vec<String>, ExportError> {
    let format = Format::of(path)?;
    progress.step(0, 1)?;
    if let (Format::PngSequence, Some(name)) = (format, NumberedName::new(path)) {
        return pictures::sequence(document, path, &name, options, progress);
    }
    let Exported { bytes, notes } = match format {
        Format::Glb => {
            Exported { bytes: io::glb(document, options.fps, progress)?, notes: Vec::new() }
        }
        Format::Bvh => io::to_bvh(document, options.fps, options.unit, progress)?,
        Format::Csv => io::to_csv(document, options.fps, progress)?,
        Format::Obj => {
            let time = options.time.unwrap_or(document.timeline.start);
            io::to_obj(document, time, options.skinning)?
        }
        Format::Png | Format::PngSequence => pictures::still(document, options, progress)?,
        Format::Apng => return pictures::animation(document, path, options, progress),
    };
    io::write(path, &bytes)?;
    Ok(notes)
}
