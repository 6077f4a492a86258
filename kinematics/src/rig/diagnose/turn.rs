use super::RigCase;
use crate::chain_ik::{Method, Status};
use crate::diagnosis::{Cause, Diagnosis, Remedy, TriedRemedy, limited_angles};
use crate::rig::evaluate::{TargetOutcome, TargetReport};
use crate::rig::skeleton_rig::SkeletonRig;
use crate::skeleton::JointId;

impl RigCase<'_> {
    /// Why a whole-body target does not get both its place and its rotation or aim, where it gets
    /// the place without it. `None` for a target that asks for no turn, and where the place is the
    /// trouble.
    pub fn turn(&self, report: &TargetReport) -> Option<Diagnosis> {
        let TargetOutcome::WholeBody(solved) = &report.outcome else { return None };
        let (joint, missing) = (self.target.joint, report.rotation_error?);
        let free_turn = self.left(Remedy::FreeTurn(joint))?;
        if !report.misses_rotation() && self.is_reached(self.residual)
            || !self.is_reached(free_turn.residual)
        {
            return None;
        }
        if let Some(found) = self.solver_gave_up(solved.iterations, solved.status) {
            return Some(found);
        }
        let freed = (!self.target.has_free_place()).then_some(free_turn);
        let free_place = freed.as_ref().and_then(|_| self.left(Remedy::FreePlace(joint)));
        let free_place = free_place.filter(is_turned);
        let cause = Cause::Turn { missing, is_had_alone: free_place.is_some() };
        let remedies = self.wider().into_iter().chain(freed).chain(free_place).collect();
        Some(self.diagnosis(cause, vec![joint], remedies))
    }

    /// The diagnosis of a solver that misses what more iterations or another method reach.
    fn solver_gave_up(&self, iterations: u32, status: Status) -> Option<Diagnosis> {
        // Multiple of the iterations after which a solver that was stopped ends by itself.
        const PATIENCE: u32 = 10;
        const OTHERS: [Method; 3] = [Method::DampedLeastSquares, Method::Ccd, Method::Transpose];
        let path = || self.full.skeleton.ancestors(self.target.joint).collect();
        if status == Status::OutOfIterations {
            let more = Remedy::AllowIterations(iterations.saturating_mul(PATIENCE));
            if let Some(tried) = self.reaching_both(more) {
                let cause = Cause::OutOfIterations { iterations };
                return Some(self.diagnosis(cause, path(), vec![tried]));
            }
        }
        let present = self.full.solver.method;
        let others = OTHERS.into_iter().filter(|method| *method != present);
        let tried = others.map(Remedy::UseMethod).find_map(|other| self.reaching_both(other))?;
        Some(self.diagnosis(Cause::Stalled, path(), vec![tried]))
    }

    /// The limits of the chain, widened so far that place and turn are reached.
    fn wider(&self) -> Option<TriedRemedy> {
        let skeleton = &self.full.skeleton;
        let free = |joint: &JointId| !skeleton[*joint].locked;
        let path = skeleton.ancestors(self.target.joint).filter(free);
        self.reaching_both(self.widened(&limited_angles(skeleton, path))?)
    }

    /// A remedy with what it leaves, if the target then has its place and its turn.
    pub(super) fn reaching_both(&self, remedy: Remedy) -> Option<TriedRemedy> {
        self.left(remedy).filter(|it| self.is_reached(it.residual) && is_turned(it))
    }

    fn left(&self, remedy: Remedy) -> Option<TriedRemedy> {
        self.left_by(self.full, &remedy).map(|left| left.by(remedy))
    }
}

fn is_turned(tried: &TriedRemedy) -> bool {
    tried.rotation_residual <= SkeletonRig::ROTATION_TOLERANCE
}
