//! Accuracy of hands and limb lengths, over random arms of every kind.

use glam::{DVec3, Vec3};
use ik_arm_kinematics::two_bone::TwoBone;

use crate::common::Random;

/// Allowed error of a hand and of a limb's length, in arm lengths: below the promised 3e-7.
const BOUND: f64 = 2.8e-7;

/// An arm, its cursor and its twist.
struct Case {
    arm: TwoBone,
    cursor: Vec3,
    twist: f32,
}

/// The largest errors so far, in arm lengths, each with its case.
#[derive(Default)]
struct Worst {
    hand: (f64, String),
    length: (f64, String),
}

impl Case {
    /// Lengths 1e-2 to 1e4; bones 30 : 1, less uneven, nearly equal and equal.
    fn random(random: &mut Random) -> Self {
        let longer = random.power_of_ten(-2.0..4.0);
        let ratio = match random.below(8) {
            0..4 => 30.0,
            4 | 5 => 30_f64.powf(random.within(0.0..1.0).into()),
            6 => 1.0 + f64::from(random.within(-1e-6..1e-6)),
            _ => 1.0,
        };
        let shorter = (longer / ratio).max(1e-2);
        let (upper, lower) = if random.chance(0.5) { (longer, shorter) } else { (shorter, longer) };
        let arm = TwoBone::new(upper as f32, lower as f32).expect("lengths");
        let cursor = direction(random) * radius(random, arm);
        let twist = if random.chance(0.25) { 0.0 } else { random.within(-10.0..10.0) };
        Self { arm, cursor: cursor.as_vec3(), twist }
    }
}

impl Worst {
    fn of(count: usize, seed: u64) -> Self {
        let mut random = Random(seed);
        let mut worst = Self::default();
        for _ in 0..count {
            worst.add(&Case::random(&mut random));
        }
        worst
    }

    fn add(&mut self, case: &Case) {
        let Case { arm, cursor, twist } = *case;
        let pose = arm.solve(cursor, twist);
        let [upper, lower] = [arm.upper(), arm.lower()].map(f64::from);
        let (arm_length, cursor) = (upper + lower, cursor.as_dvec3());
        let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
        let distance = cursor.length().clamp((upper - lower).abs(), arm_length);
        let at_hand = hand.distance(cursor.normalize() * distance);
        let at_upper = (elbow.length() - upper).abs();
        let at_lower = (elbow.distance(hand) - lower).abs();
        assert!(elbow.is_finite() && hand.is_finite(), "{pose:?}");
        for (worst, error) in
            [(&mut self.hand, at_hand), (&mut self.length, at_upper.max(at_lower))]
        {
            let error = error / arm_length;
            if error > worst.0 {
                *worst = (error, format!("{upper} and {lower} to {cursor} with twist {twist}"));
            }
        }
    }
}

/// Uniform on the sphere, or with coordinates of very different sizes: near each axis and plane.
fn direction(random: &mut Random) -> DVec3 {
    if random.chance(0.5) {
        return random.direction().as_dvec3();
    }
    let mut coordinate = || {
        let size = random.power_of_ten(-8.0..0.0);
        if random.chance(0.5) { size } else { -size }
    };
    DVec3::new(coordinate(), coordinate(), coordinate()).normalize()
}

/// From below the inner limit to beyond the outer one, often close to either.
fn radius(random: &mut Random, arm: TwoBone) -> f64 {
    let (inner, outer) = (f64::from(arm.inner_limit()), f64::from(arm.outer_limit()));
    let share = match random.below(4) {
        0 => random.within(0.0..1.0).into(),
        1 => random.power_of_ten(-8.0..0.0),
        2 => 1.0 - random.power_of_ten(-8.0..0.0),
        _ => return outer * f64::from(random.within(1e-3..1.3)),
    };
    inner + share * (outer - inner)
}

#[test]
fn hands_and_limb_lengths_are_within_2_8e_7_of_the_arm_length() {
    let Worst { hand, length } = Worst::of(1_000_000, 1);
    assert!(hand.0 <= BOUND, "hand off by {:e}: {}", hand.0, hand.1);
    assert!(length.0 <= BOUND, "limb length off by {:e}: {}", length.0, length.1);
    // The sample has cases in which rounding adds up.
    assert!(hand.0 > 1.5e-7 && length.0 > 1.8e-7, "{:e}, {:e}", hand.0, length.0);
}

#[test]
#[ignore = "measures the worst errors over five times 1,000,000 random arms"]
fn other_random_seeds_are_as_exact() {
    for seed in 1..6 {
        let Worst { hand, length } = Worst::of(1_000_000, seed);
        println!("seed {seed}: hand {:.3e} of the arm length: {}", hand.0, hand.1);
        println!("seed {seed}: limb {:.3e} of the arm length: {}", length.0, length.1);
        assert!(hand.0 <= BOUND && length.0 <= BOUND, "seed {seed}");
    }
}
