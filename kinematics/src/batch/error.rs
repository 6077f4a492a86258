use core::fmt;

use thiserror::Error;

use crate::two_bone::LengthError;

/// Invalid arrays of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BatchError {
    /// The length of an array differs from that of the cursors' x.
    #[error("{array} has {len} numbers; the cursors' x has {arms}, and there must be as many")]
    Len {
        /// The array.
        array: BatchArray,
        /// Length of the array.
        len: usize,
        /// Number of arms, the length of the cursors' x.
        arms: usize,
    },
    /// An arm has an invalid bone length.
    #[error("arm {arm}: {source}")]
    Bone {
        /// Index of the arm.
        arm: usize,
        /// The bone and its invalid length.
        source: LengthError,
    },
}

/// An array of a batch, or a group of arrays of one quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BatchArray {
    /// The cursors' y.
    CursorY,
    /// The cursors' z.
    CursorZ,
    /// The twists' angle.
    TwistAngle,
    /// The twists' cosine.
    TwistCos,
    /// The twists' sine.
    TwistSin,
    /// The upper bones' lengths.
    UpperLengths,
    /// The lower bones' lengths.
    LowerLengths,
    /// Coordinates of the elbows.
    Elbows,
    /// Coordinates of the hands.
    Hands,
    /// Quaternions of the upper limbs.
    UpperRotations,
    /// Quaternions of the lower limbs.
    LowerRotations,
}

impl fmt::Display for BatchArray {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::CursorY => "the cursors' y",
            Self::CursorZ => "the cursors' z",
            Self::TwistAngle => "the twists' angle",
            Self::TwistCos => "the twists' cos",
            Self::TwistSin => "the twists' sin",
            Self::UpperLengths => "the upper lengths",
            Self::LowerLengths => "the lower lengths",
            Self::Elbows => "the elbows",
            Self::Hands => "the hands",
            Self::UpperRotations => "the upper rotations",
            Self::LowerRotations => "the lower rotations",
        })
    }
}
