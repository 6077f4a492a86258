//! Bake: keys the motion that targets and the followed path give a skeleton, so that it needs them
//! no longer.
//!
//! Every frame of a range is evaluated. The rotations that differ from those of the keys and
//! angles alone become keys at every frame, and so do the offsets that solvers move: those of free
//! roots and of stretched limbs. Euler angles are unwrapped: of all equivalent angles within a
//! joint's limits, a key has the ones nearest to the key before.
//!
//! Keys are then removed one by one, while every base and tip stays within a tolerance of its
//! evaluated position at every frame, until no key can be removed.
//!
//! # What breaks
//!
//! - Lengths of bones have no channel. The tip of a bone that a target stretches is not kept, but
//!   the joints at the tip are; see [`Baked::shortened`].
//! - Between frames a baked pose is interpolated from the keys, and may differ from the evaluated
//!   one by more than the tolerance.

#[expect(clippy::module_inception, reason = "the type Bake, in the file of its name")]
mod bake;
mod baked_track;
mod motion;
mod outcome;
mod reduction;

pub use bake::Bake;
pub use outcome::{BakeError, Baked, ShortenedBone};
