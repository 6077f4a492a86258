//! Division of a batch among threads.

use super::inputs::{JobInputs, LenError};
use super::kernel::BLOCK;
use super::outputs::JobOutputs;
use super::solve::solve_checked;

/// Maximum number of limbs of a task, so that starting it costs little beside solving them.
const TASK: usize = 4 * BLOCK;

/// As [`solve`](super::solve), on the threads of [`rayon`]. Results are bit-identical.
///
/// # Errors
///
/// As [`solve`](super::solve).
pub fn solve_on_all_cores(inputs: &JobInputs<'_>, outputs: JobOutputs<'_>) -> Result<(), LenError> {
    inputs.check()?;
    outputs.check(inputs.len())?;
    solve_tasks(*inputs, outputs);
    Ok(())
}

fn solve_tasks(inputs: JobInputs<'_>, mut outputs: JobOutputs<'_>) {
    if inputs.len() <= TASK {
        solve_checked(&inputs, &mut outputs);
        return;
    }
    let middle = (inputs.len() / 2).next_multiple_of(BLOCK);
    let (first, second) = (inputs.part(0..middle), inputs.part(middle..inputs.len()));
    let (first_outputs, second_outputs) = outputs.split_at(middle);
    rayon::join(|| solve_tasks(first, first_outputs), || solve_tasks(second, second_outputs));
}

impl JobOutputs<'_> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (start, second_start) = self.start_correction.split_at(middle);
        let (turn, second_turn) = self.middle_correction.split_at(middle);
        let (hand_error, second_hand_error) = self.hand_error.split_at_mut(middle);
        let (reach, second_reach) = self.reach.split_at_mut(middle);
        let first = Self { start_correction: start, middle_correction: turn, hand_error, reach };
        let second = Self {
            start_correction: second_start,
            middle_correction: second_turn,
            hand_error: second_hand_error,
            reach: second_reach,
        };
        (first, second)
    }
}
