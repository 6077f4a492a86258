//! BVH: exported joints are where the document has them, and imported joints where the file has
//! them.

use crate::common::arm::{ArmPosed, LOWER, UPPER, channels};
use ik_arm::rig::LimbPart;
use std::collections::HashMap;

use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3, Mat3, Vec3};
use ik_arm::document::{Channel, Document, SkeletonRig, Timeline};
use ik_arm::io::{self, BvhUnit, Example, Exported, MotionError, Opened, Progress};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use pollster::block_on;

use crate::common::damage::{message, mutations, wrong_lines};
use crate::common::documents::example;
use crate::common::{Random, skeletons};

fn export(document: &Document) -> Exported {
    export_in(document, BvhUnit::default())
}

fn export_in(document: &Document, unit: BvhUnit) -> Exported {
    block_on(io::to_bvh(document, None, unit, &Progress::default())).expect("it is written")
}

fn text(exported: &Exported) -> &str {
    str::from_utf8(&exported.bytes).expect("UTF-8")
}

fn open(text: &str) -> Opened {
    io::parse("test.bvh", text, &io::OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refusal(text: &str) -> String {
    message(io::parse("test.bvh", text, &io::OpenOptions::default()).expect_err("it is refused"))
}

fn shown(skeleton: Skeleton) -> Document {
    let rig = SkeletonRig::new(skeleton);
    Document::new(rig)
}

/// Positions of bases at a time, and of the tips of leaves.
fn points(document: &Document, time: f64) -> HashMap<String, Vec3> {
    let posed = document.at(time);
    let skeleton = posed.skeleton();
    let pose = skeleton.pose();
    let mut points = HashMap::new();
    for (index, joint) in skeleton.joints().iter().enumerate() {
        points.insert(joint.name.clone(), pose.base(JointId::new(index)));
        if skeleton.children(JointId::new(index)).next().is_none() {
            points.insert(format!("{}_tip", joint.name), pose.tip(JointId::new(index)));
        }
    }
    points
}

/// Every point of the document is where the file has it, at every frame.
fn assert_same(document: &Document, exported: &Exported, per_unit: f32) {
    let read = open(text(exported)).document;
    let frames = io::ExportFrames::of_pose(document, None).expect("frames");
    for frame in 0..frames.count() {
        let expected = points(document, frames.time(frame));
        let found = points(&read, frames.since_first(frame));
        let far = |point: &Vec3| point.length() * per_unit;
        let size = expected.values().map(far).fold(1e-9, f32::max);
        for (name, point) in expected {
            let distance = (point * per_unit).distance(found[&name]);
            assert!(distance <= 1e-5 * size, "{name} of frame {frame}: {distance} of {size}");
        }
    }
}

/// A rotation, translation and uniform scale; every other one mirrored.
fn even_transform(random: &mut Random) -> Affine3A {
    let mirror = if random.chance(0.5) { -1.0 } else { 1.0 };
    let scale = Vec3::new(mirror, 1.0, 1.0) * random.within(0.1..10.0);
    let turned = random.rotation() * Mat3::from_diagonal(scale);
    Affine3A::from_mat3_translation(turned, random.vector(10.0))
}

fn key_rotations(random: &mut Random, document: &mut Document) {
    for joint in 0..document.skeleton().joints().len() {
        for _ in 0..random.below(4) {
            let (time, angles) = (random.within(0.0..1.0), 3.0 * random.angles());
            document.keys.insert(Channel::Rotation(JointId::new(joint)), f64::from(time), angles);
        }
    }
}

// Round trips

#[test]
fn random_keyed_forests_round_trip() {
    let mut random = Random(1);
    for case in 0..60 {
        let joints = 1 + random.below(20);
        let mut document = shown(skeletons::forest(&mut random, joints));
        let transform = even_transform(&mut random);
        document.skeleton_mut().set_transform(transform).expect("finite");
        document.timeline = Timeline { start: -0.25, end: 1.0, frame_rate: 24.0 };
        key_rotations(&mut random, &mut document);
        if case % 3 == 0 {
            for time in [0.0, 0.5, 0.9] {
                document.keys.insert(Channel::Translation, time, random.vector(5.0));
            }
        }
        let exported = export(&document);
        assert_eq!(exported.notes, Vec::<String>::new());
        assert_same(&document, &exported, 100.0);
    }
}

#[test]
fn the_keyed_offset_of_a_single_root_round_trips() {
    let mut random = Random(2);
    let mut document = shown(skeletons::chain(&mut random, 5, 1.0));
    document.skeleton_mut().set_transform(even_transform(&mut random)).expect("finite");
    for time in [0.0, 0.5, 1.0] {
        document.keys.insert(Channel::Offset(JointId::new(0)), time, random.vector(2.0));
    }
    let exported = export(&document);
    assert_eq!(exported.notes, Vec::<String>::new());
    assert_same(&document, &exported, 100.0);
}

#[test]
fn every_example_skeleton_round_trips() {
    for example in Example::ALL {
        let document = example.open().expect("it opens").document;
        let exported = export(&document);
        assert_eq!(exported.notes, Vec::<String>::new(), "{}", example.name);
        assert_same(&document, &exported, 100.0 * document.metres_per_unit());
    }
}

#[test]
fn the_arm_round_trips() {
    let mut random = Random(3);
    let mut document = Document::default();
    document.timeline.end = 1.0;
    for time in [0.0, 0.3, 0.7, 1.0] {
        document.keys.insert(channels::HAND, time, random.vector(600.0));
        document.keys.insert(channels::TWIST, time, random.vector(5.0).with_y(0.0).with_z(0.0));
        document.keys.insert(channels::ROOT_OFFSET, time, random.vector(100.0));
    }
    let exported = export(&document);
    assert_eq!(exported.notes, Vec::<String>::new());
    let read = open(text(&exported)).document;
    for frame in 0..31 {
        let time = f64::from(frame) / 30.0;
        let arm = document.at(time).arm_frames();
        let found = points(&read, time);
        for (name, part) in
            [("upper", LimbPart::Root), ("lower", LimbPart::Elbow), ("hand", LimbPart::Hand)]
        {
            let expected = arm.origin(part) * 0.1;
            assert!(found[name].distance(expected) < 1e-3, "{name} {} {expected}", found[name]);
        }
    }
}

#[test]
fn a_file_that_was_read_is_written_unchanged() {
    let mut random = Random(4);
    let mut document = shown(skeletons::tree(&mut random, 3, 10.0).0);
    key_rotations(&mut random, &mut document);
    document.timeline = Timeline { start: 0.0, end: 0.5, frame_rate: 60.0 };
    let first = open(text(&export(&document))).document;
    assert_eq!(first.timeline, document.timeline);
    let again = open(text(&export(&first))).document;
    assert_eq!(again.skeleton().joints().len(), first.skeleton().joints().len());
    assert_same(&first, &export(&first), 1.0);
}

// Export

#[test]
fn a_small_skeleton_is_written_as_this_text() {
    let mut skeleton = Skeleton::with_root("the hip");
    let add = |skeleton: &mut Skeleton, name, parent, offset, axis| {
        let joint = Joint { offset, ..Joint::new(name, Some(parent), axis) };
        skeleton.add(joint).expect("joint")
    };
    let thigh = add(&mut skeleton, "thigh", JointId::new(0), Vec3::ZERO, Vec3::new(0.0, 0.5, 0.0));
    add(&mut skeleton, "the_hip", JointId::new(0), Vec3::X, Vec3::ZERO);
    add(&mut skeleton, "shin", thigh, Vec3::new(0.0, 0.5, 0.0), Vec3::new(0.0, 0.25, 0.0));
    let mut document = shown(skeleton);
    document.timeline = Timeline { start: 1.0, end: 1.1, frame_rate: 10.0 };
    let turn = |degrees: f32| Vec3::new(0.0, 0.0, degrees.to_radians());
    document.keys.insert(Channel::Rotation(thigh), 1.0, turn(0.0));
    document.keys.insert(Channel::Rotation(thigh), 1.1, turn(90.0));
    document.keys.insert(Channel::Translation, 0.0, Vec3::new(0.0, 2.0, -0.0));
    assert_eq!(
        text(&export(&document)),
        "HIERARCHY\n\
         ROOT the_hip\n\
         {\n\
         \tOFFSET 0 0 0\n\
         \tCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n\
         \tJOINT thigh\n\
         \t{\n\
         \t\tOFFSET 0 0 0\n\
         \t\tCHANNELS 3 Zrotation Yrotation Xrotation\n\
         \t\tJOINT shin\n\
         \t\t{\n\
         \t\t\tOFFSET 0 50 0\n\
         \t\t\tCHANNELS 3 Zrotation Yrotation Xrotation\n\
         \t\t\tEnd Site\n\
         \t\t\t{\n\
         \t\t\t\tOFFSET 0 25 0\n\
         \t\t\t}\n\
         \t\t}\n\
         \t}\n\
         \tJOINT the_hip_2\n\
         \t{\n\
         \t\tOFFSET 100 0 0\n\
         \t\tCHANNELS 3 Zrotation Yrotation Xrotation\n\
         \t\tEnd Site\n\
         \t\t{\n\
         \t\t\tOFFSET 0 0 0\n\
         \t\t}\n\
         \t}\n\
         }\n\
         MOTION\n\
         Frames: 2\n\
         Frame Time: 0.100000000\n\
         0 200 0 0 0 0 0 0 0 0 0 0 0 0 0\n\
         0 200 0 0 0 0 90 0 0 0 0 0 0 0 0\n"
    );
}

#[test]
fn the_unit_can_be_chosen() {
    let document = shown(skeletons::chain(&mut Random(5), 3, 2.0));
    let length = |document: &Document, unit| {
        let read = open(text(&export_in(document, unit))).document;
        read.skeleton().joints()[1].axis.length()
    };
    let own = document.skeleton().joints()[1].axis.length();
    let inches = Document { metres_per_unit: Some(0.0254), ..document };
    for (unit, per_unit) in
        [(BvhUnit::Centimetres, 2.54), (BvhUnit::Metres, 0.0254), (BvhUnit::Scene, 1.0)]
    {
        let found = length(&inches, unit);
        assert!((found - own * per_unit).abs() < 1e-5 * found, "{unit:?}");
    }
}

#[test]
fn the_frame_rate_can_be_chosen_and_a_still_document_has_one_frame() {
    let mut document = shown(skeletons::chain(&mut Random(6), 2, 1.0));
    let frames = |document: &Document, fps| {
        let exported = block_on(io::to_bvh(document, fps, BvhUnit::Metres, &Progress::default()));
        let exported = exported.expect("it is written");
        let said = text(&exported).lines().find_map(|line| line.strip_prefix("Frames: "));
        said.and_then(|said| said.parse::<usize>().ok()).expect("a number")
    };
    assert_eq!(frames(&document, None), 1);
    document.keys.insert(Channel::Rotation(JointId::new(1)), 0.0, Vec3::X);
    assert_eq!((frames(&document, None), frames(&document, Some(7.0))), (241, 57));
    for fps in [0.0, 0.001, 1001.0, f64::NAN, f64::INFINITY] {
        let refused =
            block_on(io::to_bvh(&document, Some(fps), BvhUnit::Metres, &Progress::default()));
        assert!(matches!(refused, Err(MotionError::FrameRate(_))));
    }
}

#[test]
fn angles_continue_past_full_turns() {
    let mut document = shown(skeletons::chain(&mut Random(7), 3, 1.0));
    document.skeleton_mut().set_transform(even_transform(&mut Random(8))).expect("finite");
    for (time, turns) in [(0.0, 0.0), (8.0, 2.0)] {
        let angles = Vec3::new(0.3, -0.2, 1.0) * turns * std::f32::consts::TAU;
        document.keys.insert(Channel::Rotation(JointId::new(1)), time, angles);
    }
    let exported = export(&document);
    let motion = text(&exported).lines().skip_while(|line| !line.starts_with("Frame Time")).skip(1);
    let rows: Vec<Vec<f32>> = motion
        .map(|line| line.split(' ').map(|number| number.parse().expect("a number")).collect())
        .collect();
    assert_eq!(rows.len(), 241);
    let mut farthest = 0.0_f32;
    for pair in rows.windows(2) {
        for (before, after) in pair[0].iter().zip(&pair[1]).skip(3) {
            assert!((after - before).abs() <= 180.0, "{before} to {after}");
            farthest = farthest.max(after.abs());
        }
    }
    assert!(farthest > 360.0, "{farthest}");
    let read = open(text(&exported)).document;
    let keyed = read.keys.track(Channel::Rotation(JointId::new(1))).expect("keyed").knots();
    for pair in keyed.windows(2) {
        let jump = (pair[1].value - pair[0].value).abs().max_element();
        assert!(jump <= std::f32::consts::PI, "{jump}");
    }
}

#[test]
fn every_joint_whose_offset_moves_has_position_channels_and_walks_on() {
    for seed in 0..20 {
        let mut random = Random(seed);
        let mut document = shown(skeletons::tree(&mut random, 3, 1.0).0);
        document.skeleton_mut().set_transform(even_transform(&mut random)).expect("finite");
        let joints = document.skeleton().joints().len();
        let moving = [JointId::new(0), JointId::new(1), JointId::new(joints - 1)];
        for joint in moving {
            for time in [0.0, 0.5, 1.0] {
                document.keys.insert(Channel::Offset(joint), time, random.vector(10.0));
                document.keys.insert(Channel::Rotation(joint), time, random.vector(2.0));
            }
        }
        let exported = export(&document);
        assert_eq!(exported.notes, Vec::<String>::new());
        let with_positions = text(&exported).matches("CHANNELS 6").count();
        assert_eq!(with_positions, moving.len());
        assert_same(&document, &exported, 100.0);
    }
}

#[test]
fn an_offset_that_moves_by_less_than_a_hundred_thousandth_of_the_reach_is_constant() {
    for (part, channels) in [(0.5e-5, 1), (2e-5, 2)] {
        let mut document = shown(skeletons::chain(&mut Random(9), 3, 1.0));
        let reach = document.rig.reach();
        let offset = document.skeleton().joints()[2].offset;
        let moved = offset + Vec3::X * part * reach;
        document.keys.insert(Channel::Offset(JointId::new(2)), 0.0, offset);
        document.keys.insert(Channel::Offset(JointId::new(2)), 1.0, moved);
        let exported = export(&document);
        assert_eq!(text(&exported).matches("CHANNELS 6").count(), channels, "{part}");
        assert_eq!(exported.notes, Vec::<String>::new());
    }
}

#[test]
fn roots_that_move_keep_moving_below_the_added_root() {
    let mut forest = Skeleton::default();
    for name in ["a", "skeleton"] {
        forest.add(Joint::new(name, None, Vec3::Y)).expect("joint");
    }
    let mut forest = shown(forest);
    for time in [0.0, 1.0] {
        forest.keys.insert(Channel::Offset(JointId::new(0)), time, Vec3::splat(time as f32));
    }
    let exported = export(&forest);
    assert!(text(&exported).starts_with("HIERARCHY\nROOT skeleton_1\n"), "{}", text(&exported));
    assert_eq!(exported.notes, Vec::<String>::new());
    let read = open(text(&exported)).document;
    let keyed = read.keys.value(Channel::Offset(JointId::new(1)), 1.0).expect("keyed");
    assert!(keyed.distance(Vec3::splat(100.0)) < 1e-3);
}

#[test]
fn bones_of_an_arm_that_change_are_written_and_a_last_bone_that_changes_is_noted() {
    let keyed = |mut document: Document, joint, lengths: [f32; 2]| {
        for (time, length) in lengths.into_iter().enumerate() {
            document.keys.insert(Channel::Length(joint), time as f64, Vec3::X * length);
        }
        export(&document)
    };
    for (joint, lengths) in [(UPPER, [200.0, 250.0]), (LOWER, [300.0, 250.0])] {
        let written = keyed(Document::default(), joint, lengths);
        assert_eq!(written.notes, Vec::<String>::new());
        assert_eq!(text(&written).matches("CHANNELS 6").count(), 2, "the root and the bone's end");
    }
    let chain = shown(skeletons::chain(&mut Random(6), 2, 1.0));
    let (last, joint) = chain.skeleton().iter().last().expect("joints");
    let (name, length) = (joint.name.clone(), joint.axis.length());
    let noted = keyed(chain, last, [length, 2.0 * length]);
    let [note] = &noted.notes[..] else { panic!("one note: {:?}", noted.notes) };
    assert!(note.starts_with(&format!("the last bone of \"{name}\" changes in time")), "{note}");
}

#[test]
fn a_non_uniform_or_singular_transform_is_noted_and_keeps_the_positions_of_joints() {
    let mut random = Random(10);
    for scale in [Vec3::new(1.0, 2.0, 1.0), Vec3::new(1.0, 0.0, 1.0), Vec3::ZERO] {
        let mut document = shown(skeletons::tree(&mut random, 3, 1.0).0);
        skeletons::shake(&mut random, document.skeleton_mut());
        document.skeleton_mut().set_transform(Affine3A::from_scale(scale)).expect("finite");
        key_rotations(&mut random, &mut document);
        let exported = export(&document);
        assert!(exported.notes[0].contains("unevenly"), "{:?}", exported.notes);
        let read = open(text(&exported)).document;
        for time in [0.0, 1.0] {
            let (expected, found) = (points(&document, time), points(&read, time));
            for (name, point) in expected.iter().filter(|(name, _)| !name.ends_with("_tip")) {
                let distance = (*point * 100.0).distance(found[name]);
                assert!(distance < 1e-3, "{name} at {time} s, scale {scale}: {distance}");
            }
        }
    }
    // With a nearly uniform scale, rotations are nearly right.
    let mut document = shown(skeletons::chain(&mut random, 4, 1.0));
    skeletons::shake(&mut random, document.skeleton_mut());
    let nearly = Affine3A::from_scale(Vec3::new(-1.0, 1.00002, 1.0));
    document.skeleton_mut().set_transform(nearly).expect("finite");
    let exported = export(&document);
    assert_eq!(exported.notes.len(), 1);
    assert_same(&document, &exported, 100.0);
}

#[test]
fn documents_that_no_file_can_hold_are_refused() {
    let refused = |document: &Document| {
        block_on(io::to_bvh(document, None, BvhUnit::default(), &Progress::default()))
            .expect_err("refused")
            .to_string()
    };
    assert!(refused(&shown(Skeleton::default())).contains("at least one joint"));
    let mut far = Skeleton::with_root("far");
    far.change(JointId::new(0), |root| root.offset = Vec3::splat(3e38)).expect("finite");
    assert_eq!(refused(&shown(far)), "the position of \"far\" must be within ±3.4028235e38");
    let mut long = shown(Skeleton::with_root("root"));
    long.timeline = Timeline { start: 0.0, end: 86_000.0, frame_rate: 1000.0 };
    long.keys.insert(Channel::Rotation(JointId::new(0)), 0.0, Vec3::X);
    assert!(refused(&long).contains("must have at most 100000000 numbers"));
}

#[test]
fn a_cancelled_export_stops() {
    let progress = Progress::default();
    progress.cancel();
    let document = example("snake");
    let stopped = block_on(io::to_bvh(&document, None, BvhUnit::default(), &progress));
    assert!(matches!(stopped, Err(MotionError::Cancelled(_))));
}

#[test]
fn a_very_deep_skeleton_round_trips() {
    let mut joints = vec![Joint::new("0", None, Vec3::Y)];
    for index in 1..Skeleton::MOST_JOINTS {
        let joint = Joint::new(&index.to_string(), Some(JointId::new(index - 1)), Vec3::Y);
        joints.push(Joint { offset: Vec3::Y, ..joint });
    }
    let document = shown(Skeleton::from_joints(joints).expect("a chain"));
    let read = open(text(&export(&document))).document;
    assert_eq!(read.skeleton().joints().len(), Skeleton::MOST_JOINTS);
}

// Import

/// A root with three channels for rotation.
const SMALL: &str = "HIERARCHY\nROOT hip\n{\n OFFSET 1 2 3\n CHANNELS 3 Zrotation Xrotation Yrotation\n \
    JOINT knee\n {\n  OFFSET 0 4 0\n  CHANNELS 1 Xposition\n  End Site\n  {\n   OFFSET 0 0 5\n  }\n }\n}\n\
    MOTION\nFrames: 2\nFrame Time: 0.04\n10 20 30 7\n10 20 40 7\n";

#[test]
fn a_small_file_is_read_as_written() {
    let Opened { document, warnings, order, skeletons, .. } = open(SMALL);
    let joints = document.skeleton().joints();
    let name = |index: usize| (joints[index].name.as_str(), joints[index].parent);
    assert_eq!((name(0), name(1)), (("hip", None), ("knee", Some(JointId::new(0)))));
    // A position channel replaces one component of the offset.
    assert_eq!(
        (joints[0].offset, joints[1].offset),
        ((1.0, 2.0, 3.0).into(), (7.0, 4.0, 0.0).into())
    );
    assert_eq!((joints[0].axis, joints[1].axis), ((7.0, 4.0, 0.0).into(), (0.0, 0.0, 5.0).into()));
    let keyed: Vec<_> = document.keys.tracks().map(|(channel, _)| channel).collect();
    assert_eq!(keyed, [Channel::Rotation(JointId::new(0))]);
    assert_eq!(document.timeline, Timeline { start: 0.0, end: 0.04, frame_rate: 25.0 });
    assert_eq!(document.metres_per_unit, Some(0.01));
    assert_eq!(document.camera, document.framing_camera());
    assert_eq!(
        (warnings, order, skeletons),
        (vec![], [0, 1].map(JointId::new).to_vec(), vec!["hip".to_owned()])
    );
    assert!(io::parse("x", SMALL, &io::OpenOptions::of_skeleton("hip")).is_ok());
    let error = io::parse("x", SMALL, &io::OpenOptions::of_skeleton("knee"))
        .expect_err("no skeleton")
        .to_string();
    assert_eq!(error, "x has no skeleton called \"knee\"; it has \"hip\"");
}

#[test]
fn whitespace_line_breaks_and_case_do_not_matter() {
    let plain = open(SMALL).document;
    for text in [
        SMALL.replace('\n', "\r\n"),
        SMALL.replace('\n', "\n\n \t\n"),
        SMALL.replace(' ', "\t "),
        format!("\u{feff}\n {SMALL}\n\n"),
        SMALL
            .replace("hip\n{", "hip {")
            .replace("JOINT", "joint")
            .replace("End Site", "END SITE x"),
        SMALL.to_uppercase().replace("HIP", "hip").replace("KNEE", "knee"),
        SMALL.replace("0.04", "4.0e-2").replace("10 20 30", "+1e1 20. 3.0E+1"),
        SMALL.replace("Frames: 2", "frames :2").replace("Frame Time:", "FRAME  TIME:"),
        SMALL.trim_end().to_owned(),
    ] {
        let opened = open(&text);
        assert_eq!((opened.document, opened.warnings), (plain.clone(), vec![]), "{text}");
    }
}

#[test]
fn a_joint_rotates_by_the_product_of_its_channels_in_file_order() {
    const ROTATIONS: [&str; 3] = ["Xrotation", "Yrotation", "Zrotation"];
    const POSITIONS: [&str; 3] = ["Xposition", "Yposition", "Zposition"];
    let mut random = Random(11);
    for _ in 0..200 {
        let (mut hierarchy, mut numbers) = ("HIERARCHY\n".to_owned(), [Vec::new(), Vec::new()]);
        let mut expected = [vec![DAffine3::IDENTITY], vec![DAffine3::IDENTITY]];
        let joints = 1 + random.below(6);
        for joint in 0..joints {
            let mut channels = [&ROTATIONS[..], &POSITIONS[..]].concat();
            for index in (1..channels.len()).rev() {
                channels.swap(index, random.below(index + 1));
            }
            channels.truncate(random.below(7));
            let offset = random.vector(3.0);
            let kind = if joint == 0 { "ROOT" } else { "JOINT" };
            let Vec3 { x, y, z } = offset;
            hierarchy += &format!("{kind} j{joint} {{ OFFSET {x} {y} {z}\n");
            hierarchy += &format!("CHANNELS {} {}\n", channels.len(), channels.join(" "));
            for frame in 0..2 {
                let (mut position, mut turn) = (offset.as_dvec3(), DMat3::IDENTITY);
                for channel in &channels {
                    let value = random.within(-400.0..400.0);
                    numbers[frame].push(value.to_string());
                    let (value, angle) = (f64::from(value), f64::from(value).to_radians());
                    match *channel {
                        "Xrotation" => turn *= DMat3::from_rotation_x(angle),
                        "Yrotation" => turn *= DMat3::from_rotation_y(angle),
                        "Zrotation" => turn *= DMat3::from_rotation_z(angle),
                        "Xposition" => position.x = value,
                        "Yposition" => position.y = value,
                        _ => position.z = value,
                    }
                }
                let above = expected[frame][joint];
                expected[frame].push(above * DAffine3::from_mat3_translation(turn, position));
            }
        }
        let text = format!(
            "{hierarchy}{}MOTION\nFrames: 2\nFrame Time: 0.5\n{}\n{}\n",
            "}".repeat(joints),
            numbers[0].join(" "),
            numbers[1].join(" ")
        );
        let document = open(&text).document;
        // Without channels all frames are equal.
        for frame in 0..2 {
            let pose = document.at(frame as f64 * 0.5).into_document().skeleton().pose();
            let size = 400.0 * joints as f64;
            for joint in 0..joints {
                let expected = expected[frame][joint + 1];
                let found = pose.full(JointId::new(joint));
                let off = found.translation.as_dvec3().distance(expected.translation);
                assert!(off < 1e-5 * size, "{off}\n{text}");
                let turned = found.transform_vector3(Vec3::ONE).as_dvec3();
                assert!(turned.distance(expected.matrix3 * DVec3::ONE) < 1e-4, "{text}");
            }
        }
    }
}

#[test]
fn between_frames_joints_turn_the_shortest_way_also_near_gimbal_lock() {
    let mut random = Random(391);
    for _ in 0..100 {
        // In gimbal lock of z, y, x, with a little change from frame to frame.
        let turn = |random: &mut Random| {
            [0.0, 90.0, 0.0].map(|it| f64::from(it + random.within(-3.0..3.0)))
        };
        let frames = [turn(&mut random), turn(&mut random)];
        let lines = frames.map(|turns| turns.map(|it| it.to_string()).join(" ")).join("\n");
        let text = format!(
            "HIERARCHY ROOT a {{ OFFSET 0 0 0 CHANNELS 3 Yrotation Xrotation Zrotation\n\
             End Site {{ OFFSET 0 1 0 }} }}\nMOTION\nFrames: 2\nFrame Time: 1\n{lines}\n"
        );
        let rotation = |[y, x, z]: [f64; 3]| {
            let [y, x, z] = [y, x, z].map(f64::to_radians);
            DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x) * DQuat::from_rotation_z(z)
        };
        let [from, to] = frames.map(rotation);
        let document = open(&text).document;
        for part in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let expected = from.slerp(to, part) * DVec3::new(0.3, 0.5, 0.7);
            let posed = document.at(part);
            let found = posed.skeleton().pose().full(JointId::new(0));
            let found = found.transform_point3(Vec3::new(0.3, 0.5, 0.7)).as_dvec3();
            assert!(found.distance(expected) < 1e-6, "{found}, not {expected} at {part}\n{text}");
        }
    }
}

#[test]
fn joints_whose_positions_are_all_zero_keep_their_offsets() {
    let file = |root: &str, positions: [&str; 2]| {
        let channels = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation";
        let [first, second] = positions;
        format!(
            "HIERARCHY ROOT a {{ OFFSET 0 9 0 {channels} JOINT b {{ OFFSET 0 2 0 {channels}\n\
             JOINT c {{ OFFSET 0 0 0 {channels} End Site {{ OFFSET 0 1 0 }} }} }} }}\n\
             MOTION\nFrames: 2\nFrame Time: 1\n{root} 0 0 0 {first} 0 0 0 0 0 0 0 0 0\n\
             {root} 0 0 0 {second} 0 0 90 0 0 0 0 0 0\n"
        )
    };
    let bases = |text: &str| {
        let opened = open(text);
        let pose = opened.document.at(1.0).skeleton().pose();
        ([0, 1].map(|joint| pose.base(JointId::new(joint)).y), opened.warnings.len())
    };
    assert_eq!(bases(&file("0 5 0", ["0 0 0"; 2])), ([5.0, 7.0], 1), "the root goes");
    assert_eq!(bases(&file("0 0 0", ["0 0 0"; 2])), ([9.0, 11.0], 1), "the root stays, too");
    assert_eq!(bases(&file("0 5 0", ["0 0 0", "0 1 0"])), ([5.0, 6.0], 0), "a joint moves");
}

#[test]
fn several_roots_are_one_skeleton() {
    let root = |name: &str, x: i32| {
        format!("ROOT {name} {{ OFFSET {x} 0 0 CHANNELS 0 End Site {{ OFFSET 0 1 0 }} }}\n")
    };
    let text =
        format!("HIERARCHY\n{}{}MOTION\nFrames: 1\nFrame Time: 1\n", root("a", 1), root("b", 2));
    let document = open(&text).document;
    let joints = document.skeleton().joints();
    assert_eq!(
        [0, 1].map(|index| (joints[index].parent, joints[index].offset.x)),
        [(None, 1.0), (None, 2.0)]
    );
    assert_eq!((document.keys.is_empty(), document.timeline.frame_rate), (true, 1.0));
}

#[test]
fn duplicate_names_are_changed_with_a_warning() {
    let leaf = "JOINT left arm { OFFSET 0 1 0 }\n";
    let text = format!(
        "HIERARCHY\nROOT left arm {{ OFFSET 0 0 0\n{}}}\nMOTION\nFrames: 0\nFrame Time: 1\n",
        leaf.repeat(30)
    );
    let Opened { document, warnings, .. } = open(&text);
    let joints = document.skeleton().joints();
    assert_eq!(
        [0, 1, 30].map(|index| &joints[index].name),
        ["left arm", "left arm_2", "left arm_31"]
    );
    assert_eq!(warnings.len(), 21);
    let first = warnings[0].to_string();
    assert_eq!(
        first,
        "line 3, column 7: [\"left arm\"]: joint names must be unique; renamed to \
         \"left arm_2\""
    );
    assert!(warnings[20].reason.contains("10 more"));
}

#[test]
fn a_bone_ends_at_the_child_that_continues_the_chain_and_a_leaf_without_end_site_goes_straight_on()
{
    let text = "HIERARCHY\nROOT a { OFFSET 0 0 0\n\
        JOINT b { OFFSET 2 4 0 JOINT c { OFFSET 0 6 0 } }\n\
        JOINT d { OFFSET 0 4 0 } }\nMOTION\nFrames: 0\nFrame Time: 1\n";
    let joints = open(text).document.skeleton().clone();
    let axis = |name| joints.joints()[joints.find(name).expect("there").index()].axis;
    assert_eq!(axis("a"), Vec3::new(2.0, 4.0, 0.0));
    assert_eq!(axis("b"), Vec3::new(0.0, 6.0, 0.0));
    assert_eq!((axis("c"), axis("d")), (Vec3::Y * 3.0, Vec3::Y * 6.0));
}

#[test]
fn rounded_frame_times_give_the_frame_rate_that_was_meant() {
    for (said, frame_rate, end) in [
        ("0.033333", 30.0, 2.0 / 30.0),
        ("0.0083333", 120.0, 2.0 / 120.0),
        ("0.00100000", 1000.0, 0.002),
        ("1", 1.0, 2.0),
        ("0.0333667", 30e3 / 1001.0, 2002.0 / 30e3),
        ("0.0005", 1000.0, 0.001),
        ("3", 1.0 / 3.0, 6.0),
        ("0.030003", 1.0 / 0.030_003, 0.060_006),
    ] {
        let text = SMALL.replace("0.04", said).replace("Frames: 2", "Frames: 3") + "10 20 50 7\n";
        let document = open(&text).document;
        let knots = document.keys.track(Channel::Rotation(JointId::new(0))).expect("keyed").knots();
        assert_eq!((document.timeline.frame_rate, knots.len()), (frame_rate, 3), "{said}");
        assert!((knots[2].time - end).abs() < 1e-12 && document.timeline.end == knots[2].time);
        assert!(document.timeline.is_valid());
    }
}

#[test]
fn frames_beyond_the_declared_count_are_ignored_with_a_warning() {
    let opened = open(&SMALL.replace("Frames: 2", "Frames: 1"));
    assert_eq!(opened.warnings.len(), 1);
    assert_eq!(
        opened.warnings[0].to_string(),
        "line 20, column 1: ignored: text after the 1 frames of the header"
    );
    assert!(opened.document.keys.is_empty());
}

#[test]
fn errors_name_the_position_the_joint_and_the_rule() {
    for (right, invalid, said) in [
        ("ROOT", "", "line 2, column 2: found \"hip\", expected ROOT"),
        ("hip\n", "\n", "line 3, column 1: ROOT must be followed by a name"),
        ("hip\n{", "hip\n", "line 4, column 2: hip: found \"OFFSET\", expected {"),
        (" OFFSET 1 2 3\n", "", "line 14, column 1: hip: must have an OFFSET"),
        ("1 2 3", "1 2", "line 5, column 2: hip: found \"CHANNELS\", expected a number"),
        ("1 2 3", "1 2 nan", "line 4, column 13: hip: must be within ±3.4"),
        ("1 2 3", "1 2 1e39", "line 4, column 13: hip: must be within ±3.4028235e38, got 1e39"),
        (
            "1 2 3",
            "1 2 3 4",
            "line 4, column 15: hip: found \"4\", expected OFFSET, CHANNELS, JOINT,",
        ),
        (
            "1 2 3",
            "1 2 3\nOFFSET 1 2 3",
            "line 5, column 1: hip: must have one OFFSET, got a second",
        ),
        ("CHANNELS 3", "CHANNELS 7", "line 5, column 11: hip: must have 0 to 6 channels, got 7"),
        (
            "CHANNELS 3",
            "CHANNELS -3",
            "line 5, column 11: hip: found \"-3\", expected a whole number",
        ),
        (
            "CHANNELS 3",
            "CHANNELS 4",
            "line 6, column 2: hip: found \"JOINT\", expected a channel: Xp",
        ),
        (
            "Xrotation",
            "Wrotation",
            "line 5, column 23: hip: found \"Wrotation\", expected a channel",
        ),
        ("Xrotation", "Zrotation", "line 5, column 23: hip: CHANNELS must have Zrotation once"),
        ("End Site", "End", "line 11, column 3: knee: End must be followed by Site"),
        (
            "OFFSET 0 0 5",
            "",
            "line 13, column 3: knee: found \"}\", expected OFFSET in the End Site",
        ),
        (
            "   OFFSET 0 0 5\n  }\n }\n}",
            "OFFSET 0 0 5",
            "found \"MOTION\", expected } in the End Site",
        ),
        ("MOTION", "", "expected ROOT or MOTION"),
        ("Frames: 2", "Frames 2", "line 17, column 1: found \"Frames\", expected Frames:"),
        ("Frames: 2", "Frames: 2.5", "line 17, column 9: found \"2.5\", expected a whole number"),
        (
            "Frames: 2",
            "Frames: 4",
            "line 17, column 9: Frames must be 2, the number of lines that follow, got 4",
        ),
        (
            "Frames: 2",
            "Frames: 999999999999",
            "motion must last at most 86400 s, got 999999999999 frames of 0.04 s",
        ),
        (
            "Frame Time: 0.04",
            "Frame: 0.04",
            "line 18, column 1: found \"Frame:\", expected Frame Time:",
        ),
        ("0.04", "0", "line 18, column 13: Frame Time must be above 0 s, got 0"),
        ("0.04", "-1", "line 18, column 13: Frame Time must be above 0 s, got -1"),
        ("0.04", "inf", "line 18, column 13: found \"inf\", expected a time in seconds"),
        (
            "0.04",
            "1e5",
            "line 18, column 13: motion must last at most 86400 s, got 2 frames of 100000 s",
        ),
        (
            "10 20 40 7",
            "10 20",
            "line 20, column 6: hip: frame 1 must have 4 numbers, got 2 before",
        ),
        ("10 20 40 7", "10 20 40", "line 20, column 9: knee: frame 1 must have 4 numbers, got 3"),
        ("10 20 40 7", "10 20 40 7 8", "line 20, column 12: frame 1 must have 4 numbers, got 5"),
        (
            "10 20 40 7",
            "10 x 40 7",
            "line 20, column 4: hip: Xrotation of frame 1: found \"x\", expected",
        ),
        (
            "10 20 40 7",
            "10 20 40 inf",
            "line 20, column 10: knee: Xposition of frame 1: must be within ±3.4028235e38, got inf",
        ),
    ] {
        let text = SMALL.replacen(right, invalid, 1);
        let refusal = refusal(&text);
        assert!(refusal.contains(said), "{refusal}\n{said}\n{text}");
    }
    assert!(refusal("HIERARCHY").contains("found the end of the file, expected ROOT"));
    let late = SMALL.replace(" CHANNELS 3 Zrotation Xrotation Yrotation\n", "");
    let late = late.replace(" }\n}\n", " }\n CHANNELS 0\n}\n");
    assert!(refusal(&late).contains("CHANNELS must be before the joint's children"));
    let many = "JOINT a { OFFSET 0 0 0 }\n".repeat(Skeleton::MOST_JOINTS);
    let many = format!("HIERARCHY ROOT a\n{{ OFFSET 0 0 0 {many} }}");
    assert!(refusal(&many).contains("at most 10000 joints"));
}

#[test]
fn damaged_files_open_or_are_refused() {
    let mut random = Random(12);
    let mut document = shown(skeletons::tree(&mut Random(13), 3, 1.0).0);
    key_rotations(&mut Random(14), &mut document);
    document.timeline.end = 0.5;
    let exported = export(&document);
    let whole = text(&exported);
    let words =
        ["JOINT x {", "}", "{", "End Site", "MOTION", "1e400", "-", "CHANNELS 6", "NaN", "é"];
    let wrong_words = wrong_lines(whole, &words, &mut random, 300);
    let mut opened = 0;
    for bytes in mutations(whole, &mut random, 900).into_iter().chain(wrong_words) {
        match io::read("damaged.bvh", &bytes[..], &io::OpenOptions::default()) {
            Ok(read) => {
                opened += 1;
                assert!(read.document.timeline.is_valid());
                let again = io::to_json(&read.document).expect("written");
                io::parse("again", &again, &io::OpenOptions::default())
                    .expect("every document can be saved and opened");
            }
            Err(error) => drop(message(error)),
        }
    }
    assert!((50..1100).contains(&opened), "{opened}");
}

#[test]
fn deep_and_endless_files_are_refused_without_deep_recursion() {
    let deep = "JOINT a { OFFSET 0 0 0\n".repeat(1_000_000);
    assert!(refusal(&format!("HIERARCHY ROOT a {{ OFFSET 0 0 0 {deep}")).contains("at most 10000"));
    let braces = format!("HIERARCHY ROOT a {}", "{".repeat(1_000_000));
    assert!(refusal(&braces).contains("expected OFFSET"));
    let empty =
        "HIERARCHY ROOT a { OFFSET 0 0 0 } MOTION Frames: 18446744073709551615 Frame Time: 1e-300";
    refusal(&empty.replace("1e-300", "1"));
    open(empty);
}

#[test]
fn a_file_too_large_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.bvh");
    let file = std::fs::File::create(&path).expect("created");
    file.set_len(200 << 20).expect("sparse");
    let before = std::time::Instant::now();
    let error = message(io::open(&path, &io::OpenOptions::default()).expect_err("refused"));
    assert!(error.ends_with("must be at most 64 MB large"), "{error}");
    assert!(before.elapsed().as_millis() < 100);
}
