//! The panels beside and over the viewport.

mod arm;
pub(in crate::ui) mod crowd;
pub(in crate::ui) mod explain;
pub(in crate::ui) mod left;
mod overlays;
mod skeleton;
pub(in crate::ui) mod solver;
pub(in crate::ui) mod statistics;
