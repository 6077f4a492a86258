use core::ops::RangeInclusive;

use thiserror::Error;

use crate::document::{Document, Timeline};
use crate::kinematics::skeleton::JointId;

/// A baked document, and what the bake cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// The document with the keys. Its targets have no influence in the range, and its skeleton
    /// follows no path.
    pub document: Document,
    /// Number of keys at every frame, before keys were removed.
    pub keys_at_frames: usize,
    /// Number of keys that are left.
    pub keys: usize,
    /// Largest distance of a base or tip from its evaluated position at a frame, in the world. Tips
    /// of shortened bones are compared at their own length.
    pub error: f32,
    /// Bones that targets stretch. They keep their own length in the baked document.
    pub shortened: Vec<ShortenedBone>,
}

/// A bone that cannot keep the length that a target gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShortenedBone {
    /// The bone's joint.
    pub joint: JointId,
    /// Largest distance of its tip from the evaluated position at a frame, in the world.
    pub error: f32,
}

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
