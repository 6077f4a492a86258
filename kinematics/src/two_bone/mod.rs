//! Closed-form inverse kinematics of two bones: position of the elbow for a position of the hand.
//!
//! ```text
//!                 elbow
//!                  o              y  Socket space: +x is the Pointer, from the
//!          upper ╱ │ ╲ lower      │  shoulder through the hand; +y is the side
//!           d₁ ╱   │ out ╲ d₂     │  the elbow is on; right-handed.
//!            ╱ θe  │ oₑ    ╲      └── x
//!  shoulder o──────┴─────────o hand ─ ─ ─ · cursor
//!            along hₑ
//!            └─── distance D ───┘
//! ```
//!
//! Everything is in Root space: the shoulder is the origin, +x right, +y up, +z towards the
//! viewer, right-handed. Lengths share any one unit; angles are radians.
//!
//! # The mathematics
//!
//! With d₁, d₂ the bone lengths, L = d₁ + d₂, δ = d₁ − d₂ and c the cursor:
//!
//! ```text
//! D  = clamp(|c|, |δ|, L)
//! a  = d₁ − hₑ = (L−D)(D−δ) / 2D                   the law of cosines, factored
//! b  = d₁ + hₑ = (L+D)(D+δ) / 2D
//! hₑ = d₁ − a if a ≤ b, else b − d₁
//! oₑ = √(min(a, b) · (d₁ + |hₑ|))
//! ```
//!
//! The elbow is computed from the cursor without arc cosine or tangent, and nothing cancels. hₑ and
//! oₑ are both computed from the smaller of a and b, so that hₑ² + oₑ² = d₁² whatever the rounding
//! of that number. The pose is therefore as exact near a straight or folded arm as anywhere else:
//! limb lengths and the hand's position are within 3e-7·L. With the textbook form,
//! hₑ = (d₁² − d₂² + D²)/2D and oₑ = √(d₁² − hₑ²), oₑ is off by 5e-4·L when the upper bone is thirty
//! times as long as the lower. The elbow itself is ill-conditioned where the arm is nearly straight
//! or folded, whatever the formula: there oₑ moves like √(L − D).
//!
//! # What breaks
//!
//! - The elbow's reference direction is the Limb frame's +y. It is singular where the Pointer is
//!   vertical: the elbow turns around when the hand passes over ±y. Where the Pointer points
//!   straight up or down, the frame takes the yaw of the previous pose ([`Pointer`]).
//! - A cursor at the shoulder has no direction: the arm keeps the direction of the previous pose.
//!
//! # Sources
//!
//! E. Palmieri, *IK-Rigging in three.js*, 2014, section 2 (hierarchy, θ_z, θ_y, θ_e); R. Juckett,
//! *Analytic Two-Bone IK in 2D*, 2008 (law of cosines); W. Kahan, *Miscalculating Area and Angles
//! of a Needle-like Triangle*, 2014 (why the products must stay factored).

mod bones;
mod closed_form;
mod pose;

pub(crate) use bones::opposite_side;
pub use bones::{Bone, LengthError, TwoBone};
pub(super) use closed_form::{ClosedForm, ScaledBones};
pub use pose::Pointer;
pub use pose::Reach;
pub use pose::TwoBonePose;
