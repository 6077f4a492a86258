//! The fast path: corrections in straight-line code, with no call, no loop, and no branch that a
//! compiler cannot turn into a select, so that [`batch`](super::batch) can vectorise it.
//!
//! It solves jobs without softness, with a weight of 1, that are *regular*: the limb is bent, no
//! bone is negligible, the hand is away from the start joint, the rotations are not near half a
//! turn, and no number overflows. [`Solved::is_regular`] tells. All other jobs are solved by
//! [`stages`](super::stages).
//!
//! Vectors are in start joint space *times det M_s* (`_ds`): M_s⁻¹ is the adjugate of M_s divided
//! by det M_s, and since only ratios of lengths count, nothing has to be divided. Under a negative
//! det M_s these vectors are reflected at the start joint. Rotations and cross products are those
//! of start joint space all the same; only a turn about a reflected vector changes its sense.

mod joint_axes;
mod limb;

use glam::{DMat3, DQuat, DVec3};

use self::joint_axes::{MiddleAxes, StartAxes, sign};
use self::limb::FastLimb;
use crate::two_bone::Reach;

pub(super) use joint_axes::cofactors;
pub(super) use limb::{
    HalfAngle, IN_LINE, NEAR_HALF_TURN, ON_LINE, OPPOSITE, least_rotation, rotation_between, side,
};

/// A job without softness, with a weight of 1. Whether it is regular, too, is a result:
/// [`Solved::is_regular`].
#[derive(Clone, Copy)]
pub struct FastPathJob {
    /// M_s and M_m, as columns.
    pub axes: [DMat3; 2],
    /// Positions of the start, middle and end joint.
    pub joints: [DVec3; 3],
    pub target: DVec3,
    /// Not used without `POLE`.
    pub pole: DVec3,
    /// 0 for none.
    pub hinge: DVec3,
    /// Sine and cosine of the twist.
    pub twist: [f64; 2],
}

impl FastPathJob {
    #[inline(always)]
    pub fn solve<const POLE: bool>(&self) -> Solved {
        let [start_axes, middle_axes] = self.axes;
        let start = StartAxes::new(start_axes);
        let middle = MiddleAxes::new(start.adjugate * middle_axes);
        let limb = FastLimb::new(self.joints, self.target, &start);
        let bent = limb.bend(middle.axis(self.hinge));

        let [sin, cos] = self.twist;
        let twist = [sin * sign(start.determinant), cos];
        let (start_turn, is_aimed) = if POLE {
            bent.aim_by_pole(&limb, start.adjugate * self.pole, twist)
        } else {
            bent.aim(&limb, twist)
        };
        let middle_turn = bent.half_turn.about(middle.to_middle_space(bent.axis));
        let corrections = [rounded(start_turn), rounded(middle_turn)];
        let solved = self.measure(corrections, &start, &middle, &limb);
        let is_regular = start.is_regular & middle.is_regular & bent.is_regular & is_aimed;
        Solved { is_regular: is_regular & solved.is_regular, ..solved }
    }

    /// The corrections with the reach that these rounded rotations give.
    #[inline(always)]
    fn measure(
        &self,
        corrections: [[f32; 4]; 2],
        start: &StartAxes,
        middle: &MiddleAxes,
        limb: &FastLimb,
    ) -> Solved {
        let [start_correction, middle_correction] = corrections;
        let (start_turn, middle_turn) = (widened(start_correction), widened(middle_correction));
        let lower_ms = middle.cofactors.transpose_mul_vec3(limb.lower_ds) * middle.inv_determinant;
        let lower_ds = middle.axes_ds * (middle_turn * lower_ms);
        let hand_ds = start_turn * (limb.upper_ds + lower_ds);
        let off_ds = hand_ds - limb.target_ds;
        let length = limb.upper + limb.lower;
        let near = NEAR * length;
        let is_near = off_ds.length_squared() <= near * near;
        let left = (limb.target - limb.distance).abs();
        let [start_axes, _] = self.axes;
        let hand_error = (start_axes * off_ds).length() * start.inv_determinant.abs();
        Solved {
            start_correction,
            middle_correction,
            is_reached: is_near & (left <= AT_LIMIT * length),
            is_too_close: hand_ds.length_squared() > limb.target * limb.target,
            hand_error: hand_error as f32,
            is_regular: hand_error < f64::from(f32::MAX),
        }
    }
}

/// The quaternion (x, y, z, w) with w ≥ 0 of a rotation.
#[inline(always)]
fn rounded(turn: DQuat) -> [f32; 4] {
    let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
    let DQuat { x, y, z, w } = turn;
    [(x * sign) as f32, (y * sign) as f32, (z * sign) as f32, (w * sign) as f32]
}

#[inline(always)]
fn widened([x, y, z, w]: [f32; 4]) -> DQuat {
    DQuat::from_xyzw(x.into(), y.into(), z.into(), w.into())
}

/// Maximum distance, in chain lengths, of a hand that counts as being at its target: the rounding
/// of the middle joint's axes and of the rotations to f32.
pub const NEAR: f64 = 7e-7;

/// Maximum distance, in chain lengths, from a target to the reach [|d₁ − d₂|, d₁ + d₂], if the
/// target still counts as reached: the rounding of these two bounds.
pub const AT_LIMIT: f64 = 2e-7;

/// The two corrections (x, y, z, w), and whether the hand reaches the target with them. Meaningless
/// if not `is_regular`.
#[derive(Clone, Copy)]
pub struct Solved {
    pub start_correction: [f32; 4],
    pub middle_correction: [f32; 4],
    pub is_reached: bool,
    /// True if the hand is farther from the start joint than the target is.
    pub is_too_close: bool,
    /// Distance from the hand to the target in model space.
    pub hand_error: f32,
    pub is_regular: bool,
}

impl Solved {
    #[inline(always)]
    pub fn reach(&self) -> Reach {
        if self.is_reached {
            Reach::Reached
        } else if self.is_too_close {
            Reach::TooClose
        } else {
            Reach::TooFar
        }
    }
}
