//! Two-bone inverse kinematics for another program's skeleton: corrections of two joints' rotations
//! that bring its hand to a target.
//!
//! A program with its own skeleton gives the matrices of three of its joints and gets two rotations
//! back, like ozz-animation's `IKTwoBoneJob`:
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
//! let correction = TwoBoneJob { pole: Some(Vec3::Y), hinge: Some(Vec3::Z), ..job }.run()?;
//!
//! let shoulder = shoulder * Affine3A::from_quat(correction.start_correction);
//! let elbow = shoulder * elbow_local * Affine3A::from_quat(correction.middle_correction);
//! assert_eq!(correction.reach, Reach::Reached);
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
//! (−1, −1, −1); for one that is not, see [`TwoBoneCorrection::before_scales`].
//!
//! # The mathematics
//!
//! Named for the stages, in start joint space (`_ss`). d₁, d₂, L, δ, D, hₑ and oₑ are those of
//! [`two_bone`](super::two_bone); u runs from start to middle, l from middle to end.
//!
//! 1. *Soften.* D from the target's distance, as in [`soft_reach`](super::soft_reach).
//! 2. *Middle joint.* The inner angle becomes tan(φ/2) = √((D−δ)(D+δ) / ((L−D)(L+D))), by a turn
//!    about k, the normal of the plane of the two bones: k = ±(−u) × l, on the hinge's side.
//! 3. *Start joint.* x̂ is then the hand's direction and k × x̂ the elbow's: that frame is brought to
//!    the target's direction ŵ and the pole's, e = p less its part along ŵ, turned by the twist.
//! 4. *Weight.* Each rotation is scaled to that fraction of its angle.
//!
//! # Hinge
//!
//! A positive turn about the hinge axis *opens* the elbow: for a bent limb it is
//! (start − middle) × (end − middle), in the middle joint's space. It selects the side to which the
//! limb bends:
//!
//! | hinge axis | what happens |
//! | --- | --- |
//! | perpendicular to the bones | the middle joint turns about it |
//! | not perpendicular | the middle joint turns about the normal of its bones, on the side of the axis: the hand is exact, and a pose that needs no correction gets none |
//! | opposite | the limb bends to its other side: the middle joint passes through straight and the start joint compensates. The elbow is still at the pole and the hand at the target |
//! | `None`, 0, or in the plane of the bones to 1e-3 | the present side |
//!
//! A straight or folded limb (to 1e-3, or to the rounding of the coordinates) has no normal: it bends
//! about the hinge axis, made perpendicular to the upper bone; without such an axis towards the pole;
//! without a pole in any direction.
//!
//! # What breaks
//!
//! - The elbow turns around where the target passes the pole's line through the start joint. On it
//!   (to 1e-6), and without a pole, the start joint makes the least rotation from the given pose.
//! - Where the target is opposite to the hand, the axis of the least rotation is arbitrary.
//! - A target at the start joint has no direction: the hand keeps its own.
//! - A bone of length 0, or a middle joint of scale 0, leaves one bone: the start joint points it at
//!   the target by the least rotation, and the middle joint stays. No bone at all, or a start joint of
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
//! or shorter as M_s makes it. [`TwoBoneCorrection::reach`] is measured there too, with the rotations as they
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
//! its sources in [`two_bone`](super::two_bone), the curve in [`soft_reach`](super::soft_reach).

mod chain;
mod correction;
mod error;
mod stages;
mod two_bone_job;

pub use correction::TwoBoneCorrection;
pub use error::{JobError, JobField};
pub use two_bone_job::TwoBoneJob;
