//! Accuracy of the hand.

use glam::{DAffine3, DVec3, Vec3};
use ik_arm_kinematics::job::TwoBoneJob;
use ik_arm_kinematics::two_bone::Reach;

use crate::common::Random;
use crate::two_bone_job::skeleton::*;

#[test]
fn the_hand_is_within_a_millionth_of_the_chain_at_103_000_random_targets() {
    let (mut random, mut worst) = (Random(1), 0.0_f64);
    for _ in 0..103_000 {
        let skeleton = Skeleton::random(&mut random);
        let direction = random.direction().as_dvec3();
        let target = skeleton.point_in_reach(direction, random.within(0.0..1.0).into());
        let job = TwoBoneJob {
            pole: Some(random.vector(1.0)),
            hinge: Some(if random.chance(0.2) { Vec3::ZERO } else { random.vector(1.0) }),
            twist: random.within(-4.0..4.0),
            ..skeleton.job(target)
        };
        let correction = run(job);
        assert_eq!(correction.reach, Reach::Reached, "{correction:?}");
        let [_, _, hand] = skeleton.turned(&correction).points();
        worst = worst.max(hand.distance(target) / skeleton.length());
    }
    println!("worst hand error: {worst:e} of the chain's length");
    assert!(worst <= EXACT, "{worst:e}");
}

#[test]
fn a_hand_reported_reached_close_to_a_limit_is_at_its_target() {
    let (mut random, mut worst, mut reached) = (Random(2), 0.0_f64, 0);
    for _ in 0..50_000 {
        let skeleton = Skeleton::random(&mut random);
        let share = if random.chance(0.5) { 0.0 } else { 1.0 };
        let share = share + f64::from(random.within(-2e-6..2e-6));
        let direction = random.direction().as_dvec3();
        let target = skeleton.point_in_reach(direction, share);
        let job = TwoBoneJob { pole: Some(random.vector(1.0)), ..skeleton.job(target) };
        let correction = run(job);
        let [_, _, hand] = skeleton.turned(&correction).points();
        if correction.reach == Reach::Reached {
            reached += 1;
            worst = worst.max(hand.distance(target) / skeleton.length());
        }
    }
    println!("reached: {reached}, worst hand error: {worst:e} of the chain's length");
    assert!(reached > 10_000 && worst <= EXACT, "{reached}, {worst:e}");
}

/// A limit keeps the hand of all but the first target, at distances that a hand within its bones'
/// reach may have by rounding alone.
#[test]
fn a_target_beyond_the_limit_is_reached_only_within_the_rounding_of_the_limit() {
    for exponent in [-20, -3, 0, 3, 20] {
        let parent = DAffine3::from_scale(DVec3::splat(2_f64.powi(exponent)));
        let skeleton = Skeleton { parent, ..Skeleton::square() };
        for (ulps, reach) in [(1, Reach::Reached), (2, Reach::TooFar), (4, Reach::TooFar)] {
            let distance = 2.0 * (1.0 + f64::from(ulps) * f64::from(f32::EPSILON));
            let target = parent.transform_point3(distance * DVec3::X);
            let correction = run(skeleton.job(target));
            assert_eq!(correction.reach, reach, "{ulps} ulps, 2^{exponent}");
        }
    }
}
