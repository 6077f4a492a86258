//! Closed-form inverse kinematics for a limb of a skeleton: two bones with limits, between any other
//! joints.
//!
//! The lower joint turns about one axis until the tip of the lower bone is as far from the upper
//! joint as the target is (*bend*); the upper joint then turns the bent limb to the target (*aim*).
//! Everything is computed in f64 in skeleton space, from the angles that the skeleton has: the FK
//! pose.
//!
//! # Bend
//!
//! With p from the upper to the lower joint, r from the lower joint to the tip, and the unit axis â
//! of the lower joint,
//!
//! ```text
//! |p + R_â(β) r|² = |p|² + |r|² + 2 (c₀ + h cos(β − β₀))
//! c₀ = (p·â)(r·â)    c₁ = p·r − c₀    c₂ = p·(â × r)    h = hypot(c₁, c₂)    β₀ = atan2(c₂, c₁)
//! ```
//!
//! This holds for skew axes and for locked joints between the two bones. The limits of β bound the
//! reach; they take the place of |δ| and L in [soft limits](super::soft_reach).
//!
//! The axis is the free one of a hinge (a joint with two fixed angles); otherwise the normal of the
//! plane in which the limb is bent; for a straight limb, the axis about which its limits allow most.
//!
//! # Aim
//!
//! The elbow's direction from the Pointer, the axis from the upper joint to the target, is e₀ turned
//! by the twist; e₀ follows from the [`ElbowReference`].
//!
//! # What breaks
//!
//! - Limits of the upper joint, and of a lower joint that is no hinge, are applied last. The limb
//!   may then miss the target; [`LimbReach::Limited`] names the joint.
//! - Every reference but [`ElbowReference::Fk`] flips the elbow in the direction where it is
//!   singular, as for [twist references](super::twist); [`ElbowReference::Fk`] only for a target
//!   opposite to the tip of the FK pose.

mod aim;
mod bend;
mod limb;
mod solver;

pub use limb::{Limb, NoLimb};
pub use solver::{ElbowReference, LimbReach, LimbReport, LimbTarget, fk_twist, solve};
