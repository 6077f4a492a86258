use crate::chain_ik::{SolveError, TipTarget};
use crate::skeleton::Skeleton;

pub(super) fn check_targets(skeleton: &Skeleton, targets: &[TipTarget]) -> Result<(), SolveError> {
    let mut targeted = vec![false; skeleton.joints().len()];
    for target in targets {
        if skeleton.joint(target.joint).is_none() {
            return Err(SolveError::NoJoint(target.joint));
        }
        if std::mem::replace(&mut targeted[target.joint.index()], true) {
            return Err(SolveError::TwoTargets(target.joint));
        }
        check_target(target)?;
    }
    Ok(())
}

/// Checks that a target's point is finite, and its weight finite and above 0.
pub fn check_target(&TipTarget { joint, point, weight }: &TipTarget) -> Result<(), SolveError> {
    if !point.is_finite() {
        return Err(SolveError::Point { joint, point });
    }
    if !(weight.is_finite() && weight > 0.0) {
        return Err(SolveError::Weight { joint, weight });
    }
    Ok(())
}
