//! Limbs of random skeletons: reach, hinges, limits, elbow references, influence and stretch, seen
//! by forward kinematics alone.

use core::f32::consts::{PI, TAU};

use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};
use ik_arm_kinematics::limb_ik::{
    CarriedLimb, ElbowReference, Limb, LimbReach, LimbReport, LimbTarget, fk_twist, solve, step,
};
use ik_arm_kinematics::skeleton::{
    Cone, Joint, JointId, JointLimits, Limit, RotationAxis, Skeleton,
};
use ik_arm_kinematics::soft_reach::SoftReach;
use ik_arm_kinematics::twist::Stereographic;

use crate::common::Random;

const CASES: usize = 2_000;

const PELVIS: JointId = JointId::new(1);
const HIP: JointId = JointId::new(2);

/// A skeleton with a limb: root, pelvis, hip, perhaps a locked joint between the bones, knee, foot.
pub fn leg(random: &mut Random) -> (Skeleton, Limb) {
    let mut skeleton = Skeleton::with_root("root");
    let pelvis = Joint::new("pelvis", Some(JointId::new(0)), random.vector(0.5));
    skeleton.add(Joint { rotation: random.vector(3.0), ..pelvis }).expect("pelvis");
    let bone = |random: &mut Random| random.direction() * random.within(0.3..2.0);
    let hip = Joint::new("hip", Some(PELVIS), bone(random));
    let rotation = random.vector(3.0);
    let mut last =
        skeleton.add(Joint { offset: random.vector(0.5), rotation, ..hip }).expect("hip");
    let mut offset = skeleton[last].axis;
    if random.chance(0.3) {
        let twist = Joint::new("twist", Some(last), bone(random) * 0.2);
        let rotation = random.vector(0.5);
        last = skeleton.add(Joint { offset, rotation, locked: true, ..twist }).expect("twist");
        offset = skeleton[last].axis;
    }
    let knee = Joint::new("knee", Some(last), bone(random));
    let knee = Joint { offset, rotation: random.vector(2.0), frame: frame(random), ..knee };
    let knee = skeleton.add(knee).expect("knee");
    let foot = Joint::new("foot", Some(knee), random.vector(0.3));
    let offset = skeleton[knee].axis;
    skeleton.add(Joint { offset, rotation: random.vector(1.0), ..foot }).expect("foot");
    skeleton.set_transform(transform(random)).expect("finite");
    let limb = Limb::ending_at(&skeleton, knee).expect("a limb");
    (skeleton, limb)
}

/// A right-handed frame of axes, or the identity.
fn frame(random: &mut Random) -> Mat3 {
    if random.coin() { Mat3::IDENTITY } else { random.rotation() }
}

/// A transform with an even scale, mirrored or not.
fn transform(random: &mut Random) -> Affine3A {
    let scale = random.within(0.1..10.0);
    let side = if random.coin() { 1.0 } else { -1.0 };
    Affine3A::from_scale_rotation_translation(
        Vec3::new(side, 1.0, 1.0) * scale,
        Quat::from_mat3(&random.rotation()),
        random.vector(scale),
    )
}

/// Fixes all angles of the lower joint but one.
pub fn with_hinge(
    random: &mut Random,
    mut skeleton: Skeleton,
    limb: Limb,
) -> (Skeleton, RotationAxis) {
    let free = random.one_of(&RotationAxis::ALL);
    skeleton
        .change(limb.lower, |knee| {
            for axis in RotationAxis::ALL {
                let angle = knee.rotation[axis.index()];
                let fixed = (axis != free).then_some(Limit { min: angle, max: angle });
                knee.limits.set_range(axis, fixed);
            }
            if random.coin() {
                let angle = knee.rotation[free.index()];
                let (below, above) = (random.within(0.0..2.5), random.within(0.0..2.5));
                let range = Limit { min: angle - below, max: angle + above };
                knee.limits.set_range(free, Some(range));
            }
        })
        .expect("limits");
    (skeleton, free)
}

/// Positions of the tip for random angles within the limits of hip and knee: all are in reach.
pub fn reachable(random: &mut Random, skeleton: &Skeleton, limb: Limb) -> Vec3 {
    let mut other = skeleton.clone();
    for joint in [limb.upper, limb.lower] {
        let rotation = skeleton[joint].limits.project(random.vector(3.0));
        other.set_rotation(joint, rotation).expect("a joint");
    }
    other.tip(limb.lower)
}

/// Length of both bones in the world.
fn length(skeleton: &Skeleton, limb: Limb) -> f32 {
    let [hip, knee, tip] = points(skeleton, limb);
    hip.distance(knee) + knee.distance(tip)
}

/// The change of the tip's distance as each movable angle of the lower joint grows by 0.01.
fn changes_of_distance(skeleton: &Skeleton, limb: Limb) -> impl Iterator<Item = f32> + '_ {
    let distance =
        move |skeleton: &Skeleton| skeleton.base(limb.upper).distance(skeleton.tip(limb.lower));
    let knee = &skeleton[limb.lower];
    let free = RotationAxis::ALL.into_iter().filter(|axis| !knee.limits.is_fixed(*axis));
    free.map(move |axis| {
        let mut other = skeleton.clone();
        let change = |knee: &mut Joint| {
            knee.limits = JointLimits::NONE;
            knee.rotation[axis.index()] += 0.01;
        };
        other.change(limb.lower, change).expect("a joint");
        (distance(&other) - distance(skeleton)).abs()
    })
}

fn points(skeleton: &Skeleton, limb: Limb) -> [Vec3; 3] {
    [skeleton.base(limb.upper), skeleton.base(limb.lower), skeleton.tip(limb.lower)]
}

fn solved(skeleton: &Skeleton, limb: Limb, target: &LimbTarget) -> (Skeleton, LimbReport) {
    let mut solved = skeleton.clone();
    let report = solve(&mut solved, limb, target).expect("an invertible transform");
    (solved, report)
}

#[test]
fn a_hinged_limb_reaches_every_target_within_its_limits_about_its_hinge_alone() {
    let mut random = Random(15);
    for case in 0..CASES {
        let (skeleton, limb) = leg(&mut random);
        let (skeleton, free) = with_hinge(&mut random, skeleton, limb);
        let point = reachable(&mut random, &skeleton, limb);
        let (after, report) = solved(&skeleton, limb, &LimbTarget::new(point));
        let length = length(&skeleton, limb);
        let error = after.tip(limb.lower).distance(point);
        assert!(error <= 1e-5 * length, "{case}: {error} of {length}, {report:?}");
        assert!((report.error - error).abs() <= 1e-5 * length, "{case}: {report:?}, {error}");
        assert_eq!(report.reach, LimbReach::Reached, "{case}");
        let (knee, before) = (&after[limb.lower], &skeleton[limb.lower]);
        for axis in 0..3 {
            if axis != free.index() {
                assert_eq!(knee.rotation[axis], before.rotation[axis], "{case}: a fixed angle");
            }
        }
        assert_eq!(knee.limits.project(knee.rotation), knee.rotation, "{case}: limits");
        let others =
            skeleton.iter().filter(|(joint, _)| *joint != limb.upper && *joint != limb.lower);
        for (joint, before) in others {
            assert_eq!(&after[joint], before, "{case}");
        }
    }
}

#[test]
fn a_ball_joint_keeps_the_plane_of_its_fk_bend() {
    let mut random = Random(16);
    for case in 0..CASES {
        let (skeleton, limb) = leg(&mut random);
        let point = reachable(&mut random, &skeleton, limb);
        let (after, report) = solved(&skeleton, limb, &LimbTarget::new(point));
        let length = length(&skeleton, limb);
        assert!(after.tip(limb.lower).distance(point) <= 1e-5 * length, "{case}: {report:?}");
        // The knee bends about the same axis of the upper joint's space.
        let normal = |skeleton: &Skeleton| {
            let [hip, knee, tip] = points(skeleton, limb);
            let to_upper = skeleton.full_transform(limb.upper).matrix3.inverse();
            let local = |v: Vec3| to_upper * glam::Vec3A::from(v);
            local(knee - hip).cross(local(tip - knee)).normalize()
        };
        assert!(normal(&after).distance(normal(&skeleton)) < 1e-3, "{case}");
    }
}

#[test]
fn the_tip_of_the_fk_pose_as_the_target_changes_nothing() {
    let mut random = Random(17);
    for case in 0..CASES {
        let (mut skeleton, limb) = leg(&mut random);
        if random.coin() {
            skeleton = with_hinge(&mut random, skeleton, limb).0;
        }
        let target = LimbTarget::new(skeleton.tip(limb.lower));
        let (after, _) = solved(&skeleton, limb, &target);
        let length = length(&skeleton, limb);
        for (before, after) in points(&skeleton, limb).into_iter().zip(points(&after, limb)) {
            assert!(before.distance(after) <= 3e-6 * length, "{case}: {before} to {after}");
        }
        // At its greatest and least distance the limb's angles depend on the target's rounding.
        if changes_of_distance(&skeleton, limb).any(|change| change < 5e-4 * length) {
            continue;
        }
        for joint in limb.joints() {
            let turned =
                Mat3::from(after[joint].local_rotation() - skeleton[joint].local_rotation());
            let largest =
                turned.to_cols_array().into_iter().fold(0.0, |max: f32, it| max.max(it.abs()));
            assert!(largest < 1e-4, "{case}: {joint} turned by {largest}");
        }
    }
}

#[test]
fn a_target_out_of_reach_is_pointed_at_by_the_straight_limb() {
    let mut random = Random(18);
    for case in 0..CASES {
        let (skeleton, limb) = leg(&mut random);
        let [hip, ..] = points(&skeleton, limb);
        let length = length(&skeleton, limb);
        let distance = length * random.within(1.01..3.0);
        let point = hip + random.direction() * distance;
        let (after, report) = solved(&skeleton, limb, &LimbTarget::new(point));
        assert_eq!(report.reach, LimbReach::TooFar, "{case}");
        assert!(
            (report.error - (distance - length)).abs() <= 1e-5 * distance,
            "{case}: {report:?}"
        );
        let [hip, knee, tip] = points(&after, limb);
        let straight = (tip - hip).normalize();
        assert!((knee - hip).reject_from(straight).length() <= 2e-3 * length, "{case}");
        assert!(straight.distance((point - hip).normalize()) < 1e-5, "{case}");
    }
}

#[test]
fn the_elbow_is_on_the_side_of_its_reference_turned_by_the_twist() {
    let mut random = Random(19);
    for case in 0..CASES {
        let (skeleton, limb) = leg(&mut random);
        let point = reachable(&mut random, &skeleton, limb);
        let pole = random.vector(10.0);
        let twist = random.within(-3.0..3.0);
        let reference = ElbowReference::Pole(pole);
        let target = LimbTarget { reference, twist, ..LimbTarget::new(point) };
        let (after, _) = solved(&skeleton, limb, &target);
        let [hip, knee, tip] = points(&after, limb);
        let pointer = (tip - hip).normalize();
        let elbow = (knee - hip).reject_from_normalized(pointer);
        let to_pole = (pole - hip).reject_from_normalized(pointer);
        if elbow.length() < 0.02 * hip.distance(knee) || to_pole.length() < 0.1 {
            continue;
        }
        let sign = skeleton.transform().matrix3.determinant().signum();
        let side = sign * pointer.cross(to_pole.normalize());
        let angle = elbow.dot(side).atan2(elbow.dot(to_pole.normalize()));
        let apart = (angle - twist + 9.0 * std::f32::consts::PI).rem_euclid(std::f32::consts::TAU)
            - std::f32::consts::PI;
        assert!(apart.abs() < 2e-3, "{case}: {angle} for {twist}");
    }
}

#[test]
fn the_fk_twist_of_every_reference_keeps_the_elbow() {
    let mut random = Random(20);
    for case in 0..CASES {
        let (skeleton, limb) = leg(&mut random);
        let reference = random.one_of(&[
            ElbowReference::Fk,
            ElbowReference::Up,
            ElbowReference::Pole(Vec3::new(3.0, 4.0, -5.0)),
            ElbowReference::Stereographic(Stereographic::default()),
        ]);
        let twist = fk_twist(&skeleton, limb, reference, None).expect("an invertible transform");
        let target = LimbTarget { reference, twist, ..LimbTarget::new(skeleton.tip(limb.lower)) };
        let (after, _) = solved(&skeleton, limb, &target);
        let length = length(&skeleton, limb);
        for (before, after) in points(&skeleton, limb).into_iter().zip(points(&after, limb)) {
            assert!(before.distance(after) <= 1e-5 * length, "{case}: {reference:?}");
        }
    }
}

#[test]
fn influence_0_is_the_fk_pose_bit_for_bit_and_bones_keep_their_lengths_at_every_influence() {
    let mut random = Random(21);
    for case in 0..CASES {
        let (skeleton, limb) = leg(&mut random);
        let point = reachable(&mut random, &skeleton, limb);
        let at = |influence| {
            solved(&skeleton, limb, &LimbTarget { influence, ..LimbTarget::new(point) }).0
        };
        assert_eq!(at(0.0), skeleton, "{case}");
        let blend = at(random.within(0.0..1.0));
        let lengths = |skeleton: &Skeleton| {
            let [hip, knee, tip] = points(skeleton, limb);
            [hip.distance(knee), knee.distance(tip)]
        };
        for (before, after) in lengths(&skeleton).into_iter().zip(lengths(&blend)) {
            assert!((before - after).abs() <= 1e-5 * before, "{case}");
        }
        let almost = at(0.9999).tip(limb.lower);
        assert!(
            almost.distance(at(1.0).tip(limb.lower)) < 2e-3 * length(&skeleton, limb),
            "{case}"
        );
    }
}

#[test]
fn a_hand_keeps_its_rotation_in_the_world() {
    let mut random = Random(22);
    for case in 0..CASES {
        let (skeleton, limb) = leg(&mut random);
        let point = reachable(&mut random, &skeleton, limb);
        let hand = Quat::from_mat3(&random.rotation());
        let (after, _) =
            solved(&skeleton, limb, &LimbTarget { hand: Some(hand), ..LimbTarget::new(point) });
        let foot = limb.hand.expect("a foot");
        let mut posed = after.clone();
        // Without the transform's scale, which may mirror, only the rotation is left.
        let (_, turned, _) = skeleton.transform().to_scale_rotation_translation();
        posed.set_transform(Affine3A::from_quat(turned)).expect("finite");
        let found = Quat::from_mat3a(&posed.full_transform(foot).matrix3);
        assert!(found.dot(hand).abs() > 1.0 - 1e-5, "{case}: {found} for {hand}");
    }
}

#[test]
fn a_stretched_limb_reaches_farther_and_a_soft_one_lags() {
    let mut random = Random(23);
    for case in 0..CASES {
        let (skeleton, limb) = leg(&mut random);
        let [hip, ..] = points(&skeleton, limb);
        let length = length(&skeleton, limb);
        let point = hip + random.direction() * length * random.within(1.01..1.45);
        let stretching = SoftReach::new(0.0, 1.5, 0.0).expect("in range");
        let target = LimbTarget { soft_reach: stretching, ..LimbTarget::new(point) };
        let (after, report) = solved(&skeleton, limb, &target);
        let [_, knee, tip] = points(&after, limb);
        assert!(tip.distance(point) < 1e-5 * length, "{case}: {report:?}");
        let grown = hip.distance(knee) + knee.distance(tip);
        assert!((grown / length - report.stretch).abs() < 1e-5, "{case}: {report:?}");

        let soft = SoftReach::new(0.3, 1.0, 0.0).expect("in range");
        let near = hip + (point - hip).normalize() * length * 0.99;
        let target = LimbTarget { soft_reach: soft, ..LimbTarget::new(near) };
        let (_, report) = solved(&skeleton, limb, &target);
        assert!(report.error > 1e-3 * length, "{case}: {report:?}");
        assert_eq!(report.reach, LimbReach::TooFar, "{case}");
    }
}

#[test]
fn a_straight_limb_bends_to_the_side_that_its_limits_allow() {
    let mut random = Random(24);
    let knee_forward = Limit { min: 0.0, max: 2.5 };
    let fixed = Limit { min: 0.0, max: 0.0 };
    for limits in [
        [Some(knee_forward), Some(fixed), Some(fixed)],
        [Some(knee_forward), Some(Limit { min: -0.1, max: 0.1 }), Some(fixed)],
        [
            Some(knee_forward),
            Some(Limit { min: -0.1, max: 0.1 }),
            Some(Limit { min: -0.1, max: 0.1 }),
        ],
    ] {
        let mut skeleton = Skeleton::with_root("pelvis");
        let thigh = Joint::new("thigh", Some(JointId::new(0)), Vec3::NEG_Y * 0.43);
        let thigh = skeleton.add(thigh).expect("thigh");
        let shin = Joint::new("shin", Some(thigh), Vec3::NEG_Y * 0.41);
        let shin = Joint { offset: Vec3::NEG_Y * 0.43, limits: limits.into(), ..shin };
        let shin = skeleton.add(shin).expect("shin");
        let limb = Limb::ending_at(&skeleton, shin).expect("a limb");
        for case in 0..1_000 {
            let below = random.direction() * Vec3::new(1.0, 1.0, 1.0);
            let point = Vec3::new(below.x, -below.y.abs(), below.z) * random.within(0.3..0.83);
            let (after, report) = solved(&skeleton, limb, &LimbTarget::new(point));
            assert_eq!(report.reach, LimbReach::Reached, "{case}: {limits:?}");
            assert!(after.tip(shin).distance(point) < 1e-5, "{case}: {report:?}");
            assert!(after[shin].rotation.x > 0.0, "{case}: the knee bends forward");
        }
    }
}

#[test]
fn limits_of_the_upper_joint_are_held_and_named() {
    let mut skeleton = Skeleton::with_root("root");
    let limits = JointLimits::new([Some(Limit { min: -0.2, max: 0.2 }); 3]);
    let upper = Joint { limits, ..Joint::new("upper", Some(JointId::new(0)), Vec3::X) };
    let upper = skeleton.add(upper).expect("upper");
    let lower = Joint { offset: Vec3::X, ..Joint::new("lower", Some(upper), Vec3::X) };
    let lower = skeleton.add(lower).expect("lower");
    let limb = Limb::ending_at(&skeleton, lower).expect("a limb");
    let (after, report) = solved(&skeleton, limb, &LimbTarget::new(Vec3::new(-1.5, 0.3, 0.2)));
    assert_eq!(report.reach, LimbReach::Limited(upper));
    assert_eq!(after[upper].limits.project(after[upper].rotation), after[upper].rotation);
    assert!((after.tip(lower).distance(Vec3::new(-1.5, 0.3, 0.2)) - report.error).abs() < 1e-6);
}

#[test]
fn degenerate_limbs_and_targets_give_finite_poses() {
    let mut random = Random(25);
    for case in 0..CASES {
        let (mut skeleton, limb) = leg(&mut random);
        let straight = random.coin();
        if straight {
            let axis = skeleton[limb.lower].offset * random.one_of(&[1.0, -1.0, 0.5, 1e-6, 1e6]);
            skeleton.set_axis(limb.lower, axis).expect("finite");
            skeleton.set_rotation(limb.lower, Vec3::ZERO).expect("finite");
        }
        let [hip, knee, tip] = points(&skeleton, limb);
        let point = random.one_of(&[
            hip,
            knee,
            hip + (hip - tip),
            hip + Vec3::Y,
            hip - Vec3::X,
            Vec3::splat(1e30),
            Vec3::splat(f32::MAX),
        ]);
        let soft_reach = SoftReach::new(random.within(0.0..0.9), 1.2, 0.5).expect("in range");
        let reference = random.one_of(&[
            ElbowReference::Fk,
            ElbowReference::Up,
            ElbowReference::Pole(point),
            ElbowReference::Stereographic(Stereographic::default()),
        ]);
        let target = LimbTarget { soft_reach, reference, ..LimbTarget::new(point) };
        let (after, report) = solved(&skeleton, limb, &target);
        assert!(report.error.is_finite() && report.stretch.is_finite(), "{case}: {report:?}");
        for (_, joint) in after.iter() {
            assert!(joint.rotation.is_finite() && joint.offset.is_finite(), "{case}: {joint:?}");
            assert!(joint.axis.is_finite(), "{case}: {joint:?}");
        }
    }
}

#[test]
fn limbs_are_found_by_their_ends() {
    let mut random = Random(26);
    let (mut skeleton, limb) = leg(&mut random);
    assert_eq!(limb.upper, HIP);
    let foot = skeleton.find("foot").expect("a foot");
    assert_eq!(limb.hand, Some(foot));
    assert_eq!(Limb::for_end(&skeleton, foot), None, "a chain that is no limb of a body");
    let spine = skeleton.add(Joint::new("spine", Some(PELVIS), Vec3::Y)).expect("a joint");
    assert_eq!(Limb::for_end(&skeleton, foot), Some(limb));
    assert_eq!(Limb::for_end(&skeleton, spine), None);
    let mut with_toes = skeleton.clone();
    let shin = skeleton[limb.lower].axis.length();
    with_toes.change(foot, |foot| foot.axis = Vec3::Z * 0.4 * shin).expect("a foot");
    for (name, length) in [("toe", 0.2), ("long toe", 0.3)] {
        let axis = Vec3::Z * length * shin;
        let toe = Joint { offset: with_toes[foot].axis, ..Joint::new(name, Some(foot), axis) };
        with_toes.add(toe).expect("a joint");
        assert_eq!(Limb::for_end(&with_toes, foot), Some(limb), "a foot with toes");
        assert_eq!(Limb::for_end(&with_toes, limb.lower), Some(limb));
    }
    with_toes.change(foot, |foot| foot.axis = Vec3::Z * 0.9 * shin).expect("a foot");
    assert_eq!(Limb::for_end(&with_toes, foot), None, "longer than a foot");
    let mut chain = Skeleton::with_root("root");
    let upper = chain.add(Joint::new("upper", Some(JointId::new(0)), Vec3::X)).expect("a joint");
    let lower = Joint { offset: Vec3::X, ..Joint::new("lower", Some(upper), Vec3::X) };
    let lower = chain.add(lower).expect("a joint");
    assert_eq!(Limb::for_end(&chain, lower), Some(Limb { upper, lower, hand: None }));
    let no_limb = |joint| Limb::ending_at(&skeleton, joint).expect_err("no limb").to_string();
    assert_eq!(no_limb(JointId::new(0)), "it has no bone");
    assert_eq!(no_limb(PELVIS), "no joint above it can turn it");
    assert_eq!(no_limb(JointId::new(99)), "there is no joint 99");
}

#[test]
fn limits_of_the_upper_joint_turn_the_elbow_aside_by_as_little_as_they_must() {
    const PLACES: u16 = 360;
    let mut random = Random(47);
    let (mut turned, mut missed) = (0, 0);
    for case in 0..150 {
        let (skeleton, limb) = leg(&mut random);
        let (mut skeleton, _) = with_hinge(&mut random, skeleton, limb);
        let limits = if random.coin() {
            let twist = Limit { min: random.within(-2.0..0.0), max: random.within(0.2..2.0) };
            JointLimits::cone(Cone {
                x: random.within(0.3..2.0),
                z: random.within(0.3..2.0),
                twist,
                middle: Vec2::new(random.within(-0.8..0.8), random.within(-0.8..0.8)),
            })
        } else {
            JointLimits::new([(); 3].map(|()| {
                Some(Limit { min: random.within(-2.0..-0.1), max: random.within(0.1..2.0) })
            }))
        };
        skeleton.change(limb.upper, |upper| upper.limits = limits).expect("limits");
        let [base, _, tip] = points(&skeleton, limb);
        let way = Quat::from_mat3(&random.rotation()) * (tip - base);
        let target = LimbTarget::new(base + way * random.within(0.7..1.0));
        let near = 2e-5 * length(&skeleton, limb);
        // Every place of the elbow, by the twist.
        let apart = TAU / f32::from(PLACES);
        let reaches = |turn: f32| {
            let (_, report) = solved(&skeleton, limb, &LimbTarget { twist: turn, ..target });
            report.turned_aside == 0.0 && report.error < near
        };
        let places = (0..PLACES).map(|place| apart * f32::from(place));
        let places = places.map(|turn| if turn > PI { turn - TAU } else { turn });
        let least = places.filter(|turn| reaches(*turn)).map(f32::abs).reduce(f32::min);
        let (after, report) = solved(&skeleton, limb, &target);
        let upper = &after[limb.upper];
        assert!(upper.limits.project(upper.rotation).distance(upper.rotation) < 1e-5, "{case}");
        match least {
            Some(least) => {
                assert!(report.error < 2.0 * near, "{case}: {report:?}, by {least}");
                assert!(report.turned_aside.abs() <= least + 1e-3, "{case}: {report:?}, {least}");
                assert!(
                    report.turned_aside.abs() > least - 1.1 * apart,
                    "{case}: {report:?}, {least}"
                );
                turned += usize::from(least > 0.0);
            }
            None => missed += usize::from(report.error > near),
        }
    }
    assert!(turned > 15 && missed > 15, "{turned} turned aside, {missed} missed");
}

#[test]
fn an_elbow_that_is_turned_aside_goes_on_smoothly_from_step_to_step() {
    const STEPS: u16 = 400;
    let mut skeleton = Skeleton::with_root("root");
    let twist = Limit { min: -0.5, max: 0.5 };
    let limits = JointLimits::cone(Cone { x: 1.2, z: 0.6, twist, middle: Vec2::new(0.2, -0.1) });
    let upper = Joint { limits, ..Joint::new("upper", Some(JointId::new(0)), Vec3::X) };
    let upper = skeleton.add(upper).expect("upper");
    let hinge = JointLimits::new([0.0, 0.0, 2.5].map(|max| Some(Limit { min: 0.0, max })));
    let lower =
        Joint { offset: Vec3::X, limits: hinge, ..Joint::new("lower", Some(upper), Vec3::X) };
    let lower = skeleton.add(lower).expect("lower");
    let limb = Limb::ending_at(&skeleton, lower).expect("a limb");
    let (mut carried, mut last) = (CarriedLimb::default(), None::<(Vec3, Vec3)>);
    let (mut most, mut aside) = (0.0_f32, 0);
    for at in 0..=STEPS {
        let angle = TAU * f32::from(at) / f32::from(STEPS);
        let point = Vec3::new(1.2, 0.5 * angle.sin(), 0.7 * angle.cos());
        let mut posed = skeleton.clone();
        let report =
            step(&mut posed, limb, &LimbTarget::new(point), &mut carried).expect("a report");
        aside += usize::from(report.turned_aside != 0.0);
        let elbow = posed.base(lower);
        if let Some((before, from)) = last {
            most = most.max(elbow.distance(before) / point.distance(from));
        }
        last = Some((elbow, point));
    }
    println!("{aside} steps aside, the elbow moves at most {most} times as far");
    assert!(aside > 20 && most < 8.0, "{aside}, {most}");
}
