//! `ik-arm check` as a user runs it: what is wrong with motions that are broken on purpose.

use std::fs;
use std::process::Output;

use glam::Vec3;
use ik_arm::document::{
    Channel, Document, SkeletonRig, Target, TargetMotion, TargetPath, Timeline,
};
use ik_arm::io::{self, Example};
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::skeleton::{Joint, JointId, JointLimits, Limit, Skeleton};
use ik_arm::kinematics::spline::{Interpolation, Knot};
use ik_arm::kinematics::twist::TwistReferenceKind;
use ik_arm::rig::{LimbSettings, RigPopCause, TargetKind};
use serde_json::Value;

use crate::{program, stderr};

fn check(document: &Document, arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.json");
    fs::write(&file, io::to_json(document).expect("finite")).expect("written");
    program().arg("check").arg(&file).args(arguments).output().expect("it runs")
}

fn found(document: &Document, arguments: &[&str]) -> Value {
    let output = check(document, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = String::from_utf8(output.stdout).expect("text");
    assert_eq!(text.lines().count(), 1, "one line of JSON");
    serde_json::from_str(&text).expect("JSON")
}

fn causes(found: &Value) -> Vec<String> {
    let pops = found["pops"].as_array().expect("pops");
    pops.iter().map(|pop| pop["cause"].as_str().expect("a cause").to_owned()).collect()
}

fn list<'a>(found: &'a Value, name: &str) -> &'a Vec<Value> {
    found[name].as_array().expect("a list")
}

/// A chain of ten bones, bent a little, with a target.
fn chain(target: impl Fn(Target) -> Target) -> Document {
    let mut skeleton = Skeleton::with_root("root");
    let mut last = JointId::new(0);
    for bone in 0..10 {
        let joint = Joint::new(&format!("bone {bone}"), Some(last), Vec3::Y * 0.3);
        let rotation = Vec3::new(if bone % 2 == 0 { -0.02 } else { 0.04 }, 0.0, -0.12);
        last = skeleton
            .add(Joint { offset: skeleton[last].axis, rotation, ..joint })
            .expect("a joint");
    }
    let mut rig = SkeletonRig::new(skeleton);
    let home = Vec3::new(-0.9, 1.5, 0.6);
    rig.targets.push(target(Target { influence: 1.0, ..Target::new(last, home, 0.5) }));
    shown(rig)
}

fn shown(rig: SkeletonRig) -> Document {
    let timeline = Timeline { start: 0.0, end: 4.0, frame_rate: 30.0 };
    Document { timeline, ..Document::new(rig) }
}

fn circle(target: Target) -> Target {
    let motion = TargetMotion { path: TargetPath::Circle, radius: 0.5, period: 4.0 };
    Target { motion, ..target }
}

/// A leg with a hinged knee that bends by `most` radians at most, and a foot with a limb target.
fn leg(least: f32, most: f32, reference: TwistReferenceKind) -> Document {
    let fixed = Some(Limit { min: 0.0, max: 0.0 });
    let limits = JointLimits::new([Some(Limit { min: least, max: most }), fixed, fixed]);
    let mut skeleton = Skeleton::with_root("hips");
    let thigh = Joint::new("thigh", Some(JointId::new(0)), Vec3::NEG_Y);
    let thigh = skeleton.add(Joint { rotation: Vec3::X * -0.3, ..thigh }).expect("a joint");
    let shin = Joint::new("shin", Some(thigh), Vec3::NEG_Y);
    let rotation = Vec3::X * 0.6;
    let shin = Joint { offset: Vec3::NEG_Y, limits, rotation, ..shin };
    let shin = skeleton.add(shin).expect("a joint");
    let mut rig = SkeletonRig::new(skeleton);
    let kind = TargetKind::Limb(LimbSettings { reference, ..LimbSettings::default() });
    let home = rig.skeleton.tip(shin);
    rig.targets.push(Target { influence: 1.0, kind, ..Target::new(shin, home, 0.3) });
    shown(rig)
}

fn key(document: &mut Document, channel: Channel, keys: &[(f64, Vec3)]) {
    for (time, value) in keys {
        document.keys.insert_auto(channel, *time, *value);
    }
}

#[test]
fn examples_that_show_a_figure_have_no_pop_without_a_cause() {
    for example in Example::ALL {
        let document = example.open().expect("valid").document;
        let found = found(&document, &[]);
        assert!(!causes(&found).contains(&"unknown".to_owned()), "{}: {found}", example.name);
        assert!(list(&found, "lost").is_empty(), "{}: {found}", example.name);
        assert!(list(&found, "slides").is_empty(), "{}: {found}", example.name);
    }
}

#[test]
fn a_smooth_motion_has_no_faults() {
    let found = found(&chain(circle), &["--fail-on", "pops,lost,slides"]);
    assert_eq!(found["pops"], Value::Array(Vec::new()));
    let worst = &found["targets"][0];
    assert_eq!(worst["joint"], 10);
    assert!(worst["worst"].as_f64().expect("a number") < 1e-3, "{worst}");
}

#[test]
fn frames_that_are_solved_by_themselves_pop() {
    let mut document = chain(circle);
    document.rig.solver = document.rig.solver.with_method(Method::Transpose);
    document.rig.is_tracked = false;
    let causes = causes(&found(&document, &[]));
    assert!(causes.len() > 10 && causes.iter().all(|cause| cause == "by_itself"), "{causes:?}");
}

#[test]
fn targets_and_joint_angles_that_jump_are_named() {
    let mut document = chain(|target| target);
    let joint = document.rig.targets[0].joint;
    let home = document.rig.targets[0].home;
    for (time, value) in [(0.0, home), (2.0, home * 0.6)] {
        let step = Knot { interpolation: Interpolation::Step, ..Knot::new(time, value) };
        document.keys.insert_key(Channel::Target(joint), step);
    }
    // A jump of the target is no pop unless joints move farther than it does.
    let found_target = causes(&found(&document, &[]));
    assert!(found_target.iter().all(|cause| cause == "target_jump"), "{found_target:?}");

    let mut document = chain(|target| target);
    let second = JointId::new(2);
    for (time, angle) in [(0.0, 0.0), (2.0, 1.5)] {
        let value = Vec3::new(angle, 0.0, -0.12);
        let step = Knot { interpolation: Interpolation::Step, ..Knot::new(time, value) };
        document.keys.insert_key(Channel::Rotation(second), step);
    }
    let causes = causes(&found(&document, &[]));
    assert!(causes.iter().all(|cause| cause == "fk_jump"), "{causes:?}");
}

#[test]
fn a_target_that_is_switched_on_is_named() {
    let mut document = chain(|target| target);
    let joint = document.rig.targets[0].joint;
    document.keys.insert(Channel::Enabled(joint), 0.0, Vec3::ZERO);
    document.keys.insert(Channel::Enabled(joint), 1.0, Vec3::X);
    let found = found(&document, &[]);
    assert_eq!(causes(&found), ["switched"], "{found}");
    assert_eq!(found["pops"][0]["time"], 1.0);
}

#[test]
fn limbs_pop_where_they_are_straight_and_where_references_are_singular() {
    let mut document = leg(0.0, 2.5, TwistReferenceKind::Fk);
    let shin = document.rig.targets[0].joint;
    let ways = [(0.0, Vec3::new(0.0, -1.5, 0.3)), (2.0, Vec3::new(0.0, -2.05, 0.0))];
    key(&mut document, Channel::Target(shin), &ways);
    let straight = causes(&found(&document, &[]));
    assert!(!straight.is_empty() && straight.iter().all(|it| it == "straight"), "{straight:?}");

    let mut document = leg(0.0, 2.5, TwistReferenceKind::Up);
    let ways = [(0.0, Vec3::new(-0.4, -1.4, 0.02)), (2.0, Vec3::new(0.4, -1.4, 0.02))];
    key(&mut document, Channel::Target(shin), &ways);
    let singular = causes(&found(&document, &[]));
    assert!(!singular.is_empty() && singular.iter().all(|it| it == "singular"), "{singular:?}");
}

#[test]
fn a_knee_at_its_limit_is_listed_with_its_time() {
    let mut document = leg(0.2, 1.0, TwistReferenceKind::Fk);
    let shin = document.rig.targets[0].joint;
    let ways = [
        (0.0, Vec3::new(0.0, -1.85, 0.0)),
        (2.0, Vec3::new(0.0, -1.0, 0.0)),
        (4.0, Vec3::new(0.0, -1.85, 0.0)),
    ];
    key(&mut document, Channel::Target(shin), &ways);
    let found = found(&document, &[]);
    let spans = list(&found, "at_limits");
    assert_eq!(spans.len(), 1, "{found}");
    assert_eq!(spans[0]["joint"], 2);
    let [from, to] = ["from", "to"].map(|end| spans[0][end].as_f64().expect("a time"));
    assert!(from > 0.2 && from < 2.0 && to > 2.0 && to < 3.8, "{from} {to}");
}

#[test]
fn a_planted_foot_that_slides_is_listed_with_its_way() {
    let mut document = leg(0.0, 2.5, TwistReferenceKind::Fk);
    let shin = document.rig.targets[0].joint;
    // The hips go up, and the leg is too short to keep the foot down.
    let hips = Channel::Offset(JointId::new(0));
    let home = document.rig.targets[0].home;
    key(&mut document, hips, &[(0.0, Vec3::ZERO), (4.0, Vec3::Y * 0.6)]);
    let output = check(&document, &["--fail-on", "slides,lost"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).ends_with("scene.json: 1 slide\n"), "{}", stderr(&output));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let slide = &found["slides"][0];
    assert_eq!(slide["target"], shin.index());
    let by = slide["by"].as_f64().expect("a number");
    let reach = f64::from((Vec3::Y * 0.6 - home).length());
    assert!((by - (reach - 2.0)).abs() < 0.05, "{by}, not {}", reach - 2.0);
}

#[test]
fn a_motion_that_does_not_close_has_a_seam() {
    let mut document = chain(|target| target);
    let joint = document.rig.targets[0].joint;
    let home = document.rig.targets[0].home;
    let ways = [(0.0, home), (2.0, home + Vec3::X * 0.6), (4.0, home + Vec3::Z * 0.4)];
    key(&mut document, Channel::Target(joint), &ways);
    assert_eq!(causes(&found(&document, &[])), [""; 0]);
    let looped = found(&document, &["--loop"]);
    assert_eq!(causes(&looped), ["seam"], "{looped}");
    assert_eq!(looped["pops"][0]["time"], 4.0);
}

#[test]
fn another_frame_rate_looks_at_more_frames_of_the_same_motion() {
    let document = chain(circle);
    let worst = |arguments: &[&str]| {
        let found = found(&document, arguments);
        found["targets"][0]["worst"].as_f64().expect("a number")
    };
    assert!(worst(&["--fps", "120"]) >= worst(&[]));
}

#[test]
fn the_arm_is_checked_like_a_figure() {
    let mut document = Document::default();
    let elbow = SkeletonRig::LOWER;
    for (time, x) in [(0.0, -100.0), (1.0, 100.0)] {
        document.keys.insert(Channel::Target(elbow), time, Vec3::new(x, 300.0, 0.0));
    }
    let found = found(&document, &[]);
    assert!(list(&found, "pops").iter().any(|pop| pop["cause"] == "singular"), "{found}");
}

#[test]
fn the_help_names_every_cause() {
    let output = program().args(["check", "--help"]).output().expect("it runs");
    let help = String::from_utf8(output.stdout).expect("text");
    for cause in RigPopCause::ALL {
        assert!(help.contains(cause.name()), "{}", cause.name());
    }
}

#[test]
fn a_target_that_another_pose_reaches_is_lost() {
    let text = include_str!("../data/lost-target.json");
    let options = io::OpenOptions::default();
    let document = io::parse("lost-target.json", text, &options).expect("a document").document;
    let output = check(&document, &["--fail-on", "lost"]);
    assert_eq!(output.status.code(), Some(1));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let span = &list(&found, "lost")[0];
    assert_eq!(span["target"], 10);
    let [from, to, miss] =
        ["from", "to", "miss"].map(|name| span[name].as_f64().expect("a number"));
    assert!(from < to && miss > 0.01, "{span}");
    assert!(span["sentence"].as_str().expect("text").contains("reaches it from another pose"));
}
