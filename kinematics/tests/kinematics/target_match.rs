//! Matches between the FK pose and targets: nothing moves.

use glam::{DQuat, Vec3};
use ik_arm_kinematics::rig::{Carried, LimbSettings, SkeletonRig, Target, TargetKind, TargetSpace};
use ik_arm_kinematics::skeleton::{Joint, JointId, Limit, Skeleton};
use ik_arm_kinematics::soft_reach::SoftReach;
use ik_arm_kinematics::twist::TwistReferenceKind;

use crate::common::Random;
use crate::common::skeletons::transform;

/// A trunk, an arm of two bones with a hand, hinged or not, in a random pose, and a prop.
struct Figure {
    rig: SkeletonRig,
    forearm: JointId,
}

fn figure(random: &mut Random) -> Figure {
    let is_hinge = random.coin();
    let mut skeleton = Skeleton::default();
    let mut add = |mut joint: Joint| {
        joint.rotation = joint.limits.project(random.angles() * 0.6);
        skeleton.add(joint).expect("a joint")
    };
    let trunk = add(Joint::new("trunk", None, Vec3::Y));
    let upper = Joint::new("upper", Some(trunk), Vec3::new(0.4, 0.0, 0.05));
    let upper = add(Joint { offset: Vec3::Y, ..upper });
    let bone = Vec3::new(0.35, 0.1, 0.0);
    let mut fore =
        Joint { offset: Vec3::new(0.4, 0.0, 0.05), ..Joint::new("fore", Some(upper), bone) };
    if is_hinge {
        let fixed = Some(Limit { min: 0.0, max: 0.0 });
        fore.limits = [fixed, fixed, Some(Limit { min: 0.0, max: 2.5 })].into();
    }
    let forearm = add(fore);
    add(Joint { offset: bone, ..Joint::new("hand", Some(forearm), Vec3::X * 0.1) });
    add(Joint { offset: Vec3::X, ..Joint::new("prop", None, Vec3::Y * 0.3) });
    // Near the origin, so that rounding in the world is small beside the figure.
    let mut transform = transform(random);
    transform.translation = transform.transform_vector3(random.vector(1.0)).into();
    skeleton.set_transform(transform).expect("finite");
    Figure { rig: SkeletonRig::new(skeleton), forearm }
}

fn settings(random: &mut Random) -> LimbSettings {
    LimbSettings {
        reference: random.one_of(&[
            TwistReferenceKind::Fk,
            TwistReferenceKind::Up,
            TwistReferenceKind::Pole,
            TwistReferenceKind::Stereographic,
        ]),
        pole: Some(Vec3::new(1.0, -2.0, 3.0)),
        twist: random.within(-3.0..3.0),
        soft_reach: SoftReach::new(0.0, random.one_of(&[1.0, 1.4]), 0.0).expect("in range"),
        ..LimbSettings::default()
    }
}

/// The greatest distance between tips as a fraction of the reach, and the greatest angle in radians
/// between rotations in the world.
fn difference(one: &Skeleton, other: &Skeleton, reach: f32) -> (f32, f64) {
    let turned = |skeleton: &Skeleton, joint| {
        let angles = skeleton[joint].rotation.as_dvec3();
        DQuat::from_euler(glam::EulerRot::ZYX, angles.z, angles.y, angles.x)
    };
    one.ids().fold((0.0, 0.0), |(distance, angle), joint| {
        let apart = one.tip(joint).distance(other.tip(joint)) / reach;
        let between = turned(one, joint).angle_between(turned(other, joint));
        (distance.max(apart), angle.max(between))
    })
}

#[test]
fn a_target_that_moves_to_the_fk_pose_takes_over_without_moving_the_skeleton() {
    let mut random = Random(170);
    let mut worst = (0.0_f32, 0.0_f64);
    for case in 0..2_000 {
        let Figure { mut rig, forearm } = figure(&mut random);
        let target = Target::new(forearm, random.vector(1.0), 0.1);
        let kind = TargetKind::Limb(settings(&mut random));
        let prop = rig.skeleton.find("prop").expect("a prop");
        let space = random.one_of(&[TargetSpace::World, TargetSpace::Joint(prop)]);
        rig.targets.push(Target {
            kind,
            space,
            orientation: random.coin().then(|| random.angles()),
            influence: random.one_of(&[0.0, 0.5, 1.0]),
            ..target
        });
        let reach = rig.reach();
        let time = f64::from(random.within(0.0..4.0));
        rig.match_target_to_fk(0, time, &Carried::default());
        for influence in [0.0, 0.3, 1.0] {
            rig.targets[0].influence = influence;
            let (tip, angle) = difference(&rig.evaluate(time).solved, &rig.fk_at(time), reach);
            assert!(tip <= 1e-6, "{case}: a tip moves by {tip} at influence {influence}");
            assert!(angle <= 1e-4, "{case}: a joint turns by {angle} at influence {influence}");
            worst = (worst.0.max(tip), worst.1.max(angle));
        }
    }
    println!("worst: {worst:?}");
}

#[test]
fn the_evaluated_pose_written_to_the_angles_moves_nothing() {
    let mut random = Random(171);
    let mut worst = (0.0_f32, 0.0_f64);
    for case in 0..2_000 {
        let Figure { mut rig, forearm } = figure(&mut random);
        let home = rig.skeleton.tip(forearm) + random.vector(0.3) * rig.reach();
        let mut settings = settings(&mut random);
        let influence = random.one_of(&[0.0, 0.4, 1.0]);
        if influence == 0.4 {
            // FK angles cannot hold a part of a stretch.
            settings.soft_reach = SoftReach::default();
        }
        let kind = TargetKind::Limb(settings);
        let orientation = random.coin().then(|| random.angles());
        let target = Target::new(forearm, home, 0.1);
        rig.targets.push(Target { kind, orientation, influence, ..target });
        let before = rig.evaluate(0.0);
        rig.match_fk_to_pose(0, 0.0, &Carried::default());
        let after = rig.evaluate(0.0);
        let (tip, angle) = difference(&before.solved, &after.solved, rig.reach());
        assert!(tip <= 1e-6, "{case}: a tip moves by {tip} at influence {influence}");
        assert!(angle <= 1e-4, "{case}: a joint turns by {angle} at influence {influence}");
        worst = (worst.0.max(tip), worst.1.max(angle));
        for joint in rig.skeleton.ids() {
            let own = after.fk[joint].rotation;
            assert_eq!(own, before.solved[joint].rotation, "{case}: {joint}");
        }
    }
    println!("worst: {worst:?}");
}
