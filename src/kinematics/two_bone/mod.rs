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
//! No arc cosine and no tangent stands between the cursor and the elbow, and nothing cancels. hₑ and
//! oₑ come from the same one of a and b, the smaller, so hₑ² + oₑ² = d₁² whatever its rounding. So
//! the pose is as exact near a straight or folded arm as anywhere else: limb lengths and hand hold
//! to 3e-7·L. The textbook form (d₁² − d₂² + D²)/2D misses by 3e-4·L when one bone is thirty times
//! the other. The elbow itself is ill-conditioned where the arm is nearly straight or folded,
//! whatever the formula: there oₑ moves like √(L − D).
//!
//! # What breaks
//!
//! - The elbow's reference direction is the Limb frame's +y, as in the seed. It is singular where
//!   the Pointer is vertical: a hand that passes over ±y turns the elbow around. Straight up or
//!   down the frame's yaw is the caller's last one ([`Facing`]).
//! - A cursor at the shoulder has no direction; it takes the caller's last one.
//!
//! # Sources
//!
//! E. Palmieri, *IK-Rigging in three.js*, 2014, section 2 (hierarchy, θ_z, θ_y, θ_e); R. Juckett,
//! *Analytic Two-Bone IK in 2D*, 2008 (law of cosines); W. Kahan, *Miscalculating Area and Angles
//! of a Needle-like Triangle*, 2014 (why the products must stay factored).

mod closed_form;

use core::f32::consts::PI;

use glam::{Mat3, Vec2, Vec3};
use thiserror::Error;

use closed_form::Sight;
pub(super) use closed_form::{Placed, Scaled};

/// Two bones joined at an elbow, with the shoulder at the origin.
///
/// ```
/// use glam::Vec3;
/// use ik_arm::kinematics::two_bone::{Reach, TwoBone};
///
/// let arm = TwoBone::new(200.0, 300.0)?;
/// let pose = arm.solve(Vec3::new(250.0, 120.0, 60.0), 0.0);
///
/// assert_eq!(pose.reach, Reach::Reached);
/// assert_eq!(pose.hand, Vec3::new(250.0, 120.0, 60.0));
/// assert!((pose.elbow.length() - 200.0).abs() < 1e-4);
/// assert!((pose.elbow.distance(pose.hand) - 300.0).abs() < 1e-4);
/// # Ok::<(), ik_arm::kinematics::two_bone::LengthError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBone {
    pub(super) upper: f32,
    pub(super) lower: f32,
}

/// An invalid bone length.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{bone} length is {value}; it must be a finite number above 0")]
pub struct LengthError {
    /// Which bone: `"upper"` or `"lower"`.
    pub bone: &'static str,
    /// The refused length.
    pub value: f32,
}

/// Position of the hand relative to the cursor, by the limit that prevents reaching it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// The hand is the cursor, bit for bit; where it is softened, within 1e-6·L.
    Reached,
    /// The cursor is beyond the outer limit L: the arm is straight and points at it.
    TooFar,
    /// The cursor is inside the inner limit |δ|: the arm is folded and points at it.
    TooClose,
}

/// Direction and yaw of the Pointer. A caller keeps it from one pose to the next to resolve a cursor
/// without a direction (at the shoulder) or without a yaw (straight above or below it).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// Unit vector from the shoulder to the hand: the Pointer, ŵ.
    pub direction: Vec3,
    /// Cosine and sine of the yaw θ_z: the direction seen from above, as (x, z), of unit length.
    pub heading: Vec2,
}

/// A solved arm, in Root space. The same D feeds every field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBonePose {
    /// Position of the elbow.
    pub elbow: Vec3,
    /// Position of the hand: the cursor when it is [`Reach::Reached`], else on a limit sphere.
    pub hand: Vec3,
    /// Whether the hand is at the cursor.
    pub reach: Reach,
    /// D, from shoulder to hand.
    pub distance: f32,
    /// h_e, the elbow's x in Socket space, along the Pointer; negative when the lower bone reaches
    /// back past the shoulder.
    pub along: f32,
    /// o_e ≥ 0, the elbow's y in Socket space: its distance from the Pointer.
    pub out: f32,
    /// Angle about the Pointer from the Limb frame's +y to the elbow, radians: the Socket's rotation
    /// ψ_ref + ψ.
    pub spin: f32,
    /// Factor by which the bones are lengthened; 1 without stretch.
    pub stretch: f32,
    /// The Pointer's direction and heading. Keep it for the next [`TwoBone::solve_from`].
    pub facing: Facing,
}

impl TwoBone {
    /// Two bones of finite lengths above 0.
    ///
    /// # Errors
    ///
    /// [`LengthError`] for the first invalid length.
    pub fn new(upper: f32, lower: f32) -> Result<Self, LengthError> {
        for (bone, value) in [("upper", upper), ("lower", lower)] {
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

    /// The bones scaled by `factor`, clamped to finite lengths; unchanged for an invalid factor.
    #[must_use]
    pub fn stretched(self, factor: f32) -> Self {
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

    /// Poses the hand at `cursor` (Root space) with the elbow turned by `twist` (ψ, radians,
    /// right-handed about the Pointer) from the Limb frame's +y.
    ///
    /// A cursor without a direction takes [`Facing::default`]; see [`Self::solve_from`].
    ///
    /// # Panics
    ///
    /// In debug builds, if an argument is not finite; in release builds the pose is then
    /// meaningless. Callers check numbers where they enter the program.
    pub fn solve(self, cursor: Vec3, twist: f32) -> TwoBonePose {
        self.solve_from(cursor, twist, Facing::default())
    }

    /// As [`Self::solve`], with the previous pose's [`Facing`] for a cursor at the shoulder (direction)
    /// or straight above or below it (yaw).
    pub fn solve_from(self, cursor: Vec3, twist: f32, last: Facing) -> TwoBonePose {
        debug_assert!(cursor.is_finite(), "cursor is {cursor}");
        debug_assert!(twist.is_finite(), "twist is {twist}");
        let (sin, cos) = twist.sin_cos();
        let placed = Placed::new::<true>(self, cursor, cos, sin, last);
        TwoBonePose { hand: placed.hand_of(cursor), ..placed.pose(twist) }
    }

    /// The pose with the hand at `distance`, clamped to the limits, in the direction of `facing`. Its
    /// reach is always [`Reach::Reached`].
    ///
    /// # Panics
    ///
    /// As [`Self::solve`].
    pub fn solve_at(self, facing: Facing, distance: f32, twist: f32) -> TwoBonePose {
        debug_assert!(distance.is_finite(), "distance is {distance}");
        debug_assert!(twist.is_finite(), "twist is {twist}");
        let (sin, cos) = twist.sin_cos();
        let scaled = Scaled::new(self);
        let placed = Placed::at::<true>(scaled, facing, distance * scaled.scale, cos, sin);
        TwoBonePose { reach: Reach::Reached, ..placed.pose(twist) }
    }
}

impl TwoBonePose {
    /// θ_z, the Pointer's angle about −y from +x: `atan2(z, x)`, in [−π, π].
    pub fn yaw(&self) -> f32 {
        self.facing.heading.y.atan2(self.facing.heading.x)
    }

    /// θ_y, the Pointer's angle above the xz-plane: `atan2(y, h_c)`, in [−π/2, π/2].
    pub fn pitch(&self) -> f32 {
        let Vec3 { x, y, z } = self.facing.direction;
        y.atan2(x.hypot(z))
    }

    /// Unit vector perpendicular to the Pointer towards the elbow; defined for a straight or folded arm
    /// too.
    pub fn outward(&self) -> Vec3 {
        let limb = self.facing.limb_frame();
        let (sin, cos) = self.spin.sin_cos();
        limb.y_axis * cos + limb.z_axis * sin
    }

    /// Angle about this pose's Pointer from its elbow to another pose's, in (−π, π].
    pub fn elbow_turn_to(&self, other: &Self) -> f32 {
        let (w, from, to) = (self.facing.direction, self.outward(), other.outward());
        w.dot(from.cross(to)).atan2(from.dot(to))
    }

    /// θ_e, the angle at the shoulder between Pointer and upper bone, in [0, π].
    pub fn shoulder_angle(&self) -> f32 {
        self.out.atan2(self.along)
    }

    /// φ, the inner angle at the elbow: π straight, 0 folded.
    pub fn elbow_angle(&self) -> f32 {
        let at_hand = self.out.atan2(self.distance - self.along);
        PI - self.shoulder_angle() - at_hand
    }
}

impl Default for Facing {
    /// Along Root's +x.
    fn default() -> Self {
        Self { direction: Vec3::X, heading: Vec2::X }
    }
}

impl Facing {
    /// Direction and heading of the cursor. A cursor at the shoulder keeps the last direction, one
    /// straight above or below it the last heading.
    pub fn towards(cursor: Vec3, last: Self) -> Self {
        Sight::new::<true>(cursor, last).facing
    }

    /// The Limb's rotation, R_y(−θ_z)·R_z(θ_y): its +x is the Pointer, its +y the side of
    /// the elbow at ψ = 0, its +z horizontal.
    #[inline(always)]
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
