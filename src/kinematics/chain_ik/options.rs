use core::fmt;
use core::str::FromStr;

use glam::Vec3;
use thiserror::Error;

use crate::kinematics::skeleton::JointId;

/// Solver method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Jacobian transpose with a fixed step length.
    TransposeFixed,
    /// Jacobian transpose with a line search.
    Transpose,
    /// Damped least squares (Levenberg–Marquardt).
    DampedLeastSquares,
    /// Cyclic coordinate descent.
    Ccd,
    /// Forward and backward reaching (FABRIK).
    #[default]
    Fabrik,
    /// Closed form for a target's joint and its parent.
    TwoBone,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 6] = [
        Self::TransposeFixed,
        Self::Transpose,
        Self::DampedLeastSquares,
        Self::Ccd,
        Self::Fabrik,
        Self::TwoBone,
    ];

    /// Name on the command line and in files.
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

    /// Default maximum number of iterations of [`ChainSolver::run`](super::ChainSolver::run).
    pub fn budget(self) -> u32 {
        match self {
            Self::Fabrik | Self::Ccd => 2_000,
            Self::TransposeFixed | Self::Transpose | Self::DampedLeastSquares => 500,
            Self::TwoBone => 1,
        }
    }
}

/// The [name](Method::name).
impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Reads a [name](Method::name).
impl FromStr for Method {
    type Err = ParseMethodError;

    fn from_str(name: &str) -> Result<Self, ParseMethodError> {
        let found = Self::ALL.into_iter().find(|method| method.name() == name);
        found.ok_or_else(|| ParseMethodError(name.to_owned()))
    }
}

/// A text that is not the [name](Method::name) of a method.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("must be one of {names}, got {0:?}", names = Method::ALL.map(Method::name).join(", "))]
pub struct ParseMethodError(String);

/// A target for the tip of a joint's bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipTarget {
    /// The joint whose tip is to reach the target.
    pub joint: JointId,
    /// Position in the world.
    pub point: Vec3,
    /// Weight relative to other targets, above 0.
    pub weight: f32,
}

/// Options of all methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverOptions {
    /// The method.
    pub method: Method,
    /// Maximum number of iterations; `None` for the [method's default](Method::budget).
    pub iterations: Option<u32>,
    /// Maximum distance from any tip to its target in the world when converged; `None` for 1e-4 of the
    /// chain's length.
    pub tolerance: Option<f32>,
    /// Damping λ of damped least squares, in chain lengths.
    pub damping: f32,
    /// Step length of [`Method::TransposeFixed`], in units of 1/Σr².
    pub step: f32,
    /// Whether roots move.
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

/// Mobility of roots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Root {
    /// Roots keep their offsets.
    #[default]
    Fixed,
    /// Solvers change the offsets of roots.
    Free,
}

/// Progress of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// The method.
    pub method: Method,
    /// Number of iterations so far.
    pub iterations: u32,
    /// Largest distance from a tip to its target, in the world.
    pub error: f32,
    /// Whether the error is within the tolerance.
    pub converged: bool,
    /// Whether the solve has stalled: further iterations change nothing, because targets are out of
    /// reach or limits prevent reaching them.
    pub resting: bool,
}

/// An invalid skeleton, target or option.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
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
