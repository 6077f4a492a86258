use core::ops::Range;

use super::array::{
    BatchArray, BatchBones, BatchError, BatchPositions, BatchRotations, BatchTwist, Points,
};
use super::kernel::{self, BLOCK, Block, BlockArray, PoseBlock, PositionBlock};
use crate::two_bone::TwoBone;

/// Arms to solve: bones, cursors and twists.
#[derive(Clone, Copy, Debug)]
pub struct ArmBatch<'a> {
    bones: BatchBones<'a>,
    cursor: [&'a [f32]; 3],
    twist: BatchTwist<'a>,
}

impl<'a> ArmBatch<'a> {
    /// A batch with one arm for each number in the arrays. Cursors are in Root space.
    ///
    /// # Errors
    ///
    /// [`BatchError`] for arrays of different lengths and for a bone length that is not finite or
    /// not above 0.
    pub fn new(
        bones: BatchBones<'a>,
        cursor: Points<'a>,
        twist: BatchTwist<'a>,
    ) -> Result<Self, BatchError> {
        let arms = cursor.x.len();
        check(BatchArray::CursorY, cursor.y.len(), arms)?;
        check(BatchArray::CursorZ, cursor.z.len(), arms)?;
        match twist {
            BatchTwist::Angle(angle) => check(BatchArray::TwistAngle, angle.len(), arms)?,
            BatchTwist::CosSin { cos, sin } => {
                check(BatchArray::TwistCos, cos.len(), arms)?;
                check(BatchArray::TwistSin, sin.len(), arms)?;
            }
        }
        if let BatchBones::Each { upper, lower } = bones {
            check(BatchArray::UpperLengths, upper.len(), arms)?;
            check(BatchArray::LowerLengths, lower.len(), arms)?;
            if !(are_lengths(upper) && are_lengths(lower)) {
                for (arm, (upper, lower)) in upper.iter().zip(lower).enumerate() {
                    TwoBone::new(*upper, *lower)
                        .map_err(|source| BatchError::Bone { arm, source })?;
                }
            }
        }
        Ok(Self { bones, cursor: [cursor.x, cursor.y, cursor.z], twist })
    }

    /// Number of arms.
    pub fn len(&self) -> usize {
        self.cursor[0].len()
    }

    /// True if the batch has no arms.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Solves all arms on this thread without allocating. Writes elbows and hands to `positions`
    /// and, if given, the limbs' rotations to `rotations`.
    ///
    /// # Errors
    /// [`BatchError::Len`] if the length of an output differs from the number of arms.
    pub fn solve(
        &self,
        mut positions: BatchPositions<'_>,
        mut rotations: Option<BatchRotations<'_>>,
    ) -> Result<(), BatchError> {
        self.check_outputs(&positions, rotations.as_ref())?;
        self.solve_into(&mut positions, rotations.as_mut());
        Ok(())
    }

    pub(super) fn check_outputs(
        &self,
        positions: &BatchPositions<'_>,
        rotations: Option<&BatchRotations<'_>>,
    ) -> Result<(), BatchError> {
        for (array, points) in
            [(BatchArray::Elbows, &positions.elbow), (BatchArray::Hands, &positions.hand)]
        {
            for len in [points.x.len(), points.y.len(), points.z.len()] {
                check(array, len, self.len())?;
            }
        }
        let turns = rotations.into_iter().flat_map(|of| {
            [(BatchArray::UpperRotations, &of.upper), (BatchArray::LowerRotations, &of.lower)]
        });
        for (array, of) in turns {
            for len in [of.x.len(), of.y.len(), of.z.len(), of.w.len()] {
                check(array, len, self.len())?;
            }
        }
        Ok(())
    }

    /// The batch of a range of the arms.
    pub(super) fn part(&self, arms: Range<usize>) -> Self {
        let of = |array: &'a [f32]| &array[arms.clone()];
        Self {
            bones: match self.bones {
                BatchBones::Same(bones) => BatchBones::Same(bones),
                BatchBones::Each { upper, lower } => {
                    BatchBones::Each { upper: of(upper), lower: of(lower) }
                }
            },
            cursor: self.cursor.map(of),
            twist: match self.twist {
                BatchTwist::Angle(angle) => BatchTwist::Angle(of(angle)),
                BatchTwist::CosSin { cos, sin } => {
                    BatchTwist::CosSin { cos: of(cos), sin: of(sin) }
                }
            },
        }
    }

    /// Solves into outputs whose lengths have been checked.
    pub(super) fn solve_into(
        &self,
        positions: &mut BatchPositions<'_>,
        rotations: Option<&mut BatchRotations<'_>>,
    ) {
        match rotations {
            None => self
                .solve_blocks(PositionBlock::ZERO, |block, arms| positions.copy_from(block, arms)),
            Some(rotations) => {
                self.solve_blocks(PoseBlock::ZERO, |block, arms| {
                    positions.copy_from(&block.positions, arms.clone());
                    rotations.copy_from(block, arms);
                });
            }
        }
    }

    fn solve_blocks<B: Block>(&self, mut block: B, mut copy_out: impl FnMut(&B, Range<usize>)) {
        for from in (0..self.len()).step_by(BLOCK) {
            let arms = from..self.len().min(from + BLOCK);
            self.part(arms.clone()).solve_block(&mut block);
            copy_out(&block, arms);
        }
    }

    fn solve_block(&self, block: &mut impl Block) {
        match self.twist {
            BatchTwist::CosSin { cos, sin } => self.solve_twists([cos, sin], block),
            BatchTwist::Angle(angles) => {
                let mut turns = [BlockArray::ZERO; 2];
                let [BlockArray(cos), BlockArray(sin)] = &mut turns;
                for (angle, (cos, sin)) in angles.iter().zip(cos.iter_mut().zip(sin)) {
                    (*sin, *cos) = angle.sin_cos();
                }
                self.solve_twists(
                    turns.each_ref().map(|BlockArray(of)| &of[..angles.len()]),
                    block,
                );
            }
        }
    }

    fn solve_twists(&self, twist: [&[f32]; 2], block: &mut impl Block) {
        match self.bones {
            BatchBones::Same(bones) => {
                self.solve_bones::<true>([&[bones.upper()], &[bones.lower()]], twist, block);
            }
            BatchBones::Each { upper, lower } => {
                self.solve_bones::<false>([upper, lower], twist, block);
            }
        }
    }

    /// Solves by the fast path, which is correct for normal numbers; if some numbers are not
    /// normal, solves again by the path for all finite numbers.
    fn solve_bones<const SAME: bool>(
        &self,
        bones: [&[f32]; 2],
        twist: [&[f32]; 2],
        block: &mut impl Block,
    ) {
        let is_done = kernel::solve::<false, SAME, _>(bones, self.cursor, twist, block);
        if !is_done {
            kernel::solve::<true, SAME, _>(bones, self.cursor, twist, block);
        }
    }
}

/// True if all values are finite and above 0. Checking all of them is faster than stopping at the
/// first invalid one.
fn are_lengths(values: &[f32]) -> bool {
    values.iter().fold(true, |are, value| are & (*value > 0.0) & (*value < f32::INFINITY))
}

fn check(array: BatchArray, len: usize, arms: usize) -> Result<(), BatchError> {
    if len == arms { Ok(()) } else { Err(BatchError::Len { array, len, arms }) }
}
