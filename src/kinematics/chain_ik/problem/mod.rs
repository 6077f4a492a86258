//! A skeleton in the form that solvers work on: only the joints between targets and roots, every
//! locked joint fused with its parent, lengths near 1.
//!
//! A link rotates about its pivot by E = R_z · R_y · R_x alone: the frame A of its joint is absorbed
//! into the constants around it. With G the orientation of a link in skeleton space,
//!
//! ```text
//! G = G(parent) · mount · E        base = base(parent) + G(parent) · pivot
//! ```
//!
//! Points are in skeleton space relative to the tree's origin (its root's offset), times a power of
//! two that brings the chain's length to 1 … 2, so that huge and tiny skeletons solve like others.

mod build;
mod check;
mod data;

pub(super) use build::build;
pub(super) use check::check_target;
pub(super) use data::{EndEffector, Link, Problem};
