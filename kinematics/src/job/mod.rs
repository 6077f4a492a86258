//! Two-bone inverse kinematics for another program's skeleton: corrections of two joints' rotations
//! that bring the hand to a target.
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
//! use ik_arm_kinematics::job::TwoBoneJob;
//! use ik_arm_kinematics::two_bone::Reach;
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
//! # Ok::<(), ik_arm_kinematics::job::JobError>(())
//! ```
//!
//! # Spaces
//!
//! The matrices, the target and the pole are in one space that the caller chooses: the model's, the
//! world's, the start joint's parent's. It is called model space here. Vectors are columns: model =
//! parent's model · local. The joints need not be each other's direct children; joints between them
//! are left unchanged. No parent's matrix is needed: everything is computed in f64 in start joint
//! space, M_s⁻¹ · (point − start), with M_s the start joint's matrix. There both rotations are
//! rigid for every M_s that has an inverse, also if the joints above the start joint translate,
//! rotate, scale or mirror it, scale it unevenly or shear it. The rotations do not depend on where
//! the model is in the world. Bone lengths, limits, the twist angle and the accuracy are measured
//! in start joint space.
//!
//! Only M_s⁻¹ · M_m, the middle joint's matrix in start joint space, must be a rotation with an
//! even scale, mirrored or not. A joint's own scale may mirror all three axes, as (−1, −1, −1)
//! does; for a scale that mirrors one or two, see [`TwoBoneCorrection::before_scales`].
//!
//! # The mathematics
//!
//! Each step is named for its stage and works in start joint space (`_ss`). d₁, d₂, L, δ, D, hₑ and
//! oₑ are those of [`two_bone`](super::two_bone); the vector u is from start to middle, l from
//! middle to end, and p is the pole.
//!
//! 1. *Soften.* The hand's distance D follows from the target's distance, as in
//!    [`soft_reach`](super::soft_reach).
//! 2. *Middle joint.* A turn about k sets the inner angle φ, with tan(φ/2) = √((D−δ)(D+δ) /
//!    ((L−D)(L+D))). k is the normal of the plane of the two bones, ±(−u) × l, on the hinge's side.
//! 3. *Start joint.* The hand is then in the direction x̂ and the elbow in the direction k × x̂.
//!    The start joint turns these to the target's direction ŵ and to e, the part of p perpendicular
//!    to ŵ; then it turns by the twist about ŵ.
//! 4. *Weight.* The angle of each rotation is multiplied by the weight.
//!
//! # Hinge
//!
//! A positive turn about the hinge axis *opens* the elbow: for a bent limb this axis is (start −
//! middle) × (end − middle), in the middle joint's space. It selects the side to which the limb
//! bends:
//!
//! | hinge axis | what happens |
//! | --- | --- |
//! | perpendicular to the bones | the middle joint turns about it |
//! | not perpendicular | the middle joint turns about the normal of its bones, on the side of the axis: the hand is exact, and a pose that needs no correction gets none |
//! | opposite | the limb bends to its other side: the middle joint passes through straight and the start joint compensates. The elbow is still at the pole and the hand at the target |
//! | `None`, 0, or in the plane of the bones to 1e-3 | the limb stays on its present side |
//!
//! A straight or folded limb (to 1e-3, or to the rounding of the coordinates) has no normal. It
//! bends about the hinge axis, made perpendicular to the upper bone; without such an axis, it bends
//! towards the pole; without a pole, in any direction.
//!
//! # What breaks
//!
//! - The elbow flips when the target passes the line through the start joint in the direction of
//!   the pole. On this line (to 1e-6), and without a pole, the start joint turns by the smallest
//!   angle from the given pose.
//! - Where the target is opposite to the hand, the axis of this smallest turn is arbitrary.
//! - A target at the start joint has no direction: the hand keeps its own direction.
//! - A bone of length 0, or a middle joint of scale 0, leaves one bone: the start joint points it
//!   at the target by the smallest turn, and the middle joint does not turn. Without any bone, or
//!   with a start joint of scale 0, there is no correction.
//! - A weight between 0 and 1 moves the hand on an arc, which need not pass near the target. If the
//!   full correction is half a turn, the sense of the turn is arbitrary.
//! - An uneven scale below the start joint changes the length of the lower bone as the bone turns,
//!   which the closed form does not know. If such a scale shows in M_s⁻¹ · M_m, the job is refused
//!   from a difference of one in a thousand; a smaller difference is ignored, and the hand is off
//!   by as much.
//! - An uneven scale of the start joint itself (translation · rotation · *scale*) cannot be seen,
//!   because a parent's scale may give the same M_s. The hand then misses the target. Give M_s
//!   without that scale.
//! - A start joint whose axes are in one plane, such as one of scale (1, 0, 1), has no start joint
//!   space: it is refused.
//!
//! # Accuracy
//!
//! With the three matrices taken as exact, the hand of a skeleton posed by the correction is within
//! 1e-6 of the chain's length of a target within reach, in start joint space; M_s scales this
//! distance to model space. [`TwoBoneCorrection::reach`] is measured in start joint space, too,
//! with the rotations that are returned: it is never
//! [`Reach::Reached`](super::two_bone::Reach::Reached) for a hand that is elsewhere.
//!
//! The matrices themselves are rounded to f32. Large coordinates add an error of some 4 ulp of the
//! largest coordinate in model space. A very uneven M_s magnifies the rounding of M_m in start
//! joint space, by its condition number. The middle joint is then not quite a similarity, and the
//! hand does not count as reached if this moves it by more than 7e-7 of the chain's length.
//!
//! # Other programs
//!
//! Nothing has to be converted as long as everything is in one space: a left-handed space is only a
//! mirrored one, the results are in the space of the inputs, and lengths may have any unit.
//!
//! | program | space | unit | note |
//! | --- | --- | --- | --- |
//! | this crate, glTF, Godot | right-handed, y up | any, m, m | |
//! | Unity | left-handed, y up | m | `localToWorldMatrix` has its vectors in columns, as here; `localRotation *= Δ` |
//! | Unreal | left-handed, z up | cm | `FMatrix` has its vectors in rows, which are the columns here; with `FQuat`, q * Δ (a product of `FTransform`s has the other order) |
//!
//! In terms of numbers, every turn here is right-handed. In a left-handed program the same numbers
//! are left-handed turns, which is what such a program means by a positive angle. This holds for
//! the twist, the hinge axis and both results. The same formula, (start − middle) × (end − middle),
//! gives the hinge axis in every program. Only numbers that come from a program of the other
//! handedness must be mirrored before they are used: points and directions (the pole) like any
//! vector, axes of turns (the hinge axis) like a vector and then negated, and the twist negated.
//!
//! # Sources
//!
//! G. Blanc, ozz-animation, `IKTwoBoneJob`, 2017 (inputs, outputs and stages; there the hinge axis
//! is used as given, which is exact only if it is perpendicular to the bones); the closed form and
//! its sources in [`two_bone`](super::two_bone), the curve in [`soft_reach`](super::soft_reach).

pub mod batch;
mod chain;
mod error;
mod fast_path;
mod stages;
mod two_bone_job;

pub use error::{JobError, JobField};
pub use two_bone_job::{TwoBoneCorrection, TwoBoneJob};
