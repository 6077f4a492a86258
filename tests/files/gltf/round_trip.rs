//! Export and import keep positions.

use std::collections::HashMap;

use glam::Vec3;
use ik_arm::document::{Channel, Document, SkeletonRig, Timeline};
use ik_arm::io::{self, Opened};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};

use crate::common::Random;
use crate::common::documents::example;
use crate::gltf::documents::{all, glb, keyed_arm};

fn reopened(document: &Document) -> Opened {
    let bytes = glb(document);
    io::read("test.glb", &bytes[..], &io::OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Bases of bones in metres.
fn bases(document: &Document, time: f64) -> Vec<(String, Vec3)> {
    let posed = document.at(time);
    let (skeleton, pose) = (posed.skeleton(), posed.skeleton().pose());
    let joints = skeleton.joints().iter().enumerate();
    let named = joints.map(|(index, joint)| (joint.name.clone(), pose.base(JointId::new(index))));
    let metres = document.metres_per_unit();
    named.map(|(name, point): (String, Vec3)| (name, point * metres)).collect()
}

/// The same of an imported document, by the names of the joints.
fn imported(document: &Document, time: f64) -> HashMap<String, Vec3> {
    let document = document.at(time).into_document();
    let pose = document.skeleton().pose();
    let joints = document.skeleton().iter();
    joints.map(|(id, joint)| (joint.name.clone(), pose.base(id))).collect()
}

fn largest(points: &[(String, Vec3)]) -> f32 {
    let centre = points.iter().map(|(_, point)| *point).sum::<Vec3>() / points.len() as f32;
    points.iter().map(|(_, point)| point.distance(centre)).fold(0.0, f32::max)
}

fn check(name: &str, document: &Document, opened: &Opened) {
    let timeline = document.timeline;
    let frames = if opened.document.keys.is_empty() { 1 } else { timeline.frames() };
    for frame in 0..frames {
        let expected = bases(document, timeline.time(frame));
        let size = largest(&expected).max(0.25 * document.metres_per_unit());
        let time = frame as f64 / timeline.frame_rate;
        let found = imported(&opened.document, time);
        for (joint, expected) in &expected {
            let Some(found) = found.get(joint) else { panic!("{name} has no joint {joint}") };
            let gap = found.distance(*expected);
            // f32 are coarse far from the origin.
            let largest = expected.abs().max_element();
            let coarse = 2.0 * (largest.next_up() - largest);
            assert!(
                gap <= 1e-4 * size + coarse,
                "{name}, {joint} at frame {frame}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn every_joint_is_where_it_was_in_every_frame() {
    for (name, document) in all().into_iter().filter(|(name, _)| name != "names") {
        let opened = reopened(&document);
        let Opened { document: read, warnings, order, skeletons, .. } = &opened;
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
        assert_eq!(skeletons, &["Armature".to_owned()]);
        assert_eq!(order.len(), read.skeleton().joints().len());
        // The solver refuses a flat skeleton, whose targets then move nothing.
        let moves = document.is_animated() && name != "jumping-chain-flat";
        assert_eq!(moves, !read.keys.is_empty(), "{name}");
        check(&name, &document, &opened);
    }
}

#[test]
fn animations_keep_their_duration_and_frame_rate() {
    for name in ["tadpoles", "human-keyed-0", "keyed-lengths"] {
        let (_, document) = all().into_iter().find(|(other, _)| other == name).expect(name);
        let (was, is) = (document.timeline, reopened(&document).document.timeline);
        assert_eq!((is.start, is.frame_rate, is.frames()), (0.0, was.frame_rate, was.frames()));
    }
}

#[test]
fn still_documents_have_no_keys_and_keep_their_pose() {
    for name in ["human", "arm", "degenerate"] {
        let document = example(name);
        let opened = reopened(&document);
        assert!(opened.document.keys.is_empty(), "{name}");
        check(name, &document, &opened);
    }
}

#[test]
fn a_skeleton_keeps_its_joints_and_the_bones_of_its_leaves() {
    let document = example("human");
    let (was, is) = (document.skeleton(), reopened(&document).document);
    let is = is.skeleton();
    let names = |skeleton: &Skeleton| -> Vec<String> {
        skeleton.joints().iter().map(|joint| joint.name.clone()).collect()
    };
    assert_eq!(names(is), names(was));
    for (index, joint) in was.joints().iter().enumerate() {
        assert_eq!(is.joints()[index].parent, joint.parent);
        if was.children(JointId::new(index)).next().is_none() {
            assert!(
                is.tip(JointId::new(index)).distance(was.tip(JointId::new(index))) < 1e-4,
                "{}",
                joint.name
            );
        }
    }
}

#[test]
fn the_hand_of_an_arm_with_keyed_lengths_is_a_joint() {
    let read = reopened(&keyed_arm(&mut Random(1))).document;
    let skeleton = read.skeleton();
    let names: Vec<&str> = skeleton.joints().iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["root", "upper", "lower", "hand", "upper_tip", "lower_tip"]);
}

#[test]
fn a_chain_of_the_largest_number_of_joints_keeps_its_lengths() {
    let mut document = Document::new(SkeletonRig::default());
    document.timeline = Timeline { start: 0.0, end: 0.125, frame_rate: 24.0 };
    let joint = |index: usize| {
        let parent = index.checked_sub(1);
        let offset = parent.map_or(Vec3::ZERO, |_| Vec3::Y);
        Joint { offset, ..Joint::new(&format!("j{index}"), parent.map(JointId::new), Vec3::Y) }
    };
    let joints = (0..Skeleton::MOST_JOINTS).map(joint).collect();
    *document.skeleton_mut() = Skeleton::from_joints(joints).expect("a skeleton");
    for joint in 0..Skeleton::MOST_JOINTS {
        for (time, angle) in [(0.0, 0.0), (0.125, 0.002)] {
            let angles = Vec3::splat(angle * (joint % 7) as f32);
            document.keys.insert(Channel::Rotation(JointId::new(joint)), time, angles);
        }
    }
    let opened = reopened(&document);
    let joints = opened.document.skeleton().joints();
    assert_eq!(joints.len(), Skeleton::MOST_JOINTS);
    assert!(
        opened.document.keys.tracks().all(|(channel, _)| matches!(channel, Channel::Rotation(_)))
    );
    let (was, is) = (document.at(0.125).into_document(), opened.document.at(0.125).into_document());
    let (was, is) = (was.skeleton().pose(), is.skeleton().pose());
    let gap = (0..was.len())
        .map(|joint| was.base(JointId::new(joint)).distance(is.base(JointId::new(joint))));
    let far =
        (0..was.len()).map(|joint| was.base(JointId::new(joint)).length()).fold(0.0, f32::max);
    assert!(gap.fold(0.0, f32::max) < 1e-5 * far);
}
