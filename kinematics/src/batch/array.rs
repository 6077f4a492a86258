use core::fmt;
use core::ops::Range;

use thiserror::Error;

use super::kernel::{BlockArray, PoseBlock, PositionBlock};
use crate::two_bone::{LengthError, TwoBone};

/// Coordinates of points, one point for each arm.
#[derive(Clone, Copy, Debug)]
pub struct Points<'a> {
    /// x of each arm's point.
    pub x: &'a [f32],
    /// y of each arm's point.
    pub y: &'a [f32],
    /// z of each arm's point.
    pub z: &'a [f32],
}

/// Arrays to which points are written, one point for each arm.
#[derive(Debug)]
pub struct PointsMut<'a> {
    /// x of each arm's point.
    pub x: &'a mut [f32],
    /// y of each arm's point.
    pub y: &'a mut [f32],
    /// z of each arm's point.
    pub z: &'a mut [f32],
}

/// Arrays to which unit quaternions are written, one for each arm.
#[derive(Debug)]
pub struct QuaternionsMut<'a> {
    /// x of each arm's quaternion.
    pub x: &'a mut [f32],
    /// y of each arm's quaternion.
    pub y: &'a mut [f32],
    /// z of each arm's quaternion.
    pub z: &'a mut [f32],
    /// w of each arm's quaternion.
    pub w: &'a mut [f32],
}

impl<'a> PointsMut<'a> {
    /// Borrows three arrays: x, y and z.
    pub fn of([x, y, z]: &'a mut [impl AsMut<[f32]>; 3]) -> Self {
        Self { x: x.as_mut(), y: y.as_mut(), z: z.as_mut() }
    }
}

impl<'a> QuaternionsMut<'a> {
    /// Borrows four arrays: x, y, z and w.
    pub fn of([x, y, z, w]: &'a mut [impl AsMut<[f32]>; 4]) -> Self {
        Self { x: x.as_mut(), y: y.as_mut(), z: z.as_mut(), w: w.as_mut() }
    }
}

/// Bone lengths of a batch.
#[derive(Clone, Copy, Debug)]
pub enum BatchBones<'a> {
    /// The same bones for all arms.
    Same(TwoBone),
    /// Lengths of each arm, finite and above 0.
    Each {
        /// d₁ of each arm.
        upper: &'a [f32],
        /// d₂ of each arm.
        lower: &'a [f32],
    },
}

/// Twists of a batch: angles ψ about the Pointer from the Limb frame's +y to the elbow.
#[derive(Clone, Copy, Debug)]
pub enum BatchTwist<'a> {
    /// ψ in radians.
    Angle(&'a [f32]),
    /// Cosine and sine of ψ: several times as fast, and the same on every machine.
    CosSin {
        /// cos ψ of each arm.
        cos: &'a [f32],
        /// sin ψ of each arm.
        sin: &'a [f32],
    },
}

/// Arrays to which elbows and hands are written, in Root space.
#[derive(Debug)]
pub struct BatchPositions<'a> {
    /// Positions of the elbows.
    pub elbow: PointsMut<'a>,
    /// Positions of the hands.
    pub hand: PointsMut<'a>,
}

/// Arrays to which the limbs' rotations are written, in Root space: +x is along the limb, +z along
/// the hinge axis; w ≥ 0.
#[derive(Debug)]
pub struct BatchRotations<'a> {
    /// Rotations of the upper limbs.
    pub upper: QuaternionsMut<'a>,
    /// Rotations of the lower limbs.
    pub lower: QuaternionsMut<'a>,
}

impl BatchPositions<'_> {
    /// Copies the results of a block to the range `arms`.
    pub(super) fn copy_from(&mut self, block: &PositionBlock, arms: Range<usize>) {
        let Self { elbow, hand } = self;
        copy(&block.elbow, [&mut *elbow.x, &mut *elbow.y, &mut *elbow.z], arms.clone());
        copy(&block.hand, [&mut *hand.x, &mut *hand.y, &mut *hand.z], arms);
    }
}

impl BatchRotations<'_> {
    /// Copies the results of a block to the range `arms`.
    pub(super) fn copy_from(&mut self, block: &PoseBlock, arms: Range<usize>) {
        for (values, QuaternionsMut { x, y, z, w }) in
            [(&block.upper, &mut self.upper), (&block.lower, &mut self.lower)]
        {
            copy(values, [&mut **x, &mut **y, &mut **z, &mut **w], arms.clone());
        }
    }
}

fn copy<const N: usize>(block: &[BlockArray; N], arrays: [&mut [f32]; N], arms: Range<usize>) {
    for (BlockArray(values), array) in block.iter().zip(arrays) {
        array[arms.clone()].copy_from_slice(&values[..arms.len()]);
    }
}

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
