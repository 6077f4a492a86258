use thiserror::Error;

use super::format::FormatError;
use crate::io::{Cancelled, ContentError, MotionError, WriteError};
use crate::render::{DrawError, GpuError};

/// Reasons why no file is exported.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The export was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The path selects no format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The format cannot hold the document.
    #[error(transparent)]
    Content(ContentError),
    /// The time of a single picture is not finite.
    #[error("time must be a finite number of seconds, got {0}")]
    Time(f64),
    /// There is no graphics device for pictures.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A picture could not be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// A picture could not be encoded.
    #[error("cannot encode PNG: {0}")]
    Png(#[from] png::EncodingError),
    /// An animated picture has too many frames.
    #[error("an animated PNG must have at most {max} frames, got {0}", max = u32::MAX)]
    Frames(usize),
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl ExportError {
    /// Returns whether the error is about the file to write, or about no file, rather than about
    /// the document.
    pub fn is_about_output(&self) -> bool {
        match self {
            Self::Cancelled(_) | Self::Format(_) | Self::Gpu(_) | Self::Write(_) => true,
            Self::Content(_) | Self::Time(_) | Self::Draw(_) | Self::Png(_) | Self::Frames(_) => {
                false
            }
        }
    }
}

/// Turns a nested `Cancelled` into [`ExportError::Cancelled`].
impl From<ContentError> for ExportError {
    fn from(error: ContentError) -> Self {
        match error {
            ContentError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Content(error),
        }
    }
}

impl From<MotionError> for ExportError {
    fn from(error: MotionError) -> Self {
        ContentError::from(error).into()
    }
}
