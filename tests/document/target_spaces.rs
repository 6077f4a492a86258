//! Targets and poles that are fixed in the space of a joint.

use glam::{DAffine3, DMat3, DVec3, Quat, Vec3};
use ik_arm::document::{Channel, Document, SkeletonRig, Target};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::kinematics::twist::TwistReferenceKind;
use ik_arm::rig::{Aim, LimbSettings, TargetKind, TargetSpace, TargetSpaceError};

use crate::common::Random;
use crate::common::skeletons::{shake, transform};

/// A trunk with two arms, and a wheel on a root of its own.
struct Driver {
    rig: SkeletonRig,
    trunk: JointId,
    forearms: [JointId; 2],
    hands: [JointId; 2],
    wheel: JointId,
}

impl Driver {
    fn new() -> Self {
        let mut skeleton = Skeleton::default();
        let mut add = |joint: Joint| skeleton.add(joint).expect("a joint");
        let trunk = add(Joint::new("trunk", None, Vec3::Y));
        let arms = [("left", 1.0), ("right", -1.0)].map(|(side, x)| {
            let upper = Joint::new(&format!("{side}_upper"), Some(trunk), Vec3::X * x * 0.5);
            let upper = add(Joint { offset: Vec3::Y, ..upper });
            let bone = Vec3::new(0.1 * x, 0.0, 0.5);
            let fore = Joint::new(&format!("{side}_fore"), Some(upper), bone);
            let fore = add(Joint { offset: Vec3::X * x * 0.5, ..fore });
            let hand = Joint::new(&format!("{side}_hand"), Some(fore), Vec3::Z * 0.1);
            (fore, add(Joint { offset: bone, ..hand }))
        });
        let wheel = add(Joint {
            offset: Vec3::new(0.0, 0.9, 0.6),
            ..Joint::new("wheel", None, Vec3::Y * 0.2)
        });
        let rig = SkeletonRig::new(skeleton);
        let [(left, left_hand), (right, right_hand)] = arms;
        Self { rig, trunk, forearms: [left, right], hands: [left_hand, right_hand], wheel }
    }

    /// Adds a limb target for a forearm, in the world.
    fn add_target(&mut self, forearm: JointId, home: Vec3) -> &mut Target {
        let kind = TargetKind::Limb(LimbSettings::default());
        let target = Target::new(forearm, home, 0.1);
        self.rig.targets.push(Target { kind, influence: 1.0, ..target });
        self.rig.targets.last_mut().expect("a target")
    }
}

/// Transform of a joint's space to the world in f64, as a product of matrices.
fn to_world(skeleton: &Skeleton, joint: JointId) -> DAffine3 {
    let Joint { parent, offset, frame, rotation, .. } = &skeleton[joint];
    let above = parent.map_or(
        DAffine3::from_mat3_translation(
            DMat3::from_cols_array(&skeleton.transform().matrix3.to_cols_array().map(f64::from)),
            skeleton.transform().translation.as_dvec3(),
        ),
        |parent| to_world(skeleton, parent),
    );
    let DVec3 { x, y, z } = rotation.as_dvec3();
    let turned = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    let frame = frame.as_dmat3();
    let local = frame * turned * frame.transpose();
    above * DAffine3::from_mat3_translation(local, offset.as_dvec3())
}

#[test]
fn hands_stay_on_a_wheel_that_turns_and_moves() {
    let mut random = Random(160);
    let mut driver = Driver::new();
    let rims = [Vec3::new(0.2, 0.0, 0.0), Vec3::new(-0.2, 0.0, 0.0)];
    for (forearm, rim) in driver.forearms.into_iter().zip(rims) {
        let wheel = driver.wheel;
        driver.add_target(forearm, rim).space = TargetSpace::Joint(wheel);
    }
    driver.rig.check_target_spaces().expect("a wheel is no part of an arm");
    for _ in 0..200 {
        let (turned, moved) = (random.within(-1.0..1.0), random.vector(0.05));
        let turn = |wheel: &mut Joint| {
            wheel.rotation = Vec3::Z * turned;
            wheel.offset = Vec3::new(0.0, 0.9, 0.6) + moved;
        };
        driver.rig.skeleton_mut().change(driver.wheel, turn).expect("a wheel");
        let evaluated = driver.rig.evaluate(0.0);
        for ((forearm, rim), report) in
            driver.forearms.into_iter().zip(rims).zip(&evaluated.targets)
        {
            let on_wheel =
                to_world(&evaluated.solved, driver.wheel).transform_point3(rim.as_dvec3());
            let tip = evaluated.solved.tip(forearm).as_dvec3();
            assert!(tip.distance(on_wheel) <= 2e-6, "{report:?}");
            assert!(report.position.as_dvec3().distance(on_wheel) <= 2e-6);
        }
    }
}

#[test]
fn a_target_on_a_hand_follows_that_hand_whatever_the_order_of_the_targets() {
    let mut random = Random(161);
    for _ in 0..100 {
        let mut driver = Driver::new();
        let [left, right] = driver.forearms;
        let held = random.vector(0.05) + Vec3::Y * 0.1;
        let follower = *driver.add_target(left, held);
        let hand = driver.hands[1];
        driver.rig.targets[0].space = TargetSpace::Joint(hand);
        let home = Vec3::new(-0.1, 1.2, 0.5) + random.vector(0.1);
        let leader = *driver.add_target(right, home);
        driver.rig.check_target_spaces().expect("the right hand depends on nothing");
        assert_eq!((follower.joint, leader.joint), (left, right));

        let evaluated = driver.rig.evaluate(0.0);
        let expected = to_world(&evaluated.solved, hand).transform_point3(held.as_dvec3());
        assert!(evaluated.solved.tip(left).as_dvec3().distance(expected) <= 2e-6);
        driver.rig.targets.reverse();
        assert_eq!(driver.rig.evaluate(0.0).solved, evaluated.solved);
    }
}

#[test]
fn targets_cannot_be_where_they_could_not_be_evaluated() {
    let mut driver = Driver::new();
    let [left, right] = driver.forearms;
    driver.add_target(left, Vec3::ONE);
    driver.add_target(right, Vec3::ONE);
    let check = |driver: &Driver, spaces: [TargetSpace; 2]| {
        let mut rig = driver.rig.clone();
        for (target, space) in rig.targets.iter_mut().zip(spaces) {
            target.space = space;
        }
        rig.check_target_spaces()
    };
    let world = TargetSpace::World;
    let [left_hand, right_hand] = driver.hands.map(TargetSpace::Joint);
    assert_eq!(check(&driver, [TargetSpace::Joint(driver.trunk), world]), Ok(()));
    assert_eq!(check(&driver, [right_hand, world]), Ok(()));
    let own = TargetSpaceError::Own { target: left, joint: driver.hands[0] };
    assert_eq!(check(&driver, [left_hand, world]), Err(own));
    let cycle = TargetSpaceError::Cycle { target: left };
    assert_eq!(check(&driver, [right_hand, left_hand]), Err(cycle));
    let missing = JointId::new(99);
    let error = TargetSpaceError::NoJoint { target: left, joint: missing };
    assert_eq!(check(&driver, [TargetSpace::Joint(missing), world]), Err(error));

    driver.rig.targets[0].kind = TargetKind::WholeBody;
    let error = TargetSpaceError::Own { target: left, joint: driver.trunk };
    assert_eq!(check(&driver, [TargetSpace::Joint(driver.trunk), world]), Err(error));
    let error = TargetSpaceError::Own { target: left, joint: driver.hands[1] };
    assert_eq!(check(&driver, [right_hand, world]), Err(error), "the trunk carries both hands");
    assert_eq!(check(&driver, [TargetSpace::Joint(driver.wheel), world]), Ok(()));
    assert_eq!(
        error.to_string(),
        "the target of joint 2 must be on a joint that it does not move, got 6"
    );
}

/// The driver with keys that turn trunk and wheel, and with a left target whose position,
/// orientation and pole are keyed.
fn keyed(random: &mut Random) -> (Document, JointId) {
    let mut driver = Driver::new();
    let forearm = driver.forearms[0];
    let target = driver.add_target(forearm, Vec3::new(0.3, 1.0, 0.6));
    target.kind = TargetKind::Limb(LimbSettings {
        reference: TwistReferenceKind::Pole,
        pole: Some(Vec3::new(2.0, 0.0, 0.0)),
        ..LimbSettings::default()
    });
    target.orientation = Some(random.angles());
    shake(random, driver.rig.skeleton_mut());
    driver.rig.skeleton_mut().set_transform(transform(random)).expect("finite");
    let mut document = Document { rig: driver.rig, ..Document::default() };
    for time in [0.0, 0.4, 1.0, 2.5] {
        for joint in [driver.trunk, driver.wheel] {
            document.keys.insert(Channel::Rotation(joint), time, random.angles());
        }
        for channel in [
            Channel::Target(forearm),
            Channel::TargetOrientation(forearm),
            Channel::TargetPole(forearm),
        ] {
            document.keys.insert(channel, time, random.vector(1.0));
        }
    }
    (document, driver.wheel)
}

/// Position, orientation and pole of the document's target in the world at a time.
fn in_world(document: &Document, time: f64) -> (Vec3, Quat, Vec3) {
    let rig = document.at(time).into_document().rig;
    let pose = rig.skeleton_at(time);
    let target = &rig.targets[0];
    let limb = target.limb().expect("a limb");
    (
        target.in_world(&pose, time),
        target.orientation_in_world(&pose).expect("an orientation"),
        limb.pole_in_world(&pose).expect("a pole"),
    )
}

#[test]
fn a_target_stays_where_it_is_when_it_moves_to_another_space_and_at_each_of_its_keys() {
    let mut random = Random(162);
    for case in 0..50 {
        let (before, wheel) = keyed(&mut random);
        let joint = before.rig.targets[0].joint;
        let size = before.rig.reach().max(1.0);
        let mut after = before.clone();
        after.set_target_space(joint, TargetSpace::Joint(wheel), 0.0);
        after.set_pole_space(joint, TargetSpace::Joint(wheel), 0.0);
        assert_eq!(after.rig.targets[0].space, TargetSpace::Joint(wheel));
        let mut back = after.clone();
        back.set_target_space(joint, TargetSpace::World, 0.0);
        back.set_pole_space(joint, TargetSpace::World, 0.0);
        for document in [&after, &back] {
            for time in [0.0, 0.4, 1.0, 2.5] {
                let (place, turned, pole) = in_world(&before, time);
                let (place_after, turned_after, pole_after) = in_world(document, time);
                assert!(place.distance(place_after) <= 2e-5 * size, "{case}: at {time} s");
                assert!(pole.distance(pole_after) <= 2e-5 * size, "{case}: at {time} s");
                assert!(turned.angle_between(turned_after) <= 2e-3, "{case}: at {time} s");
            }
        }
    }
}

#[test]
fn deleting_a_joint_leaves_the_targets_that_were_on_it_where_they_are() {
    let mut random = Random(163);
    for _ in 0..20 {
        let (mut before, wheel) = keyed(&mut random);
        let joint = before.rig.targets[0].joint;
        before.set_target_space(joint, TargetSpace::Joint(wheel), 0.0);
        before.set_pole_space(joint, TargetSpace::Joint(wheel), 0.0);
        let mut deleted = before.clone();
        deleted.delete(&[wheel]).expect("a joint");
        let mut dissolved = before.clone();
        dissolved.dissolve(&[wheel]).expect("a joint");
        let size = before.rig.reach().max(1.0);
        for document in [deleted, dissolved] {
            assert_eq!(document.rig.targets[0].space, TargetSpace::World);
            for time in [0.0, 0.4, 1.0, 2.5] {
                let ((place, _, pole), (place_after, _, pole_after)) =
                    (in_world(&before, time), in_world(&document, time));
                assert!(place.distance(place_after) <= 2e-5 * size);
                assert!(pole.distance(pole_after) <= 2e-5 * size);
            }
        }
    }
}

#[test]
fn an_aim_stays_at_its_point_in_the_world_when_its_space_changes() {
    let mut random = Random(381);
    for _ in 0..200 {
        let mut driver = Driver::new();
        shake(&mut random, driver.rig.skeleton_mut());
        driver.rig.skeleton_mut().set_transform(transform(&mut random)).expect("finite");
        let (pose, wheel) = (driver.rig.skeleton.clone(), driver.wheel);
        let aim = Some(Aim { axis: Vec3::Z, point: random.vector(2.0) });
        let target = Target::new(driver.forearms[0], random.vector(1.0), 0.1);
        let target = Target { aim, ..target };
        let before = target.aim_point_in_world(&pose).expect("an aim");
        let moved = target.in_space(TargetSpace::Joint(wheel), &pose, 0.0, None);
        let pinned = moved.with_pinned(true, &pose, 0.0);
        for after in [moved, pinned, pinned.with_pinned(false, &pose, 0.0)] {
            let point = after.aim_point_in_world(&pose).expect("an aim");
            assert!(point.distance(before) < 1e-4 * before.length().max(1.0), "{point}, {before}");
        }
    }
}

#[test]
fn keys_of_influence_twist_orientation_and_pole_pose_the_limb_as_their_values_do() {
    let mut random = Random(164);
    for _ in 0..30 {
        let (mut document, _) = keyed(&mut random);
        // Along a track, a pose depends on those before it, too.
        document.rig.is_tracked = false;
        let joint = document.rig.targets[0].joint;
        for time in [0.0, 1.0, 2.0] {
            let influence = Vec3::X * random.within(0.0..1.0);
            document.keys.insert(Channel::TargetInfluence(joint), time, influence);
            let twist = Vec3::X * random.within(-4.0..4.0);
            document.keys.insert(Channel::TargetTwist(joint), time, twist);
        }
        for time in [0.0, 0.7, 1.0, 3.0] {
            let value = |channel| document.keys.value(channel, time).expect("keys");
            let mut rig = document.at(time).into_document().rig;
            let target = &mut rig.targets[0];
            target.home = value(Channel::Target(joint));
            target.influence = value(Channel::TargetInfluence(joint)).x;
            let limb = target.limb_mut().expect("a limb");
            limb.twist = value(Channel::TargetTwist(joint)).x;
            limb.pole = Some(value(Channel::TargetPole(joint)));
            target.orientation = Some(value(Channel::TargetOrientation(joint)));
            let solved = document.at(time).skeleton().clone();
            assert_eq!(solved, rig.skeleton_at(time));
        }
    }
}

#[test]
fn a_pole_on_a_missing_joint_is_refused_for_every_reference() {
    let missing = JointId::new(99);
    for reference in [TwistReferenceKind::Fk, TwistReferenceKind::Pole] {
        let mut driver = Driver::new();
        let [left, _] = driver.forearms;
        let target = driver.add_target(left, Vec3::ONE);
        let limb = target.limb_mut().expect("a limb");
        (limb.reference, limb.pole_space) = (reference, TargetSpace::Joint(missing));
        let expected = TargetSpaceError::NoJoint { target: left, joint: missing };
        assert_eq!(driver.rig.check_target_spaces(), Err(expected));
    }
}
