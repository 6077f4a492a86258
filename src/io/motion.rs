use thiserror::Error;

use super::Cancelled;
use crate::document::Timeline;

/// The content of an exported file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The bytes of the file.
    pub bytes: Vec<u8>,
    /// Descriptions of content of the document that the format cannot hold.
    pub notes: Vec<String>,
}

/// The reason why a motion cannot be exported.
#[derive(Debug, Error)]
pub enum MotionError {
    /// The export was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The frame rate, in frames per second, is not one that a timeline can have.
    #[error(
        "frames per second must be from {min} to {max}, got {0}",
        min = Timeline::MIN_FRAME_RATE, max = Timeline::MAX_FRAME_RATE
    )]
    FrameRate(f64),
    /// The skeleton has no joints.
    #[error("the skeleton must have at least one joint")]
    NoJoints,
    /// A position overflows in the file's unit.
    #[error("the position of {joint:?} must be within ±3.4028235e38")]
    TooFar {
        /// Name of the joint or point.
        joint: String,
    },
    /// The motion has more than [`MotionError::MOST_NUMBERS`] numbers.
    #[error(
        "a motion must have at most {max} numbers, got {frames} frames of {numbers}; export a \
         shorter time or fewer frames per second",
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
    /// Maximum count of numbers in a motion. As text they take about a gigabyte.
    pub const MOST_NUMBERS: usize = 100_000_000;

    /// Checks the size of a motion that has `frames` frames of `numbers` numbers each.
    ///
    /// # Errors
    ///
    /// Fails if the motion has more than [`MotionError::MOST_NUMBERS`] numbers.
    pub(super) fn check_size(frames: usize, numbers: usize) -> Result<(), Self> {
        if frames.saturating_mul(numbers) > Self::MOST_NUMBERS {
            return Err(Self::TooMuch { frames, numbers });
        }
        Ok(())
    }
}
