//! Files for other programs, made of a document: motions, tables, pictures.
//!
//! An export may take long: [`export`] runs where nobody waits for it, with a document and a device
//! of its own, says how far it is, and stops when it is told to. A file is there whole or not at
//! all, and so is a sequence of files.

mod error;
mod film;
mod format;

use std::path::Path;

pub use error::ExportError;
pub use format::{Format, existing};

use crate::document::{Document, Theme};
use crate::io::{self, BvhUnit, Exported, Progress};

/// What there is to choose; each counts for the formats that have it.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// How many frames there are in a second; the timeline's own if nothing is said.
    pub fps: Option<u32>,
    /// Pixels across and down of a picture.
    pub size: (u32, u32),
    /// Of a picture.
    pub theme: Theme,
    /// When a single picture is taken, in seconds; at the timeline's start if nothing is said.
    pub time: Option<f64>,
    /// What BVH is measured in.
    pub unit: BvhUnit,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            fps: None,
            size: (1280, 800),
            theme: Theme::Dark,
            time: None,
            unit: BvhUnit::default(),
        }
    }
}

/// Writes a document to a file of the [`Format`] that its name asks for, and returns what the
/// document has and the file cannot say.
///
/// # Errors
///
/// If it is to stop, the format is not known, the document has what the format cannot hold at all,
/// or the file cannot be written. There is no file then, or the one from before.
pub fn export(
    document: &Document,
    path: &Path,
    options: &Options,
    progress: &Progress,
) -> Result<Vec<String>, ExportError> {
    let format = Format::of(path)?;
    progress.step(0, 1)?;
    let Exported { bytes, notes } = match format {
        Format::Glb => {
            Exported { bytes: io::glb(document, options.fps, progress)?, notes: Vec::new() }
        }
        Format::Bvh => io::to_bvh(document, options.fps, options.unit, progress)?,
        Format::Csv => io::to_csv(document, options.fps, progress)?,
        Format::Png => film::still(document, options, progress)?,
        Format::PngSequence => return film::sequence(document, path, options, progress),
        Format::Apng => return film::animation(document, path, options, progress),
    };
    io::write(path, &bytes)?;
    Ok(notes)
}
