use core::fmt;

use super::Method;

/// Progress of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Report {
    /// The method.
    pub method: Method,
    /// Number of iterations so far.
    pub iterations: u32,
    /// Largest distance from a tip to its target, in the world.
    pub error: f32,
    /// Whether and why the solve has ended.
    pub status: Status,
}

impl Report {
    /// Whether the error is within the tolerance.
    pub fn converged(&self) -> bool {
        self.status == Status::Converged
    }
}

/// State of a solve.
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
    /// Further iterations change nothing: targets are out of reach, or limits prevent reaching them.
    Stalled,
    /// The maximum number of iterations is made.
    OutOfIterations,
}

/// In words: "iterating", "converged", "stalled" or "out of iterations".
impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Iterating => "iterating",
            Self::Converged => "converged",
            Self::Stalled => "stalled",
            Self::OutOfIterations => "out of iterations",
        })
    }
}
