//! Why a tip is not at its target, and what would bring it there.
//!
//! A [`Diagnosis`] names a [`Cause`] and the joints concerned. Its remedies have been tried: each is
//! told with the residual that it leaves. [`chain_ik::diagnose`](super::chain_ik::diagnose) finds the
//! causes for the solvers of chains; [`SkeletonRig::diagnose`](crate::rig::SkeletonRig::diagnose)
//! adds those of limbs and of targets that share a pose with FK.

mod cause;
#[expect(clippy::module_inception, reason = "the type Diagnosis, in the file of its name")]
mod diagnosis;
mod remedy;

pub use cause::{Boundary, Cause};
pub(crate) use diagnosis::in_turn;
pub use diagnosis::{Diagnosis, TriedRemedy};
pub(crate) use remedy::{Angle, is_fixed, limited_angles, remove_limits, widen_to_contain};
pub use remedy::{Remedy, Start, WidenedLimit};
