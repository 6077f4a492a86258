use crate::diagnosis::{Cause, Diagnosis, Remedy, TriedRemedy};
use crate::rig::evaluate::TargetReport;
use crate::rig::skeleton_rig::SkeletonRig;
use crate::rig::target::Target;
use crate::skeleton::JointId;

/// A target of a rig that is not reached.
pub(super) struct RigCase<'a> {
    pub rig: &'a SkeletonRig,
    /// The rig with full influence of all missed targets.
    pub full: &'a SkeletonRig,
    pub time: f64,
    pub tolerance: f32,
    pub target: &'a Target,
    pub residual: f32,
    /// Angle in radians that the hand's rotation misses; 0 for a target that asks for none.
    pub rotation_residual: f32,
}

/// What a pose leaves between a target and what it moves.
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
        let TargetReport { error, rotation_error, .. } = changed.evaluate(self.time).targets[index];
        Some(Left { distance: error, angle: rotation_error.unwrap_or_default() })
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
