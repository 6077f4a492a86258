use thiserror::Error;

use super::skeleton_rig::SkeletonRig;
use super::target::{MovedJoints, Target, TargetKind, TargetSpace};
use crate::skeleton::JointId;

/// A target that is fixed in a space from which it cannot be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TargetSpaceError {
    /// The skeleton has no such joint.
    #[error("the target of joint {target} must be in the world or on a joint, got joint {joint}")]
    NoJoint {
        /// Joint of the target.
        target: JointId,
        /// The missing joint.
        joint: JointId,
    },
    /// The target moves the joint that it is on.
    #[error("the target of joint {target} must be on a joint that it does not move, got {joint}")]
    Own {
        /// Joint of the target.
        target: JointId,
        /// The joint that the target is on.
        joint: JointId,
    },
    /// A whole-body target is on a joint that another target moves.
    #[error(
        "the whole-body target of joint {target} must be on a joint that no target moves, got {joint}"
    )]
    WholeBody {
        /// Joint of the target.
        target: JointId,
        /// The joint that the target is on.
        joint: JointId,
    },
    /// Limbs whose targets are on each other.
    #[error("the target of joint {target} must not be on a limb whose target depends on it")]
    Cycle {
        /// Joint of one of the targets.
        target: JointId,
    },
}

impl TargetSpaceError {
    /// The reason without the names of the joints.
    pub fn reason(&self) -> &'static str {
        match self {
            Self::NoJoint { .. } => "There is no such joint",
            Self::Own { .. } => "The target moves this joint",
            Self::WholeBody { .. } => "Another target moves this joint",
            Self::Cycle { .. } => "A limb's target on this joint depends on this one",
        }
    }
}

impl SkeletonRig {
    /// Checks that each target can be evaluated after the joints that it is on.
    ///
    /// # Errors
    ///
    /// [`TargetSpaceError`] for the first target that cannot.
    pub fn check_target_spaces(&self) -> Result<(), TargetSpaceError> {
        for target in &self.targets {
            // Of any limb, since a change of its reference brings its pole into use.
            let pole = target.limb().and_then(|limb| limb.pole_space.joint());
            if let Some(joint) = pole.filter(|joint| self.skeleton.joint(*joint).is_none()) {
                return Err(TargetSpaceError::NoJoint { target: target.joint, joint });
            }
        }
        if !self.targets.iter().any(is_on_joint) {
            return Ok(());
        }
        let moved: Vec<_> = self.targets.iter().map(|it| self.moved_by(it)).collect();
        for (target, own) in self.targets.iter().zip(&moved) {
            for joint in target.spaces().filter_map(TargetSpace::joint) {
                let error = if self.skeleton.joint(joint).is_none() {
                    Some(TargetSpaceError::NoJoint { target: target.joint, joint })
                } else if own.moves(&self.skeleton, joint) {
                    Some(TargetSpaceError::Own { target: target.joint, joint })
                } else if target.kind == TargetKind::WholeBody
                    && moved.iter().any(|other| other.moves(&self.skeleton, joint))
                {
                    Some(TargetSpaceError::WholeBody { target: target.joint, joint })
                } else {
                    None
                };
                error.map_or(Ok(()), Err)?;
            }
        }
        let limbs = (0..self.targets.len()).filter(|index| self.targets[*index].limb().is_some());
        match LimbOrder::new(self, limbs.collect()).cycle {
            Some(index) => Err(TargetSpaceError::Cycle { target: self.targets[index].joint }),
            None => Ok(()),
        }
    }
}

/// Indices of limb targets in the order in which they are solved: those that move a joint before
/// those that depend on it, otherwise in the order of their joints.
pub(super) struct LimbOrder {
    pub indices: Vec<usize>,
    /// A target that depends on itself through others.
    cycle: Option<usize>,
}

impl LimbOrder {
    /// The order of the limb targets with these indices.
    pub fn new(rig: &SkeletonRig, mut left: Vec<usize>) -> Self {
        left.sort_by_key(|index| rig.targets[*index].joint);
        if !left.iter().any(|index| is_on_joint(&rig.targets[*index])) {
            return Self { indices: left, cycle: None };
        }
        let mut order = Self { indices: Vec::with_capacity(left.len()), cycle: None };
        let moved: Vec<MovedJoints> =
            rig.targets.iter().map(|target| rig.moved_by(target)).collect();
        let depends = |one: usize, other: usize| {
            one != other && moved[one].depends_on(&rig.skeleton, &rig.targets[one], &moved[other])
        };
        while !left.is_empty() {
            let is_free = |one: &usize| !left.iter().any(|other| depends(*one, *other));
            let next = left.iter().position(is_free);
            if next.is_none() {
                order.cycle = order.cycle.or(left.first().copied());
            }
            order.indices.push(left.remove(next.unwrap_or(0)));
        }
        order
    }
}

fn is_on_joint(target: &Target) -> bool {
    target.spaces().any(|space| space.joint().is_some())
}
