use thiserror::Error;

use super::skeleton_rig::SkeletonRig;
use super::target::Target;
use crate::chain_ik::SolveError;
use crate::diagnosis::Remedy;
use crate::skeleton::{JointId, SkeletonError};
use crate::soft_reach::{SoftReach, SoftReachError};

/// Changed soft limits.
type Changed = Result<SoftReach, SoftReachError>;

/// A remedy that cannot be applied.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RemedyError {
    /// It names a joint that the skeleton does not have, or changes an angle or a length to an invalid
    /// one.
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
                if moved.home.is_finite() {
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
