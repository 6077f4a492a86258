//! Many arms on a plane, each after a target of its own: what a batch is for.

use core::f32::consts::{PI, TAU};
use core::time::Duration;
use std::time::Instant;

use glam::Vec3;
use multiversion::multiversion;

use crate::kinematics::batch::{Arms, BatchError, Bones, Places, Points, PointsMut, Spin};
use crate::kinematics::two_bone::TwoBone;

/// What makes a crowd what it is at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crowd {
    /// How many arms there are, at most [`Crowd::MOST`].
    pub arms: u32,
    /// All have the same.
    pub bones: TwoBone,
    /// In seconds; after [`Crowd::PERIOD`] it begins again.
    pub time: f32,
    pub solved_by: SolvedBy,
}

/// Where arms are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SolvedBy {
    /// By [`batch`](crate::kinematics::batch), on all cores.
    #[default]
    Cpu,
    /// By the same mathematics in a shader.
    Gpu,
}

impl Crowd {
    pub const MOST: u32 = 1_000_000;

    /// Seconds after which all targets are where they were.
    pub const PERIOD: f32 = 16.0;

    /// How far apart the shoulders are, in lengths of an arm: targets of neighbours hardly meet.
    const SPACING: f32 = 1.15;

    /// A sphere around all arms, in the world: middle and radius.
    pub fn bounds(&self) -> (Vec3, f32) {
        let reach = self.bones.outer_limit();
        (Vec3::ZERO, self.spread() * (self.arms as f32).sqrt() + reach)
    }

    /// A shoulder's distance from the middle is this many times the root of its number, so that each
    /// has as much of the plane for itself.
    fn spread(&self) -> f32 {
        Self::SPACING * self.bones.outer_limit() / PI.sqrt()
    }
}

/// How long a crowd took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrowdTimes {
    pub arms: u32,
    /// The solving alone, from cursors to elbows and hands.
    pub solve: Duration,
}

/// The arms of a crowd: what each is asked and what it answers, kind beside kind.
#[derive(Debug, Default)]
pub struct CrowdArrays {
    /// On the plane y = 0 of the world; the arms' Root spaces differ from it by no turn.
    pub shoulder: [Vec<f32>; 2],
    /// In Root space.
    pub cursor: [Vec<f32>; 3],
    pub cos: Vec<f32>,
    pub sin: Vec<f32>,
    /// In Root space.
    pub elbow: [Vec<f32>; 3],
    pub hand: [Vec<f32>; 3],
    spread: f32,
}

impl CrowdArrays {
    /// Has as many arms as the crowd, with their shoulders where they belong. Says whether that is a
    /// change.
    ///
    /// Shoulders are set like the seeds of a sunflower (H. Vogel, *A Better Way to Construct the
    /// Sunflower Head*, 1979), so that more arms leave those that are there where they are.
    pub fn resize(&mut self, crowd: &Crowd) -> bool {
        /// 2π(1 − 1/φ).
        const GOLDEN: f64 = 2.399_963_229_728_653;
        let (arms, spread) = (crowd.arms as usize, crowd.spread());
        if self.len() == arms && self.spread == spread {
            return false;
        }
        let known = if self.spread == spread { self.len() } else { 0 };
        self.spread = spread;
        let Self { shoulder: [x, z], cursor, cos, sin, elbow, hand, .. } = self;
        for of in cursor.iter_mut().chain([cos, sin]).chain(elbow).chain(hand) {
            of.resize(arms, 0.0);
        }
        x.truncate(known);
        z.truncate(known);
        for arm in x.len()..arms {
            let far = spread * (arm as f32).sqrt();
            let (sin, cos) = (arm as f64 * GOLDEN).sin_cos();
            x.push(far * cos as f32);
            z.push(far * sin as f32);
        }
        true
    }

    pub fn len(&self) -> usize {
        self.cos.len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sets every cursor and spin to where it is at the crowd's time.
    pub fn set_targets(&mut self, crowd: &Crowd) {
        let time = (crowd.time / Crowd::PERIOD).rem_euclid(1.0);
        let Self { cursor: [x, y, z], cos, sin, .. } = self;
        follow(time, crowd.bones.outer_limit(), [x, y, z], [cos, sin]);
    }

    /// Answers all, and says how long that took.
    ///
    /// # Errors
    ///
    /// None, as long as all arrays are of one length, which they are.
    pub fn solve(&mut self, bones: TwoBone) -> Result<Duration, BatchError> {
        let Self { cursor: [x, y, z], cos, sin, elbow, hand, .. } = self;
        let arms = Arms::new(Bones::Same(bones), Points { x, y, z }, Spin::Turn { cos, sin })?;
        let places = Places { elbow: PointsMut::of(elbow), hand: PointsMut::of(hand) };
        let start = Instant::now();
        #[cfg(feature = "parallel")]
        arms.solve_on_all_cores(places, None)?;
        #[cfg(not(feature = "parallel"))]
        arms.solve(places, None)?;
        Ok(start.elapsed())
    }
}

/// Where each target is in its round, at a time from 0 to 1: on a loop before and above its shoulder,
/// some of it out of reach, the elbow going around by itself.
#[multiversion(targets(
    "x86_64+avx512f+avx512vl+avx512dq+avx512bw",
    "x86_64+avx2",
    "aarch64+neon"
))]
fn follow(time: f32, reach: f32, cursor: [&mut [f32]; 3], spin: [&mut [f32]; 2]) {
    const BLOCK: usize = 256;
    let arms = cursor[0].len();
    let mut block = [[0.0_f32; BLOCK]; 5];
    let [x, y, z] = cursor;
    let [cos, sin] = spin;
    let mut arrays = [x, y, z, cos, sin];
    for from in (0..arms).step_by(BLOCK) {
        for (arm, of) in (from as u32..).zip(0..BLOCK) {
            let own = Own::of(arm);
            let [x, y, z] = own.cursor(time);
            block[0][of] = x * reach;
            block[1][of] = y * reach;
            block[2][of] = z * reach;
            let turn = own.spin(time);
            block[3][of] = sine(turn + 0.25);
            block[4][of] = sine(turn);
        }
        let to = arms.min(from + BLOCK);
        for (array, block) in arrays.iter_mut().zip(&block) {
            array[from..to].copy_from_slice(&block[..to - from]);
        }
    }
}

/// What one arm has for itself: shares of a round from 0 to 1, out of its number.
#[derive(Clone, Copy)]
struct Own {
    phases: [f32; 4],
    /// 1 or 2 rounds in a period, the one way or the other.
    rounds: f32,
}

impl Own {
    #[inline(always)]
    fn of(arm: u32) -> Self {
        // Mixed well (C. Wellons, *Prospecting for Hash Functions*, 2018).
        let mut mixed = arm.wrapping_add(0x9e37_79b9);
        mixed = (mixed ^ (mixed >> 16)).wrapping_mul(0x7feb_352d);
        mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x846c_a68b);
        mixed ^= mixed >> 16;
        let phase = |byte: u32| ((mixed >> (8 * byte)) & 0xff) as f32 / 256.0;
        let rounds = if mixed & 1 == 0 { 1.0 } else { 2.0 };
        let way = if mixed & 2 == 0 { 1.0 } else { -1.0 };
        Self { phases: [phase(0), phase(1), phase(2), phase(3)], rounds: rounds * way }
    }

    /// In lengths of the arm.
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

    /// ψ in turns.
    #[inline(always)]
    fn spin(self, time: f32) -> f32 {
        self.phases[3] + time * self.rounds
    }
}

/// sin 2πt, to 1e-7: in plain arithmetic, so that it is done for many arms at once and is the same on
/// every machine.
#[inline(always)]
fn sine(turns: f32) -> f32 {
    // To the nearest quarter before or after 0, where the sine has the same value.
    let turns = turns - turns.round_ties_even();
    let half = if turns < 0.0 { -0.5 } else { 0.5 };
    let turns = if turns.abs() > 0.25 { half - turns } else { turns };
    let x = turns * TAU;
    let square = x * x;
    // Taylor's series up to x¹¹: the next term is 6e-8 at a quarter.
    let series = -1.0 / 39_916_800.0;
    let series = series * square + 1.0 / 362_880.0;
    let series = series * square - 1.0 / 5_040.0;
    let series = series * square + 1.0 / 120.0;
    let series = series * square - 1.0 / 6.0;
    x + x * square * series
}
