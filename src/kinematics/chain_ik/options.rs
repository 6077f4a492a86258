use glam::Vec3;
use thiserror::Error;

use crate::kinematics::skeleton::JointId;

/// How the joints are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Gradient descent by the Jacobian's transpose with one step length throughout.
    TransposeFixed,
    /// The same with a step length that is searched for.
    Transpose,
    /// DampedLeastSquares least squares.
    DampedLeastSquares,
    /// Cyclic coordinate descent.
    Ccd,
    /// Constraint relaxation, forward and backward.
    #[default]
    Fabrik,
    /// Closed form, for a target's joint and its parent.
    TwoBone,
}

impl Method {
    pub const ALL: [Self; 6] = [
        Self::TransposeFixed,
        Self::Transpose,
        Self::DampedLeastSquares,
        Self::Ccd,
        Self::Fabrik,
        Self::TwoBone,
    ];

    /// As the command line and files have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::TransposeFixed => "transpose-fixed",
            Self::Transpose => "transpose",
            Self::DampedLeastSquares => "dls",
            Self::Ccd => "ccd",
            Self::Fabrik => "fabrik",
            Self::TwoBone => "two-bone",
        }
    }

    /// After how many iterations [`ChainSolver::run`](super::ChainSolver::run) gives up, unless asked otherwise.
    pub fn budget(self) -> u32 {
        match self {
            Self::Fabrik | Self::Ccd => 2_000,
            Self::TransposeFixed | Self::Transpose | Self::DampedLeastSquares => 500,
            Self::TwoBone => 1,
        }
    }
}

/// Where the tip of a joint's bone is asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipTarget {
    pub joint: JointId,
    /// In the world.
    pub point: Vec3,
    /// How much it counts beside other targets; above 0.
    pub weight: f32,
}

/// What every method is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverOptions {
    pub method: Method,
    /// At most so many; the method's [budget](Method::budget) if nothing is said.
    pub iterations: Option<u32>,
    /// How near every tip must come to its target, in the world; 1e-4 of the chain's length if
    /// nothing is said.
    pub tolerance: Option<f32>,
    /// λ of damped least squares, in chain lengths.
    pub damping: f32,
    /// The step of the fixed Jacobian transpose, in parts of 1/Σr².
    pub step: f32,
    pub root: Root,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            method: Method::default(),
            iterations: None,
            tolerance: None,
            damping: 0.05,
            step: 1.0,
            root: Root::Fixed,
        }
    }
}

/// Whether roots may move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Root {
    #[default]
    Fixed,
    /// Roots move (their offsets change) as a snake's head does.
    Free,
}

/// How a solve stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    pub method: Method,
    pub iterations: u32,
    /// The largest distance between a tip and its target, in the world.
    pub error: f32,
    /// Whether that is within the tolerance.
    pub converged: bool,
    /// Whether further iterations would change nothing: the targets are out of reach, or a limit
    /// is in the way.
    pub resting: bool,
}

/// What cannot be solved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolveError {
    #[error("there is no joint {0} to bring to a target")]
    NoJoint(JointId),
    #[error("joint {0} has more than one target")]
    TwoTargets(JointId),
    #[error("the target of joint {joint} is at {point}; it must be finite numbers")]
    Point { joint: JointId, point: Vec3 },
    #[error("the weight of joint {joint}'s target is {weight}; it must be a finite number above 0")]
    Weight { joint: JointId, weight: f32 },
    #[error("{field} is {value}; it must be a finite number {bound}")]
    Option { field: &'static str, value: f32, bound: &'static str },
    #[error("the skeleton's transform flattens space; targets cannot be brought into it")]
    Flat,
    #[error("two-bone cannot move joint {joint}: {reason}")]
    TwoBone { joint: JointId, reason: &'static str },
}

impl SolverOptions {
    pub(super) fn check(&self) -> Result<(), SolveError> {
        let refuse = |field, value, bound| Err(SolveError::Option { field, value, bound });
        for (field, value) in [("damping", self.damping), ("step", self.step)] {
            if !(value.is_finite() && value > 0.0) {
                return refuse(field, value, "above 0");
            }
        }
        match self.tolerance {
            Some(value) if !(value.is_finite() && value >= 0.0) => {
                refuse("tolerance", value, "that is 0 or more")
            }
            _ => Ok(()),
        }
    }
}
