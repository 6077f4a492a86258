//! Dissolving joints: their children keep their positions.

use glam::Vec3;
use ik_arm::document::{Channel, Document};
use ik_arm::kinematics::skeleton::JointId;

use crate::common::documents::example;

/// Positions of bases and tips in world space, by joint name.
fn positions(document: &Document, time: f64) -> Vec<(String, Vec3, Vec3)> {
    let evaluated = document.at(time).into_document();
    let pose = evaluated.rig.skeleton_at(time).pose();
    let joints = evaluated.skeleton().iter();
    joints.map(|(at, joint)| (joint.name.clone(), pose.base(at), pose.tip(at))).collect()
}

fn assert_children_stay(document: &Document, deleted: &[JointId], times: &[f64]) {
    let mut after = document.clone();
    after.dissolve(deleted).expect("dissolved");
    let names: Vec<_> =
        deleted.iter().map(|at| &document.skeleton().joints()[at.index()].name).collect();
    for time in times {
        let mut before = positions(document, *time);
        before.retain(|(name, ..)| !names.contains(&name));
        let now = positions(&after, *time);
        assert_eq!(now.len(), before.len());
        for ((name, base, tip), (other, now_base, now_tip)) in before.into_iter().zip(now) {
            assert_eq!(name, other);
            let moved = base.distance(now_base).max(tip.distance(now_tip));
            assert!(moved < 1e-4, "{name} moves by {moved} at {time} s");
        }
    }
}

/// The figure of the Human example with other angles, posed by them alone.
fn human() -> Document {
    let mut document = example("human");
    document.rig.targets.clear();
    for joint in document.skeleton().ids() {
        let turn = |axis: f32| (joint.index() as f32 * 1.7 + axis).sin() * 0.8;
        let rotation = Vec3::new(turn(0.0), turn(1.0), turn(2.0));
        document.skeleton_mut().set_rotation(joint, rotation).expect("turned");
    }
    document
}

#[test]
fn children_of_a_dissolved_joint_keep_their_positions() {
    let document = human();
    for joint in document.skeleton().ids() {
        assert_children_stay(&document, &[joint], &[0.0]);
    }
    assert_children_stay(&document, &[0, 1, 2, 5].map(JointId::new), &[0.0]);
}

#[test]
fn children_keep_their_positions_at_every_key() {
    let mut document = human();
    let (shoulder, elbow) = (JointId::new(1), JointId::new(2));
    for (time, angle) in [(0.0, 0.2), (1.0, -0.7), (2.5, 1.1)] {
        let rotation = Vec3::new(angle, -angle, 0.5 * angle);
        document.keys.insert(Channel::Rotation(shoulder), time, rotation);
    }
    document.keys.insert(Channel::Rotation(elbow), 0.5, Vec3::splat(0.3));
    document.keys.insert(Channel::Rotation(elbow), 2.0, Vec3::splat(-0.2));
    assert_children_stay(&document, &[shoulder], &[0.0, 0.5, 1.0, 2.0, 2.5]);
}
