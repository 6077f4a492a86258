//! The correction of a usual job in straight-line code: no call, no loop, and no branch that a
//! compiler cannot turn into a select, so that [`batch`](super::batch) can vectorise it.
//!
//! A usual job has a bent limb, hard limits and a weight of 1, and is far from all special cases:
//! [`Solved::is_usual`] tells. The others are solved by [`stages`](super::stages).
//!
//! Vectors are in start joint space *times det M_s* (`_ds`): M_s⁻¹ is the adjugate of M_s divided by
//! det M_s, and since only ratios of lengths count, nothing has to be divided. Under a negative
//! det M_s these vectors are reflected at the start joint. Rotations and cross products are those
//! of start joint space all the same; only a turn about a reflected vector changes its sense.

mod joint_axes;
mod limb;
mod rotation;
mod solved;
mod usual_job;

pub(super) use joint_axes::cofactors;
pub(super) use limb::{IN_LINE, ON_LINE, side};
pub(super) use rotation::{NEAR_HALF_TURN, OPPOSITE, least_rotation, rotation_between};
pub(super) use solved::{AT_LIMIT, NEAR, Solved};
pub(super) use usual_job::UsualJob;
