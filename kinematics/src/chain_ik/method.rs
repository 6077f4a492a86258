use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use super::problem::{Link, Problem};

/// Method of a [`ChainSolver`](super::ChainSolver).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "String", into = "&'static str")
)]
pub enum Method {
    /// Jacobian transpose with a fixed step length.
    TransposeFixed,
    /// Jacobian transpose with a variable step length (Barzilai and Borwein).
    Transpose,
    /// Damped least squares (Levenberg–Marquardt).
    DampedLeastSquares,
    /// Cyclic coordinate descent.
    Ccd,
    /// Forward and backward reaching (FABRIK).
    #[default]
    Fabrik,
    /// Constraint relaxation: the length of each bone is restored in turn by moving both of its
    /// ends.
    Relaxation,
    /// Closed form for two joints: a target's joint and its parent.
    TwoBone,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 7] = [
        Self::TransposeFixed,
        Self::Transpose,
        Self::DampedLeastSquares,
        Self::Ccd,
        Self::Fabrik,
        Self::Relaxation,
        Self::TwoBone,
    ];

    /// Name on screen.
    pub fn title(self) -> &'static str {
        match self {
            Self::TransposeFixed => "Jacobian transpose, fixed step",
            Self::Transpose => "Jacobian transpose",
            Self::DampedLeastSquares => "Damped least squares",
            Self::Ccd => "Cyclic coordinate descent",
            Self::Fabrik => "FABRIK",
            Self::Relaxation => "Constraint relaxation",
            Self::TwoBone => "Two-bone",
        }
    }

    /// Name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::TransposeFixed => "transpose-fixed",
            Self::Transpose => "transpose",
            Self::DampedLeastSquares => "dls",
            Self::Ccd => "ccd",
            Self::Fabrik => "fabrik",
            Self::Relaxation => "relaxation",
            Self::TwoBone => "two-bone",
        }
    }

    /// Work of one iteration: the joints and the pairs of a joint and a target that it visits. Damped
    /// least squares factors a matrix with three rows for each target, too.
    pub(super) fn work(self, problem: &Problem) -> u64 {
        /// Multiplications that take as long as a visit of a joint.
        const MULTIPLICATIONS: u64 = 64;
        let visits = problem.links.len() as u64 + problem.below.len() as u64;
        match self {
            Self::Fabrik
            | Self::Relaxation
            | Self::Ccd
            | Self::Transpose
            | Self::TransposeFixed
            | Self::TwoBone => visits,
            Self::DampedLeastSquares => {
                let pairs = |link: &Link| (problem.below(link).len() as u64).pow(2);
                let rows = 3 * problem.effectors.len() as u64;
                let factor = rows.saturating_pow(3) / (3 * MULTIPLICATIONS);
                visits + problem.links.iter().map(pairs).sum::<u64>() + factor
            }
        }
    }

    /// Default maximum number of iterations of [`ChainSolver::run`](super::ChainSolver::run).
    pub fn budget(self) -> u32 {
        match self {
            Self::Fabrik | Self::Relaxation | Self::Ccd => 2_000,
            Self::Transpose | Self::DampedLeastSquares => 500,
            Self::TransposeFixed => 4_000,
            Self::TwoBone => 1,
        }
    }
}

/// Writes the [name](Method::name).
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

#[cfg(feature = "serde")]
impl TryFrom<String> for Method {
    type Error = ParseMethodError;

    fn try_from(name: String) -> Result<Self, ParseMethodError> {
        name.parse()
    }
}

#[cfg(feature = "serde")]
impl From<Method> for &'static str {
    fn from(method: Method) -> Self {
        method.name()
    }
}

/// Error for a text that is not the [name](Method::name) of a method.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("must be one of {names}, got {0:?}", names = Method::ALL.map(Method::name).join(", "))]
pub struct ParseMethodError(String);
