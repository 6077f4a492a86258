//! Twist references: directions from which the twist angle ψ of the elbow is measured.
//!
//! ŵ is the Pointer's direction. A reference gives a unit vector e₀ ⟂ ŵ; the elbow is on the side
//!
//! ```text
//! e = cos ψ e₀ + sin ψ (ŵ × e₀)
//! ```
//!
//! Everything is in Root space, right-handed; angles are radians.
//!
//! # What breaks
//!
//! No choice of e₀ that depends on ŵ alone is smooth for every ŵ (a hair on a ball cannot be combed
//! flat). References differ in where they are singular and in how far around the singularity e₀
//! still rotates fast. The gain g measures that: radians by which e₀ rotates against a
//! parallel-transported direction, per radian of rotation of the Pointer. The table gives the
//! maximum of g, which is reached by a rotation of the Pointer across the direction to the
//! singularity. θ_y is the Pointer's pitch, p the pole; R is the singular direction of the
//! [`Stereographic`] map and V its up direction.
//!
//! | reference | e₀ | singular at | gain |
//! | --- | --- | --- | --- |
//! | [`TwistReference::Up`] | the Limb frame's +y | ŵ = ±y | \|tan θ_y\| |
//! | [`TwistReference::Pole`] p | component of p perpendicular to ŵ, normalised | ŵ ∥ p | \|cot ∠(ŵ, p)\| |
//! | [`TwistReference::Stereographic`] | k × ŵ normalised, k = (ŵ − R) × V | ŵ = R | tan(½ ∠(ŵ, −R)) |
//! | [`TwistReference::Transport`] | the previous e₀, parallel-transported | none | 0 |
//!
//! Parallel transport around a closed loop returns e₀ rotated by the solid angle of the loop (its
//! holonomy). So transport suits a live drag, and keys are measured from another reference.
//!
//! # Sources
//!
//! A. Elias, J. Wen, *Redundancy parameterization and inverse kinematics of 7-DOF revolute
//! manipulators*, arXiv 2307.13122, 2023 (stereographic swivel angle); E. Palmieri, *IK-Rigging in
//! three.js*, 2014 (up as reference).

mod reference;
mod stereographic;

pub use reference::TwistReference;
pub use reference::{TwistReferenceKind, UnknownTwistReference};
pub use reference::{angle_from_limb, remeasured};
pub use stereographic::Stereographic;
pub use stereographic::TransportedFrame;
