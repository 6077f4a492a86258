//! Documents to export: every example, with and without keys.

use crate::common::arm::{Arm, channels};
use glam::Vec3;
use ik_arm::document::{Channel, Document, SkeletonRig, Timeline, TwistReferenceKind};
use ik_arm::io::{self, Example, Progress};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::kinematics::soft_reach::SoftReach;
use pollster::block_on;

use crate::common::Random;
use crate::common::documents::example;
use crate::common::skeletons::transform;

pub fn glb(document: &Document) -> Vec<u8> {
    block_on(io::glb(document, None, &Progress::default()))
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Every example, and variants with keys and transforms.
pub fn all() -> Vec<(String, Document)> {
    let mut random = Random(20);
    let mut all = vec![("keyed-lengths".to_owned(), keyed_arm(&mut random))];
    all.push(("led".to_owned(), led_arm(&mut random)));
    for Example { name, .. } in Example::ALL {
        let document = example(name);
        // Variants of one figure are enough.
        let is_another = matches!(name, "reaching-down" | "looking-at-the-hand");
        if document.rig.sole_limb().is_none() && !is_another {
            for variant in 0..4 {
                let mut keyed = keyed_skeleton(document.clone(), &mut random);
                let transform = transform(&mut random);
                keyed.skeleton_mut().set_transform(transform).expect("finite");
                all.push((format!("{name}-keyed-{variant}"), keyed));
            }
            all.push((format!("{name}-flat"), flat(document.clone())));
        }
        all.push((name.to_owned(), document));
    }
    all.push(("points".to_owned(), points()));
    all.push(("names".to_owned(), names()));
    all
}

/// An arm all of whose channels have keys.
pub fn keyed_arm(random: &mut Random) -> Document {
    let mut document = Document { timeline: short(), ..Document::default() };
    for time in times() {
        let mut key = |channel, value| document.keys.insert(channel, time, value);
        key(channels::HAND, random.vector(450.0));
        key(channels::ROOT_OFFSET, random.vector(100.0));
        for (channel, low, high) in [
            (channels::TWIST, -9.0, 9.0),
            (channels::UPPER_LENGTH, 50.0, 400.0),
            (channels::LOWER_LENGTH, 50.0, 400.0),
        ] {
            key(channel, Vec3::X * random.within(low..high));
        }
    }
    document
}

/// An arm with stretch and softness, switched between IK and FK.
fn led_arm(random: &mut Random) -> Document {
    let soft_reach = SoftReach::new(0.3, 2.0, 0.5).expect("a softening");
    let arm =
        Arm { twist_reference: TwistReferenceKind::Stereographic, soft_reach, ..Arm::default() };
    let mut document = Document { timeline: short(), ..arm.document() };
    for time in times() {
        let mut key = |channel, value| document.keys.insert(channel, time, value);
        key(channels::HAND, random.vector(700.0));
        key(channels::TWIST, Vec3::X * random.within(-9.0..9.0));
        key(channels::INFLUENCE, Vec3::X * random.within(0.0..1.0));
        key(channels::SHOULDER, random.vector(3.0));
        key(channels::BEND, Vec3::Z * random.within(-3.0..3.0));
    }
    document
}

fn keyed_skeleton(mut document: Document, random: &mut Random) -> Document {
    document.timeline = short();
    let size = document.rig.reach();
    for joint in 0..document.skeleton().joints().len() {
        let offset = document.skeleton().joints()[joint].offset;
        let (turns, moves) = (random.chance(0.7), random.chance(0.2));
        for time in times() {
            if turns {
                document.keys.insert(Channel::Rotation(JointId::new(joint)), time, random.angles());
            }
            if moves {
                let offset = offset + random.vector(0.1 * size);
                document.keys.insert(Channel::Offset(JointId::new(joint)), time, offset);
            }
        }
    }
    for time in times() {
        document.keys.insert(Channel::Translation, time, random.vector(size));
    }
    document
}

fn flat(mut document: Document) -> Document {
    let mut transform = document.skeleton().transform();
    transform.matrix3.z_axis = glam::Vec3A::ZERO;
    document.skeleton_mut().set_transform(transform).expect("finite");
    document
}

/// Joints without length, all at one point.
fn points() -> Document {
    let mut document = Document::new(SkeletonRig::default());
    let joint = |name, parent| Joint::new(name, parent, Vec3::ZERO);
    let joints =
        vec![joint("one", None), joint("two", Some(JointId::new(0))), joint("three", None)];
    *document.skeleton_mut() = Skeleton::from_joints(joints).expect("a skeleton");
    document
}

/// Names that the file has already, and that tips would have.
fn names() -> Document {
    let mut document = Document::new(SkeletonRig::default());
    let joint = |name, parent| Joint::new(name, parent, Vec3::Y);
    let joints = vec![
        joint("Armature", None),
        joint("a", Some(JointId::new(0))),
        joint("a_tip", Some(JointId::new(0))),
    ];
    *document.skeleton_mut() = Skeleton::from_joints(joints).expect("a skeleton");
    document
}

fn short() -> Timeline {
    Timeline { start: -0.5, end: 1.5, frame_rate: 24.0 }
}

fn times() -> [f64; 4] {
    [-0.5, 0.1, 0.75, 1.5]
}
