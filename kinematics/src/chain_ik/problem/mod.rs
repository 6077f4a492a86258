//! A skeleton in the form on which solvers work: it has only the joints between targets and roots,
//! every locked joint is fused with its parent, and lengths are scaled to near 1.
//!
//! A link rotates about its pivot by E = R_z · R_y · R_x alone: the frame A of its joint is
//! absorbed into the constant transforms before and after E. With G the orientation of a link in
//! skeleton space,
//!
//! ```text
//! G = G(parent) · mount · E        base = base(parent) + G(parent) · pivot
//! ```
//!
//! Points are in problem space: skeleton space relative to the tree's origin (its root's offset),
//! times a power of two that brings the chain's length to 1 … 2, so that huge and tiny skeletons
//! solve like others.

mod build;
mod data;

pub(super) use build::build;
pub(super) use build::check_target;
pub(super) use data::{EndEffector, Link, Problem};
