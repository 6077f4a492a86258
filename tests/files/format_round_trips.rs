//! Motions go from format to format and back without loss, at every frame.

use glam::{Affine3A, Mat3, Vec3};
use ik_arm::document::{Channel, Document, SkeletonRig, Timeline};
use ik_arm::io::{self, BvhUnit, ExportFrames, OpenOptions, Progress};
use ik_arm::kinematics::skeleton::JointId;
use pollster::block_on;

use crate::common::{Random, skeletons};

/// A tree with turning joints, a walking root and inner joints that slide, in a turned and scaled
/// place.
fn motion(random: &mut Random) -> Document {
    let (mut skeleton, _) = skeletons::tree(random, 3, 1.0);
    let turned = random.rotation() * random.within(0.2..5.0);
    let transform = Affine3A::from_mat3_translation(turned, random.vector(3.0));
    skeleton.set_transform(transform).expect("finite");
    let joints = skeleton.joints().len();
    let rig = SkeletonRig::new(skeleton);
    let mut document = Document::new(rig);
    let start = f64::from(random.within(0.0..3.0));
    let frame_rate = random.one_of(&[24.0, 29.97, 30.0, 33.33, 60.0, 119.88]);
    document.timeline = Timeline { start, end: start + 20.0 / frame_rate, frame_rate };
    for time in [0.0, 0.3, 1.0].map(|part| start + part * 20.0 / frame_rate) {
        document.keys.insert(Channel::Offset(JointId::new(0)), time, random.vector(4.0));
        for joint in (0..joints).map(JointId::new) {
            document.keys.insert(Channel::Rotation(joint), time, random.angles());
        }
        let sliding = JointId::new(1 + random.below(joints - 1));
        document.keys.insert(Channel::Offset(sliding), time, random.vector(1.0));
    }
    document
}

/// Where the joints are in a frame, in metres, by their names.
fn joints_at(document: &Document, frames: &ExportFrames, frame: usize) -> Vec<(String, Vec3)> {
    let time = frames.time(frame);
    let skeleton = document.at(time).skeleton().clone();
    let (pose, metres) = (skeleton.pose(), document.metres_per_unit());
    let named = skeleton.iter().map(|(id, joint)| (joint.name.clone(), pose.base(id) * metres));
    named.collect()
}

fn assert_same(before: &Document, after: &Document, what: &str) {
    let frames = |document| ExportFrames::of_pose(document, None).expect("frames");
    let (old, new) = (frames(before), frames(after));
    assert_eq!(old.count(), new.count(), "{what}");
    for frame in 0..old.count() {
        let (was, is) = (joints_at(before, &old, frame), joints_at(after, &new, frame));
        let size = was.iter().map(|(_, at)| at.length()).fold(1e-3, f32::max);
        for (name, at) in was {
            let found = is.iter().find(|(other, _)| *other == name).expect("the same joints").1;
            let far = found.distance(at) / size;
            assert!(far < 1e-5, "{what}, {name} in frame {frame}: {far:e}");
        }
    }
}

fn through_glb(document: &Document) -> Document {
    let bytes = block_on(io::glb(document, None, &Progress::default())).expect("written");
    io::read("x.glb", &bytes[..], &OpenOptions::default()).expect("read").document
}

fn through_bvh(document: &Document) -> Document {
    let unit = BvhUnit::Centimetres;
    let exported =
        block_on(io::to_bvh(document, None, unit, &Progress::default())).expect("written");
    io::read("x.bvh", &exported.bytes[..], &OpenOptions::default()).expect("read").document
}

fn through_json(document: &Document) -> Document {
    let text = io::to_json(document).expect("written");
    io::parse("x.json", &text, &OpenOptions::default()).expect("read").document
}

#[test]
fn every_joint_is_where_it_was_after_each_format_and_each_pair() {
    let mut random = Random(91);
    for _ in 0..40 {
        let document = motion(&mut random);
        assert_eq!(through_json(&document), document);
        let glb = through_glb(&document);
        assert_same(&document, &glb, "glTF");
        assert_same(&document, &through_glb(&glb), "glTF, glTF");
        let bvh = through_bvh(&document);
        assert_same(&document, &bvh, "BVH");
        assert_same(&document, &through_bvh(&bvh), "BVH, BVH");
        assert_same(&document, &through_glb(&through_bvh(&glb)), "glTF, BVH, glTF");
        assert_same(&document, &through_bvh(&through_glb(&bvh)), "BVH, glTF, BVH");
        assert_same(&document, &through_json(&through_bvh(&through_json(&glb))), "with documents");
    }
}

#[test]
fn a_mirrored_skeleton_keeps_its_places() {
    let mut random = Random(92);
    for _ in 0..10 {
        let mut document = motion(&mut random);
        let mirrored = Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0)) * random.rotation();
        let transform = Affine3A::from_mat3_translation(mirrored, random.vector(1.0));
        document.skeleton_mut().set_transform(transform).expect("finite");
        assert_same(&document, &through_glb(&document), "glTF");
        assert_same(&document, &through_bvh(&document), "BVH");
    }
}
