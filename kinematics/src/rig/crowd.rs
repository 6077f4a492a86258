//! A crowd: many arms on a plane, each with a moving target, solved as a batch.

use core::f32::consts::{PI, TAU};
use core::time::Duration;

use glam::Vec3;
use multiversion::multiversion;
use web_time::Instant;

use crate::batch::{
    ArmBatch, BatchBones, BatchError, BatchPositions, BatchTwist, Points, PointsMut,
};
use crate::two_bone::TwoBone;

/// Parameters of a crowd, with the time at which it is posed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crowd {
    /// Number of arms, at most [`Crowd::MOST`].
    pub arms: u32,
    /// Bones that all arms have.
    pub bones: TwoBone,
    /// Time in seconds. The motion of the targets repeats after [`Crowd::PERIOD`].
    pub time: f32,
    /// Processor that solves the crowd.
    pub processor: Processor,
}

/// Processor that solves a crowd.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Processor {
    /// The CPU: [`batch`](crate::batch) on all cores.
    #[default]
    Cpu,
    /// The GPU: the same mathematics in a shader.
    Gpu,
}

impl Crowd {
    /// Maximum number of arms.
    pub const MOST: u32 = 1_000_000;

    /// Period of the targets' motion, in seconds.
    pub const PERIOD: f32 = 16.0;

    /// Distance between neighbouring shoulders, in arm lengths: the paths of their targets hardly
    /// overlap.
    const SPACING: f32 = 1.15;

    /// Bounding sphere of all arms in the world: centre and radius.
    pub fn bounds(&self) -> (Vec3, f32) {
        let reach = self.bones.outer_limit();
        (Vec3::ZERO, self.spread() * (self.arms as f32).sqrt() + reach)
    }

    /// Ratio of a shoulder's distance from the centre to the square root of its index. The square
    /// root gives every arm the same area.
    fn spread(&self) -> f32 {
        Self::SPACING * self.bones.outer_limit() / PI.sqrt()
    }
}

/// Time taken to solve a crowd.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrowdTimes {
    /// Number of arms.
    pub arms: u32,
    /// Time of the solver alone, which computes elbows and hands from cursors and twists.
    pub solve: Duration,
}

/// Inputs and results of all arms of a crowd, as a structure of arrays.
#[derive(Debug, Default)]
pub struct CrowdArrays {
    /// x and z of the shoulders, on the plane y = 0 of the world. The axes of Root spaces are
    /// parallel to the world's.
    pub shoulder: [Vec<f32>; 2],
    /// Cursors in Root space.
    pub cursor: [Vec<f32>; 3],
    /// Cosines of the twists.
    pub cos: Vec<f32>,
    /// Sines of the twists.
    pub sin: Vec<f32>,
    /// Elbows in Root space.
    pub elbow: [Vec<f32>; 3],
    /// Hands in Root space.
    pub hand: [Vec<f32>; 3],
    spread: f32,
}

impl CrowdArrays {
    /// Resizes the arrays to the crowd's number of arms and positions the shoulders. Returns
    /// whether anything changed.
    ///
    /// Shoulders are arranged like the seeds of a sunflower (H. Vogel, *A Better Way to Construct
    /// the Sunflower Head*, 1979), so that adding arms does not move the others.
    pub fn resize(&mut self, crowd: &Crowd) -> bool {
        /// The golden angle 2π(1 − 1/φ) in radians, with the golden ratio φ.
        const GOLDEN: f64 = 2.399_963_229_728_653;
        let (arms, spread) = (crowd.arms as usize, crowd.spread());
        if self.len() == arms && self.spread == spread {
            return false;
        }
        let unchanged = if self.spread == spread { self.len() } else { 0 };
        self.spread = spread;
        let Self { shoulder: [x, z], cursor, cos, sin, elbow, hand, .. } = self;
        for of in cursor.iter_mut().chain([cos, sin]).chain(elbow).chain(hand) {
            of.resize(arms, 0.0);
        }
        x.truncate(unchanged);
        z.truncate(unchanged);
        for arm in x.len()..arms {
            let radius = spread * (arm as f32).sqrt();
            let (sin, cos) = (arm as f64 * GOLDEN).sin_cos();
            x.push(radius * cos as f32);
            z.push(radius * sin as f32);
        }
        true
    }

    /// Number of arms.
    pub fn len(&self) -> usize {
        self.cos.len()
    }

    /// True if there are no arms.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sets every cursor and twist to its value at the crowd's time.
    pub fn set_targets(&mut self, crowd: &Crowd) {
        let time = (crowd.time / Crowd::PERIOD).rem_euclid(1.0);
        let Self { cursor: [x, y, z], cos, sin, .. } = self;
        follow(time, crowd.bones.outer_limit(), [x, y, z], [cos, sin]);
    }

    /// Solves all arms and returns the time taken.
    ///
    /// # Errors
    ///
    /// [`BatchError::Len`] if the public arrays were resized to different lengths.
    pub fn solve(&mut self, bones: TwoBone) -> Result<Duration, BatchError> {
        let Self { cursor: [x, y, z], cos, sin, elbow, hand, .. } = self;
        let arms = ArmBatch::new(
            BatchBones::Same(bones),
            Points { x, y, z },
            BatchTwist::CosSin { cos, sin },
        )?;
        let positions = BatchPositions { elbow: PointsMut::of(elbow), hand: PointsMut::of(hand) };
        let start = Instant::now();
        #[cfg(feature = "parallel")]
        arms.solve_on_all_cores(positions, None)?;
        #[cfg(not(feature = "parallel"))]
        arms.solve(positions, None)?;
        Ok(start.elapsed())
    }
}

/// Writes cursors and twists (cosine and sine) at `time`, a fraction of the period from 0 to 1. The
/// cursors move on loops around and above their shoulders, partly out of reach; `reach` is the
/// arm's length.
#[multiversion(targets(
    "x86_64+avx512f+avx512vl+avx512dq+avx512bw",
    "x86_64+avx2",
    "aarch64+neon"
))]
fn follow(time: f32, reach: f32, cursor: [&mut [f32]; 3], twist: [&mut [f32]; 2]) {
    const BLOCK: usize = 256;
    let arms = cursor[0].len();
    let mut block = [[0.0_f32; BLOCK]; 5];
    let [x, y, z] = cursor;
    let [cos, sin] = twist;
    let mut arrays = [x, y, z, cos, sin];
    for from in (0..arms).step_by(BLOCK) {
        for (arm, of) in (from as u32..).zip(0..BLOCK) {
            let motion = ArmMotion::of(arm);
            let [x, y, z] = motion.cursor(time);
            block[0][of] = x * reach;
            block[1][of] = y * reach;
            block[2][of] = z * reach;
            let turn = motion.twist(time);
            block[3][of] = sine(turn + 0.25);
            block[4][of] = sine(turn);
        }
        let to = arms.min(from + BLOCK);
        for (array, block) in arrays.iter_mut().zip(&block) {
            array[from..to].copy_from_slice(&block[..to - from]);
        }
    }
}

/// Parameters of one arm's motion, hashed from the arm's index.
#[derive(Clone, Copy)]
struct ArmMotion {
    /// Phases of the motion, in turns.
    phases: [f32; 4],
    /// Turns per period: 1 or 2, negative for the opposite direction.
    rounds: f32,
}

impl ArmMotion {
    #[inline(always)]
    fn of(arm: u32) -> Self {
        // A hash with low bias (C. Wellons, *Prospecting for Hash Functions*, 2018).
        let mut mixed = arm.wrapping_add(0x9e37_79b9);
        mixed = (mixed ^ (mixed >> 16)).wrapping_mul(0x7feb_352d);
        mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x846c_a68b);
        mixed ^= mixed >> 16;
        let phase = |byte: u32| ((mixed >> (8 * byte)) & 0xff) as f32 / 256.0;
        let rounds = if mixed & 1 == 0 { 1.0 } else { 2.0 };
        let direction = if mixed & 2 == 0 { 1.0 } else { -1.0 };
        Self { phases: [phase(0), phase(1), phase(2), phase(3)], rounds: rounds * direction }
    }

    /// Cursor at `time` (a fraction of the period), in Root space and arm lengths.
    #[inline(always)]
    fn cursor(self, time: f32) -> [f32; 3] {
        let [across, up, along, _] = self.phases;
        let around = time * self.rounds;
        [
            0.55 * sine(around + across),
            0.55 + 0.35 * sine(time * 2.0 + up),
            0.55 * sine(around + across + 0.25) + 0.15 * sine(time * 3.0 + along),
        ]
    }

    /// Twist ψ at `time` (a fraction of the period), in turns.
    #[inline(always)]
    fn twist(self, time: f32) -> f32 {
        self.phases[3] + time * self.rounds
    }
}

/// sin 2πt, with an error below 1e-7, for an angle of t turns. Plain arithmetic vectorizes and
/// gives the same bits on every machine.
#[inline(always)]
fn sine(turns: f32) -> f32 {
    // Reduces the angle to −¼ … ¼ turn without changing its sine.
    let turns = turns - turns.round_ties_even();
    let half = if turns < 0.0 { -0.5 } else { 0.5 };
    let turns = if turns.abs() > 0.25 { half - turns } else { turns };
    let x = turns * TAU;
    let square = x * x;
    // Taylor's series up to x¹¹: at a quarter turn the next term is 6e-8.
    let series = -1.0 / 39_916_800.0;
    let series = series * square + 1.0 / 362_880.0;
    let series = series * square - 1.0 / 5_040.0;
    let series = series * square + 1.0 / 120.0;
    let series = series * square - 1.0 / 6.0;
    x + x * square * series
}
