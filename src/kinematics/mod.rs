//! Pure numbers: solvers that know nothing of files, windows or GPUs.

mod arc;
pub mod batch;
mod direction;
pub mod euler;
pub mod fk;
pub mod follow;
pub mod ik;
pub mod job;
pub mod pop;
pub mod reach;
pub mod skeleton;
pub mod solve;
pub mod spline;
pub mod swivel;
pub mod two_bone;

pub(crate) use arc::arc;
pub(crate) use direction::direction;
