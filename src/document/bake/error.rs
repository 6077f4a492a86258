use core::ops::RangeInclusive;

use thiserror::Error;

use crate::document::Timeline;

/// The reason why a document is not baked.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The document shows the arm.
    #[error("only a skeleton can be baked, and the document shows the arm")]
    Arm,
    /// No target and no path poses the skeleton in the range.
    #[error("nothing to bake: no target and no path poses the skeleton in this range")]
    Nothing,
    /// The range or its frame rate is not [valid](Timeline::is_valid).
    #[error(
        "a bake must start before it ends, within {max} s of time 0, at {least} to {rate} frames per \
         second, got {start} s to {end} s at {frame_rate}",
        max = Timeline::MAX_TIME, least = Timeline::MIN_FRAME_RATE,
        rate = Timeline::MAX_FRAME_RATE,
        start = .0.start, end = .0.end, frame_rate = .0.frame_rate
    )]
    Range(Timeline),
    /// The tolerance is not in [`BakeError::TOLERANCES`].
    #[error(
        "the tolerance must be from {least} to {most} of the reach, got {0}",
        least = Self::TOLERANCES.start(), most = Self::TOLERANCES.end()
    )]
    Tolerance(f32),
    /// The range has more than [`BakeError::MOST_POSES`] frames times joints.
    #[error(
        "frames times joints must be at most {max}, got {frames} frames of {joints} joints; bake a \
         shorter time or fewer frames per second",
        max = Self::MOST_POSES
    )]
    TooMuch {
        /// Number of frames.
        frames: usize,
        /// Number of joints.
        joints: usize,
    },
    /// The bake was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl BakeError {
    /// The tolerances that a bake can keep, as fractions of the reach. Smaller ones are near
    /// rounding.
    pub const TOLERANCES: RangeInclusive<f32> = 1e-5..=1.0;
    /// Maximum number of frames times joints. A bake of so many takes about half a gigabyte of
    /// memory.
    pub const MOST_POSES: usize = 2_000_000;
}
