use crate::document::Posed;
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{self, Report, SolveError, SolverOptions, Status};
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::Skeleton;
use crate::rig::TargetOutcome;

/// A pose of a rig's skeleton, with the report of the solver of several joints together, if any.
pub struct AnsweredPose {
    pub skeleton: Shared<Skeleton>,
    pub report: Option<Report>,
    /// Why targets are not reached.
    pub why: Vec<Diagnosis>,
    /// Why the whole-body targets are not solved, or not to the end.
    pub remark: Option<String>,
}

impl AnsweredPose {
    /// The FK pose.
    pub fn fk(posed: &Posed) -> Self {
        let skeleton = posed.document().skeleton_rig.fk_at(posed.time());
        Self { skeleton, report: None, why: Vec::new(), remark: None }
    }

    /// The pose by the rig's targets.
    pub fn by_targets(posed: &Posed) -> Self {
        let outcomes = || posed.targets().iter().map(|target| &target.outcome);
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
        let why = posed.document().skeleton_rig.diagnose(posed.time());
        Self { skeleton: posed.skeleton().clone(), report, why, remark }
    }

    /// The FK pose after a solve for all enabled targets.
    ///
    /// # Errors
    ///
    /// [`SolveError`] if the solver refuses a target.
    pub fn solved(posed: &Posed, options: &SolverOptions) -> Result<Self, SolveError> {
        let (rig, time) = (&posed.document().skeleton_rig, posed.time());
        let mut skeleton = rig.fk_at(time);
        let targets = rig.targets_at(time);
        let why = chain_ik::diagnose(&skeleton, &targets, options)?;
        let report = chain_ik::solve(skeleton.make_mut(), &targets, options)?;
        Ok(Self { skeleton, report: Some(report), why, remark: None })
    }
}
