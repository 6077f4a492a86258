//! Targets of chains: they turn some joints from their own upwards, after the body.

use core::num::NonZeroU32;

use glam::Vec3;
use ik_arm::document::{Channel, Document, Inspection, SkeletonRig, Target, Track};
use ik_arm::kinematics::diagnosis::{Cause, Remedy};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::rig::{Aim, Carried, EvaluatedSkeleton, TargetKind, TargetSpace};
use pollster::block_on;

use crate::common::Random;
use crate::common::documents::example;

fn chain(length: u32) -> TargetKind {
    TargetKind::Chain(NonZeroU32::new(length).expect("above 0"))
}

/// A chain of bones of length 1, bent at random.
fn bent(random: &mut Random, joints: usize) -> SkeletonRig {
    let parent = |index: usize| index.checked_sub(1).map(JointId::new);
    let bone = |index: usize| Joint {
        offset: if index == 0 { Vec3::ZERO } else { Vec3::Y },
        ..Joint::new(&format!("joint {index}"), parent(index), Vec3::Y)
    };
    let mut skeleton = Skeleton::from_joints((0..joints).map(bone).collect()).expect("a chain");
    for joint in skeleton.ids() {
        skeleton.set_rotation(joint, random.vector(0.6)).expect("angles");
    }
    SkeletonRig::new(skeleton)
}

fn last(rig: &SkeletonRig) -> JointId {
    rig.skeleton.ids().last().expect("a joint")
}

/// Adds a target with full influence.
fn add(rig: &mut SkeletonRig, joint: JointId, kind: TargetKind, at: Vec3) {
    rig.targets.push(Target { kind, influence: 1.0, ..Target::new(joint, at, 0.1) });
}

#[test]
fn a_chain_turns_its_joints_alone_and_reaches_what_they_reach() {
    let mut random = Random(381);
    for case in 0..200 {
        let mut rig = bent(&mut random, 7);
        let (length, tip) = (2 + random.below(4) as u32, last(&rig));
        let fk = rig.skeleton.clone();
        let top = JointId::new(7 - length as usize);
        // Places that a chain of the last bones alone can have.
        let mut reached = Skeleton::clone(&fk);
        for joint in fk.ids().filter(|joint| *joint >= top) {
            reached.set_rotation(joint, random.vector(1.0)).expect("angles");
        }
        add(&mut rig, tip, chain(length), reached.tip(tip));
        let evaluated = rig.evaluate(0.0);
        assert!(rig.is_reached(&evaluated.targets[0]), "{case}: {:?}", evaluated.targets[0]);
        for joint in fk.ids() {
            let is_turned = evaluated.solved[joint].rotation != fk[joint].rotation;
            assert!(!is_turned || joint >= top, "{case}: {joint} of {length} turns");
        }
    }
}

#[test]
fn a_chain_as_long_as_the_body_is_the_body() {
    let mut random = Random(382);
    for case in 0..50 {
        let mut rig = bent(&mut random, 5);
        let tip = last(&rig);
        let place = rig.skeleton.tip(tip) + random.vector(1.5);
        add(&mut rig, tip, TargetKind::WholeBody, place);
        let whole = rig.evaluate(0.0).solved;
        rig.targets[0].kind = chain(5 + case);
        assert_eq!(rig.evaluate(0.0).solved, whole, "{case}");
    }
}

/// A trunk of three bones with two branches of three.
fn fork(random: &mut Random) -> (SkeletonRig, [JointId; 2]) {
    let names = ["a", "b", "c", "left 1", "left 2", "left 3", "right 1", "right 2", "right 3"];
    let parents = [None, Some(0), Some(1), Some(2), Some(3), Some(4), Some(2), Some(6), Some(7)];
    let bones = names.into_iter().zip(parents).map(|(name, parent)| Joint {
        offset: if parent.is_some() { Vec3::Y } else { Vec3::ZERO },
        ..Joint::new(name, parent.map(JointId::new), Vec3::Y)
    });
    let mut skeleton = Skeleton::from_joints(bones.collect()).expect("a fork");
    for joint in skeleton.ids() {
        skeleton.set_rotation(joint, random.vector(0.4)).expect("angles");
    }
    (SkeletonRig::new(skeleton), [5, 8].map(JointId::new))
}

#[test]
fn chains_with_a_joint_in_common_are_solved_together() {
    let mut random = Random(383);
    for case in 0..50 {
        let (mut rig, tips) = fork(&mut random);
        let mut wanted = Skeleton::clone(&rig.skeleton);
        for joint in wanted.ids().skip(1) {
            let rotation = wanted[joint].rotation + random.vector(0.4);
            wanted.set_rotation(joint, rotation).expect("angles");
        }
        // Neither reaches its place without turning the joints that both have.
        for tip in tips {
            add(&mut rig, tip, chain(5), wanted.tip(tip));
        }
        let evaluated = rig.evaluate(0.0);
        assert!(rig.has_reached_all(&evaluated), "{case}");
        assert_eq!(evaluated.solved[JointId::new(0)], rig.skeleton[JointId::new(0)], "{case}");
    }
}

/// The head of the Human with a target that aims it with the neck.
fn looking(at: Vec3, space: TargetSpace) -> Document {
    let mut human = example("human");
    let head = human.skeleton().find("head").expect("a head");
    human.rig.targets.retain(|target| target.joint != head);
    let target = Target::new(head, human.skeleton().tip(head), 0.1);
    let aim = Some(Aim { axis: Vec3::Z, point: at });
    human.rig.targets.push(Target {
        kind: chain(2),
        aim,
        space,
        influence: 1.0,
        weight: 0.0,
        ..target
    });
    human
}

fn head_angle(rig: &SkeletonRig, evaluated: &EvaluatedSkeleton) -> f32 {
    let index = rig.targets.len() - 1;
    evaluated.targets[index].rotation_error.expect("an aim")
}

#[test]
fn a_head_that_looks_at_something_leaves_the_body_as_it_is() {
    let mut random = Random(384);
    let mut without = example("human");
    let head = without.skeleton().find("head").expect("a head");
    without.rig.targets.retain(|target| target.joint != head);
    for case in 0..30 {
        let hand = 0.3 * random.direction();
        let at = Vec3::new(random.within(-0.6..0.6), random.within(1.2..2.0), 1.0);
        let mut human = looking(at, TargetSpace::World);
        for document in [&mut human, &mut without] {
            document.rig.targets[0].home = Vec3::new(0.3, 1.0, 0.2) + hand;
        }
        let (looks, body) = (human.rig.evaluate(0.0), without.rig.evaluate(0.0));
        assert!(head_angle(&human.rig, &looks) < 1e-3, "{case}");
        for (joint, of_body) in body.solved.iter() {
            let is_turned = ["neck", "head"].contains(&of_body.name.as_str());
            assert!(is_turned || looks.solved[joint] == *of_body, "{case}: {}", of_body.name);
        }
        // The line from the base of the head along its z goes through the point.
        let full = looks.solved.full_transform(head);
        let way = (at - full.translation.to_vec3()).as_dvec3();
        let axis = full.z_axis.as_dvec3();
        assert!(axis.angle_between(way) < 2e-3, "{case}");
    }
}

#[test]
fn a_head_can_look_at_a_point_of_the_hand_that_another_target_moves() {
    let mut random = Random(385);
    let human = example("human");
    let hand = human.skeleton().find("left_hand").expect("a hand");
    for case in 0..30 {
        let mut human = looking(Vec3::new(0.05, -0.03, 0.0), TargetSpace::Joint(hand));
        human.rig.check_target_spaces().expect("solved after the hand");
        human.rig.targets[0].home =
            Vec3::new(random.within(-0.1..0.5), random.within(0.9..1.6), random.within(0.3..0.6));
        let evaluated = human.rig.evaluate(0.0);
        let angle = head_angle(&human.rig, &evaluated);
        assert!(angle < 1e-3, "{case}: {angle}");
    }
}

#[test]
fn a_look_that_follows_a_point_does_not_pop() {
    let mut human = looking(Vec3::ZERO, TargetSpace::World);
    let head = human.skeleton().find("head").expect("a head");
    for frame in 0..=60 {
        let turn = f32::from(u8::try_from(frame).expect("small")) / 60.0 * std::f32::consts::TAU;
        let point = Vec3::new(0.7 * turn.sin(), 1.6 + 0.3 * (2.0 * turn).sin(), 1.2);
        human.keys.insert(Channel::TargetAim(head), f64::from(frame) / 15.0, point);
    }
    human.timeline.end = 4.0;
    let track = Track::new(&human);
    let inspection =
        block_on(Inspection::new(&track, human.timeline, false, async |_| true)).expect("whole");
    assert_eq!(inspection.pops, Vec::new());
    for frame in 0..=120 {
        let posed = track.at(f64::from(frame) / 30.0);
        let missing = posed.targets().last().and_then(|it| it.rotation_error).expect("an aim");
        assert!(missing < 1e-3, "{frame}: {missing}");
    }
}

#[test]
fn a_chain_of_too_few_joints_says_so_and_how_many_would_do() {
    let mut random = Random(386);
    let mut said = 0;
    for case in 0..20 {
        let mut rig = bent(&mut random, 6);
        let tip = last(&rig);
        let mut wanted = Skeleton::clone(&rig.skeleton);
        let turned = JointId::new(2);
        wanted.set_rotation(turned, random.vector(1.5)).expect("angles");
        add(&mut rig, tip, chain(2), wanted.tip(tip));
        if rig.has_reached_all(&rig.evaluate(0.0)) {
            continue;
        }
        let found = rig.diagnose(0.0, &Carried::default());
        let short = found.iter().find(|it| it.cause == Cause::ShortChain { length: 2 });
        let Some(short) = short else { panic!("{case}: {found:?}") };
        let [tried] = &short.remedies[..] else { panic!("{case}: {short:?}") };
        let Remedy::LengthenChain { length, .. } = tried.remedy else { panic!("{tried:?}") };
        assert!(length.get() <= 4, "{case}: the third joint from the tip's base is enough");
        rig.apply_remedy(&tried.remedy, 0.0).expect("a remedy");
        assert!(rig.has_reached_all(&rig.evaluate(0.0)), "{case}");
        rig.targets[0].kind = chain(length.get() - 1);
        assert!(!rig.has_reached_all(&rig.evaluate(0.0)), "{case}: not one more than needed");
        said += 1;
    }
    assert!(said > 10, "{said}");
}

#[test]
fn a_chain_comes_back_to_its_posture_in_a_saved_motion() {
    let mut random = Random(387);
    let mut rig = bent(&mut random, 7);
    let tip = last(&rig);
    let mut carried = Carried::default();
    let start = rig.skeleton.tip(tip);
    add(&mut rig, tip, chain(4), start);
    let mut posed = rig.evaluate(0.0);
    for step in 0..20 {
        rig.targets[0].home = start + Vec3::new(-0.05, -0.04, 0.03) * step as f32;
        (posed, carried) = rig.step(0.0, &carried);
    }
    let posture = carried.to_posture();
    assert_eq!(posture.joints.len(), 4, "{posture:?}");
    let (again, _) = rig.step(0.0, &Carried::from_posture(&posture.into()));
    for joint in rig.skeleton.ids() {
        let apart = posed.solved.tip(joint).distance(again.solved.tip(joint));
        assert!(apart < 1e-4, "{joint}: {apart}");
    }
}
