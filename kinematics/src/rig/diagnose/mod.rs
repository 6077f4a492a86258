//! Why the tips of a rig are not at their targets, and its hands not turned as these ask.

mod limb;
mod turn;

use core::num::NonZeroU32;

use thiserror::Error;

use super::carried::Carried;
use super::chain::with_others_locked;
use super::evaluate::{EvaluatedSkeleton, TargetOutcome, TargetReport};
use super::skeleton_rig::SkeletonRig;
use super::target::{Target, TargetKind};
use crate::chain_ik::{self, ChainTarget, SolveError, SolverOptions};
use crate::diagnosis::{
    Angle, Cause, Diagnosis, Remedy, TriedRemedy, in_turn, remove_limits, widen_to_contain,
};
use crate::skeleton::{JointId, Skeleton, SkeletonError};
use crate::soft_reach::{SoftReach, SoftReachError};

impl SkeletonRig {
    /// The causes for which the tips are not at their enabled targets at a time in seconds, or
    /// hands not turned as these ask, the most likely first; empty if all are reached.
    ///
    /// The pose is that of [`SkeletonRig::step`] from the state `before`. Every remedy was tried:
    /// its residual is that of the step after [`SkeletonRig::apply_remedy`], or that of
    /// [`SkeletonRig::evaluate`] where only this reaches all targets.
    pub fn diagnose(&self, time: f64, before: &Carried) -> Vec<Diagnosis> {
        let all: Vec<usize> = (0..self.targets.len()).collect();
        self.diagnose_targets(&all, time, before)
    }

    /// [`SkeletonRig::diagnose`] for the targets with these indices.
    ///
    /// # Panics
    ///
    /// If there is no target with one of the indices.
    pub fn diagnose_targets(
        &self,
        targets: &[usize],
        time: f64,
        before: &Carried,
    ) -> Vec<Diagnosis> {
        let evaluated = self.step(time, before).0;
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
        let evaluated_full = full.step(time, before).0;
        let still_missed: Vec<usize> = missed
            .iter()
            .copied()
            .filter(|it| full.is_missed(*it, &evaluated_full, tolerance))
            .collect();
        let of_solver = full.diagnose_solved(&still_missed, &evaluated_full, time);
        let afresh = (*before != Carried::default()).then(|| full.evaluate(time));
        let is_lost = |index: usize| {
            let afresh = afresh.as_ref().filter(|_| self.targets[index].limb().is_none());
            afresh.is_some_and(|afresh| !full.is_missed(index, afresh, tolerance))
        };

        let examine = |index: usize| {
            let case = RigCase {
                rig: self,
                full: &full,
                solved: &evaluated_full.solved,
                time,
                before,
                tolerance,
                target: &self.targets[index],
                residual: evaluated.targets[index].error,
                rotation_residual: evaluated.targets[index].rotation_error.unwrap_or_default(),
            };
            let mut found: Vec<Diagnosis> = case.influence().into_iter().collect();
            if still_missed.contains(&index) {
                if is_lost(index) {
                    found.push(case.diagnosis(Cause::Lost, Vec::new(), Vec::new()));
                }
                let report = &evaluated_full.targets[index];
                let of_target = of_solver.iter().filter(|it| it.target == case.target.joint);
                match case.turn(report) {
                    Some(turn) => found.push(turn),
                    None => found.extend(of_target.map(|it| case.tried_again(it))),
                }
                found.extend(case.limb(report));
                found.extend(case.balance());
                found.extend(case.longer_chain());
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

    /// The causes for the targets of the whole body and of chains among those with the indices
    /// `missed`.
    fn diagnose_solved(
        &self,
        missed: &[usize],
        evaluated: &EvaluatedSkeleton,
        time: f64,
    ) -> Vec<Diagnosis> {
        let of_kind = |is_kind: fn(&TargetKind) -> bool| {
            missed.iter().copied().filter(move |index| is_kind(&self.targets[*index].kind))
        };
        let body = self.bodies();
        let missed_by_body: Vec<usize> = of_kind(|it| *it == TargetKind::WholeBody).collect();
        let mut found =
            self.diagnose_together(&evaluated.fk, &body, &missed_by_body, &self.solver, time);
        for index in of_kind(TargetKind::is_chain) {
            let together = self.chains_with(index);
            let turned = self.turned_together(&together);
            let mut pose = with_others_locked(&evaluated.solved, &turned);
            for joint in turned {
                let rotation = evaluated.fk[joint].rotation;
                pose.write_local(joint, |joint| joint.rotation = rotation);
            }
            let options = self.chain_options();
            found.extend(self.diagnose_together(&pose, &together, &[index], &options, time));
        }
        found
    }

    /// The causes for missed targets among those that are solved together from an FK pose.
    fn diagnose_together(
        &self,
        fk: &Skeleton,
        together: &[usize],
        missed: &[usize],
        options: &SolverOptions,
        time: f64,
    ) -> Vec<Diagnosis> {
        if missed.is_empty() {
            return Vec::new();
        }
        let tip = |index: &usize| self.tip_target(&self.targets[*index], fk, time);
        let tips: Vec<ChainTarget> = together.iter().map(tip).collect();
        let missed: Vec<JointId> = missed.iter().map(|index| self.targets[*index].joint).collect();
        chain_ik::diagnose_targets(fk, &tips, options, &missed).unwrap_or_default()
    }
}

/// Changed soft limits.
type Changed = Result<SoftReach, SoftReachError>;

/// A remedy that cannot be applied.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RemedyError {
    /// It names a joint that the skeleton does not have, or changes an angle or a length to an
    /// invalid one.
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
    /// It changes a target to an invalid one.
    #[error(transparent)]
    Target(#[from] SolveError),
    /// It allows the solver no iterations.
    #[error("the solver's iterations must be above 0, got 0")]
    NoIterations,
}

impl SkeletonRig {
    /// Applies a remedy at a time in seconds, at which a moved target is at its new position.
    ///
    /// # Errors
    ///
    /// See [`RemedyError`]. The rig may then be changed in part.
    pub fn apply_remedy(&mut self, remedy: &Remedy, time: f64) -> Result<(), RemedyError> {
        check(remedy)?;
        if let Remedy::MoveTarget { joint, point } = remedy {
            let pose = self.skeleton_at(time);
            self.change_target(*joint, |target| {
                let moved = target.placed(&pose, time, *point);
                if moved.present_home().is_finite() {
                    *target = moved;
                }
            });
        }
        remedy.change_skeleton(self.skeleton_mut())?;
        remedy.change_options(&mut self.solver);
        match *remedy {
            Remedy::SwitchOff(joint) => self.change_target(joint, |it| it.enabled = false),
            Remedy::SetWeight { joint, weight } => {
                self.change_target(joint, |target| target.weight = weight);
            }
            Remedy::FreeTurn(joint) => self.change_target(joint, |target| {
                if !target.has_free_place() {
                    (target.orientation, target.aim) = (None, None);
                }
            }),
            Remedy::FreePlace(joint) => self.change_target(joint, |target| {
                if target.turns_joint() {
                    target.weight = 0.0;
                }
            }),
            Remedy::FollowBody => self.body_follows = true,
            Remedy::FreeBalance => self.balance = None,
            Remedy::LengthenChain { joint, length } => self.change_target(joint, |target| {
                if target.kind.is_chain() {
                    target.kind = TargetKind::Chain(length);
                }
            }),
            Remedy::FullInfluence(joint) => self.change_target(joint, |it| it.influence = 1.0),
            Remedy::Stretch { joint, max_stretch } => {
                self.change_soft_reach(joint, |soft| {
                    SoftReach::new(soft.softness(), max_stretch, soft.min_elbow_angle())
                });
            }
            Remedy::HardLimits(joint) => {
                self.change_soft_reach(joint, |soft| SoftReach::new(0.0, soft.max_stretch(), 0.0));
            }
            _ => {}
        }
        Ok(())
    }

    fn change_target(&mut self, joint: JointId, change: impl FnOnce(&mut Target)) {
        if let Some(target) = self.targets.iter_mut().find(|target| target.joint == joint) {
            change(target);
        }
    }

    /// Changes the soft limits of a limb's target, unless the new ones are invalid.
    fn change_soft_reach(&mut self, joint: JointId, change: impl FnOnce(SoftReach) -> Changed) {
        self.change_target(joint, |target| {
            if let Some(limb) = target.limb_mut() {
                limb.soft_reach = change(limb.soft_reach).unwrap_or(limb.soft_reach);
            }
        });
    }
}

/// Checks the numbers of a remedy for a target or the solver.
fn check(remedy: &Remedy) -> Result<(), RemedyError> {
    match *remedy {
        Remedy::MoveTarget { joint, point } if !point.is_finite() => {
            Err(SolveError::Point { joint, point }.into())
        }
        Remedy::SetWeight { joint, weight } if !(weight.is_finite() && weight > 0.0) => {
            Err(SolveError::Weight { joint, weight }.into())
        }
        Remedy::AllowIterations(0) => Err(RemedyError::NoIterations),
        _ => Ok(()),
    }
}

/// A target of a rig that is not reached.
struct RigCase<'a> {
    pub rig: &'a SkeletonRig,
    /// The rig with full influence of all missed targets.
    pub full: &'a SkeletonRig,
    /// The pose of `full`.
    pub solved: &'a Skeleton,
    pub time: f64,
    pub before: &'a Carried,
    pub tolerance: f32,
    pub target: &'a Target,
    pub residual: f32,
    /// Angle in radians that the hand's rotation misses; 0 for a target that asks for none.
    pub rotation_residual: f32,
}

/// The rest of a target that a pose leaves: distance and rotation.
struct Left {
    /// In the world.
    distance: f32,
    /// In radians.
    angle: f32,
}

/// Fraction of a residual that a remedy may leave: one that is left nearly as it was is not worth
/// an edit.
const WORTH: f32 = 0.9;

impl RigCase<'_> {
    /// The mix with the FK pose.
    pub fn influence(&self) -> Option<Diagnosis> {
        let Target { joint, influence, .. } = *self.target;
        if influence == 1.0 {
            return None;
        }
        let full = Remedy::FullInfluence(joint);
        let tried = self.try_remedy(full.clone()).or_else(|| self.try_rotation_remedy(full));
        let remedies = Vec::from_iter(tried);
        (!remedies.is_empty())
            .then(|| self.diagnosis(Cause::Influence { influence }, vec![joint], remedies))
    }

    /// The balance, if the target can be reached without it.
    pub fn balance(&self) -> Option<Diagnosis> {
        self.rig.active_balance()?;
        let tried = self.try_remedy(Remedy::FreeBalance)?;
        let is_reached = self.is_reached(tried.residual);
        is_reached.then(|| self.diagnosis(Cause::Balance, Vec::new(), vec![tried]))
    }

    /// A chain of too few joints, if the target is reached with more of them.
    pub fn longer_chain(&self) -> Option<Diagnosis> {
        let TargetKind::Chain(length) = self.target.kind else { return None };
        let joint = self.target.joint;
        let most = self.rig.skeleton.ancestors(joint).count() as u32;
        let longer = (length.get() + 1..=most).filter_map(NonZeroU32::new);
        let mut remedies = longer.map(|length| Remedy::LengthenChain { joint, length });
        let tried = remedies.find_map(|remedy| self.reaching_both(remedy))?;
        let cause = Cause::ShortChain { length: length.get() };
        Some(self.diagnosis(cause, self.rig.moved_by(self.target).turned, vec![tried]))
    }

    /// A diagnosis of the solver with the residuals that its remedies leave in the rig.
    pub fn tried_again(&self, found: &Diagnosis) -> Diagnosis {
        let remedies = found.remedies.iter().map(|tried| tried.remedy.clone());
        let remedies = remedies.filter_map(|remedy| self.try_remedy(remedy)).collect();
        self.diagnosis(found.cause, found.joints.clone(), remedies)
    }

    /// Tries a remedy; `None` if it does not bring the tip nearer.
    pub fn try_remedy(&self, remedy: Remedy) -> Option<TriedRemedy> {
        let left = self.left_by(self.rig, &remedy)?;
        (left.distance <= WORTH * self.residual).then(|| left.by(remedy))
    }

    /// Tries a remedy; `None` if it does not bring the hand nearer to the rotation that its target
    /// asks for, or takes the tip away from the target.
    pub fn try_rotation_remedy(&self, remedy: Remedy) -> Option<TriedRemedy> {
        let left = self.left_by(self.rig, &remedy)?;
        let stays = left.distance <= self.residual.max(self.tolerance);
        (stays && left.angle <= WORTH * self.rotation_residual).then(|| left.by(remedy))
    }

    /// True if a remedy brings the tip to its target at full influence.
    pub fn reaches(&self, remedy: &Remedy) -> bool {
        self.left_by(self.full, remedy).is_some_and(|left| self.is_reached(left.distance))
    }

    fn left_by(&self, rig: &SkeletonRig, remedy: &Remedy) -> Option<Left> {
        let mut changed = rig.clone();
        changed.apply_remedy(remedy, self.time).ok()?;
        let index = changed.target(self.target.joint)?;
        let mut solved = changed.settle(self.time, self.before).0;
        if !changed.has_reached_all(&solved) {
            let afresh = changed.evaluate(self.time);
            solved = if changed.has_reached_all(&afresh) { afresh } else { solved };
        }
        let TargetReport { error, rotation_error, .. } = solved.targets[index];
        Some(Left { distance: error, angle: rotation_error.unwrap_or_default() })
    }

    /// The limits of angles, widened to contain the pose that the rig has without them.
    pub fn widened(&self, angles: &[Angle]) -> Option<Remedy> {
        let mut free = self.full.clone();
        remove_limits(free.skeleton_mut(), angles);
        let pose = free.settle(self.time, self.before).0.solved;
        widen_to_contain(&self.full.skeleton, &pose, angles)
    }

    pub fn diagnosis(
        &self,
        cause: Cause,
        joints: Vec<JointId>,
        mut remedies: Vec<TriedRemedy>,
    ) -> Diagnosis {
        remedies.sort_by_key(|tried| !self.is_reached(tried.residual));
        let target = self.target.joint;
        Diagnosis { target, residual: self.residual, cause, joints, remedies }
    }

    /// Diagnoses whose remedy reaches the target, then those with the least residual left.
    pub fn sorted(&self, mut found: Vec<Diagnosis>) -> Vec<Diagnosis> {
        let left = |it: &Diagnosis| {
            let residual = it.residual_with_remedy();
            if self.is_reached(residual) { 0.0 } else { residual }
        };
        found.sort_by(|one, other| left(one).total_cmp(&left(other)));
        found
    }

    fn is_reached(&self, residual: f32) -> bool {
        // A solve from a rounded position ends at another point within the tolerance.
        const ROUNDING: f32 = 1.01;
        residual <= ROUNDING * self.tolerance
    }
}

impl Left {
    fn by(self, remedy: Remedy) -> TriedRemedy {
        TriedRemedy { remedy, residual: self.distance, rotation_residual: self.angle }
    }
}
