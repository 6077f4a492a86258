//! The arm with a twist reference and soft reach: agreement with the plain arm, and bounds of
//! speed.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};
use ik_arm_kinematics::ik::{Ik, IkSolution, IkState};
use ik_arm_kinematics::soft_reach::SoftReach;
use ik_arm_kinematics::twist::{Stereographic, TwistReference};
use ik_arm_kinematics::two_bone::{Pointer, Reach, TwoBone};
use proptest::prelude::*;

use crate::common::strategies::{arms_of, config, limits, points, references};

fn softenings() -> impl Strategy<Value = SoftReach> {
    (0.0..0.9_f32, 1.0..2.0_f32, 0.0..2.0_f32)
        .prop_map(|(softness, stretch, angle)| soft(softness, stretch, angle))
}

fn soft(softness: f32, stretch: f32, angle: f32) -> SoftReach {
    SoftReach::new(softness, stretch, angle).expect("a softening")
}

fn bits(v: Vec3) -> [u32; 3] {
    v.to_array().map(f32::to_bits)
}

proptest! {
    #![proptest_config(config(10_000, 0x001c_0de5))]

    #[test]
    fn without_options_a_pose_is_bit_identical_to_the_plain_arm(
        bones in arms_of(1.0..10.0), cursor in points(25.0), twist in -7.0..7.0_f32
    ) {
        let plain = bones.solve(cursor, twist);
        let ik = Ik { bones, reference: TwistReference::Up, soft_reach: SoftReach::default() };
        let pose = ik.solve(cursor, twist, IkState::default()).pose;
        prop_assert_eq!(bits(pose.elbow), bits(plain.elbow));
        prop_assert_eq!(bits(pose.hand), bits(plain.hand));
        prop_assert_eq!(pose, plain);
    }

    #[test]
    fn softness_does_not_change_the_direction_of_the_elbow(
        bones in arms_of(1.0..10.0), cursor in points(25.0), twist in 0.0..6.0_f32,
        reference in references(points(25.0)), soft_reach in softenings()
    ) {
        let hard = Ik { bones, reference, soft_reach: SoftReach::default() };
        let soft = Ik { soft_reach, ..hard };
        let [hard, soft] = [hard, soft].map(|ik| ik.solve(cursor, twist, IkState::default()));
        prop_assert!(hard.pose.outward().distance(soft.pose.outward()) < 1e-6);
        prop_assert_eq!(hard.transported, soft.transported);
    }

    #[test]
    fn the_elbow_is_turned_from_the_reference_by_the_twist(
        bones in arms_of(1.0..10.0), cursor in points(25.0), twist in 0.0..6.0_f32, reference in references(points(25.0))
    ) {
        let ik = Ik { bones, reference, soft_reach: SoftReach::default() };
        let IkSolution { pose, transported, .. } = ik.solve(cursor, twist, IkState::default());
        let (w, e) = (pose.pointer.direction.as_dvec3(), transported.outward.as_dvec3());
        let (sin, cos) = f64::from(twist).sin_cos();
        let expected = e * cos + w.cross(e) * sin;
        let elbow = w * f64::from(pose.along) + expected * f64::from(pose.out);
        let error = elbow.distance(pose.elbow.as_dvec3());
        prop_assert!(error < 2e-6 * limits(bones).1, "off by {}", error);
    }

    #[test]
    fn a_softened_hand_is_on_the_line_to_the_cursor_and_its_limbs_are_stretched_alike(
        bones in arms_of(1.0..10.0), cursor in points(25.0), reference in references(points(25.0)), soft_reach in softenings()
    ) {
        let ik = Ik { bones, reference, soft_reach };
        let pose = ik.solve(cursor, 0.3, IkState::default()).pose;
        let (l, sigma) = (limits(bones).1, f64::from(pose.stretch));
        let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
        let asked = cursor.as_dvec3();
        let extent = soft_reach.hand_distance(bones, asked.length() as f32);
        prop_assert!(hand.distance(asked.normalize() * f64::from(extent.distance)) < 1e-6 * l);
        for (limb, rest) in [(elbow.length(), bones.upper()), ((hand - elbow).length(), bones.lower())]
        {
            prop_assert!((limb - sigma * f64::from(rest)).abs() < 6e-7 * sigma * l);
        }
        let short = asked.length() - f64::from(extent.distance);
        let expected = match short / l {
            off if off > 2e-6 => Some(Reach::TooFar),
            off if off < -2e-6 => Some(Reach::TooClose),
            off if off.abs() < 0.5e-6 => Some(Reach::Reached),
            _ => None,
        };
        prop_assert!(expected.is_none_or(|reach| Some(reach) == pose.reach), "{:?} off by {}", pose.reach, short);
        prop_assert!(pose.reach != Some(Reach::Reached) || hand.distance(asked) < 3e-6 * l);
    }

    #[test]
    fn a_pose_is_recovered_from_its_hand_and_its_elbow(
        bones in arms_of(1.0..10.0), cursor in points(25.0), twist in 0.0..6.0_f32,
        from in references(points(25.0)), to in references(points(25.0)), soft_reach in softenings()
    ) {
        let from = Ik { bones, reference: from, soft_reach };
        let to = Ik { reference: to, ..from };
        let solved = from.solve(cursor, twist, IkState::default());
        let (cursor, twist) = to.matching(&solved.pose, None);
        prop_assert!((0.0..TAU as f32).contains(&twist));
        let again = to.solve(cursor, twist, IkState { pointer: solved.pose.pointer, transported: None }).pose;
        let l = limits(bones).1;
        let hand = again.hand.as_dvec3().distance(solved.pose.hand.as_dvec3());
        let stretched = f64::from(solved.pose.stretch) * l;
        prop_assert!(hand < 1e-6 * stretched, "the hand is off by {}", hand / l);
        let angle = solved.pose.elbow_angle().to_degrees();
        let bound = if (1.0..=179.0).contains(&angle) { 1e-5 } else { 1e-3 };
        let elbow = again.elbow.as_dvec3().distance(solved.pose.elbow.as_dvec3());
        prop_assert!(elbow < bound * stretched, "the elbow is off by {} at {}°", elbow / l, angle);
    }
}

/// A smooth path through space: three waves along each axis.
#[derive(Clone, Debug)]
struct Way([[(f64, f64); 3]; 3]);

impl Way {
    fn at(&self, t: f64) -> DVec3 {
        DVec3::from_array(self.0.map(|waves| {
            let wave = |(place, (size, phase)): (usize, &(f64, f64))| {
                size * ((place as f64 + 1.0) * t + phase).sin()
            };
            waves.iter().enumerate().map(wave).sum()
        }))
    }
}

fn ways() -> impl Strategy<Value = Way> {
    let wave = || (-0.6..0.6_f64, 0.0..TAU);
    let axis = move || [wave(), wave(), wave()];
    [axis(), axis(), axis()].prop_map(Way)
}

/// Bound of the elbow's speed relative to the cursor's, in f64.
fn bound(arm: TwoBone, softness: f64, cursor: DVec3, gain: f64) -> f64 {
    let [d1, d2] = [arm.upper(), arm.lower()].map(f64::from);
    let (l, least, d) = (d1 + d2, (d1 - d2).abs(), cursor.length());
    let w = softness * (l - least) / 2.0;
    let (distance, slope) = if d > l - w {
        let left = (-(d - (l - w)) / w).exp();
        (l - w * left, left)
    } else if d < least + w {
        let left = ((d - (least + w)) / w).exp();
        (least + w * left, left)
    } else {
        (d, 1.0)
    };
    let along = (distance * distance + d1 * d1 - d2 * d2) / (2.0 * distance);
    let out = (d1 * d1 - along * along).max(0.0).sqrt();
    let radial = slope * d1 * (distance - along).abs() / (distance * out);
    let around = (d1 + out * gain) / d;
    radial.hypot(around)
}

/// Largest excess of the elbow's movement over its bound along a path, relative to the arm's
/// length. Steps near the shoulder, or nearer to a direction than 30°, are left out.
fn excess(ik: Ik, softness: f64, way: &Way, avoided: Option<DVec3>) -> f64 {
    const STEPS: usize = 6000;
    let l = limits(ik.bones).1;
    let counts = |cursor: DVec3| {
        let near = avoided.is_some_and(|avoided| cursor.normalize().dot(avoided) > 0.866);
        cursor.length() > 0.05 * l && !near
    };
    let gain = |cursor: DVec3| {
        let pointer = Pointer::towards(cursor.as_vec3(), Pointer::default());
        f64::from(ik.reference.gain(pointer))
    };
    let mut worst: f64 = 0.0;
    let mut last: Option<(DVec3, IkSolution)> = None;
    for step in 0..=STEPS {
        let cursor = way.at(TAU * step as f64 / STEPS as f64) * l;
        let state = last.map_or_else(IkState::default, |(_, solved)| solved.state());
        let solved = ik.solve(cursor.as_vec3(), 0.7, state);
        if let Some((before, was)) = last
            && counts(before)
            && counts(cursor)
        {
            let middle = before.midpoint(cursor);
            let fastest = [before, middle, cursor]
                .map(|cursor| bound(ik.bones, softness, cursor, gain(cursor)))
                .into_iter()
                .fold(0.0, f64::max);
            let moved = solved.pose.elbow.as_dvec3().distance(was.pose.elbow.as_dvec3());
            worst = worst.max((moved - 1.02 * fastest * before.distance(cursor)) / l);
        }
        last = Some((cursor, solved));
    }
    worst
}

/// Elbow movement by rounding of the hand for a nearly straight arm, relative to its length.
const ROUNDING: f64 = 2e-4;

proptest! {
    #![proptest_config(config(1_000, 0x001c_0de5))]

    #[test]
    fn a_soft_elbow_never_pops_with_stereographic(
        bones in arms_of(1.0..10.0), way in ways(), softness in 0.1..0.8_f32
    ) {
        let map = Stereographic::default();
        let ik =
            Ik { bones, reference: TwistReference::Stereographic(map), soft_reach: soft(softness, 1.0, 0.0) };
        let avoided = Some(map.singular().as_dvec3());
        let excess = excess(ik, f64::from(softness), &way, avoided);
        prop_assert!(excess < ROUNDING, "faster than its bound by {}", excess);
    }

    #[test]
    fn a_soft_elbow_never_pops_with_transport(
        bones in arms_of(1.0..10.0), way in ways(), softness in 0.1..0.8_f32
    ) {
        let ik = Ik { bones, reference: TwistReference::Transport, soft_reach: soft(softness, 1.0, 0.0) };
        let excess = excess(ik, f64::from(softness), &way, None);
        prop_assert!(excess < ROUNDING, "faster than its bound by {}", excess);
    }
}

/// The elbow's speed over the cursor's where the cursor passes a point above the shoulder by a
/// hair.
fn speed_beside_vertical(reference: TwistReference, aside: f32) -> f64 {
    let bones = TwoBone::new(1.0, 1.0).expect("lengths");
    let ik = Ik { bones, reference, soft_reach: soft(0.2, 1.0, 0.0) };
    let step = 0.1 * aside;
    let elbow =
        |x: f32| ik.solve(Vec3::new(x, 1.2, aside), 0.0, IkState::default()).pose.elbow.as_dvec3();
    elbow(-0.5 * step).distance(elbow(0.5 * step)) / f64::from(step)
}

#[test]
fn past_vertical_elbow_speed_is_unbounded_with_limb_and_bounded_with_stereographic() {
    for bound in [1e1, 1e2, 1e3, 1e4] {
        let aside = 0.5 / bound as f32;
        let speed = speed_beside_vertical(TwistReference::Up, aside);
        assert!(speed > bound, "{speed} at {aside}");
        let map = TwistReference::Stereographic(Stereographic::default());
        let speed = speed_beside_vertical(map, aside.max(1e-3));
        assert!(speed < 3.0, "{speed} at {aside}");
    }
}

#[test]
fn without_softness_the_speed_of_a_nearly_straight_elbow_is_unbounded() {
    let bones = TwoBone::new(1.0, 1.0).expect("lengths");
    let speed = |soft_reach, from: f32| {
        let ik = Ik { bones, reference: TwistReference::Up, soft_reach };
        let elbow = |x| ik.solve(Vec3::X * x, 0.0, IkState::default()).pose.elbow.as_dvec3();
        elbow(from).distance(elbow(2.0)) / f64::from(2.0 - from)
    };
    for (near, bound) in [(1e-2, 5.0), (1e-4, 50.0), (1e-6, 500.0)] {
        assert!(speed(SoftReach::default(), 2.0 - near) > bound);
        assert!(speed(soft(0.2, 1.0, 0.0), 2.0 - near) < 5.0);
    }
}

#[test]
fn transport_without_earlier_state_starts_stereographic() {
    let bones = TwoBone::new(1.0, 1.0).expect("lengths");
    let solve = |reference| {
        let ik = Ik { bones, reference, soft_reach: SoftReach::default() };
        ik.solve(Vec3::new(0.3, 0.9, -0.4), 0.5, IkState::default())
    };
    let map = TwistReference::Stereographic(Stereographic::default());
    assert_eq!(solve(TwistReference::Transport), solve(map));
}

#[test]
fn a_cursor_whose_distance_overflows_is_not_reached() {
    const FAR: f32 = f32::MAX;
    // √2 times as far as the largest number.
    let cursor = Vec3::new(0.0, FAR, FAR);
    let bones = TwoBone::new(1.0, FAR).expect("lengths");
    let ik = Ik { bones, reference: TwistReference::Up, soft_reach: soft(0.1, 1.0, 0.0) };
    let pose = ik.solve(cursor, 0.0, IkState::default()).pose;
    assert_eq!(pose.reach, Some(Reach::TooFar));
    assert!((pose.hand.as_dvec3().length() / f64::from(FAR) - 1.0).abs() < 0.1, "{}", pose.hand);
}
