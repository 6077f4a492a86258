//! A skeleton that targets pose over time is the same in a session, in any order of times, in CSV,
//! in GLB, on the command line and in the picture.

use std::process::Command;

use glam::{Mat4, Quat, Vec3};
use ik_arm::document::{
    Channel, Document, FollowPath, PathKind, SkeletonRig, Target, TargetMotion, TargetPath, Theme,
    Timeline, Track,
};
use ik_arm::io::{self, Progress};
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::skeleton::{Joint, JointId};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::kinematics::twist::TwistReferenceKind;
use ik_arm::rig::{LimbSettings, TargetKind, TargetSpace};
use ik_arm::scene::Scene;
use ik_arm::session::{Overlays, PlaybackAction, Preferences, Session};
use pollster::block_on;
use serde_json::Value;

use crate::common::Random;
use crate::common::documents::example;
use crate::common::skeletons::{forest, transform};
use crate::gltf::documents::glb;
use crate::gltf::glb::{Glb, index};

const FRAMES: u32 = 24;

/// A random skeleton with targets of both kinds in the world and on joints, and keys of everything
/// that poses it.
fn document(random: &mut Random) -> Document {
    let mut skeleton = forest(random, 12);
    skeleton.set_transform(transform(random)).expect("finite");
    let mut rig = SkeletonRig::new(skeleton);
    rig.solver = rig.solver.with_method(random.one_of(&[
        Method::Fabrik,
        Method::Relaxation,
        Method::Ccd,
        Method::DampedLeastSquares,
        Method::Transpose,
    ]));
    let joints: Vec<JointId> = rig.skeleton.ids().collect();
    let reach = rig.reach();
    for joint in joints.iter().copied() {
        if random.chance(0.4) {
            let target = target(random, &rig, joint, reach);
            rig.targets.push(target);
        }
    }
    for index in 0..rig.targets.len() {
        rig.targets[index].space = TargetSpace::Joint(random.one_of(&joints));
        if rig.check_target_spaces().is_err() {
            rig.targets[index].space = TargetSpace::World;
        }
    }
    if random.chance(0.4) {
        let kind = random.one_of(&[PathKind::Head, PathKind::Target]);
        rig.follow_paths = vec![FollowPath { root: JointId::new(0), kind }];
    }
    let mut document = Document::new(rig);
    document.timeline = Timeline { start: 0.0, end: 1.0, frame_rate: f64::from(FRAMES) };
    key(random, &mut document, reach);
    document
}

fn target(random: &mut Random, rig: &SkeletonRig, joint: JointId, reach: f32) -> Target {
    let home = rig.skeleton.tip(joint) + random.vector(0.3) * reach;
    let path = random.one_of(&[TargetPath::Still, TargetPath::Circle, TargetPath::FigureEight]);
    let motion = TargetMotion { path, radius: 0.1 * reach, period: 1.3 };
    let pole = Some(random.vector(3.0) * reach);
    let reference =
        random.one_of(&[TwistReferenceKind::Fk, TwistReferenceKind::Up, TwistReferenceKind::Pole]);
    let settings = LimbSettings {
        reference,
        pole,
        twist: random.within(-2.0..2.0),
        // No stretch: bones of exported skeletons keep their lengths.
        soft_reach: SoftReach::new(random.within(0.0..0.5), 1.0, 0.1).expect("in range"),
        ..LimbSettings::default()
    };
    let orientation = random.coin().then(|| random.angles());
    let kind = if random.coin() { TargetKind::Limb(settings) } else { TargetKind::WholeBody };
    let influence = random.one_of(&[0.0, 0.6, 1.0, 1.0]);
    let orientation = orientation.filter(|_| kind != TargetKind::WholeBody);
    Target { kind, orientation, influence, motion, ..Target::new(joint, home, 0.1) }
}

fn key(random: &mut Random, document: &mut Document, reach: f32) {
    let rig = document.rig.clone();
    let of_joints = rig.skeleton.ids().map(Channel::Rotation);
    let roots = rig.skeleton.iter().filter(|(_, joint): &(_, &Joint)| joint.parent.is_none());
    let of_roots = roots.map(|(joint, _)| Channel::Offset(joint));
    let of_targets = rig.targets.iter().flat_map(|target| Channel::of_target(target.joint));
    for channel in of_joints.chain(of_roots).chain(of_targets) {
        let Some(now) = channel.value(document).filter(|_| random.chance(0.3)) else { continue };
        for time in [0.0, 0.3, 0.8] {
            let value = match channel {
                Channel::Enabled(_) | Channel::Pinned(_) => {
                    Vec3::X * f32::from(u8::from(random.chance(0.8)))
                }
                Channel::TargetInfluence(_) => Vec3::X * random.within(0.0..1.0),
                Channel::TargetTwist(_) => Vec3::X * random.within(-2.0..2.0),
                Channel::Target(_) | Channel::TargetPole(_) => now + random.vector(0.2) * reach,
                _ => now + random.vector(0.3),
            };
            document.keys.insert(channel, time, value);
        }
    }
}

fn bits(session: &Session) -> Vec<u32> {
    let solved = &session.posed().evaluated_skeleton().solved;
    let vectors = solved.iter().flat_map(|(_, it)| [it.rotation, it.offset, it.axis]);
    vectors.flat_map(|vector| vector.to_array()).map(f32::to_bits).collect()
}

#[test]
fn two_sessions_show_the_same_bits_at_50_times_in_any_order() {
    let mut random = Random(180);
    for case in 0..10 {
        let document = document(&mut random);
        let mut one = Session::with_document(Preferences::default(), document.clone());
        let mut other = Session::with_document(Preferences::default(), document.clone());
        let times: Vec<f64> = (0..50).map(|index| f64::from(index) / 45.0).collect();
        let at = |session: &mut Session, time: f64| {
            session.apply(PlaybackAction::SetTime(time));
            bits(session)
        };
        let first: Vec<_> = times.iter().map(|time| at(&mut one, *time)).collect();
        for _ in 0..100 {
            let index = random.below(times.len());
            assert_eq!(at(&mut other, times[index]), first[index], "{case}: {} s", times[index]);
        }
        assert_eq!(one.document(), &document, "evaluating writes nothing");
        assert!(!other.history().is_unsaved());
    }
}

/// Bases of all joints in a frame, in the order of the joints.
type Bases = Vec<Vec3>;

/// Bases by the table.
fn by_csv(document: &Document) -> Vec<Bases> {
    let table =
        block_on(io::to_csv(document, None, &Progress::default())).expect("it is written").bytes;
    let mut rows = csv::Reader::from_reader(&table[..]);
    let joints = document.skeleton().joints().len();
    let row = |row: csv::StringRecord| -> Bases {
        let number = |index: usize| row[index].parse().expect("a number");
        let point = |joint: usize| {
            Vec3::new(number(2 + 3 * joint), number(3 + 3 * joint), number(4 + 3 * joint))
        };
        (0..joints).map(point).collect()
    };
    rows.records().map(|record| row(record.expect("a row"))).collect()
}

/// Bases by the animation of the file, in metres.
fn by_glb(document: &Document) -> Vec<Bases> {
    let glb = Glb::new(&glb(document));
    let frames = document.timeline.frames();
    (0..frames).map(|frame| glb_frame(&glb, document, frame)).collect()
}

fn glb_frame(glb: &Glb, document: &Document, frame: usize) -> Bases {
    let mut locals: Vec<Mat4> = (0..glb.nodes().len()).map(|node| glb.local(node)).collect();
    let animation = &glb.json["animations"][0];
    for channel in animation["channels"].as_array().into_iter().flatten() {
        let sampler = &animation["samplers"][index(&channel["sampler"])];
        let values = glb.rows(&sampler["output"]);
        let value = &values[frame.min(values.len() - 1)];
        let node = index(&channel["target"]["node"]);
        let (_, turned, moved) = locals[node].to_scale_rotation_translation();
        locals[node] = match channel["target"]["path"].as_str() {
            Some("rotation") => {
                let turned = Quat::from_xyzw(value[0], value[1], value[2], value[3]);
                Mat4::from_rotation_translation(turned, moved)
            }
            Some("translation") => {
                Mat4::from_rotation_translation(turned, Vec3::new(value[0], value[1], value[2]))
            }
            path => panic!("{path:?}"),
        };
    }
    let mut worlds = vec![Mat4::NAN; locals.len()];
    let roots = glb.json["scenes"][0]["nodes"].as_array().expect("roots");
    let mut next: Vec<usize> = roots.iter().map(index).collect();
    next.iter().for_each(|node| worlds[*node] = locals[*node]);
    while let Some(node) = next.pop() {
        for child in glb.children(node) {
            worlds[child] = worlds[node] * locals[child];
            next.push(child);
        }
    }
    let base = |(_, joint): (JointId, &Joint)| worlds[glb.node(&joint.name)].w_axis.truncate();
    document.skeleton().iter().map(base).collect()
}

/// Bases by `ik-arm pose --time`.
fn by_pose(document: &Document, time: f64) -> Bases {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("posed.json");
    std::fs::write(&path, io::to_json(document).expect("JSON")).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_ik-arm"))
        .args(["pose", path.to_str().expect("UTF-8"), "--time", &time.to_string()])
        .output()
        .expect("the program runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let base = |joint: &Value| {
        let number = |axis: usize| joint["base"][axis].as_f64().expect("a number") as f32;
        Vec3::new(number(0), number(1), number(2))
    };
    answer["joints"].as_array().expect("joints").iter().map(base).collect()
}

/// The greatest distance of a base from the nearest ball of the picture.
fn farthest_from_balls(document: &Document, time: f64, bases: &Bases) -> f32 {
    let track = Track::new(document);
    let mut shown = track.at(time).into_document();
    shown.rig.skin = None;
    let posed = track.pose(shown, time);
    let scene = Scene::new(&posed, &Overlays::new(&track, &posed), Theme::Dark);
    let nearest = |base: &Vec3| {
        let distances = scene.balls.iter().map(|ball| ball.centre.distance(*base));
        distances.fold(f32::INFINITY, f32::min)
    };
    bases.iter().map(nearest).fold(0.0, f32::max)
}

fn farthest(one: &Bases, other: &Bases) -> f32 {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max)
}

/// The bases that the document gives, and the reach.
fn expected(document: &Document, time: f64) -> Bases {
    let posed = document.at(time).skeleton().pose();
    posed.ids().map(|joint| posed.base(joint)).collect()
}

fn check(name: &str, document: &Document, poses: usize) {
    let reach = document.rig.reach();
    let (csv, glb) = (by_csv(document), by_glb(document));
    let frames = document.timeline.frames();
    assert_eq!((csv.len(), glb.len()), (frames, frames), "{name}");
    for frame in 0..frames {
        let time = document.timeline.time(frame);
        let expected = expected(document, time);
        let bound = 1e-5 * reach.max(expected.iter().map(|it| it.length()).fold(0.0, f32::max));
        for (how, found) in [("CSV", &csv[frame]), ("GLB", &glb[frame])] {
            let apart = farthest(&expected, found);
            assert!(apart <= bound, "{name}: {how} is {apart} apart at {time} s of {reach}");
        }
        if frame % frames.div_ceil(poses) == 0 {
            let apart = farthest(&expected, &by_pose(document, time));
            assert!(apart <= bound, "{name}: `pose` is {apart} apart at {time} s of {reach}");
            let apart = farthest_from_balls(document, time, &expected);
            assert!(apart <= bound, "{name}: the picture is {apart} apart at {time} s of {reach}");
        }
    }
}

#[test]
fn table_file_command_line_and_picture_agree_for_random_documents() {
    let mut random = Random(181);
    for case in 0..12 {
        let document = document(&mut random);
        if document.is_animated() {
            check(&format!("case {case}"), &document, 4);
        }
    }
}

#[test]
fn table_file_command_line_and_picture_agree_for_the_walk() {
    check("walk", &example("walk"), 6);
}
