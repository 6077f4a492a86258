use crate::diagnosis::{Cause, Diagnosis, Remedy, TriedRemedy};
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
}

impl RigCase<'_> {
    /// The mix with the FK pose.
    pub fn influence(&self) -> Option<Diagnosis> {
        let Target { joint, influence, .. } = *self.target;
        if influence == 1.0 {
            return None;
        }
        let remedies = Vec::from_iter(self.try_remedy(Remedy::FullInfluence(joint)));
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
        // A residual that is left nearly as it was is not worth an edit.
        const WORTH: f32 = 0.9;
        let residual = self.residual_with(self.rig, &remedy)?;
        (residual <= WORTH * self.residual).then_some(TriedRemedy { remedy, residual })
    }

    /// Whether a remedy brings the tip to its target at full influence.
    pub fn reaches(&self, remedy: &Remedy) -> bool {
        self.residual_with(self.full, remedy).is_some_and(|residual| self.is_reached(residual))
    }

    fn residual_with(&self, rig: &SkeletonRig, remedy: &Remedy) -> Option<f32> {
        let mut changed = rig.clone();
        changed.apply_remedy(remedy, self.time).ok()?;
        let index = changed.target(self.target.joint)?;
        Some(changed.evaluate(self.time).targets[index].error)
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
