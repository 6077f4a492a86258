use super::inputs::{JobInputs, LenError};
use super::kernel::{self, BLOCK, FastPathJobs, Results, outcome};
use super::outputs::JobOutputs;

/// Solves all limbs on this thread without allocating.
///
/// # Errors
///
/// [`LenError`] for arrays of different lengths; nothing is written then. The error of a single
/// limb is in [`JobOutputs::reach`].
pub fn solve(inputs: &JobInputs<'_>, mut outputs: JobOutputs<'_>) -> Result<(), LenError> {
    inputs.check()?;
    outputs.check(inputs.len())?;
    solve_checked(inputs, &mut outputs);
    Ok(())
}

/// Solves limbs whose arrays have equal lengths.
pub(super) fn solve_checked(inputs: &JobInputs<'_>, outputs: &mut JobOutputs<'_>) {
    let (mut jobs, mut results) = (FastPathJobs::ZERO, Results::ZERO);
    for first in (0..inputs.len()).step_by(BLOCK) {
        let limbs = inputs.len().min(first + BLOCK) - first;
        let part = inputs.part(first..first + limbs);
        part.copy_to(&mut jobs);
        match part.pole {
            Some(_) => kernel::solve::<true>(&jobs, &mut results),
            None => kernel::solve::<false>(&jobs, &mut results),
        }
        outputs.copy_from(&results, first, limbs);
        for limb in (0..limbs).filter(|limb| !is_done(&part, &results, *limb)) {
            outputs.set(first + limb, part.job(limb).solve_any());
        }
    }
}

/// True if the results are those of the limb's job, because it fits the fast path.
fn is_done(inputs: &JobInputs<'_>, results: &Results, limb: usize) -> bool {
    let weight = inputs.weight.map_or(1.0, |weight| weight[limb]);
    results.outcome[limb] != outcome::IRREGULAR && weight == 1.0 && inputs.softness == 0.0
}
