use thiserror::Error;

use super::Cancelled;
use crate::document::Timeline;

/// A file made of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    pub bytes: Vec<u8>,
    /// What the document has and the file cannot say.
    pub notes: Vec<String>,
}

/// Why a motion cannot be a file.
#[derive(Debug, Error)]
pub enum MotionError {
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("{0} frames in a second are not possible; they are 1 to {max}", max = Timeline::HIGHEST_FRAME_RATE)]
    FrameRate(u32),
    #[error("the skeleton has no joint; the file needs at least one")]
    NoJoints,
    #[error("{joint:?} is beyond 3.4028235e38; bring it nearer to 0")]
    TooFar { joint: String },
    #[error(
        "{frames} frames of {numbers} numbers each are more than {max} numbers; export a shorter \
         time or fewer frames in a second",
        max = MotionError::MOST_NUMBERS
    )]
    TooMuch { frames: usize, numbers: usize },
    #[error("the table could not be written: {0}")]
    Table(#[from] csv::Error),
}

impl MotionError {
    /// How many numbers a motion can have: about a gigabyte of text.
    pub const MOST_NUMBERS: usize = 100_000_000;

    /// # Errors
    ///
    /// Refuses more than [`MotionError::MOST_NUMBERS`].
    pub(super) fn if_too_much(frames: usize, numbers: usize) -> Result<(), Self> {
        if frames.saturating_mul(numbers) > Self::MOST_NUMBERS {
            return Err(Self::TooMuch { frames, numbers });
        }
        Ok(())
    }
}
