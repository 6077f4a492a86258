//! Jobs of many limbs at once.
//!
//! Each array holds one number for each limb (a structure of arrays), so that one instruction
//! computes 2, 4 or 8 limbs. The instruction set is chosen at run time.
//!
//! ```
//! use ik_arm_kinematics::batch::{Points, QuaternionsMut};
//! use ik_arm_kinematics::job::batch::{JobInputs, JobOutputs, Joints, solve};
//! use ik_arm_kinematics::two_bone::Reach;
//!
//! // Two limbs with their shoulders at the origin, elbows above them, hands to the right.
//! let (zero, one) = ([0.0; 2], [1.0; 2]);
//! let [x, y, z] = [
//!     Points { x: &one, y: &zero, z: &zero },
//!     Points { x: &zero, y: &one, z: &zero },
//!     Points { x: &zero, y: &zero, z: &one },
//! ];
//! let joints = |translation| Joints { x_axis: x, y_axis: y, z_axis: z, translation };
//! let inputs = JobInputs {
//!     start: joints(Points { x: &zero, y: &zero, z: &zero }),
//!     middle: joints(y),
//!     end: Points { x: &one, y: &one, z: &zero },
//!     target: Points { x: &[0.3, 3.0], y: &[0.8, 0.0], z: &[1.1, 0.0] },
//!     pole: Some(y),
//!     hinge: Some(z),
//!     twist: None,
//!     weight: None,
//!     softness: 0.0,
//! };
//!
//! let (mut start, mut middle) = ([[0.0; 2]; 4], [[0.0; 2]; 4]);
//! let (mut hand_error, mut reach) = ([0.0; 2], [Ok(Reach::Reached); 2]);
//! let outputs = JobOutputs {
//!     start_correction: QuaternionsMut::of(&mut start),
//!     middle_correction: QuaternionsMut::of(&mut middle),
//!     hand_error: &mut hand_error,
//!     reach: &mut reach,
//! };
//! solve(&inputs, outputs)?;
//! assert_eq!(reach, [Ok(Reach::Reached), Ok(Reach::TooFar)]);
//! # Ok::<(), ik_arm_kinematics::job::batch::LenError>(())
//! ```
//!
//! # Results
//!
//! Results are bit-identical to [`TwoBoneJob::run`](super::TwoBoneJob::run) of each limb alone, for
//! every division of the batch, number of threads and machine. (The sine of a twist differs between
//! machines.) Spaces, units and what breaks are those of [`job`](super). The error of a limb does
//! not affect other limbs.
//!
//! # Speed
//!
//! Most jobs take the fast path: bent limbs without softness, with a weight of 1, bone lengths that
//! differ by less than 1 : 1,000,000, a start joint whose scales differ by less than 1 : 1000, a
//! middle joint that is a rotation with an even scale to 5e-6, and numbers from about 1e-9 to 1e9.
//! Other limbs are solved alone. A twist adds about a third of the time, for its sine and cosine.
//! `docs/performance.md` has the times.

#[cfg(feature = "parallel")]
mod cores;
mod inputs;
mod kernel;
mod outputs;
mod solve;

#[cfg(feature = "parallel")]
pub use cores::solve_on_all_cores;
pub use inputs::LenError;
pub use inputs::{JobInputs, Joints};
pub use outputs::JobOutputs;
pub use solve::solve;
