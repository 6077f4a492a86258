//! Why the tips of a rig are not at their targets, and its hands not turned as these ask.

mod limb;
mod rig_case;

use self::rig_case::RigCase;
use super::evaluate::{EvaluatedSkeleton, TargetOutcome};
use super::skeleton_rig::SkeletonRig;
use super::target::{Target, TargetKind};
use crate::chain_ik::{self, TipTarget};
use crate::diagnosis::{Diagnosis, in_turn};
use crate::skeleton::JointId;

impl SkeletonRig {
    /// The causes for which the tips are not at their enabled targets at a time in seconds, or
    /// hands not turned as these ask, the most likely first; empty if all are reached.
    ///
    /// Every remedy was tried: its residual is that of [`SkeletonRig::evaluate`] after
    /// [`SkeletonRig::apply_remedy`].
    pub fn diagnose(&self, time: f64) -> Vec<Diagnosis> {
        let all: Vec<usize> = (0..self.targets.len()).collect();
        self.diagnose_targets(&all, time)
    }

    /// [`SkeletonRig::diagnose`] for the targets with these indices.
    ///
    /// # Panics
    ///
    /// If there is no target with one of the indices.
    pub fn diagnose_targets(&self, targets: &[usize], time: f64) -> Vec<Diagnosis> {
        let evaluated = self.evaluate(time);
        let tolerance = self.tolerance();
        let is_missed = |index: &usize| self.is_missed(*index, &evaluated, tolerance);
        let mut missed: Vec<usize> = targets.iter().copied().filter(is_missed).collect();
        if missed.is_empty() {
            return Vec::new();
        }
        let error = |index: &usize| evaluated.targets[*index].error;
        missed.sort_by(|one, other| error(other).total_cmp(&error(one)));

        let mut full = self.clone();
        missed.iter().for_each(|index| full.targets[*index].influence = 1.0);
        let evaluated_full = full.evaluate(time);
        let still_missed: Vec<usize> = missed
            .iter()
            .copied()
            .filter(|it| full.is_missed(*it, &evaluated_full, tolerance))
            .collect();
        let whole_body = full.diagnose_whole_body(&still_missed, &evaluated_full, time);

        let examine = |index: usize| {
            let case = RigCase {
                rig: self,
                full: &full,
                time,
                tolerance,
                target: &self.targets[index],
                residual: evaluated.targets[index].error,
                rotation_residual: evaluated.targets[index].rotation_error.unwrap_or_default(),
            };
            let mut found: Vec<Diagnosis> = case.influence().into_iter().collect();
            if still_missed.contains(&index) {
                let of_target = whole_body.iter().filter(|it| it.target == case.target.joint);
                found.extend(of_target.map(|it| case.tried_again(it)));
                found.extend(case.limb(&evaluated_full.targets[index]));
            }
            case.sorted(found)
        };
        in_turn(missed.into_iter().map(examine).collect())
    }

    /// True if the place or the rotation of an enabled target is not reached in the evaluated pose.
    fn is_missed(&self, index: usize, evaluated: &EvaluatedSkeleton, tolerance: f32) -> bool {
        let (target, report) = (&self.targets[index], &evaluated.targets[index]);
        let has_converged = match &report.outcome {
            TargetOutcome::WholeBody(report) => target.influence == 1.0 && report.converged(),
            _ => false,
        };
        let is_reached = report.error <= tolerance && !report.misses_rotation();
        target.enabled && !has_converged && !is_reached
    }

    /// The causes for the whole-body targets among those with the indices `missed`.
    fn diagnose_whole_body(
        &self,
        missed: &[usize],
        evaluated: &EvaluatedSkeleton,
        time: f64,
    ) -> Vec<Diagnosis> {
        let is_whole_body = |target: &&Target| target.kind == TargetKind::WholeBody;
        let missed = missed.iter().map(|index| &self.targets[*index]).filter(is_whole_body);
        let missed: Vec<JointId> = missed.map(|target| target.joint).collect();
        if missed.is_empty() {
            return Vec::new();
        }
        let active = self.targets.iter().filter(|it| self.is_solved_for(it)).filter(is_whole_body);
        let tips: Vec<TipTarget> = active.map(|it| it.tip_target(&evaluated.fk, time)).collect();
        chain_ik::diagnose_targets(&evaluated.fk, &tips, &self.solver, &missed).unwrap_or_default()
    }
}
