//! Division of a batch among threads.

use super::arm_batch::ArmBatch;
use super::array::{BatchError, BatchPositions, BatchRotations, PointsMut, QuaternionsMut};
use super::kernel::BLOCK;

/// Maximum number of arms of a task. They are many blocks, so that starting a task costs little
/// beside solving its arms.
const TASK: usize = 8 * BLOCK;

impl ArmBatch<'_> {
    /// As [`Self::solve`], on the threads of [`rayon`]. Results are bit-identical.
    ///
    /// # Errors
    ///
    /// As [`Self::solve`].
    pub fn solve_on_all_cores(
        &self,
        positions: BatchPositions<'_>,
        rotations: Option<BatchRotations<'_>>,
    ) -> Result<(), BatchError> {
        self.check_outputs(&positions, rotations.as_ref())?;
        solve_tasks(*self, positions, rotations);
        Ok(())
    }
}

fn solve_tasks(
    arms: ArmBatch<'_>,
    mut positions: BatchPositions<'_>,
    mut rotations: Option<BatchRotations<'_>>,
) {
    if arms.len() <= TASK {
        arms.solve_into(&mut positions, rotations.as_mut());
        return;
    }
    let middle = (arms.len() / 2).next_multiple_of(BLOCK);
    let first = arms.part(0..middle);
    let second = arms.part(middle..arms.len());
    let (first_positions, second_positions) = positions.split_at(middle);
    let (first_rotations, second_rotations) = rotations.map(|of| of.split_at(middle)).unzip();
    rayon::join(
        || solve_tasks(first, first_positions, first_rotations),
        || solve_tasks(second, second_positions, second_rotations),
    );
}

impl BatchPositions<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (elbow, second_elbow) = self.elbow.split_at(middle);
        let (hand, second_hand) = self.hand.split_at(middle);
        (Self { elbow, hand }, Self { elbow: second_elbow, hand: second_hand })
    }
}

impl BatchRotations<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (upper, second_upper) = self.upper.split_at(middle);
        let (lower, second_lower) = self.lower.split_at(middle);
        (Self { upper, lower }, Self { upper: second_upper, lower: second_lower })
    }
}

impl PointsMut<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let [(x, x2), (y, y2), (z, z2)] =
            [self.x, self.y, self.z].map(|of| of.split_at_mut(middle));
        (Self { x, y, z }, Self { x: x2, y: y2, z: z2 })
    }
}

impl QuaternionsMut<'_> {
    pub(crate) fn split_at(self, middle: usize) -> (Self, Self) {
        let [(x, x2), (y, y2), (z, z2), (w, w2)] =
            [self.x, self.y, self.z, self.w].map(|of| of.split_at_mut(middle));
        (Self { x, y, z, w }, Self { x: x2, y: y2, z: z2, w: w2 })
    }
}
