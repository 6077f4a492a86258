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
//! hₑ = (d₁² − d₂² + D²)/2D and oₑ = √(d₁² − hₑ²), oₑ is off by 5e-4·L when the upper bone is
//! thirty times as long as the lower. The elbow itself is ill-conditioned where the arm is nearly
//! straight or folded, whatever the formula: there oₑ moves like √(L − D).
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

mod closed_form;

use core::f32::consts::PI;
use core::fmt;

use glam::{Mat3, Vec2, Vec3};
use thiserror::Error;

pub(super) use closed_form::{ClosedForm, ScaledBones};

/// Two bones joined at an elbow, with the shoulder at the origin.
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::two_bone::{Reach, TwoBone};
///
/// let arm = TwoBone::new(200.0, 300.0)?;
/// let pose = arm.solve(Vec3::new(250.0, 120.0, 60.0), 0.0);
///
/// assert_eq!(pose.reach, Some(Reach::Reached));
/// assert_eq!(pose.hand, Vec3::new(250.0, 120.0, 60.0));
/// assert!((pose.elbow.length() - 200.0).abs() < 1e-4);
/// assert!((pose.elbow.distance(pose.hand) - 300.0).abs() < 1e-4);
/// # Ok::<(), ik_arm_kinematics::two_bone::LengthError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "UncheckedBones")
)]
pub struct TwoBone {
    pub(crate) upper: f32,
    pub(crate) lower: f32,
}

/// One of the two bones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Bone {
    /// From shoulder to elbow.
    Upper,
    /// From elbow to hand.
    Lower,
}

/// An invalid bone length.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{bone} length must be finite and above 0, got {value}")]
pub struct LengthError {
    /// The bone with the invalid length.
    pub bone: Bone,
    /// The refused length.
    pub value: f32,
}

impl Default for TwoBone {
    /// The bones of the arm of E. Palmieri's report (2014).
    fn default() -> Self {
        Self { upper: 200.0, lower: 300.0 }
    }
}

impl TwoBone {
    /// Two bones of finite lengths above 0.
    ///
    /// # Errors
    ///
    /// [`LengthError`] for the first invalid length.
    pub fn new(upper: f32, lower: f32) -> Result<Self, LengthError> {
        for (bone, value) in [(Bone::Upper, upper), (Bone::Lower, lower)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(LengthError { bone, value });
            }
        }
        Ok(Self { upper, lower })
    }

    /// Length d₁ from shoulder to elbow.
    pub fn upper(self) -> f32 {
        self.upper
    }

    /// Length d₂ from elbow to hand.
    pub fn lower(self) -> f32 {
        self.lower
    }

    /// The bones scaled by `factor`, with lengths of at most `f32::MAX`. The bones are unchanged if
    /// `factor` is NaN or a scaled length is not above 0.
    #[must_use]
    pub fn stretched(self, factor: f32) -> Self {
        if factor.is_nan() {
            return self;
        }
        let length = |length: f32| (length * factor).min(f32::MAX);
        Self::new(length(self.upper), length(self.lower)).unwrap_or(self)
    }

    /// L = d₁ + d₂, the hand's maximum distance (`f32::MAX` if the sum overflows).
    pub fn outer_limit(self) -> f32 {
        (self.upper + self.lower).min(f32::MAX)
    }

    /// |δ| = |d₁ − d₂|, the hand's minimum distance.
    pub fn inner_limit(self) -> f32 {
        (self.upper - self.lower).abs()
    }

    /// Distance of the hand from the shoulder if the elbow's inner angle is `elbow_angle` (φ,
    /// radians, from 0 to π).
    pub(crate) fn distance_at(self, elbow_angle: f64) -> f64 {
        opposite_side(f64::from(self.upper), f64::from(self.lower), elbow_angle)
    }
}

/// Length of the side of a triangle opposite to the angle (radians, from 0 to π) between two sides.
pub(crate) fn opposite_side(one: f64, other: f64, angle: f64) -> f64 {
    let (least, most) = ((one - other).abs(), one + other);
    // (a − b)² + 2 a b (1 − cos φ), which does not cancel.
    let half = (0.5 * angle).sin();
    let side = (least * least + 4.0 * one * other * half * half).sqrt();
    least.max(side).min(most)
}

impl fmt::Display for Bone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Upper => "upper",
            Self::Lower => "lower",
        })
    }
}

/// Direction and yaw of the Pointer, the axis from the shoulder through the hand. A caller keeps it
/// from one pose to the next: it supplies the direction for a cursor at the shoulder, and the yaw
/// for a cursor straight above or below the shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pointer {
    /// Unit vector ŵ from the shoulder to the hand.
    pub direction: Vec3,
    /// Cosine and sine of the yaw θ_z: the (x, z) part of the direction, normalised.
    pub heading: Vec2,
}

impl Default for Pointer {
    /// A Pointer along +x of Root space.
    fn default() -> Self {
        Self { direction: Vec3::X, heading: Vec2::X }
    }
}

impl Pointer {
    /// The rotation of the Limb frame, R_y(−θ_z)·R_z(θ_y): +x is along the Pointer, +y is the side
    /// of the elbow at ψ = 0, and +z is horizontal.
    #[inline(always)]
    #[must_use]
    pub fn limb_frame(self) -> Mat3 {
        let Vec2 { x: cos_yaw, y: sin_yaw } = self.heading;
        let sin_pitch = self.direction.y;
        let cos_pitch = self.direction.x * cos_yaw + self.direction.z * sin_yaw;
        Mat3::from_cols(
            self.direction,
            Vec3::new(-sin_pitch * cos_yaw, cos_pitch, -sin_pitch * sin_yaw),
            Vec3::new(-sin_yaw, 0.0, cos_yaw),
        )
    }
}

/// True if the hand reaches the cursor, and which limit prevents it if not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Reach {
    /// The hand is at the cursor: bit for bit with hard limits, within 1e-6·L with soft limits.
    Reached,
    /// The hand is nearer to the shoulder than the cursor. With hard limits, the cursor is beyond
    /// the outer limit L: the arm is straight and points at the cursor.
    TooFar,
    /// The hand is farther from the shoulder than the cursor. With hard limits, the cursor is
    /// inside the inner limit |δ|: the arm is folded and points at the cursor.
    TooClose,
}

/// A posed arm, in Root space. All fields are computed from the same hand distance D.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TwoBonePose {
    /// Position of the elbow.
    pub elbow: Vec3,
    /// Position of the hand. With hard limits it is the cursor if that is reached, otherwise a
    /// point on a limit sphere.
    pub hand: Vec3,
    /// True if the hand reaches the cursor; `None` for a pose without a cursor, such as one made
    /// from joint angles.
    pub reach: Option<Reach>,
    /// D, the distance from shoulder to hand.
    pub distance: f32,
    /// h_e, the elbow's x in Socket space, along the Pointer; negative when the lower bone reaches
    /// back past the shoulder.
    pub along: f32,
    /// o_e ≥ 0, the elbow's y in Socket space: its distance from the Pointer.
    pub out: f32,
    /// Angle about the Pointer from the Limb frame's +y to the elbow, radians: the Socket's
    /// rotation ψ_ref + ψ.
    pub twist: f32,
    /// Factor by which the bones are lengthened; 1 without stretch.
    pub stretch: f32,
    /// Direction and yaw of the Pointer. Pass it to the next
    /// [`TwoBone::solve_from`].
    pub pointer: Pointer,
}

impl TwoBonePose {
    /// θ_z, the Pointer's angle about −y from +x: `atan2(z, x)`, in [−π, π].
    pub fn yaw(&self) -> f32 {
        self.pointer.heading.y.atan2(self.pointer.heading.x)
    }

    /// θ_y, the Pointer's angle above the xz-plane: `atan2(y, hypot(x, z))`, in [−π/2, π/2].
    pub fn pitch(&self) -> f32 {
        let Vec3 { x, y, z } = self.pointer.direction;
        y.atan2(x.hypot(z))
    }

    /// Unit vector perpendicular to the Pointer, on the side of the elbow; defined for a straight
    /// or folded arm, too.
    pub fn outward(&self) -> Vec3 {
        let limb = self.pointer.limb_frame();
        let (sin, cos) = self.twist.sin_cos();
        limb.y_axis * cos + limb.z_axis * sin
    }

    /// Angle about this pose's Pointer from this elbow to the elbow of `other`, in (−π, π].
    pub fn elbow_turn_to(&self, other: &Self) -> f32 {
        let (w, from, to) = (self.pointer.direction, self.outward(), other.outward());
        w.dot(from.cross(to)).atan2(from.dot(to))
    }

    /// θ_e, the angle at the shoulder between the Pointer and the upper bone, in [0, π].
    pub fn shoulder_angle(&self) -> f32 {
        self.out.atan2(self.along)
    }

    /// φ, the inner angle at the elbow, in [0, π]: π for a straight arm, 0 for a folded one.
    pub fn elbow_angle(&self) -> f32 {
        let at_hand = self.out.atan2(self.distance - self.along);
        PI - self.shoulder_angle() - at_hand
    }
}

/// Deserialized lengths, not yet checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct UncheckedBones {
    upper: f32,
    lower: f32,
}

#[cfg(feature = "serde")]
impl TryFrom<UncheckedBones> for TwoBone {
    type Error = LengthError;

    fn try_from(UncheckedBones { upper, lower }: UncheckedBones) -> Result<Self, LengthError> {
        Self::new(upper, lower)
    }
}
