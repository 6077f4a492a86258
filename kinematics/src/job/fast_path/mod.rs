//! The fast path: corrections in straight-line code, with no call, no loop, and no branch that a
//! compiler cannot turn into a select, so that [`batch`](super::batch) can vectorise it.
//!
//! It solves jobs without softness, with a weight of 1, that are *regular*: the limb is bent, no bone
//! is negligible, the hand is away from the start joint, the rotations are not near half a turn, and
//! no number overflows. [`Solved::is_regular`] tells. All other jobs are solved by
//! [`stages`](super::stages).
//!
//! Vectors are in start joint space *times det M_s* (`_ds`): M_s⁻¹ is the adjugate of M_s divided by
//! det M_s, and since only ratios of lengths count, nothing has to be divided. Under a negative
//! det M_s these vectors are reflected at the start joint. Rotations and cross products are those
//! of start joint space all the same; only a turn about a reflected vector changes its sense.

mod fast_path_job;
mod joint_axes;
mod limb;
mod rotation;
mod solved;

pub(super) use fast_path_job::FastPathJob;
pub(super) use joint_axes::cofactors;
pub(super) use limb::{IN_LINE, ON_LINE, side};
pub(super) use rotation::{NEAR_HALF_TURN, OPPOSITE, least_rotation, rotation_between};
pub(super) use solved::{AT_LIMIT, NEAR, Solved};
