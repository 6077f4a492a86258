use thiserror::Error;

/// Arrays of a batch that differ in length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{array} has {len} numbers; target.x has {limbs}, and there must be as many")]
pub struct LenError {
    /// Path of the array in [`JobInputs`](super::JobInputs) or [`JobOutputs`](super::JobOutputs),
    /// such as `start.x_axis.y`.
    pub array: &'static str,
    /// Length of the array.
    pub len: usize,
    /// Number of limbs, the length of `target.x`.
    pub limbs: usize,
}
