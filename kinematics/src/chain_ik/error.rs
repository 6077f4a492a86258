use core::fmt;

use glam::Vec3;
use thiserror::Error;

use super::method::{Method, TwoBoneRefusal, TwoBonesRefused};
use crate::skeleton::JointId;

/// A skeleton, target or option that cannot be solved.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The skeleton has no joint with the index that a target names.
    #[error("the joint of a target must be one of the skeleton, got {0}")]
    NoJoint(JointId),
    /// Two targets name the same joint.
    #[error("joint {0} must have one target, got more")]
    TwoTargets(JointId),
    /// The position of a target is not finite.
    #[error("the target of joint {joint} must be finite, got {point}")]
    Point {
        /// The target's joint.
        joint: JointId,
        /// The position.
        point: Vec3,
    },
    /// The weight of a target is not finite or not above 0.
    #[error("the weight of joint {joint}'s target must be finite and above 0, got {weight}")]
    Weight {
        /// The target's joint.
        joint: JointId,
        /// The weight.
        weight: f32,
    },
    /// One iteration is more work than [`ChainSolver::bounded`](super::ChainSolver::bounded) allows.
    #[error(
        "{targets} targets and {links} joints are more work for {method} than a pose may take; \
         fabrik takes the least"
    )]
    TooMuchWork {
        /// The method.
        method: Method,
        /// Number of targets.
        targets: usize,
        /// Number of joints that move.
        links: usize,
    },
    /// An option is out of range.
    #[error("{field} must be finite and {}, got {value}", field.bound())]
    Option {
        /// The option.
        field: OptionField,
        /// The refused value.
        value: f32,
    },
    /// The skeleton's transform is singular.
    #[error("the skeleton's transform must not be singular: targets cannot be brought into it")]
    Singular,
    /// [`Method::TwoBone`](super::Method::TwoBone) cannot move a target's joint.
    #[error("two-bone cannot move joint {joint}: {reason}")]
    TwoBone {
        /// The target's joint.
        joint: JointId,
        /// The reason.
        reason: TwoBoneRefusal,
    },
}

/// A numeric field of [`SolverOptions`](super::SolverOptions).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OptionField {
    /// [`SolverOptions::tolerance`](super::SolverOptions::tolerance), 0 or more.
    Tolerance,
    /// [`SolverOptions::damping`](super::SolverOptions::damping), above 0.
    Damping,
    /// [`SolverOptions::step`](super::SolverOptions::step), above 0.
    Step,
}

impl OptionField {
    fn bound(self) -> &'static str {
        match self {
            Self::Tolerance => "0 or more",
            Self::Damping | Self::Step => "above 0",
        }
    }
}

/// The field's name: "tolerance", "damping" or "step".
impl fmt::Display for OptionField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Tolerance => "tolerance",
            Self::Damping => "damping",
            Self::Step => "step",
        })
    }
}

impl From<TwoBonesRefused> for SolveError {
    fn from(TwoBonesRefused { joint, reason }: TwoBonesRefused) -> Self {
        Self::TwoBone { joint, reason }
    }
}
