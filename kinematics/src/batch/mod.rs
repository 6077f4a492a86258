//! Batches of two-bone arms; each arm is solved as by [`two_bone`](super::two_bone).
//!
//! Each array holds one number for each arm (a structure of arrays), so that one instruction
//! computes 4, 8 or 16 arms. The instruction set is chosen at run time.
//!
//! ```
//! use ik_arm_kinematics::batch::{
//!     ArmBatch, BatchBones, BatchPositions, BatchTwist, Points, PointsMut,
//! };
//! use ik_arm_kinematics::two_bone::TwoBone;
//!
//! let (x, y, z) = ([250.0, 400.0], [120.0, 300.0], [60.0, 0.0]);
//! let arms = ArmBatch::new(
//!     BatchBones::Same(TwoBone::new(200.0, 300.0)?),
//!     Points { x: &x, y: &y, z: &z },
//!     BatchTwist::Angle(&[0.0, 0.5]),
//! )?;
//!
//! let mut elbow = [[0.0; 2]; 3];
//! let mut hand = [[0.0; 2]; 3];
//! let positions =
//!     BatchPositions { elbow: PointsMut::of(&mut elbow), hand: PointsMut::of(&mut hand) };
//! arms.solve(positions, None)?;
//!
//! assert_eq!(hand[0][0], 250.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Results
//!
//! Results are bit-identical to [`TwoBone::solve`](super::two_bone::TwoBone::solve) of each arm
//! alone, for every division of the batch, number of threads and machine. (The cosine function
//! differs between machines: batches that must agree between machines take cosines and sines
//! instead of angles.) A hand is at its cursor, bit for bit, if the cursor is reached; otherwise
//! the hand is on a limit sphere.
//!
//! Everything is in Root space, right-handed; angles are radians, and the lengths of one arm share
//! any one unit.
//!
//! # What breaks
//!
//! A number that is not finite makes the results of its own arm meaningless, and of no other arm.
//! An arm has no previous [`Pointer`](super::two_bone::Pointer): the Pointer of a cursor at the
//! shoulder is along +x, and a cursor straight above or below the shoulder has a yaw of 0.
//!
//! # Speed
//!
//! `docs/performance.md` compares the time of a batch with that of copying the same number of
//! bytes. Normal numbers, from about 1e-9 to 1e9, take the fast path. A block of 2,048 arms with
//! other numbers, or with a cursor straight above, below or at its shoulder, is solved a second
//! time by a path for all finite numbers, which halves the speed. With rotations, so is a block in
//! which one bone of an arm is more than eight times as long as the other.

mod arm_batch;
mod array;
#[cfg(feature = "parallel")]
mod cores;
mod kernel;

pub use arm_batch::ArmBatch;
pub use array::{
    BatchArray, BatchBones, BatchError, BatchPositions, BatchRotations, BatchTwist, Points,
    PointsMut, QuaternionsMut,
};
