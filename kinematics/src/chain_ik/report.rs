use core::fmt;

use super::method::Method;

/// Progress of a solver run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Report {
    /// The method.
    pub method: Method,
    /// Number of iterations so far.
    pub iterations: u32,
    /// Largest distance from a tip to its target, in world units.
    pub error: f32,
    /// Largest turn that a joint misses, in radians; 0 without wanted orientations.
    #[cfg_attr(feature = "serde", serde(default))]
    pub orientation_error: f32,
    /// The state of the run: running, or the reason for its end.
    pub status: Status,
}

impl Report {
    /// True if the errors are within the tolerance.
    pub fn converged(&self) -> bool {
        self.status == Status::Converged
    }
}

/// State of a solver run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Status {
    /// The error is above the tolerance, and iterations are left.
    Iterating,
    /// The error is within the tolerance.
    Converged,
    /// Further iterations would change nothing: targets are out of reach, or limits prevent
    /// reaching them.
    Stalled,
    /// The maximum number of iterations has been made.
    OutOfIterations,
    /// The work that [`ChainSolver::bounded`](super::ChainSolver::bounded) allows has been done,
    /// and iterations are left.
    Bounded,
}

/// Writes the state in words: "iterating", "converged", "stalled", "out of iterations" or
/// "stopped at the bound on work".
impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Iterating => "iterating",
            Self::Converged => "converged",
            Self::Stalled => "stalled",
            Self::OutOfIterations => "out of iterations",
            Self::Bounded => "stopped at the bound on work",
        })
    }
}
