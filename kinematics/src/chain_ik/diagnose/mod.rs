//! Finds out why tips are not at their targets, by trying what would help.
//!
//! Evidence comes from the pose to which the solver came: the reach of the bones against the
//! distance of the target, and the moments with which the target pulls at joints, limits and locked
//! joints. What the evidence suggests is then tried with a solve of its own, in this order:
//!
//! | tried | if the tip then reaches its target |
//! | --- | --- |
//! | (nothing: the bones are too short or too long) | out of reach |
//! | more iterations | out of iterations |
//! | a slightly bent start; other methods; the middle of the limits | singular or stalled |
//! | the target alone, and with the target that pulls against it | conflict |
//! | no limits where the target pushes | limits |
//! | unlocked joints | locked |
//!
//! A cause whose remedy brings the tip to its target excludes the ones tried after it, except that
//! limits and locked joints are both tried.
//!
//! # What breaks
//!
//! - A target in a hole of the reach that limits make is found as *limits*; whether a pose within
//!   the limits exists is not proved, only not found.
//! - The work has a bound: of many missed targets only the farthest are examined, and none if one
//!   solve takes as long as a pose may.
//! - For three targets that conflict only all together, no pair is found.

mod chain_reach;
mod examination;
mod pull;
mod solve_inputs;

use self::examination::Examination;
use self::solve_inputs::SolveInputs;
use super::{SolveError, SolverOptions, TipTarget};
use crate::diagnosis::{Diagnosis, in_turn};
use crate::skeleton::{JointId, Skeleton};

/// The causes for which the tips of `skeleton`, which is in its FK pose, are not at their targets
/// after a solve, the most likely first; empty if all are reached.
///
/// Every remedy was tried: its residual is that of a solve with these options.
///
/// # Errors
///
/// See [`SolveError`].
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::chain_ik::{SolverOptions, TipTarget, diagnose};
/// use ik_arm_kinematics::diagnosis::Cause;
/// use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton};
///
/// let mut skeleton = Skeleton::with_root("root");
/// let upper = skeleton.add(Joint::new("upper", Some(JointId::new(0)), Vec3::Y))?;
/// let lower = Joint { offset: Vec3::Y, ..Joint::new("lower", Some(upper), Vec3::Y) };
/// let lower = skeleton.add(lower)?;
///
/// let target = TipTarget { joint: lower, point: Vec3::new(3.0, 0.0, 0.0), weight: 1.0 };
/// let found = diagnose(&skeleton, &[target], &SolverOptions::default())?;
/// assert!(matches!(found[0].cause, Cause::OutOfReach { .. }));
/// assert!(found[0].remedies[0].residual < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn diagnose(
    skeleton: &Skeleton,
    targets: &[TipTarget],
    options: &SolverOptions,
) -> Result<Vec<Diagnosis>, SolveError> {
    let joints: Vec<_> = targets.iter().map(|target| target.joint).collect();
    diagnose_targets(skeleton, targets, options, &joints)
}

/// [`diagnose`] for the targets of some joints, which are solved together with all others.
///
/// # Errors
///
/// See [`SolveError`].
pub fn diagnose_targets(
    skeleton: &Skeleton,
    targets: &[TipTarget],
    options: &SolverOptions,
    joints: &[JointId],
) -> Result<Vec<Diagnosis>, SolveError> {
    let inputs =
        SolveInputs { skeleton: skeleton.clone(), targets: targets.to_vec(), options: *options };
    let solved = inputs.solve()?;
    if solved.report.converged() {
        return Ok(Vec::new());
    }
    let residual = |joint: &JointId| (*joint, solved.residual(&inputs, *joint));
    let is_missed = |(_, residual): &(JointId, f32)| *residual > solved.tolerance;
    let mut missed: Vec<_> = joints.iter().map(residual).filter(is_missed).collect();
    missed.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    missed.truncate(most_examined(solved.work));
    let examination = Examination::new(inputs, solved);
    let found = missed.into_iter().map(|(joint, residual)| examination.examine(joint, residual));
    Ok(in_turn(found.collect()))
}

/// Number of targets that are examined if one solve takes `work`.
fn most_examined(work: u64) -> usize {
    /// Work of all solves, some seconds.
    const MOST_WORK: u64 = 1 << 26;
    /// Solves for one target, roughly.
    const SOLVES: u64 = 20;
    usize::try_from(MOST_WORK / work.saturating_mul(SOLVES).max(1)).unwrap_or(usize::MAX)
}
