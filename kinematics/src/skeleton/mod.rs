//! Joint trees with Euler angles, and their forward kinematics.
//!
//! A skeleton is a forest of joints, in which parents precede their children. A joint is a ball
//! joint with one bone:
//!
//! ```text
//!   parent's base        base                     tip
//!        o──── offset ────o════════ axis ══════════o      all in the joint's own space, which is
//!                                                         its parent's, translated by the offset
//!                                                         and rotated by R
//! R          = A · R_z(r_z) · R_y(r_y) · R_x(r_x) · Aᵀ     x is applied first
//! X(joint)   = X(parent) · T(offset) · R                   full transform
//! base       = X · (0, 0, 0)          tip = X · axis
//! ```
//!
//! A is a fixed orthonormal frame in which the angles are measured. The skeleton's own transform
//! maps skeleton space to the world and may mirror and scale. The bind pose is the skeleton as
//! built, before any rotation.
//!
//! # Euler order
//!
//! x is applied first, then y, then z, about axes that do not turn with the joint; equivalently z
//! first, then y, then x, about axes that do. With A = 1, R = R_z·R_y·R_x. This is the order of
//! Scotty3D's present code; the formula on the wiki page below is not preserved.
//!
//! # Roots
//!
//! A root is a joint without a parent; its offset is its position in skeleton space. A root
//! whose joint is `locked` keeps its angles. What else solvers do with roots is one of three modes
//! ([`chain_ik::Root`](super::chain_ik::Root)): locked, turns (the default) or free to move too.
//! [`Skeleton::with_root`] starts with a locked root without a bone. A js3d file locks no joint, so
//! that by default its roots turn but do not move.
//!
//! # Units
//!
//! Angles are radians. Offsets, axes and radii are in skeleton units; positions in the world are in
//! world units.
//!
//! # Source
//!
//! *Skeleton Kinematics*, wiki of Scotty3D (CMU 15-462), task 2a.

mod balance;
mod cone;
mod edit;
pub mod exact_angles;
mod joint;
mod joint_angles;
mod limit;
mod limit_border;
mod limits;
mod pose;
mod skin_stretch;
mod tree;

pub use balance::Balance;
pub use cone::Cone;
pub use joint::{Joint, JointField, JointId, JointRemap, SkeletonError};
pub use joint_angles::nearest_angles;
pub use limit::{Extreme, Limit, LimitEnd, RotationAxis, SwingAxis};
pub use limits::JointLimits;
pub use pose::{SkeletonPose, is_within_numbers};
pub use skin_stretch::SkinStretch;
pub use tree::Skeleton;

pub(crate) use balance::{bone_masses, centre_of_mass_below};
pub(crate) use joint::AnglesWithin;
pub(crate) use joint_angles::{JointAngles, angle_triples, equivalent_triples};
