//! Jobs of many limbs at once.
//!
//! Each array holds one number for each limb (a structure of arrays), so that one instruction
//! computes 2, 4 or 8 limbs. The instruction set is chosen at run time.
//!
//! ```
//! use ik_arm_kinematics::batch::{Points, QuaternionsMut};
//! use ik_arm_kinematics::job::batch::{JobInputs, JobOutputs, Joints, solve};
//! use ik_arm_kinematics::two_bone::Reach;
//!
//! // Two limbs with their shoulders at the origin, elbows above them, hands to the right.
//! let (zero, one) = ([0.0; 2], [1.0; 2]);
//! let [x, y, z] = [
//!     Points { x: &one, y: &zero, z: &zero },
//!     Points { x: &zero, y: &one, z: &zero },
//!     Points { x: &zero, y: &zero, z: &one },
//! ];
//! let joints = |translation| Joints { x_axis: x, y_axis: y, z_axis: z, translation };
//! let inputs = JobInputs {
//!     start: joints(Points { x: &zero, y: &zero, z: &zero }),
//!     middle: joints(y),
//!     end: Points { x: &one, y: &one, z: &zero },
//!     target: Points { x: &[0.3, 3.0], y: &[0.8, 0.0], z: &[1.1, 0.0] },
//!     pole: Some(y),
//!     hinge: Some(z),
//!     twist: None,
//!     weight: None,
//!     softness: 0.0,
//! };
//!
//! let (mut start, mut middle) = ([[0.0; 2]; 4], [[0.0; 2]; 4]);
//! let (mut hand_error, mut reach) = ([0.0; 2], [Ok(Reach::Reached); 2]);
//! let outputs = JobOutputs {
//!     start_correction: QuaternionsMut::of(&mut start),
//!     middle_correction: QuaternionsMut::of(&mut middle),
//!     hand_error: &mut hand_error,
//!     reach: &mut reach,
//! };
//! solve(&inputs, outputs)?;
//! assert_eq!(reach, [Ok(Reach::Reached), Ok(Reach::TooFar)]);
//! # Ok::<(), ik_arm_kinematics::job::batch::LenError>(())
//! ```
//!
//! # Results
//!
//! Results are bit-identical to [`TwoBoneJob::run`](super::TwoBoneJob::run) of each limb alone, for
//! every division of the batch, number of threads and machine. (The sine of a twist differs between
//! machines.) Spaces, units and what breaks are those of [`job`](super). The error of a limb does
//! not affect other limbs.
//!
//! # Speed
//!
//! Most jobs take the fast path: bent limbs without softness, with a weight of 1, bone lengths that
//! differ by less than 1 : 1,000,000, a start joint whose scales differ by less than 1 : 1000, a
//! middle joint that is a rotation with an even scale to 5e-6, and numbers from about 1e-9 to 1e9.
//! Other limbs are solved alone. A twist adds about a third of the time, for its sine and cosine.
//! `docs/performance.md` has the times.

mod arrays;
mod kernel;

use self::kernel::{BLOCK, FastPathJobs, Results, outcome};

pub use arrays::{JobInputs, JobOutputs, Joints, LenError};

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

/// As [`solve`], on the threads of [`rayon`]. Results are bit-identical.
///
/// # Errors
///
/// As [`solve`].
#[cfg(feature = "parallel")]
pub fn solve_on_all_cores(inputs: &JobInputs<'_>, outputs: JobOutputs<'_>) -> Result<(), LenError> {
    inputs.check()?;
    outputs.check(inputs.len())?;
    solve_tasks(*inputs, outputs);
    Ok(())
}

/// Solves limbs whose arrays have equal lengths.
fn solve_checked(inputs: &JobInputs<'_>, outputs: &mut JobOutputs<'_>) {
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

#[cfg(feature = "parallel")]
fn solve_tasks(inputs: JobInputs<'_>, mut outputs: JobOutputs<'_>) {
    // Maximum number of limbs of a task, so that starting it costs little beside solving them.
    const TASK: usize = 4 * BLOCK;
    if inputs.len() <= TASK {
        solve_checked(&inputs, &mut outputs);
        return;
    }
    let middle = (inputs.len() / 2).next_multiple_of(BLOCK);
    let (first, second) = (inputs.part(0..middle), inputs.part(middle..inputs.len()));
    let (first_outputs, second_outputs) = outputs.split_at(middle);
    rayon::join(|| solve_tasks(first, first_outputs), || solve_tasks(second, second_outputs));
}
