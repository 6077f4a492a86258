use thiserror::Error;

use super::Format;
use crate::io::{Cancelled, GlbError, MotionError, WriteError};
use crate::render::{DrawError, GpuError};

/// Why there is no file.
#[derive(Debug, Error)]
pub enum ExportError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("{path}: its ending names no format that is known; they are {}", Format::endings())]
    Ending { path: String },
    #[error(transparent)]
    Glb(GlbError),
    #[error(transparent)]
    Motion(MotionError),
    #[error("the time of a picture is {0}; it must be a finite number of seconds")]
    Time(f64),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Draw(#[from] DrawError),
    #[error("the picture could not be made a PNG: {0}")]
    Png(#[from] png::EncodingError),
    #[error("{0} frames are more than an animated picture holds")]
    Frames(usize),
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// That it was to stop is said in one way only.
impl From<GlbError> for ExportError {
    fn from(error: GlbError) -> Self {
        match error {
            GlbError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Glb(error),
        }
    }
}

/// Likewise.
impl From<MotionError> for ExportError {
    fn from(error: MotionError) -> Self {
        match error {
            MotionError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Motion(error),
        }
    }
}
