use crate::document::SkeletonRig;
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{self, Report, SolveError, SolverOptions, Status};
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::Skeleton;
use crate::rig::TargetOutcome;

/// A pose of a rig's skeleton, with the report of the solver of several joints together, if any.
pub struct Posed {
    pub skeleton: Shared<Skeleton>,
    pub report: Option<Report>,
    /// Why targets are not reached.
    pub why: Vec<Diagnosis>,
    /// Why the whole-body targets are not solved, or not to the end.
    pub remark: Option<String>,
}

impl Posed {
    /// The FK pose.
    pub fn fk(rig: &SkeletonRig, time: f64) -> Self {
        Self { skeleton: rig.fk_at(time), report: None, why: Vec::new(), remark: None }
    }

    /// The pose by the rig's targets.
    pub fn evaluated(rig: &SkeletonRig, time: f64) -> Self {
        let evaluated = rig.evaluate(time);
        let outcomes = || evaluated.targets.iter().map(|target| &target.outcome);
        let report = outcomes().find_map(|outcome| match outcome {
            TargetOutcome::WholeBody(report) => Some(*report),
            _ => None,
        });
        let refused = outcomes().find_map(|outcome| match outcome {
            TargetOutcome::Refused(error) => Some(format!("targets are not solved: {error}")),
            _ => None,
        });
        let bounded = report.filter(|report| report.status == Status::Bounded).map(|report| {
            let Report { iterations, status, method, .. } = report;
            format!("{method} {status}, after {iterations} iterations")
        });
        let remark = refused.or(bounded);
        Self { skeleton: evaluated.solved, report, why: rig.diagnose(time), remark }
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
        Ok(Self { skeleton, report: Some(report), why, remark: None })
    }
}
