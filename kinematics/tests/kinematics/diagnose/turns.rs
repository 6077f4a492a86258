//! Targets of a body whose place and rotation or aim cannot be had together.

use glam::{Quat, Vec3};
use ik_arm_kinematics::chain_ik::{Method, SolverOptions};
use ik_arm_kinematics::diagnosis::{Cause, Diagnosis, Remedy};
use ik_arm_kinematics::rig::{Aim, Carried, SkeletonRig, Target};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Limit, RotationAxis, Skeleton};

use crate::common::Random;
use crate::diagnose::{CASES, ENOUGH};

const TURNING: [Method; 3] = [Method::DampedLeastSquares, Method::Ccd, Method::Transpose];

/// Bones of length 1 along y on a locked root.
fn bones(count: usize) -> (Skeleton, JointId) {
    let mut skeleton = Skeleton::with_root("root");
    let mut tip = JointId::new(0);
    for bone in 0..count {
        let offset = if bone == 0 { Vec3::ZERO } else { Vec3::Y };
        let joint = Joint { offset, ..Joint::new(&format!("bone {bone}"), Some(tip), Vec3::Y) };
        tip = skeleton.add(joint).expect("a bone");
    }
    (skeleton, tip)
}

/// A rig with a target of the tip at `point`.
fn rig(random: &mut Random, skeleton: Skeleton, tip: JointId, point: Vec3) -> SkeletonRig {
    let mut rig = SkeletonRig::new(skeleton);
    rig.solver = SolverOptions::new(TURNING[random.below(TURNING.len())]);
    rig.targets.push(Target { influence: 1.0, ..Target::new(tip, point, 1.0) });
    rig
}

/// A rotation by more than 60 degrees from that of a bone along `direction`.
fn across(random: &mut Random, direction: Vec3) -> Quat {
    let axis = direction.any_orthonormal_vector();
    let roll = Quat::from_axis_angle(direction, random.within(-3.0..3.0));
    roll * Quat::from_axis_angle(axis, random.within(1.1..2.0))
        * Quat::from_rotation_arc(Vec3::Y, direction)
}

fn turned(rig: &SkeletonRig, rotation: Quat) -> Option<Vec3> {
    Some(rig.targets[0].orientation_angles(&rig.skeleton, rotation, Vec3::ZERO))
}

/// Applies each remedy and compares what it leaves.
fn check_remedies(rig: &SkeletonRig, found: &Diagnosis) {
    for tried in &found.remedies {
        let mut changed = rig.clone();
        changed.apply_remedy(&tried.remedy, 0.0).expect("a remedy of the rig");
        let report = &changed.evaluate(0.0).targets[0];
        let angle = report.rotation_error.unwrap_or_default();
        assert!((report.error - tried.residual).abs() <= 1e-3 * rig.reach(), "{tried:?}");
        assert!((angle - tried.rotation_residual).abs() <= 1e-3, "{tried:?} {angle}");
    }
}

#[test]
fn a_stretched_chain_has_its_place_or_a_rotation_or_aim_across_it_but_not_both() {
    let mut random = Random(389);
    let mut named = 0;
    for case in 0..CASES {
        let (skeleton, tip) = bones(3 + random.below(3));
        let direction = random.direction();
        let reach = skeleton.joints().len() as f32 - 1.0;
        let mut rig = rig(&mut random, skeleton, tip, 0.97 * reach * direction);
        if random.coin() {
            let rotation = across(&mut random, direction);
            rig.targets[0].orientation = turned(&rig, rotation);
        } else {
            let point = 0.5 * reach * direction + 20.0 * direction.any_orthonormal_vector();
            rig.targets[0].aim = Some(Aim { axis: Vec3::Y, point });
        }
        let found = rig.diagnose(0.0, &Carried::default());
        let [first, ..] = &found[..] else { panic!("{case}: {found:?}") };
        let Cause::Turn { missing, is_had_alone: true } = first.cause else { continue };
        named += 1;
        assert!(missing > 0.01, "{case}: {missing}");
        check_remedies(&rig, first);
        let left = |remedy: &Remedy| {
            first.remedies.iter().find(|it| it.remedy == *remedy).expect("the remedy")
        };
        assert!(left(&Remedy::FreeTurn(tip)).residual <= 1.01 * rig.tolerance(), "{case}");
        let turn = left(&Remedy::FreePlace(tip)).rotation_residual;
        assert!(turn <= SkeletonRig::ROTATION_TOLERANCE, "{case}: {turn}");
    }
    assert!(named >= ENOUGH, "{named} of {CASES}");
}

#[test]
fn a_twist_beyond_all_limits_is_had_nowhere_and_wider_limits_give_it() {
    const LIMIT: f32 = 0.2;
    let mut random = Random(390);
    let mut named = 0;
    for case in 0..CASES {
        let count = 3 + random.below(3);
        let (mut skeleton, tip) = bones(count);
        for joint in skeleton.ids().skip(1) {
            let mut limits = JointLimits::default();
            for (axis, most) in RotationAxis::ALL.into_iter().zip([0.3, LIMIT, 0.3]) {
                limits.set_range(axis, Some(Limit { min: -most, max: most }));
            }
            skeleton.change(joint, |joint| joint.limits = limits).expect("limits");
            let bend = Vec3::new(random.within(-0.3..0.3), 0.0, random.within(-0.3..0.3));
            skeleton.set_rotation(joint, bend).expect("angles");
        }
        let twist = LIMIT * count as f32 + random.within(0.7..1.2);
        let (point, rotation) = (skeleton.tip(tip), skeleton.rotation_in_world(tip).as_quat());
        let mut rig = rig(&mut random, skeleton, tip, point);
        rig.targets[0].orientation = turned(&rig, rotation * Quat::from_rotation_y(twist));
        let found = rig.diagnose(0.0, &Carried::default());
        let [first, ..] = &found[..] else { panic!("{case}: {found:?}") };
        let Cause::Turn { .. } = first.cause else { continue };
        let Some(Remedy::WidenLimits(_)) = first.remedies.first().map(|it| &it.remedy) else {
            continue;
        };
        named += 1;
        check_remedies(&rig, first);
        rig.apply_remedy(&first.remedies[0].remedy, 0.0).expect("limits");
        let report = &rig.evaluate(0.0).targets[0];
        assert!(report.error <= 1.01 * rig.tolerance(), "{case}: {report:?}");
        assert!(!report.misses_rotation(), "{case}: {report:?}");
    }
    assert!(named >= ENOUGH, "{named} of {CASES}");
}

#[test]
fn a_place_with_a_rotation_that_a_pose_has_is_never_told_apart() {
    let mut random = Random(391);
    for case in 0..CASES {
        let (skeleton, tip) = bones(3 + random.below(3));
        let mut posed = skeleton.clone();
        for joint in posed.ids().skip(1) {
            let angles = [(); 3].map(|()| random.within(-1.0..1.0));
            posed.set_rotation(joint, Vec3::from_array(angles)).expect("angles");
        }
        let (point, rotation) = (posed.tip(tip), posed.rotation_in_world(tip).as_quat());
        let mut rig = rig(&mut random, skeleton, tip, point);
        rig.targets[0].orientation = turned(&rig, rotation);
        for found in rig.diagnose(0.0, &Carried::default()) {
            assert!(!matches!(found.cause, Cause::Turn { .. }), "{case}: {found:?}");
            check_remedies(&rig, &found);
        }
    }
}
