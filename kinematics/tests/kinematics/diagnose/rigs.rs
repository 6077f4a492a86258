//! Targets of rigs: limbs, influence, and remedies as edits of the rig.

use glam::{Affine3A, Quat, Vec3};
use ik_arm_kinematics::chain_ik::{Method, SolverOptions};
use ik_arm_kinematics::diagnosis::{Boundary, Cause, Diagnosis, Remedy, WidenedLimit, WiderLimit};
use ik_arm_kinematics::rig::{
    Carried, LimbSettings, SkeletonRig, Target, TargetKind, TargetMotion, TargetPath, TargetSpace,
};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Limit, Skeleton};
use ik_arm_kinematics::soft_reach::SoftReach;

use crate::common::Random;
use crate::common::skeletons::{chain, reachable, shake, tree};
use crate::diagnose::{CASES, ENOUGH};

const UPPER: JointId = JointId::new(1);
const LOWER: JointId = JointId::new(2);

/// Diagnoses rigs at random times and counts those whose first cause is as expected; checks the
/// residuals of all remedies by evaluating the changed rig.
fn first_causes(
    is_expected: impl Fn(&Diagnosis) -> bool,
    mut rig: impl FnMut(&mut Random) -> SkeletonRig,
) {
    let mut random = Random(77);
    let mut others = Vec::new();
    let mut remedied = 0;
    for case in 0..CASES {
        let rig = rig(&mut random);
        let time = f64::from(random.within(0.0..3.0));
        let found = rig.diagnose(time, &Carried::default());
        assert!(!found.is_empty(), "case {case} is reached");
        if !is_expected(&found[0]) {
            others.push((case, found[0].cause));
        }
        for diagnosis in &found {
            check_remedies(&rig, time, diagnosis);
        }
        remedied += usize::from(found[0].residual_with_remedy() <= 1.01 * rig.tolerance());
    }
    assert!(CASES - others.len() >= ENOUGH, "{others:?}");
    assert!(remedied >= ENOUGH, "{remedied} of {CASES} remedies reach the target");
}

/// True if a cause has this name on the command line.
fn is(cause: &str) -> impl Fn(&Diagnosis) -> bool {
    move |found| found.cause.name() == cause
}

fn check_remedies(rig: &SkeletonRig, time: f64, diagnosis: &Diagnosis) {
    for tried in &diagnosis.remedies {
        let mut changed = rig.clone();
        changed.apply_remedy(&tried.remedy, time).expect("joints of the rig");
        let index = changed.target(diagnosis.target).expect("the target");
        let evaluated = changed.evaluate(time);
        let target = &evaluated.targets[index];
        let seen = evaluated.solved.tip(diagnosis.target).distance(target.position);
        assert!(
            (seen - tried.residual).abs() <= 1e-3 * rig.reach(),
            "{:?} leaves {seen}, not {}",
            tried.remedy,
            tried.residual
        );
        assert!(tried.residual < diagnosis.residual, "{:?} does not help", tried.remedy);
    }
}

fn transform(random: &mut Random) -> Affine3A {
    let side = if random.coin() { 1.0 } else { -1.0 };
    Affine3A::from_scale_rotation_translation(
        Vec3::new(side, 1.0, 1.0) * random.within(0.1..10.0),
        Quat::from_mat3(&random.rotation()),
        random.vector(5.0),
    )
}

/// Two bones of random lengths with a hand, in a random pose, with a limb target `distance` of the
/// bones' lengths from the shoulder.
fn limb(random: &mut Random, distance: impl Fn(&mut Random, [f32; 2]) -> f32) -> SkeletonRig {
    let lengths = [random.within(0.5..2.0), random.within(0.5..2.0)];
    let mut skeleton = Skeleton::with_root("root");
    let mut parent = JointId::new(0);
    let mut offset = random.vector(1.0);
    for (name, length) in [("upper", lengths[0]), ("lower", lengths[1]), ("hand", 0.2)] {
        let axis = random.direction() * length;
        let joint = Joint { offset, ..Joint::new(name, Some(parent), axis) };
        parent = skeleton.add(joint).expect("joint");
        offset = axis;
    }
    shake(random, &mut skeleton);
    let point = skeleton.base(UPPER) + random.direction() * distance(random, lengths);
    let to_world = transform(random);
    skeleton.set_transform(to_world).expect("transform");
    let mut rig = SkeletonRig::new(skeleton);
    let mut target = Target::new(LOWER, to_world.transform_point3(point), 1.0);
    target.influence = 1.0;
    target.kind = TargetKind::Limb(LimbSettings::default());
    rig.targets.push(target);
    rig
}

fn set_soft_reach(rig: &mut SkeletonRig, soft_reach: SoftReach) {
    rig.targets[0].limb_mut().expect("a limb").soft_reach = soft_reach;
}

/// A distance that two bones of these lengths reach, away from the ends.
fn inside(random: &mut Random, [upper, lower]: [f32; 2]) -> f32 {
    let (least, most) = ((upper - lower).abs(), upper + lower);
    least + (most - least) * random.within(0.3..0.7)
}

#[test]
fn a_limb_that_is_too_short_is_out_of_reach() {
    first_causes(is("out_of_reach"), |random| {
        limb(random, |random, [upper, lower]| (upper + lower) * random.within(1.01..5.0))
    });
}

#[test]
fn a_limb_that_cannot_fold_enough_is_out_of_reach() {
    first_causes(is("out_of_reach"), |random| {
        loop {
            let rig = limb(random, |random, [upper, lower]| {
                (upper - lower).abs() * random.within(0.0..0.95)
            });
            let lengths = [UPPER, LOWER].map(|joint| rig.skeleton[joint].axis.length());
            if (lengths[0] - lengths[1]).abs() > 0.05 {
                return rig;
            }
        }
    });
}

#[test]
fn soft_limits_that_keep_a_limb_from_its_target_are_named() {
    let is_soft = |found: &Diagnosis| {
        matches!(found.cause, Cause::OutOfReach { boundary: Boundary::SoftLimit, .. })
    };
    first_causes(is_soft, |random| {
        let mut rig = limb(random, |random, [upper, lower]| {
            let (least, most) = ((upper - lower).abs(), upper + lower);
            most - (most - least) * random.within(0.001..0.05)
        });
        set_soft_reach(&mut rig, SoftReach::new(0.3, 1.0, 0.0).expect("valid"));
        rig
    });
}

#[test]
fn a_smallest_elbow_angle_that_keeps_a_limb_from_its_target_is_named() {
    let is_angle = |found: &Diagnosis| {
        matches!(found.cause, Cause::OutOfReach { boundary: Boundary::ElbowAngle, .. })
    };
    first_causes(is_angle, |random| {
        let mut rig = limb(random, |random, [upper, lower]| {
            (upper * upper + lower * lower).sqrt() * random.within(0.7..0.9)
        });
        let [upper, lower] = [UPPER, LOWER].map(|joint| rig.skeleton[joint].axis.length());
        if (upper - lower).abs() > 0.6 * upper.hypot(lower) {
            rig = limb(&mut Random(1), |_, [upper, lower]| 0.8 * upper.hypot(lower));
        }
        let right = core::f32::consts::FRAC_PI_2;
        set_soft_reach(&mut rig, SoftReach::new(0.0, 1.0, right).expect("valid"));
        rig
    });
}

#[test]
fn the_limits_of_an_elbow_that_keep_a_limb_from_its_target_are_named() {
    first_causes(
        |found| found.cause == Cause::Limits && found.joints == [LOWER],
        |random| {
            let most = random.within(0.2..1.0);
            let mut rig = limb(random, |random, [upper, lower]| {
                let bent = |angle: f32| {
                    (upper * upper + lower * lower + 2.0 * upper * lower * angle.cos()).sqrt()
                };
                bent(random.within(1.2..2.5))
            });
            let skeleton = rig.skeleton_mut();
            let fixed = Some(Limit { min: 0.0, max: 0.0 });
            let hinge = JointLimits::new([fixed, fixed, Some(Limit { min: 0.0, max: most })]);
            let along = Vec3::Y * skeleton[UPPER].axis.length();
            skeleton.set_axis(UPPER, along).expect("axis");
            let axis = Vec3::Y * skeleton[LOWER].axis.length();
            skeleton
                .change(LOWER, |joint| (joint.axis, joint.limits) = (axis, hinge))
                .expect("limits");
            rig
        },
    );
}

#[test]
fn a_locked_elbow_that_keeps_a_limb_from_its_target_is_named() {
    first_causes(
        |found| found.cause == Cause::Locked && found.joints == [LOWER],
        |random| {
            loop {
                let mut rig = limb(random, inside);
                let skeleton = rig.skeleton_mut();
                skeleton.change(LOWER, |joint| joint.locked = true).expect("joint");
                let evaluated = rig.evaluate(0.0);
                if evaluated.targets[0].error > 0.05 * rig.reach() {
                    return rig;
                }
            }
        },
    );
}

const HAND: JointId = JointId::new(3);
/// Limits of a hand about x, y and z: ± so many radians.
const HAND_LIMITS: [f32; 3] = [0.5, 0.4, 0.3];

/// A limb that reaches its target, with a hand that the target asks to turn about one axis by so
/// many radians.
fn turned_hand(random: &mut Random, axis: usize, angle: f32) -> SkeletonRig {
    let mut rig = limb(random, inside);
    rig.skeleton_mut().set_rotation(HAND, Vec3::ZERO).expect("angles");
    let limits = HAND_LIMITS.map(|most| Some(Limit { min: -most, max: most }));
    rig.skeleton_mut().change(HAND, |joint| joint.limits = limits.into()).expect("limits");
    let pose = rig.skeleton_at(0.0);
    let turn = Quat::from_axis_angle(Vec3::AXES[axis], angle);
    let wanted = pose.rotation_in_world(LOWER).as_quat() * turn;
    let angles = rig.targets[0].orientation_angles(&pose, wanted, Vec3::ZERO);
    rig.targets[0].orientation = Some(angles);
    rig
}

#[test]
fn a_hand_that_limits_hold_short_of_its_rotation_names_the_limit_and_the_remedy_widens_it() {
    let mut random = Random(80);
    for case in 0..CASES {
        let (axis, beyond) = (case % 3, random.within(0.05..0.8));
        let side = if random.coin() { 1.0 } else { -1.0 };
        let angle = side * (HAND_LIMITS[axis] + beyond);
        let mut rig = turned_hand(&mut random, axis, angle);
        let report = &rig.evaluate(0.0).targets[0];
        assert!(report.error <= rig.tolerance() && !rig.is_reached(report), "{case}: {report:?}");

        let found = rig.diagnose(0.0, &Carried::default());
        let [Diagnosis { cause, joints, remedies, .. }] = &found[..] else { panic!("{found:?}") };
        let Cause::RotationLimits { missing, axes } = *cause else { panic!("{case}: {cause:?}") };
        assert!((missing - beyond).abs() < 1e-4, "{case}: {missing}, {beyond}");
        assert_eq!(axes, [0, 1, 2].map(|it| it == axis), "{case}");
        assert_eq!(joints, &[HAND], "{case}");

        let tried = remedies.first().expect("a remedy");
        let Remedy::WidenLimits(widened) = &tried.remedy else { panic!("{tried:?}") };
        let is_about = |one: &WidenedLimit| matches!(one.to, WiderLimit::Range { axis: about, .. } if about.index() == axis);
        assert!(matches!(&widened[..], [one] if one.joint == HAND && is_about(one)));
        assert!(widened[0].by >= beyond - 1e-4 && widened[0].by < beyond + 0.02, "{widened:?}");
        rig.apply_remedy(&tried.remedy, 0.0).expect("limits");
        let report = &rig.evaluate(0.0).targets[0];
        assert!(rig.is_reached(report), "{case}: {report:?}");
        let left = report.rotation_error.expect("a rotation");
        assert!((left - tried.rotation_residual).abs() < 1e-5, "{left} {tried:?}");
        assert_eq!(rig.diagnose(0.0, &Carried::default()), []);
    }
}

#[test]
fn a_hand_within_its_limits_has_no_cause_and_one_that_is_out_of_reach_has_both() {
    let mut random = Random(81);
    for case in 0..CASES {
        let axis = case % 3;
        let rig = turned_hand(&mut random, axis, 0.9 * HAND_LIMITS[axis]);
        assert_eq!(rig.diagnose(0.0, &Carried::default()), [], "{case}");

        let mut rig = turned_hand(&mut random, axis, HAND_LIMITS[axis] + 1.0);
        let away = rig.targets[0].home - rig.skeleton.base(UPPER);
        rig.targets[0].home += 10.0 * away;
        let causes: Vec<_> =
            rig.diagnose(0.0, &Carried::default()).iter().map(|found| found.cause.name()).collect();
        assert_eq!(causes[0], "out_of_reach", "{case}");
    }
}

#[test]
fn a_target_with_little_influence_is_missed_because_of_it() {
    first_causes(is("influence"), |random| {
        loop {
            let mut rig = if random.coin() {
                limb(random, inside)
            } else {
                let joints = 2 + random.below(4);
                let mut skeleton = chain(random, joints, 1.0);
                let tip = JointId::new(joints);
                let [target] = reachable(random, &skeleton, &[tip])[..] else { continue };
                shake(random, &mut skeleton);
                let mut rig = SkeletonRig::new(skeleton);
                rig.solver = SolverOptions::new(Method::DampedLeastSquares);
                rig.targets.push(Target { influence: 1.0, ..Target::new(tip, target.point, 1.0) });
                rig
            };
            let reached = rig.evaluate(0.0).targets[0].error <= rig.tolerance();
            rig.targets[0].influence = random.within(0.0..0.9);
            if reached && rig.evaluate(0.0).targets[0].error > rig.tolerance() {
                return rig;
            }
        }
    });
}

#[test]
fn moved_targets_are_diagnosed_at_their_time_and_in_their_space() {
    first_causes(is("out_of_reach"), |random| {
        let mut rig = limb(random, |_, [upper, lower]| 3.0 * (upper + lower));
        let pose = rig.skeleton_at(0.0);
        let space = TargetSpace::Joint(JointId::new(0));
        let target = rig.targets[0].in_space(space, &pose, 0.0, None);
        let motion = TargetMotion { path: TargetPath::Circle, radius: 0.1, period: 2.0 };
        rig.targets[0] = Target { motion, ..target };
        rig
    });
}

#[test]
fn targets_that_are_reached_or_disabled_have_no_cause() {
    let mut random = Random(4);
    for _ in 0..CASES {
        let mut rig = limb(&mut random, inside);
        assert_eq!(rig.diagnose(0.0, &Carried::default()), []);
        rig.targets[0].home = Vec3::splat(1e3);
        assert_ne!(rig.diagnose(0.0, &Carried::default()), []);
        rig.targets[0].enabled = false;
        assert_eq!(rig.diagnose(0.0, &Carried::default()), []);
    }
}

#[test]
fn causes_of_several_targets_come_in_turn_the_farthest_target_first() {
    let mut random = Random(8);
    let (skeleton, tips) = tree(&mut random, 3, 1.0);
    let mut rig = SkeletonRig::new(skeleton);
    for (tip, distance) in tips.iter().zip([30.0, 50.0, 40.0]) {
        let target = Target::new(*tip, Vec3::X * distance, 1.0);
        rig.targets.push(Target { influence: 1.0, ..target });
    }
    let targets: Vec<_> =
        rig.diagnose(0.0, &Carried::default()).iter().map(|found| found.target).collect();
    assert_eq!(targets, [tips[1], tips[2], tips[0]]);
}

#[test]
fn a_limb_out_of_reach_has_remedies_by_target_and_stretch() {
    let mut random = Random(2);
    let mut rig = limb(&mut random, |_, [upper, lower]| 2.0 * (upper + lower));
    let found = &rig.diagnose(0.0, &Carried::default())[0];
    let Cause::OutOfReach { distance, longest, .. } = found.cause else { panic!("{found:?}") };
    assert!((distance / longest - 2.0).abs() < 1e-3);
    let stretch = found.remedies.iter().find(|it| matches!(it.remedy, Remedy::Stretch { .. }));
    rig.apply_remedy(&stretch.expect("stretch").remedy, 0.0).expect("a limb");
    assert_eq!(rig.diagnose(0.0, &Carried::default()), []);
}
