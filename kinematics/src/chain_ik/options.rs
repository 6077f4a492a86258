use core::fmt;

use glam::Vec3;
use thiserror::Error;

use super::method::{
    Method, OrientRefusal, TwoBoneRefusal, TwoBonesRefused, balancing_methods,
    methods_with_stiffness, orienting_methods,
};
use super::problem::{Orientation, Problem};
use crate::skeleton::JointId;

/// Options of all methods.
///
/// ```
/// use ik_arm_kinematics::chain_ik::{Method, SolverOptions};
///
/// let mut options = SolverOptions::new(Method::Ccd).with_tolerance(1e-3);
/// options.iterations = Some(50);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct SolverOptions {
    /// The method.
    pub method: Method,
    /// Maximum number of iterations; `None` for the [method's default](Method::budget).
    pub iterations: Option<u32>,
    /// Distance in world units: a solver has converged if no tip is farther from its target. `None`
    /// for 1e-4 of the chain's length.
    pub tolerance: Option<f32>,
    /// Initial damping λ of damped least squares, in chain lengths.
    pub damping: f32,
    /// Step length of [`Method::TransposeFixed`], in units of 1/Σ w r², with the weights w of the
    /// targets and the distances r from joints to tips in the bind pose.
    pub step: f32,
    /// The posture rate γ of [tracking](super::ChainSolver::track): for each length of the chain by
    /// which a target moves, a step moves the joints towards the FK pose by at most this many
    /// radians, where the targets leave them free. With 0, the pose does not come back after a
    /// closed path of the targets; the higher it is, the faster joints move beside the targets.
    pub posture_rate: f32,
    /// The inputs of roots that solvers may change.
    pub root: Root,
    /// Reluctance of [free](Root::Free) roots to move when a solver divides a motion among joints,
    /// from 0 to below 1, as [`Joint::stiffness`](crate::skeleton::Joint::stiffness) for turns. At
    /// 0, a way of one chain length takes as much effort as a turn by one radian.
    pub root_stiffness: f32,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            method: Method::default(),
            iterations: None,
            tolerance: None,
            damping: 0.05,
            step: 1.0,
            posture_rate: 10.0,
            root: Root::Turns,
            root_stiffness: 0.0,
        }
    }
}

impl SolverOptions {
    /// Default options of a method.
    #[must_use]
    pub fn new(method: Method) -> Self {
        Self::default().with_method(method)
    }

    /// These options with another method.
    #[must_use]
    pub fn with_method(self, method: Method) -> Self {
        Self { method, ..self }
    }

    /// These options with a maximum number of iterations.
    #[must_use]
    pub fn with_iterations(self, iterations: u32) -> Self {
        Self { iterations: Some(iterations), ..self }
    }

    /// These options with a tolerance, in world units.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f32) -> Self {
        Self { tolerance: Some(tolerance), ..self }
    }

    /// These options with an initial damping λ, in chain lengths.
    #[must_use]
    pub fn with_damping(self, damping: f32) -> Self {
        Self { damping, ..self }
    }

    /// These options with a step length, in the units of [`Self::step`].
    #[must_use]
    pub fn with_step(self, step: f32) -> Self {
        Self { step, ..self }
    }

    /// These options with another posture rate.
    #[must_use]
    pub fn with_posture_rate(self, posture_rate: f32) -> Self {
        Self { posture_rate, ..self }
    }

    /// These options with another mobility of roots.
    #[must_use]
    pub fn with_root(self, root: Root) -> Self {
        Self { root, ..self }
    }

    /// These options with another stiffness of free roots.
    #[must_use]
    pub fn with_root_stiffness(self, root_stiffness: f32) -> Self {
        Self { root_stiffness, ..self }
    }

    pub(super) fn check(&self) -> Result<(), SolveError> {
        let is_positive = |value: f32| value.is_finite() && value > 0.0;
        let checks = [
            (OptionField::Damping, self.damping, is_positive(self.damping)),
            (OptionField::Step, self.step, is_positive(self.step)),
            (
                OptionField::PostureRate,
                self.posture_rate,
                self.posture_rate.is_finite() && self.posture_rate >= 0.0,
            ),
            (
                OptionField::RootStiffness,
                self.root_stiffness,
                (0.0..1.0).contains(&self.root_stiffness),
            ),
            (
                OptionField::Tolerance,
                self.tolerance.unwrap_or_default(),
                self.tolerance.is_none_or(|value| value.is_finite() && value >= 0.0),
            ),
        ];
        match checks.into_iter().find(|(.., is_valid)| !is_valid) {
            Some((field, value, _)) => Err(SolveError::Option { field, value }),
            None => Ok(()),
        }
    }
}

/// Mobility of roots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Root {
    /// Roots keep their angles and offsets.
    Locked,
    /// Roots rotate and keep their offsets. Files of earlier versions call it `fixed`.
    #[default]
    #[cfg_attr(feature = "serde", serde(alias = "fixed"))]
    Turns,
    /// Roots rotate, and solvers change their offsets.
    Free,
}

impl Root {
    /// All mobilities.
    pub const ALL: [Self; 3] = [Self::Locked, Self::Turns, Self::Free];
}

impl SolverOptions {
    /// Maximum number of iterations of a run.
    pub(super) fn max_iterations(&self) -> u32 {
        self.iterations.unwrap_or(self.method.budget())
    }

    /// The tolerance in world units.
    pub(super) fn tolerance_of(&self, problem: &Problem) -> f64 {
        self.tolerance.map_or(1e-4 * problem.world_length(), f64::from)
    }
}

/// A skeleton, target or option that cannot be solved.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The skeleton has no joint with the index that a target names.
    #[error("the joint of a target must be one of the skeleton, got {0}")]
    NoJoint(JointId),
    /// Two targets name the same joint and the same effector, or both a centre of mass.
    #[error("joint {0} must have one target, got more")]
    TwoTargets(JointId),
    /// A joint between a target and a root has another parent or lock than in the skeleton for
    /// which the solver was made.
    #[error("joint {0} must have the parent and the lock with which the solver was made")]
    OtherJoint(JointId),
    /// The position or the grip of a target is not finite.
    #[error("the target of joint {joint} must be finite, got {point}")]
    Point {
        /// The target's joint.
        joint: JointId,
        /// The position.
        point: Vec3,
    },
    /// The distances from a target at which it is reached are not finite, negative or swapped.
    #[error(
        "the distances of joint {joint}'s target must be finite, 0 or more and in order, got \
         {least} to {most}"
    )]
    Distances {
        /// The target's joint.
        joint: JointId,
        /// The least distance.
        least: f32,
        /// The greatest distance.
        most: f32,
    },
    /// A weight of a target is not finite or negative, or none of them is above 0.
    #[error("the weight of joint {joint}'s target must be finite and above 0, got {weight}")]
    Weight {
        /// The target's joint.
        joint: JointId,
        /// The weight.
        weight: f32,
    },
    /// An orientation is not finite, its rotation or axis is zero, or it is asked of a centre of mass.
    #[error("the orientation of joint {joint} must be finite and not zero, got {orientation:?}")]
    Orientation {
        /// The target's joint.
        joint: JointId,
        /// The orientation.
        orientation: Orientation,
    },
    /// The method cannot turn a joint to its orientation.
    #[error(
        "{method} cannot {}; {} can",
        reason.of_joint(*joint),
        orienting_methods(*reason)
    )]
    CannotOrient {
        /// The method.
        method: Method,
        /// The target's joint.
        joint: JointId,
        /// What the method cannot do.
        reason: OrientRefusal,
    },
    /// The method cannot move a centre of mass.
    #[error("{method} cannot balance a body; {} can", balancing_methods())]
    CannotBalance {
        /// The method.
        method: Method,
    },
    /// The method cannot give the joint its stiffness, or one of its own to each of its angles.
    #[error(
        "{method} cannot turn joint {joint} by {}; {} can",
        if *per_angle { "angles of different stiffness" } else { "its stiffness" },
        methods_with_stiffness(*per_angle)
    )]
    CannotStiffen {
        /// The method.
        method: Method,
        /// The joint.
        joint: JointId,
        /// True if only a different stiffness of its angles is refused.
        per_angle: bool,
    },
    /// One iteration is more work than [`ChainSolver::bounded`](super::ChainSolver::bounded)
    /// allows.
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
    /// [`SolverOptions::posture_rate`](super::SolverOptions::posture_rate), 0 or more.
    PostureRate,
    /// [`SolverOptions::root_stiffness`](super::SolverOptions::root_stiffness), 0 or more and below
    /// 1.
    RootStiffness,
}

impl OptionField {
    fn bound(self) -> &'static str {
        match self {
            Self::Tolerance | Self::PostureRate => "0 or more",
            Self::Damping | Self::Step => "above 0",
            Self::RootStiffness => "0 or more and below 1",
        }
    }
}

/// The field's name: "tolerance", "damping", "step", "posture rate" or "root stiffness".
impl fmt::Display for OptionField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Tolerance => "tolerance",
            Self::Damping => "damping",
            Self::Step => "step",
            Self::PostureRate => "posture rate",
            Self::RootStiffness => "root stiffness",
        })
    }
}

impl From<TwoBonesRefused> for SolveError {
    fn from(TwoBonesRefused { joint, reason }: TwoBonesRefused) -> Self {
        Self::TwoBone { joint, reason }
    }
}
