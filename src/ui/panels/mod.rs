//! The panels beside and over the viewport.

mod arm;
pub(in crate::ui) mod crowd;
mod explain;
pub(in crate::ui) mod left;
mod overlays;
pub(in crate::ui) mod right;
mod skeleton;
mod solver;
pub(in crate::ui) mod statistics;
