use crate::document::SkeletonRig;
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{self, Report, SolveError, SolverOptions};
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::Skeleton;
use crate::rig::TargetOutcome;

/// A pose of a rig's skeleton, with the report of the solver of several joints together, if any.
pub struct Posed {
    pub skeleton: Shared<Skeleton>,
    pub report: Option<Report>,
    /// Why targets are not reached.
    pub why: Vec<Diagnosis>,
}

impl Posed {
    /// The FK pose.
    pub fn fk(rig: &SkeletonRig, time: f64) -> Self {
        Self { skeleton: rig.fk_at(time), report: None, why: Vec::new() }
    }

    /// The pose by the rig's targets.
    pub fn evaluated(rig: &SkeletonRig, time: f64) -> Self {
        let evaluated = rig.evaluate(time);
        let report = evaluated.targets.into_iter().find_map(|target| match target.outcome {
            TargetOutcome::WholeBody(report) => Some(report),
            _ => None,
        });
        Self { skeleton: evaluated.solved, report, why: rig.diagnose(time) }
    }

    /// The FK pose after a solve for all enabled targets.
    ///
    /// # Errors
    ///
    /// [`SolveError`] if the solver refuses a target.
    pub fn solved(
        rig: &SkeletonRig,
        time: f64,
        options: &SolverOptions,
    ) -> Result<Self, SolveError> {
        let mut skeleton = rig.fk_at(time);
        let targets = rig.targets_at(time);
        let why = chain_ik::diagnose(&skeleton, &targets, options)?;
        let report = chain_ik::solve(skeleton.make_mut(), &targets, options)?;
        Ok(Self { skeleton, report: Some(report), why })
    }
}
