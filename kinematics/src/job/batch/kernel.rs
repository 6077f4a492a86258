//! Jobs of the fast path, one after the other: plain code over arrays that the compiler vectorises
//! for common instruction sets. The widest set that the machine has is chosen at run time.
//!
//! No result depends on the vector width: there is no fused multiply-add, no reordered sum and no
//! approximate reciprocal.

use glam::{DMat3, DVec3};
use multiversion::multiversion;

use crate::job::fast_path::FastPathJob;

/// Number of limbs that are solved together. Their inputs and results stay in the innermost cache.
pub(super) const BLOCK: usize = 128;

/// One number for each limb of a block.
type Numbers = [f32; BLOCK];

/// Jobs of a block. Each point and axis is x, y and z.
pub(super) struct FastPathJobs {
    /// Columns of the start joints' matrices, the last the position.
    pub start: [[Numbers; 3]; 4],
    /// Columns of the middle joints' matrices, the last the position.
    pub middle: [[Numbers; 3]; 4],
    pub end: [Numbers; 3],
    pub target: [Numbers; 3],
    /// Not used without `POLE`.
    pub pole: [Numbers; 3],
    pub hinge: [Numbers; 3],
    /// Sine and cosine of the twists.
    pub twist: [[f64; BLOCK]; 2],
}

/// Results of a block.
pub(super) struct Results {
    /// x, y, z and w of each rotation.
    pub start_correction: [Numbers; 4],
    pub middle_correction: [Numbers; 4],
    pub hand_error: Numbers,
    pub outcome: Numbers,
}

/// The outcome for a limb, as a number that is as wide as the others in a vector.
pub(super) mod outcome {
    pub const REACHED: f32 = 0.0;
    pub const TOO_FAR: f32 = 1.0;
    pub const TOO_CLOSE: f32 = 2.0;
    /// The job is not regular, and the limb's results are meaningless.
    pub const IRREGULAR: f32 = 3.0;
}

impl FastPathJobs {
    pub const ZERO: Self = Self {
        start: [[[0.0; BLOCK]; 3]; 4],
        middle: [[[0.0; BLOCK]; 3]; 4],
        end: [[0.0; BLOCK]; 3],
        target: [[0.0; BLOCK]; 3],
        pole: [[0.0; BLOCK]; 3],
        hinge: [[0.0; BLOCK]; 3],
        twist: [[0.0; BLOCK], [1.0; BLOCK]],
    };
}

impl Results {
    pub const ZERO: Self = Self {
        start_correction: [[0.0; BLOCK]; 4],
        middle_correction: [[0.0; BLOCK]; 4],
        hand_error: [0.0; BLOCK],
        outcome: [0.0; BLOCK],
    };
}

#[multiversion(targets(
    "x86_64+avx512f+avx512vl+avx512dq+avx512bw",
    "x86_64+avx2",
    "aarch64+neon",
))]
pub(super) fn solve<const POLE: bool>(jobs: &FastPathJobs, results: &mut Results) {
    for limb in 0..BLOCK {
        let job = FastPathJob {
            axes: [axes(&jobs.start, limb), axes(&jobs.middle, limb)],
            joints: [at(&jobs.start[3], limb), at(&jobs.middle[3], limb), at(&jobs.end, limb)],
            target: at(&jobs.target, limb),
            pole: at(&jobs.pole, limb),
            hinge: at(&jobs.hinge, limb),
            twist: [jobs.twist[0][limb], jobs.twist[1][limb]],
        };
        let solved = job.solve::<POLE>();
        for part in 0..4 {
            results.start_correction[part][limb] = solved.start_correction[part];
            results.middle_correction[part][limb] = solved.middle_correction[part];
        }
        results.hand_error[limb] = solved.hand_error;
        let missed = if solved.is_too_close { outcome::TOO_CLOSE } else { outcome::TOO_FAR };
        let outcome = if solved.is_reached { outcome::REACHED } else { missed };
        results.outcome[limb] = if solved.is_regular { outcome } else { outcome::IRREGULAR };
    }
}

#[inline(always)]
fn at([x, y, z]: &[Numbers; 3], limb: usize) -> DVec3 {
    DVec3::new(x[limb].into(), y[limb].into(), z[limb].into())
}

#[inline(always)]
fn axes([x, y, z, _]: &[[Numbers; 3]; 4], limb: usize) -> DMat3 {
    DMat3::from_cols(at(x, limb), at(y, limb), at(z, limb))
}
