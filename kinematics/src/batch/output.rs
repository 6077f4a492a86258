use core::ops::Range;

use super::array::{PointsMut, QuaternionsMut};
use super::kernel::{BlockArray, PoseBlock, PositionBlock};

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
