//! Files in which z points up: recognised by their bind pose, and turned.

use std::f64::consts::FRAC_PI_2;

use glam::{DMat3, EulerRot, Vec3};
use ik_arm::document::{Channel, Document, SkeletonRig, Target};
use ik_arm::io::{self, OpenOptions, Opened, Upwards};
use ik_arm::kinematics::skeleton::SkeletonPose;
use ik_arm::kinematics::twist::TwistReferenceKind;
use ik_arm::rig::{LimbSettings, TargetKind};

use crate::common::{Random, skeletons};

/// The axes of a file: where its right, up and forward are.
type Axes = [[i32; 3]; 3];

const Y_UP: Axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const Z_UP: Axes = [[1, 0, 0], [0, 0, 1], [0, -1, 0]];

/// A BVH file with these joints, in axes of its own. A joint is its name, its depth in the tree,
/// and its offset to the right, up and forward. The root walks, and the joints turn.
fn bvh(joints: &[(&str, usize, [f32; 3])], axes: &Axes, random: &mut Random) -> String {
    let at = |offset: &[f32; 3]| -> Vec<f32> {
        (0..3).map(|axis| (0..3).map(|own| offset[own] * axes[own][axis] as f32).sum()).collect()
    };
    let offset = |numbers: &[f32; 3]| {
        let numbers = at(numbers);
        format!("OFFSET {} {} {}\n", numbers[0], numbers[1], numbers[2])
    };
    let mut text = "HIERARCHY\n".to_owned();
    for (index, (name, depth, numbers)) in joints.iter().enumerate() {
        let root = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
        let (kind, channels) = match depth {
            0 => ("ROOT", root),
            _ => ("JOINT", "CHANNELS 3 Zrotation Xrotation Yrotation\n"),
        };
        text += &format!("{kind} {name}\n{{\n{}{channels}", offset(numbers));
        let next = joints.get(index + 1).map_or(0, |next| next.1);
        if next <= *depth {
            text += &format!("End Site\n{{\n{}}}\n", offset(&[numbers[0], numbers[1], numbers[2]]));
            text += &"}\n".repeat(depth + 1 - next.min(*depth + 1));
        }
    }
    text += "MOTION\nFrames: 3\nFrame Time: 0.04\n";
    for frame in 0..3 {
        let walked = at(&[0.0, 90.0, 30.0 * frame as f32]);
        text += &format!("{} {} {} 0 0 0", walked[0], walked[1], walked[2]);
        for _ in 1..joints.len() {
            let turn = random.vector(6.0);
            text += &format!(" {} {} {}", turn.x, turn.y, turn.z);
        }
        text += "\n";
    }
    text
}

const HUMAN: [(&str, usize, [f32; 3]); 11] = [
    ("Hips", 0, [0.0, 90.0, 0.0]),
    ("Spine", 1, [0.0, 20.0, 0.0]),
    ("Head", 2, [0.0, 40.0, 2.0]),
    ("LeftArm", 2, [15.0, 30.0, 0.0]),
    ("LeftHand", 3, [50.0, 0.0, 0.0]),
    ("RightArm", 2, [-15.0, 30.0, 0.0]),
    ("RightHand", 3, [-50.0, 0.0, 0.0]),
    ("LeftLeg", 1, [9.0, -5.0, 0.0]),
    ("LeftFoot", 2, [0.0, -40.0, 1.0]),
    ("RightLeg", 1, [-9.0, -5.0, 0.0]),
    ("RightFoot", 2, [0.0, -40.0, 1.0]),
];

/// Longer than high, with names in which no word is a foot.
const HORSE: [(&str, usize, [f32; 3]); 10] = [
    ("pelvis", 0, [0.0, 130.0, 0.0]),
    ("thorax", 1, [0.0, 5.0, 110.0]),
    ("skull", 2, [0.0, 60.0, 60.0]),
    ("radius_l", 2, [20.0, -60.0, 0.0]),
    ("hoof_l", 3, [0.0, -70.0, 0.0]),
    ("radius_r", 2, [-20.0, -60.0, 0.0]),
    ("hoof_r", 3, [0.0, -70.0, 0.0]),
    ("tibia_l", 1, [20.0, -60.0, -10.0]),
    ("hoof_bl", 2, [0.0, -65.0, 5.0]),
    ("tail", 1, [0.0, 0.0, -60.0]),
];

fn open(text: &str, up: Option<Upwards>) -> Opened {
    let options = OpenOptions { up, ..OpenOptions::default() };
    io::parse("x.bvh", text, &options).unwrap_or_else(|error| panic!("{error}"))
}

fn nameless(joints: &[(&'static str, usize, [f32; 3])]) -> Vec<(&'static str, usize, [f32; 3])> {
    const NAMES: [&str; 12] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"];
    joints.iter().zip(NAMES).map(|((_, depth, at), name)| (name, *depth, *at)).collect()
}

fn poses(document: &Document) -> Vec<SkeletonPose> {
    let pose = |frame| {
        let time = document.timeline.time(frame);
        document.at(time).skeleton().pose()
    };
    (0..document.timeline.frames()).map(pose).collect()
}

/// All points of the poses, each turned by −90° about x.
fn turned(poses: &[SkeletonPose]) -> Vec<Vec3> {
    let points = poses.iter().flat_map(SkeletonPose::points);
    points.map(|at| Vec3::new(at.x, at.z, -at.y)).collect()
}

fn assert_at(poses: &[SkeletonPose], expected: &[Vec3]) {
    let points: Vec<Vec3> = poses.iter().flat_map(SkeletonPose::points).collect();
    assert_eq!(points.len(), expected.len());
    for (point, expected) in points.iter().zip(expected) {
        assert!(point.distance(*expected) < 1e-5 * 200.0, "{point}, not {expected}");
    }
}

#[test]
fn a_file_with_z_up_is_recognised_and_the_remark_says_what_turns_it() {
    let mut random = Random(71);
    let human_without_names = nameless(&HUMAN);
    for figure in [&HUMAN[..], &HORSE[..], &human_without_names[..]] {
        let z_up = open(&bvh(figure, &Z_UP, &mut random), None);
        let [remark] = &z_up.warnings[..] else { panic!("{figure:?}: {:?}", z_up.warnings) };
        assert!(remark.reason.contains("--up z"), "{remark}");
        let y_up = open(&bvh(figure, &Y_UP, &mut random), None);
        assert_eq!(y_up.warnings, [], "{figure:?}");
    }
}

#[test]
fn a_figure_that_its_motion_stands_up_is_not_taken_for_one_with_z_up() {
    let mut random = Random(76);
    let z_up = bvh(&HUMAN, &Z_UP, &mut random);
    let turn_root = |text: &str, turns: [i32; 3]| {
        let (head, frames) = text.split_once("Frame Time: 0.04\n").expect("frames");
        let frames = frames.lines().zip(turns).map(|(line, turn)| {
            let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
            words[4] = turn.to_string();
            words.join(" ") + "\n"
        });
        format!("{head}Frame Time: 0.04\n{}", frames.collect::<String>())
    };
    // In the first frame alone it lies.
    assert_eq!(open(&turn_root(&z_up, [0, -90, -90]), None).warnings, []);
    assert_eq!(open(&turn_root(&z_up, [0, 0, 0]), None).warnings.len(), 1);
    // A figure that lies down in its motion has y up.
    let y_up = bvh(&HUMAN, &Y_UP, &mut random);
    assert_eq!(open(&turn_root(&y_up, [90, 90, 90]), None).warnings, []);
}

/// With y up, and as long or wide along z as many a figure is high.
const FISH: [(&str, usize, [f32; 3]); 6] = [
    ("mouth", 0, [0.0, 30.0, 50.0]),
    ("v1", 1, [0.0, 0.0, -40.0]),
    ("v2", 2, [0.0, 0.0, -40.0]),
    ("top", 3, [0.0, 14.0, -12.0]),
    ("bottom", 3, [0.0, -14.0, -12.0]),
    ("side", 2, [12.0, 0.0, 0.0]),
];

#[test]
fn animals_that_are_long_or_round_are_not_taken_for_figures_that_stand_along_z() {
    let mut random = Random(75);
    let mut spider = vec![("body", 0, [0.0, 30.0, 0.0])];
    for leg in 0..8 {
        let (z, x) = (0.4 + 0.785 * leg as f32).sin_cos();
        spider.push(("thigh", 1, [20.0 * x, 20.0, 20.0 * z]));
        spider.push(("shin", 2, [50.0 * x, -50.0, 50.0 * z]));
    }
    for figure in [&FISH[..], &spider[..]] {
        let up = open(&bvh(figure, &Y_UP, &mut random), None).warnings;
        let turned = |remark: &ik_arm::io::Remark| remark.reason.contains("--up");
        assert!(!up.iter().any(turned), "{up:?}");
    }
}

#[test]
fn the_options_turn_or_leave_the_skeleton() {
    let mut random = Random(72);
    let (z_up, y_up) = (bvh(&HUMAN, &Z_UP, &mut random), bvh(&HUMAN, &Y_UP, &mut random));
    let as_in_file = poses(&open(&z_up, Some(Upwards::Y)).document);
    assert_at(&poses(&open(&z_up, None).document), &points(&as_in_file));
    assert_at(&poses(&open(&z_up, Some(Upwards::Z)).document), &turned(&as_in_file));
    assert_at(&poses(&open(&z_up, Some(Upwards::Auto)).document), &turned(&as_in_file));

    let y_as_in_file = poses(&open(&y_up, Some(Upwards::Y)).document);
    assert_at(&poses(&open(&y_up, Some(Upwards::Auto)).document), &points(&y_as_in_file));
    assert_at(&poses(&open(&y_up, Some(Upwards::Z)).document), &turned(&y_as_in_file));
    for up in [Upwards::Y, Upwards::Z] {
        assert_eq!(open(&z_up, Some(up)).warnings, [], "what was asked needs no remark");
    }
}

fn points(poses: &[SkeletonPose]) -> Vec<Vec3> {
    poses.iter().flat_map(SkeletonPose::points).collect()
}

#[test]
fn chains_without_legs_and_figures_that_lie_are_left_alone() {
    let mut random = Random(73);
    let chain: Vec<(&str, usize, [f32; 3])> = ["a", "b", "c", "d"]
        .iter()
        .enumerate()
        .map(|(at, name)| (*name, at, [0.0, 20.0, 0.0]))
        .collect();
    assert_eq!(open(&bvh(&chain, &Z_UP, &mut random), None).warnings, []);
    let sideways: Axes = [[0, 1, 0], [1, 0, 0], [0, 0, 1]];
    assert_eq!(open(&bvh(&HUMAN, &sideways, &mut random), None).warnings, []);
}

/// A rotation by −90° about x.
fn turn() -> DMat3 {
    DMat3::from_rotation_x(-FRAC_PI_2)
}

fn rotation(angles: Vec3) -> DMat3 {
    let angles = angles.as_dvec3();
    DMat3::from_euler(EulerRot::ZYX, angles.z, angles.y, angles.x)
}

/// A tree that moves, with a target in the world for the hand of a limb; the hand has an
/// orientation, and the elbow a pole. The target does not pose the skeleton: it could not do so in
/// the same way, since gravity and the elbow's rules know which way is up.
fn rig(random: &mut Random) -> Document {
    let (skeleton, tips) = skeletons::tree(random, 3, 1.0);
    let mut rig = SkeletonRig::new(skeleton);
    let limb = LimbSettings {
        reference: TwistReferenceKind::Pole,
        pole: Some(random.vector(3.0)),
        ..LimbSettings::default()
    };
    let orientation = Some(random.angles());
    let target = Target::new(tips[0], random.vector(3.0), 1.0);
    let kind = TargetKind::Limb(limb);
    rig.targets.push(Target { kind, orientation, influence: 0.0, ..target });
    let mut document = Document::new(rig);
    for time in 0..4 {
        let time = f64::from(time);
        document.keys.insert(Channel::Translation, time, random.vector(5.0));
        document.keys.insert(Channel::Target(tips[0]), time, random.vector(5.0));
        document.keys.insert(Channel::TargetPole(tips[0]), time, random.vector(5.0));
        document.keys.insert(Channel::TargetOrientation(tips[0]), time, random.angles());
        document.keys.insert(Channel::Rotation(tips[0]), time, random.angles());
    }
    document
}

#[test]
fn everything_in_the_world_turns_with_the_skeleton() {
    let mut random = Random(74);
    for _ in 0..50 {
        let before = rig(&mut random);
        let mut after = before.clone();
        after.turn_y_up();
        // Between the keys, too, except for angles, which are interpolated one by one.
        for step in 0..=30 {
            let time = f64::from(step) * 0.1;
            let evaluated = [&before, &after].map(|document| document.at(time).into_document().rig);
            let [points, turned] = evaluated.clone().map(|rig| {
                let target = rig.targets[0];
                let pole = target.limb().and_then(LimbSettings::pole).expect("a pole").1;
                let pose = rig.skeleton_at(time).pose();
                pose.points().chain([target.home, pole]).collect::<Vec<_>>()
            });
            for (point, turned) in points.iter().zip(&turned) {
                let expected = turn() * point.as_dvec3();
                assert!(turned.as_dvec3().distance(expected) < 1e-5 * 20.0, "{turned}");
            }
            if step % 10 == 0 {
                let [one, other] =
                    evaluated.map(|rig| rotation(rig.targets[0].orientation.expect("angles")));
                assert!(other.abs_diff_eq(turn() * one, 1e-5), "{other}");
            }
        }
    }
}
