//! Two bones of somebody else's skeleton: the rotations that bring its hand to a target.
//!
//! A program that has its own skeleton gives the matrices of three of its joints and gets two
//! rotations back, in the manner of ozz-animation's `IKTwoBoneJob`:
//!
//! ```text
//!            middle                 start  ← q · Δ₁    the shoulder's or hip's local rotation
//!              o                    middle ← q · Δ₂    the elbow's or knee's
//!      upper ╱   ╲ lower            nothing else changes: no length, no other joint
//!          ╱       ╲
//!   start o         o end  →  × target
//! ```
//!
//! ```
//! use glam::{Affine3A, Quat, Vec3};
//! use ik_arm::kinematics::job::TwoBoneJob;
//! use ik_arm::kinematics::two_bone::Reach;
//!
//! // Model = parent's model · local: shoulder at the origin, elbow above it, hand to its right.
//! let shoulder = Affine3A::IDENTITY;
//! let elbow_local = Affine3A::from_translation(Vec3::Y);
//! let hand_local = Affine3A::from_translation(Vec3::X);
//! let elbow = shoulder * elbow_local;
//! let target = Vec3::new(0.3, 0.8, 1.1);
//!
//! let job = TwoBoneJob::new(shoulder, elbow, elbow * hand_local, target);
//! let turn = TwoBoneJob { pole: Vec3::Y, hinge: Vec3::Z, ..job }.run()?;
//!
//! let shoulder = shoulder * Affine3A::from_quat(turn.start);
//! let elbow = shoulder * elbow_local * Affine3A::from_quat(turn.middle);
//! assert_eq!(turn.reach, Reach::Reached);
//! assert!((elbow * hand_local).translation.distance(target.into()) < 1e-6);
//! # Ok::<(), ik_arm::kinematics::job::JobError>(())
//! ```
//!
//! # Spaces
//!
//! The matrices, the target and the pole are in one space that the caller chooses: the model's, the
//! world's, the start joint's parent's. It is called model space here. Vectors are columns: model =
//! parent's model · local. The joints need not be each other's direct children; what lies between
//! them stays as it is. No parent's matrix is needed: all is computed in f64 in start joint space,
//! M_s⁻¹ · (point − start), with M_s the start joint's matrix. There both rotations are rigid whatever
//! M_s is, so every M_s that has an inverse is right: moved, turned, scaled, mirrored, and unevenly
//! scaled or sheared by what is above the start joint. The rotations are the same wherever the model
//! stands. Bone lengths, limits, the twist's angle and the accuracy are those of start joint space.
//!
//! Only M_s⁻¹ · M_m, the middle joint's matrix in that space, must be a rotation and an even scale,
//! mirrored or not. A mirror in a joint's own scale is right where that is the same along each axis
//! (−1, −1, −1); for one that is not, see [`Correction::before_scales`].
//!
//! # The mathematics
//!
//! Named for the stages, in start joint space (`_ss`). d₁, d₂, L, δ, D, hₑ and oₑ are those of
//! [`two_bone`](super::two_bone); u runs from start to middle, l from middle to end.
//!
//! 1. *Soften.* D from the target's distance, as in [`reach`](super::soft_reach).
//! 2. *Middle joint.* The inner angle becomes tan(φ/2) = √((D−δ)(D+δ) / ((L−D)(L+D))), by a turn
//!    about k, the normal of the plane of the two bones: k = ±(−u) × l, on the hinge's side.
//! 3. *Start joint.* x̂ is then the hand's direction and k × x̂ the elbow's: that frame is brought to
//!    the target's direction ŵ and the pole's, e = p less its part along ŵ, turned by the twist.
//! 4. *Weight.* Each rotation goes that part of its angle.
//!
//! # Which way round
//!
//! A positive turn about the hinge axis *opens* the elbow: for a bent limb it is
//! (start − middle) × (end − middle), in the middle joint's space. It says which side the limb bends
//! to:
//!
//! | hinge axis | what happens |
//! | --- | --- |
//! | perpendicular to the bones | the middle joint turns about it |
//! | not perpendicular | the middle joint turns about the normal of its bones instead, on the side that the axis leans to: the hand is exact, and a pose that needs no correction gets none |
//! | the wrong way round | the limb bends to its other side: the middle joint goes through straight, the start joint makes up for it. The elbow is at the pole and the hand at the target all the same |
//! | 0, or in the plane of the bones to 1e-3 | the side on which the limb is bent already |
//!
//! A straight or folded limb (to 1e-3, and to what the coordinates' rounding lets one see) has no
//! normal: it bends about the hinge axis, made perpendicular to the upper bone; without such an axis
//! towards the pole; without a pole anywhere.
//!
//! # What breaks
//!
//! - The elbow turns around where the target passes the pole's line through the start joint. On it
//!   (to 1e-6), and without a pole, the start joint makes the least turn from the pose it is given.
//! - The least turn is anything that fits where the target is opposite to the hand.
//! - A target at the start joint has no direction: the hand keeps its own.
//! - A bone of length 0, or a middle joint of scale 0, leaves one bone: the start joint points it at
//!   the target by the least turn, and the middle joint stays. No bone at all, or a start joint of
//!   scale 0: no correction.
//! - A weight between 0 and 1 moves the hand on an arc, which need not pass near the target; where a
//!   full correction is half a turn, its sense is not defined.
//! - An uneven scale below the start joint changes the lower bone's length as that turns, which the
//!   closed form does not know. Where M_s⁻¹ · M_m shows it, it is refused from a difference of one in
//!   a thousand; less is ignored, and the hand is off by as much.
//! - An uneven scale of the start joint's own (translation · rotation · *scale*) does not show: a
//!   parent's may give the same M_s. The hand is then elsewhere. Give M_s without that scale.
//! - A start joint whose axes are in one plane, such as one of scale (1, 0, 1), has no start joint
//!   space: it is refused.
//!
//! # Accuracy
//!
//! In start joint space the hand of a skeleton that is posed anew is within 1e-6 of the chain's length
//! of a target within reach, the three matrices taken as exact; in model space that is as much longer
//! or shorter as M_s makes it. [`Correction::reach`] is measured there too, with the rotations as they
//! are returned: it never says [`Reach::Reached`] of a hand that is elsewhere.
//!
//! The matrices themselves are rounded to f32. Where coordinates are large, that adds some 4 ulp of
//! the largest in model space. Where M_s is very uneven, start joint space magnifies the rounding of
//! M_m as much (its condition number times): the middle joint is then not quite a similarity, and the
//! hand is not called reached if that moves it by more than 7e-7 of the chain's length.
//!
//! # Other programs
//!
//! Nothing is to be converted as long as everything is in one space: a left-handed space only
//! mirrors, what comes out is in the space of what goes in, and lengths may have any unit.
//!
//! | program | space | unit | what to mind |
//! | --- | --- | --- | --- |
//! | here, glTF, Godot | right-handed, y up | any, m, m | |
//! | Unity | left-handed, y up | m | `localToWorldMatrix` has its vectors in columns, as here; `localRotation *= Δ` |
//! | Unreal | left-handed, z up | cm | `FMatrix` has them in rows: its rows are the columns here; `FQuat`s, q * Δ (the product of `FTransform`s has the other order) |
//!
//! By the numbers every turn here is right-handed. Read in a left-handed program the same numbers are
//! left-handed turns, which is what such a program means by a positive angle: so it is for the twist,
//! the hinge axis and both results. (start − middle) × (end − middle), computed there by the same
//! formula, is the hinge axis there too. Only numbers that come from a program of the other hand are
//! to be mirrored before they are used: points and directions (the pole) like any vector, axes of
//! turns (the hinge axis) like a vector and then negated, and the twist negated.
//!
//! # Sources
//!
//! G. Blanc, ozz-animation, `IKTwoBoneJob`, 2017 (inputs, outputs and stages; there a hinge axis is
//! used as it is, which is exact only where it is perpendicular to the bones); the closed form and
//! its sources in [`two_bone`](super::two_bone), the curve in [`reach`](super::soft_reach).

mod chain;
mod error;
mod stages;

use glam::{Affine3A, DQuat, Quat, Vec3};

use super::soft_reach::SoftReach;
use super::two_bone::Reach;
use chain::Chain;
pub use error::JobError;

/// Three joints of a skeleton and where the last of them is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBoneJob {
    /// The start joint (shoulder, hip), in model space.
    pub start: Affine3A,
    /// The middle joint (elbow, knee), in model space.
    pub middle: Affine3A,
    /// The end joint (hand, foot), in model space. Only its place is used.
    pub end: Affine3A,
    /// The point where the end joint is asked to be, in model space.
    pub target: Vec3,
    /// The direction (not a point) in which the middle joint stands out, in model space; any length.
    /// For a pole that is a point, give that point less the start joint's. 0 for none: the start
    /// joint makes the least turn.
    pub pole: Vec3,
    /// The axis about which a positive turn opens the middle joint, in the middle joint's space; any
    /// length. 0 to go by how the limb is bent.
    pub hinge: Vec3,
    /// How far the limb is turned about the line from start to target, from the pole (without one,
    /// from the least turn): radians, right-handed from start to target in start joint space.
    /// Where that is mirrored in the model, it is left-handed there.
    pub twist: f32,
    /// s, how early the hand begins to fall behind near its limits: from 0 to less than 1. See
    /// [`SoftReach`]; nothing stretches.
    pub softness: f32,
    /// How much of the correction is made: from 0 (none, exactly) to 1 (all).
    pub weight: f32,
}

/// What to multiply two local rotations by, on the right: q' = q · Δ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// Δ₁, for the start joint; of unit length, w ≥ 0.
    pub start: Quat,
    /// Δ₂, for the middle joint; of unit length, w ≥ 0.
    pub middle: Quat,
    /// Whether the hand is at the target then, in start joint space: to 7e-7 of the chain's length
    /// there, of which a limit may cost 2e-7. A hand that is not there, be it out of reach, softened
    /// or not of full weight, is [`Reach::TooClose`] where it is farther from the start joint than
    /// the target is, in that space, else [`Reach::TooFar`]. (Where the start joint has scale 0, in
    /// model space.)
    pub reach: Reach,
    /// How far the hand is from the target then, in model space: the matrices' own unit.
    pub hand_error: f32,
}

/// A correction of weight 1.
#[derive(Default)]
struct Full {
    /// Δ₁ and Δ₂.
    start: DQuat,
    middle: DQuat,
    /// How far the hand stays from the target, in lengths of the chain.
    left: f64,
}

impl TwoBoneJob {
    /// A job that goes all the way and hard, bends the limb as it is bent, and has neither pole nor
    /// twist.
    pub fn new(start: Affine3A, middle: Affine3A, end: Affine3A, target: Vec3) -> Self {
        Self {
            start,
            middle,
            end,
            target,
            pole: Vec3::ZERO,
            hinge: Vec3::ZERO,
            twist: 0.0,
            softness: 0.0,
            weight: 1.0,
        }
    }

    /// Solves it.
    ///
    /// # Errors
    ///
    /// Refuses what is not finite, a start joint whose matrix has no inverse, a middle joint whose
    /// axes, in start joint space, differ in length or are not perpendicular by more than one in a
    /// thousand (scale 0 of either is accepted), a softness outside [0, 1) and a weight outside
    /// [0, 1], and says which it is.
    pub fn run(&self) -> Result<Correction, JobError> {
        let soft_reach = self.checked()?;
        let chain = Chain::new(self)?;
        let full = self.solve(&chain, soft_reach).unwrap_or_default();
        let part = |turn| stages::weight(turn, self.weight.into()).as_quat();
        Ok(self.measured(&chain, part(full.start), part(full.middle), full.left))
    }

    /// Nothing where there is nothing to turn.
    fn solve(&self, chain: &Chain, soft_reach: SoftReach) -> Option<Full> {
        let limb = chain.limb()?;
        let target_ss = chain.point_ss(self.target.as_dvec3()) / limb.unit;
        let pole_ss = chain.vector_ss(self.pole.as_dvec3()).try_normalize();
        let hinge_ss = self.hinge.as_dvec3().try_normalize().map(|axis| chain.middle_turn * axis);

        let distance = stages::soften(&limb, target_ss.length(), soft_reach);
        let bend = stages::middle_joint(&limb, distance, hinge_ss, pole_ss);
        let towards_ss = target_ss.try_normalize().or(limb.hand_ss().try_normalize());
        Some(Full {
            start: stages::start_joint(&bend, towards_ss, pole_ss, self.twist.into()),
            middle: chain.middle_turn.inverse() * bend.turn_ss * chain.middle_turn,
            left: (target_ss.length() - distance).abs(),
        })
    }

    /// With where the rotations, as they are returned, leave the hand.
    fn measured(&self, chain: &Chain, start: Quat, middle: Quat, left: f64) -> Correction {
        // What f32 makes of the middle joint's axes and the rotations; and of the limits, which are
        // to be told from it.
        const NEAR: f64 = 7e-7;
        const AT_LIMIT: f64 = 2e-7;
        let target_ss = chain.point_ss(self.target.as_dvec3());
        let hand_ss = chain.hand_ss(start.as_dquat(), middle.as_dquat());
        let off_ss = hand_ss - target_ss;
        let reach = if off_ss.length() <= NEAR * chain.length_ss() && left <= AT_LIMIT {
            Reach::Reached
        } else if hand_ss.length() > target_ss.length() {
            Reach::TooClose
        } else {
            Reach::TooFar
        };
        let hand_error = chain.length_in_model(off_ss).min(f32::MAX.into()) as f32;
        Correction { start, middle, reach, hand_error }
    }
}

impl Correction {
    /// The same for joints whose own scale mirrors an axis or two, such as (−1, 1, 1).
    ///
    /// A local transform is translation · rotation · scale: what turns a joint after its scale must
    /// be mirrored to turn it before. Only the signs of the scales count.
    #[must_use]
    pub fn before_scales(self, start_scale: Vec3, middle_scale: Vec3) -> Self {
        let before = |turn: Quat, scale: Vec3| {
            let Vec3 { x, y, z } = scale.signum();
            Quat::from_xyzw(turn.x * y * z, turn.y * z * x, turn.z * x * y, turn.w)
        };
        Self {
            start: before(self.start, start_scale),
            middle: before(self.middle, middle_scale),
            ..self
        }
    }
}
