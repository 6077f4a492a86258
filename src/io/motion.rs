use thiserror::Error;

use super::Cancelled;
use crate::document::Timeline;

/// The content of an exported file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The bytes of the file.
    pub bytes: Vec<u8>,
    /// Losses: content of the document that the format cannot hold.
    pub notes: Vec<String>,
}

/// The reason why a motion cannot be exported.
#[derive(Debug, Error)]
pub enum MotionError {
    /// The export was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The frame rate, in frames per second, is 0 or above [`Timeline::MAX_FRAME_RATE`].
    #[error("frames a second must be from 1 to {max}, got {0}", max = Timeline::MAX_FRAME_RATE)]
    FrameRate(u32),
    /// The skeleton has no joints.
    #[error("the skeleton has no joint; the file needs at least one")]
    NoJoints,
    /// A position overflows in the file's unit.
    #[error("{joint:?} is beyond 3.4028235e38; bring it nearer to 0")]
    TooFar {
        /// Name of the joint or point.
        joint: String,
    },
    /// The motion has more than [`MotionError::MOST_NUMBERS`] numbers.
    #[error(
        "{frames} frames of {numbers} numbers each are more than {max} numbers; export a shorter \
         time or fewer frames in a second",
        max = MotionError::MOST_NUMBERS
    )]
    TooMuch {
        /// Number of frames.
        frames: usize,
        /// Numbers per frame.
        numbers: usize,
    },
    /// The CSV table cannot be written.
    #[error("the table could not be written: {0}")]
    Table(#[from] csv::Error),
}

impl MotionError {
    /// The most numbers that a motion can have: about a gigabyte of text.
    pub const MOST_NUMBERS: usize = 100_000_000;

    /// # Errors
    ///
    /// Fails with more than [`MotionError::MOST_NUMBERS`].
    pub(super) fn if_too_much(frames: usize, numbers: usize) -> Result<(), Self> {
        if frames.saturating_mul(numbers) > Self::MOST_NUMBERS {
            return Err(Self::TooMuch { frames, numbers });
        }
        Ok(())
    }
}
