//! `ik-arm pose`, as a person or a script runs it.

use std::fs;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Output, Stdio};

use glam::{Mat4, Vec3};
use ik_arm::document::Document;
use ik_arm::io::{self, Example};
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::rig::{LimbSettings, Target as RigTarget, TargetKind, TargetPath, TargetSpace};
use serde::Deserialize;

use crate::common::Random;
use crate::common::documents::example;
use crate::{program, stderr};

/// A file in a folder of its own.
struct Scene {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

impl Scene {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("scene");
        fs::write(&path, text).expect("written");
        Self { _folder: folder, path }
    }

    fn example(name: &str) -> Self {
        Self::new(Example::find(name).expect("there").text)
    }

    fn document(document: &Document) -> Self {
        Self::new(&io::to_json(document).expect("written"))
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = program();
        command.arg("pose").arg(&self.path).args(arguments).output().expect("the program runs")
    }

    fn pose(&self, arguments: &[&str]) -> Answer {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        answer(&output)
    }

    /// The message after the file's name.
    fn refusal(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{output:?}");
        let complaint = stderr(&output);
        let start = format!("ik-arm: {}", self.path.display());
        complaint.strip_prefix(&start).expect("the file is named").trim_end().to_owned()
    }
}

impl Answer {
    fn joint(&self, name: &str) -> &Joint {
        self.joints.iter().find(|joint| joint.name == name).expect("a joint")
    }
}

fn answer(output: &Output) -> Answer {
    let text = str::from_utf8(&output.stdout).expect("UTF-8");
    assert_eq!(text.find('\n'), Some(text.len() - 1), "one line: {text}");
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Answer {
    joints: Vec<Joint>,
    targets: Vec<Target>,
    report: Option<Report>,
    why: Vec<Why>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Why {
    cause: String,
    target: String,
    joints: Vec<String>,
    sentence: String,
    remedy: Option<String>,
    residual_with_remedy: Option<f32>,
    rotation_error_with_remedy_deg: Option<f32>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Joint {
    index: usize,
    name: String,
    parent: Option<usize>,
    rotation_deg: Vec3,
    base: Vec3,
    tip: Vec3,
    transform: [f32; 16],
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Target {
    joint: usize,
    kind: String,
    influence: f32,
    target: Vec3,
    tip: Vec3,
    error: f32,
    rotation_error_deg: Option<f32>,
    aim_error_deg: Option<f32>,
    limb: Option<Limb>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Limb {
    root: Vec3,
    pointer: Vec3,
    twist_deg: f32,
    reach: Option<String>,
    upper: f32,
    lower: f32,
    distance: f32,
    along: f32,
    out: f32,
    shoulder_angle_deg: f32,
    elbow_angle_deg: f32,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Report {
    solver: String,
    iterations: u32,
    error: f32,
    converged: bool,
}

const BENT: &str = r#"{"scene":{"skinned_meshes":{"X":{"skeleton":{"bones":[
    {"extent":[0,2,0],"parent":1},{"extent":[0,1,0],"pose":[0,0,90]}],
    "handles":[{"bone":0,"target":[1,1,0]},{"bone":1,"target":[0,0,0],"enabled":false}]}}},
    "transforms":{"T":{"scale":[-1,1,1],"translation":[10,0,0]}},
    "instances":{"skinned_meshes":{"I":{"mesh":"X","transform":"T"}}}}}"#;

// Posing

#[test]
fn an_answer_has_exactly_these_keys_in_this_order() {
    let bone = r#"{"scene":{"skinned_meshes":{"X":{"skeleton":{"base":[0,0,5],
        "bones":[{"extent":[0,1,0]}],"handles":[{"bone":0,"target":[0,1,5]}]}}}}}"#;
    let output = Scene::new(bone).run(&[]);
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        concat!(
            r#"{"joints":[{"index":0,"name":"bone_0","parent":null,"rotation_deg":[0.0,0.0,0.0],"#,
            r#""base":[0.0,0.0,5.0],"tip":[0.0,1.0,5.0],"transform":[1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,"#,
            r#"0.0,0.0,1.0,0.0,0.0,0.0,5.0,1.0]}],"#,
            r#""targets":[{"joint":0,"kind":"whole_body","influence":0.0,"target":[0.0,1.0,5.0],"#,
            r#""tip":[0.0,1.0,5.0],"error":0.0,"rotation_error_deg":null,"aim_error_deg":null,"limb":null}],"#,
            r#""report":null,"why":[]}"#,
            "\n"
        )
    );
    assert_eq!(stderr(&output), "");
}

#[test]
fn joints_keep_the_order_of_the_file_and_are_in_world_space() {
    let Answer { joints, targets, report, .. } = Scene::new(BENT).pose(&[]);
    let names: Vec<_> = joints.iter().map(|joint| (joint.index, joint.name.as_str())).collect();
    assert_eq!(names, [(0, "bone_0"), (1, "bone_1")]);
    assert_eq!([joints[0].parent, joints[1].parent], [Some(1), None]);
    assert_eq!(joints[1].rotation_deg, Vec3::new(0.0, 0.0, 90.0));
    let close = |a: Vec3, b: [f32; 3]| assert!(a.distance(Vec3::from_array(b)) < 1e-5, "{a}");
    close(joints[1].base, [10.0, 0.0, 0.0]);
    close(joints[1].tip, [11.0, 0.0, 0.0]);
    close(joints[0].base, [11.0, 0.0, 0.0]);
    close(joints[0].tip, [13.0, 0.0, 0.0]);
    assert_eq!((targets.len(), targets[0].joint), (1, 0));
    close(targets[0].target, [9.0, 1.0, 0.0]);
    assert_eq!(report, None);
}

#[test]
fn a_transform_maps_the_joints_own_space_to_the_world() {
    for name in ["human", "snake", "degenerate"] {
        let scene = Scene::example(name);
        let skeleton =
            io::open(&scene.path, &io::OpenOptions::default()).expect("opens").document.rig;
        for (joint, own) in scene.pose(&[]).joints.iter().zip(skeleton.skeleton.joints()) {
            let full = Mat4::from_cols_array(&joint.transform);
            assert!(full.transform_point3(Vec3::ZERO).distance(joint.base) < 1e-5);
            assert!(full.transform_point3(own.axis).distance(joint.tip) < 1e-5);
            assert_eq!((joint.parent, &joint.name), (own.parent.map(JointId::index), &own.name));
        }
    }
}

#[test]
fn a_document_comes_from_standard_input_as_well() {
    let mut child = program()
        .args(["pose", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut stdin = child.stdin.take().expect("it has a standard input");
    stdin.write_all(BENT.as_bytes()).expect("it listens");
    drop(stdin);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(answer(&output), Scene::new(BENT).pose(&[]));
}

#[test]
fn warnings_about_a_file_are_printed_beside_the_pose() {
    let scene = Scene::new(
        "{\"format\":\"ik-arm\",\"version\":2,\"rig\":\"skeleton\",\n\"colour\":\"red\"}",
    );
    let output = scene.run(&[]);
    assert_eq!(output.status.code(), Some(0));
    let path = scene.path.display();
    let expected = "line 2, column 10: colour: unknown field, ignored";
    assert_eq!(stderr(&output), format!("ik-arm: {path}, {expected}\n"));
    assert_eq!(answer(&output).joints.len(), 1);
}

// SolverRun

#[test]
fn every_solver_reports_its_error() {
    let scene = Scene::example("ten-joints");
    for solver in ["transpose", "transpose-fixed", "dls", "ccd", "fabrik", "relaxation"] {
        let Answer { targets, report, .. } = scene.pose(&["--solver", solver]);
        let report = report.expect("it solved");
        assert_eq!(report.solver, solver);
        assert!(report.converged && report.iterations > 0, "{report:?}");
        assert!((report.error - targets[0].error).abs() < 1e-6 && report.error < 4e-4);
        assert!((targets[0].tip.distance(targets[0].target) - targets[0].error).abs() < 1e-6);
    }
}

#[test]
fn the_closed_form_reaches_the_target_of_a_mirrored_skeleton() {
    let Answer { joints, targets, report, .. } = Scene::new(BENT).pose(&["--solver", "two-bone"]);
    let report = report.expect("it solved");
    assert!(report.converged, "{report:?}");
    assert!(joints[0].tip.distance(Vec3::new(9.0, 1.0, 0.0)) < 1e-4, "{:?}", joints[0]);
    assert_eq!(targets[0].tip, joints[0].tip);
}

#[test]
fn iterations_and_tolerance_limit_a_solver_run() {
    let scene = Scene::example("ten-joints");
    let report = |arguments: &[&str]| {
        scene.pose(&[&["--solver", "ccd"], arguments].concat()).report.expect("it solved")
    };
    let still = scene.pose(&["--solver", "ccd", "--iterations", "0"]);
    assert_eq!(still.joints, scene.pose(&[]).joints);
    assert_eq!(report(&["--iterations", "0"]).iterations, 0);
    let few = report(&["--iterations", "2"]);
    assert!(few.iterations == 2 && !few.converged, "{few:?}");
    let (rough, fine) = (report(&["--tolerance", "0.1"]), report(&["--tolerance", "1e-5"]));
    assert!(rough.converged && fine.converged && fine.error <= 1e-5, "{rough:?} {fine:?}");
    assert!(rough.iterations < fine.iterations);
}

#[test]
fn an_unreachable_target_is_a_result_and_not_an_error() {
    let scene = Scene::example("degenerate");
    for solver in ["dls", "fabrik", "relaxation"] {
        let report = scene.pose(&["--solver", solver]).report.expect("it solved");
        assert!(!report.converged && report.error > 0.5, "{report:?}");
    }
}

#[test]
fn the_humans_targets_are_in_reach() {
    let scene = Scene::example("human");
    for solver in ["dls", "ccd"] {
        let Answer { targets, report, .. } = scene.pose(&["--solver", solver]);
        assert_eq!(targets.len(), 5);
        assert!(report.as_ref().is_some_and(|report| report.converged), "{report:?}");
    }
}

// FK and targets

/// The figure of the Human example without targets.
fn human() -> Document {
    let mut human = example("human");
    human.rig.targets.clear();
    human.keys = Default::default();
    human
}

fn joint(document: &Document, name: &str) -> JointId {
    let joints = document.skeleton().joints();
    JointId::new(joints.iter().position(|joint| joint.name == name).expect("a joint"))
}

fn target(name: &str, Vec3 { x, y, z }: Vec3) -> String {
    format!("{name}={x},{y},{z}")
}

/// Euclidean distance between printed points, in f64.
fn distance(one: Vec3, other: Vec3) -> f64 {
    one.as_dvec3().distance(other.as_dvec3())
}

#[test]
fn a_given_target_brings_a_hand_there_and_leaves_all_other_limbs_alone() {
    const REACH: f64 = 0.54;
    let (scene, mut random) = (Scene::document(&human()), Random(6));
    let before = scene.pose(&[]);
    let shoulder = before.joint("left_upper_arm").base;
    for name in ["left_hand", "left_forearm", "8", "7"].into_iter().cycle().take(20) {
        // Where the limits of the arm let it go: in front of the body and beside it.
        let way = random.direction();
        let way = Vec3::new(way.x.abs(), way.y, way.z.abs());
        let point = shoulder + way * random.within(0.18..0.53);
        let after = scene.pose(&["--target", &target(name, point)]);
        assert!(distance(after.joint("left_hand").base, point) < 1e-5 * REACH, "{after:?}");
        let [posed] = &after.targets[..] else { panic!("one target: {after:?}") };
        assert_eq!((posed.joint, posed.kind.as_str(), posed.influence), (7, "limb", 1.0));
        assert_eq!((posed.target, posed.tip), (point, after.joint("left_forearm").tip));
        assert_eq!(after.report, None);
        for (joint, after) in before.joints.iter().zip(&after.joints) {
            let bone = |joint: &Joint| distance(joint.base, joint.tip);
            assert!((bone(joint) - bone(after)).abs() < 1e-6, "{after:?}");
            let mut above =
                std::iter::successors(Some(joint), |it| Some(&before.joints[it.parent?]));
            let is_of_arm = above.any(|joint| joint.name == "left_upper_arm");
            assert!(is_of_arm || joint == after, "{after:?}");
        }
    }
}

#[test]
fn a_given_target_for_a_joint_within_a_chain_poses_all_joints_up_to_it() {
    let scene = Scene::document(&human());
    let point = scene.pose(&[]).joint("neck").tip + Vec3::new(0.08, -0.03, 0.1);
    let answer = scene.pose(&["--target", &target("neck", point)]);
    let [posed] = &answer.targets[..] else { panic!("one target: {answer:?}") };
    assert_eq!((posed.kind.as_str(), posed.influence), ("whole_body", 1.0));
    assert_eq!(posed.tip, answer.joint("neck").tip);
    assert!((distance(posed.tip, point) - f64::from(posed.error)).abs() < 1e-6, "{posed:?}");
    let report = answer.report.expect("it was solved");
    assert!(report.converged && (report.error - posed.error).abs() < 1e-6, "{report:?} {posed:?}");
}

#[test]
fn several_given_targets_are_all_reached() {
    let scene = Scene::document(&human());
    let before = scene.pose(&[]);
    let limbs = [("left_hand", "left_upper_arm", 0.4), ("right_foot", "right_thigh", 0.7)];
    let points = limbs.map(|(_, top, far)| before.joint(top).base + Vec3::new(0.1, -far, 0.2));
    let [hand, foot] = [0, 1].map(|index| target(limbs[index].0, points[index]));
    let after = scene.pose(&["--target", &hand, "--target", &foot]);
    for ((end, ..), point) in limbs.into_iter().zip(points) {
        assert!(distance(after.joint(end).base, point) < 1e-5, "{end}");
    }
}

#[test]
fn a_given_target_moves_the_one_that_the_file_has() {
    let mut document = human();
    let forearm = joint(&document, "left_forearm");
    let mut own = RigTarget::new(forearm, Vec3::ONE, 0.2);
    own.motion.path = TargetPath::Circle;
    own.kind = TargetKind::Limb(LimbSettings::default());
    own.enabled = false;
    let on_head = TargetSpace::Joint(joint(&document, "head"));
    for (influence, expected, space) in [
        (0.0, 1.0, TargetSpace::World),
        (0.25, 0.25, TargetSpace::World),
        (1.0, 1.0, TargetSpace::World),
        (1.0, 1.0, on_head),
    ] {
        (own.influence, own.space) = (influence, space);
        document.rig.targets = vec![own];
        let scene = Scene::document(&document);
        let text = fs::read(&scene.path).expect("read");
        let point = Vec3::new(0.4, 1.2, 0.3);
        for name in ["left_hand", "left_forearm"] {
            let answer = scene.pose(&["--time", "1.3", "--target", &target(name, point)]);
            let [posed] = &answer.targets[..] else { panic!("one target: {answer:?}") };
            assert_eq!((posed.joint, posed.influence), (forearm.index(), expected));
            assert!(distance(posed.target, point) < 1e-6, "{posed:?}");
            assert_eq!(posed.tip, answer.joint("left_forearm").tip);
            let (error, is_reached) = (distance(posed.tip, point), expected == 1.0);
            assert_eq!(error < 1e-5, is_reached, "{error}");
            assert!((error - f64::from(posed.error)).abs() < 1e-6);
        }
        assert_eq!(fs::read(&scene.path).expect("read"), text, "the file is left alone");
    }
}

#[test]
fn the_fk_pose_ignores_targets_and_solvers_start_from_it() {
    let mut document = human();
    let bare = Scene::document(&document).pose(&[]);
    let hand = joint(&document, "right_forearm");
    document.rig.targets =
        vec![RigTarget { influence: 1.0, ..RigTarget::new(hand, Vec3::new(-0.4, 1.1, 0.4), 0.1) }];
    let scene = Scene::document(&document);
    let (fk, posed) = (scene.pose(&["--fk"]), scene.pose(&[]));
    assert_eq!((&fk.joints, &fk.report), (&bare.joints, &None));
    assert!(fk.targets[0].error > 0.1 && posed.targets[0].error < 1e-3, "{fk:?} {posed:?}");
    let error = distance(fk.joint("right_forearm").tip, fk.targets[0].target);
    assert!((error - f64::from(fk.targets[0].error)).abs() < 1e-6);
    let unmoved = scene.pose(&["--solver", "ccd", "--iterations", "0"]);
    assert_eq!(unmoved.joints, fk.joints);
    assert_eq!(posed.report.expect("it was solved").solver, document.rig.solver.method.name());
}

#[test]
fn a_target_for_a_joint_that_is_not_there_is_an_error_that_lists_near_names() {
    let scene = Scene::document(&human());
    for (given, expected) in [
        (
            "left_hnad",
            "there is no joint \"left_hnad\"; near names are \"left_hand\", \"left_shin\", \
             \"left_index_1\", \"left_index_2\", \"left_index_3\"",
        ),
        ("Pelvis", "there is no joint \"Pelvis\"; near names are \"pelvis\""),
        (
            "99",
            "there is no joint \"99\"; the joints are 0 to 48, called \"pelvis\", \"spine\", \
             \"chest\", \"neck\", \"head\"",
        ),
    ] {
        assert_eq!(
            scene.refusal(&["--target", &format!("{given}=0,1,0")]),
            format!(": {expected}")
        );
    }
    let twice = ["--target", "left_hand=0,1,0", "--target", "7=1,1,1"];
    let expected = ": joint \"left_forearm\" must be given one target, got two";
    assert_eq!(scene.refusal(&twice), expected);
}

#[test]
fn a_name_is_taken_before_an_index() {
    let mut document = human();
    document.skeleton_mut().rename(JointId::new(0), "7").expect("renamed");
    let scene = Scene::document(&document);
    let index = |given: &str| scene.pose(&["--target", given]).targets[0].joint;
    assert_eq!((index("7=0,1,0"), index("8=0,1,0")), (0, 7));
}

#[test]
fn a_malformed_target_is_an_error_that_shows_a_right_one() {
    let scene = Scene::document(&human());
    for given in
        ["left_hand", "left_hand=", "left_hand=1,2", "left_hand=1,2,x", "left_hand=1,2,inf"]
    {
        let output = scene.run(&["--target", given]);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{given}");
        let expected = format!(
            "error: invalid value '{given}' for '--target <JOINT=x,y,z>': must be a joint and \
             three numbers, like left_hand=0.3,1.2,0.4"
        );
        assert!(stderr(&output).starts_with(&expected), "{}", stderr(&output));
    }
}

// Failures

#[test]
fn an_invalid_file_is_an_error_with_its_position() {
    for (text, expected) in [
        ("hello", ", line 1, column 1: not JSON: expected value"),
        (
            "{\"format\":\"ik-arm\",\n\"version\":7}",
            ", line 2, column 11: version: must be at most 3, got 7, which needs a newer ik-arm",
        ),
        (
            "{\"scene\":{\"skinned_meshes\":{\"X\":{\"skeleton\":{\"bones\":\n[{\"extent\":1}]}}}}}",
            ", line 2, column 12: scene.skinned_meshes.X.skeleton.bones[0].extent: invalid type: \
             integer `1`, expected three numbers: [x, y, z]",
        ),
    ] {
        assert_eq!(Scene::new(text).refusal(&[]), expected);
    }
    let missing = Scene { path: PathBuf::from("/nowhere/x.json"), ..Scene::new("") };
    assert!(missing.refusal(&[]).starts_with(" cannot be read: "));
}

#[test]
fn a_missing_skeleton_is_an_error_that_lists_the_existing_ones() {
    let expected = " has no skeleton called \"Y\"; it has \"X\"";
    assert_eq!(Scene::new(BENT).refusal(&["--skeleton", "Y"]), expected);
    let expected = " has no skeleton called \"Y\"; it has one skeleton, without a name";
    assert_eq!(Scene::example("human").refusal(&["--skeleton", "Y"]), expected);
    assert_eq!(Scene::new(BENT).pose(&["--skeleton", "X"]), Scene::new(BENT).pose(&[]));
}

#[test]
fn a_limb_tells_its_triangle() {
    let answer = Scene::example("arm").pose(&["--target", "hand=0,400,0"]);
    let limb = answer.targets[0].limb.as_ref().expect("a limb");
    let angle = |opposite: f64, a: f64, b: f64| {
        ((a * a + b * b - opposite * opposite) / (2.0 * a * b)).acos().to_degrees()
    };
    let (shoulder, elbow) = (angle(300.0, 200.0, 400.0), angle(400.0, 200.0, 300.0));
    let (along, out) = (200.0 * shoulder.to_radians().cos(), 200.0 * shoulder.to_radians().sin());
    for (told, expected) in [
        (limb.upper, 200.0),
        (limb.lower, 300.0),
        (limb.distance, 400.0),
        (limb.along, along),
        (limb.out, out),
        (limb.shoulder_angle_deg, shoulder),
        (limb.elbow_angle_deg, elbow),
        (limb.twist_deg, 0.0),
    ] {
        assert!((f64::from(told) - expected).abs() < 1e-3, "{told} for {expected}");
    }
    assert_eq!((limb.root, limb.reach.as_deref()), (Vec3::ZERO, Some("reached")));
    assert!(limb.pointer.distance(Vec3::Y) < 1e-6);
    let far = Scene::example("arm").pose(&["--target", "hand=0,600,0"]);
    let reach = far.targets[0].limb.as_ref().expect("a limb").reach.clone();
    assert_eq!(reach.as_deref(), Some("too_far"));
}

#[test]
fn a_two_bone_target_on_a_root_is_an_error_that_names_the_files_bone() {
    let (on, off) = ("[0,0,0]", "[0,0,0],\"enabled\":false");
    let text = BENT.replace(off, on).replace("[1,1,0]", "[1,1,0],\"enabled\":false");
    let refusal = Scene::new(&text).refusal(&["--solver", "two-bone"]);
    assert!(refusal.starts_with(": two-bone cannot move joint 1: "), "{refusal}");
}

#[test]
fn a_pose_that_overflows_is_an_error() {
    let bones = r#"{"extent":[3e38,0,0]},{"extent":[3e38,0,0],"parent":0}"#;
    let scene = Scene::new(&format!(
        r#"{{"scene":{{"skinned_meshes":{{"X":{{"skeleton":{{"bones":[{bones}]}}}}}}}}}}"#
    ));
    let expected = ": the position of joint \"bone_1\" must be within ±3.4028235e38";
    assert_eq!(scene.refusal(&[]), expected);
}

#[test]
fn a_usage_error_exits_with_2_and_prints_no_result() {
    let scene = Scene::example("human");
    for arguments in [
        ["--solver", "newton"].as_slice(),
        &["--iterations", "3"],
        &["--tolerance", "1"],
        &["--solver", "ccd", "--iterations", "-1"],
        &["--solver", "ccd", "--iterations", "x"],
        &["--solver", "ccd", "--tolerance", "0"],
        &["--solver", "ccd", "--tolerance", "-1"],
        &["--solver", "ccd", "--tolerance", "inf"],
        &["--solver", "ccd", "--tolerance", "nan"],
        &["second"],
        &["--fk", "--solver", "ccd"],
        &["--fk", "--target", "head=0,2,0"],
    ] {
        let output = scene.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(output.stdout.len(), 0);
        assert!(stderr(&output).starts_with("error: "), "{output:?}");
    }
}

// Times

fn keyed_chain() -> ik_arm::document::Document {
    let mut document = example("ten-joints");
    document.keys = Default::default();
    let channel = ik_arm::document::Channel::Rotation(JointId::new(1));
    for (time, z) in [(-1.0, 0.0), (0.0, 0.5), (2.0, -1.0), (3.0, 2.0)] {
        document.keys.insert(channel, time, Vec3::new(0.0, 0.0, z));
    }
    document
}

#[test]
fn a_time_moves_the_last_joint_where_the_spline_says() {
    let document = keyed_chain();
    let scene = Scene::new(&io::to_json(&document).expect("written"));
    for time in ["-2", "-0.25", "0", "1.3", "2", "1e9"] {
        let posed = document.at(time.parse().expect("a number")).into_document();
        let pose = posed.skeleton().pose();
        let answer = scene.pose(&["--time", time]);
        for (index, joint) in answer.joints.iter().enumerate() {
            assert_eq!(
                (joint.base, joint.tip),
                (pose.base(JointId::new(index)), pose.tip(JointId::new(index))),
                "{time}"
            );
        }
    }
    assert_eq!(scene.pose(&[]), scene.pose(&["--time", "0"]));
    assert_ne!(scene.pose(&[]), scene.pose(&["--time", "1"]));
}

#[test]
fn a_time_moves_path_followers_and_targets() {
    let document = crate::common::documents::keyed_snake();
    let snake = Scene::new(&io::to_json(&document).expect("written"));
    let pose = document.at(2.5).skeleton().pose();
    assert_eq!(snake.pose(&["--time", "2.5"]).joints[0].base, pose.base(JointId::new(0)));

    let mut document = keyed_chain();
    let target = &mut document.rig.targets[0];
    target.motion.path = TargetPath::Circle;
    let expected = target.at(1.0);
    let scene = Scene::new(&io::to_json(&document).expect("written"));
    assert_eq!(scene.pose(&["--time", "1"]).targets[0].target, expected);
    let solved = scene.pose(&["--time", "1", "--solver", "dls"]);
    assert_eq!(solved.targets[0].target, expected);
}

#[test]
fn an_invalid_time_is_a_usage_error() {
    for time in ["inf", "nan", "soon", ""] {
        let output = Scene::example("human").run(&["--time", time]);
        assert_eq!(output.status.code(), Some(2), "{time}");
    }
}

#[test]
fn a_bvh_motion_is_posed_at_a_time() {
    let text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 2 0\n}\n}\n\
                MOTION\nFrames: 2\nFrame Time: 1\n0\n90\n";
    let tip = Scene::new(text).pose(&["--time", "1"]).joints[0].tip;
    assert!(tip.distance(Vec3::new(-2.0, 0.0, 0.0)) < 1e-6, "{tip}");
}

#[test]
fn a_solver_without_a_target_says_so_and_prints_the_fk_pose() {
    let mut document = example("human");
    document.rig.targets.clear();
    let scene = Scene::document(&document);
    for method in ["transpose", "ccd", "fabrik", "relaxation", "dls", "two-bone"] {
        let output = scene.run(&["--solver", method]);
        assert_eq!(output.status.code(), Some(0), "{method}: {output:?}");
        assert!(stderr(&output).contains("no enabled target, so there is nothing to solve"));
        let solved: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let fk = scene.run(&["--fk"]).stdout;
        assert_eq!(solved, serde_json::from_slice::<serde_json::Value>(&fk).expect("JSON"));
        assert!(solved["report"].is_null());
    }
}

// Why targets are not reached

/// A document of a chain from a locked root along +y, with bones of the given joints and whole-body
/// targets.
fn chain_document(joints: &str, targets: &str, solver: &str) -> Scene {
    Scene::new(&format!(
        r#"{{"format":"ik-arm","version":2,"rig":"skeleton","skeleton":{{"joints":[
        {{"name":"root","parent":null,"axis":[0,0,0],"locked":true}},{joints}]}},
        "solver":{{{solver}}},"targets":[{targets}]}}"#
    ))
}

fn two_bones() -> &'static str {
    r#"{"name":"upper","parent":0,"axis":[0,1,0]},
    {"name":"lower","parent":1,"offset":[0,1,0],"axis":[0,1,0]}"#
}

fn first_why(scene: &Scene, arguments: &[&str]) -> Why {
    let answer = scene.pose(arguments);
    answer.why.into_iter().next().expect("a cause")
}

#[test]
fn a_target_too_far_away_is_out_of_reach_with_every_solver() {
    let scene = chain_document(
        two_bones(),
        r#"{"joint":2,"home":[3,0,0],"influence":1}"#,
        r#""method":"dls""#,
    );
    let why = first_why(&scene, &[]);
    assert_eq!((why.cause.as_str(), why.target.as_str()), ("out_of_reach", "lower"));
    assert_eq!(
        why.sentence,
        "lower cannot reach that far: the target is 3 from root, the bones are 2 long"
    );
    assert!(why.residual_with_remedy.expect("a remedy") < 1e-3);
    for solver in ["fabrik", "relaxation", "ccd", "transpose", "transpose-fixed", "two-bone"] {
        assert_eq!(first_why(&scene, &["--solver", solver]).cause, "out_of_reach", "{solver}");
    }
}

/// The Human with its left foot asked to turn about x by so many degrees.
fn foot_turned_by(degrees: f32) -> Scene {
    let mut document = example("human");
    let rig = &mut document.rig;
    let shin = rig.skeleton.find("left_shin").expect("a shin");
    let index = rig.target(shin).expect("a target");
    rig.targets[index].orientation = Some(Vec3::X * degrees.to_radians());
    Scene::document(&document)
}

/// The rotation of a joint in the world, of a skeleton without scale, by the printed transform.
fn rotation(joint: &Joint) -> glam::DQuat {
    let axes = Mat4::from_cols_array(&joint.transform).as_dmat4();
    glam::DQuat::from_mat3(&glam::DMat3::from_mat4(axes)).normalize()
}

#[test]
fn a_whole_body_target_turns_its_joint_to_a_rotation() {
    let mut document = example("human");
    // The one that aims its head.
    document.rig.targets.pop();
    let scene = Scene::document(&document);
    let tip = scene.pose(&[]).joint("head").tip;
    let answer = scene.pose(&["--rotation", "head=0,45,0"]);
    let head = answer.targets.last().expect("a target of the head");
    assert_eq!(head.kind, "whole_body");
    assert!(head.target.distance(tip) < 1e-6, "it is where the head was");
    assert_eq!(head.error, 0.0, "a rotation alone leaves the place free");
    assert!(head.rotation_error_deg.expect("a rotation") < 0.06, "{head:?}");
    let angle = 45.0_f64.to_radians();
    let wanted = glam::DQuat::from_rotation_y(angle);
    let off = rotation(answer.joint("head")).angle_between(wanted).to_degrees();
    assert!(off < 0.06, "{off}");

    // In a document, the angles are in radians.
    let joint = document.skeleton().find("head").expect("a head");
    let target = RigTarget::new(joint, head.target, 0.1);
    let orientation = Some(Vec3::Y * angle as f32);
    document.rig.targets.push(RigTarget { orientation, influence: 1.0, weight: 0.0, ..target });
    let same = Scene::document(&document).pose(&[]);
    let apart = rotation(same.joint("head")).angle_between(rotation(answer.joint("head")));
    assert!(apart < 1e-3, "{apart}");
}

#[test]
fn a_head_looks_at_a_point() {
    let scene = Scene::document(&example("human"));
    let point = Vec3::new(0.5, 1.5, 1.2);
    let answer = scene.pose(&["--aim", "head=0.5,1.5,1.2"]);
    let target = answer.targets.last().expect("a target of the head");
    assert_eq!(target.rotation_error_deg, None);
    assert!(target.aim_error_deg.expect("an aim") < 0.06, "{target:?}");
    let head = answer.joint("head");
    let looks = rotation(head) * glam::DVec3::Z;
    let off = looks.angle_between((point - head.base).as_dvec3()).to_degrees();
    assert!(off < 0.06, "{off}");

    let refused = scene.run(&["--aim", "left_hand=0,1,0"]);
    let expected = "the target of joint \"left_hand\" poses a limb, which is aimed at nothing; aim \
                    another joint";
    assert!(stderr(&refused).contains(expected), "{}", stderr(&refused));
}

#[test]
fn a_rotation_that_the_method_cannot_give_is_refused_by_name() {
    let mut document = example("human");
    for (method, asked, expected) in [
        (Method::Fabrik, ["--rotation", "head=0,45,0"], "turn joint 4 while its place is free"),
        (Method::Fabrik, ["--aim", "head=0,1,3"], "aim joint 4 at a point"),
        (Method::TwoBone, ["--rotation", "head=0,45,0"], "turn joint 4 to an orientation"),
    ] {
        document.rig.solver.method = method;
        let output = Scene::document(&document).run(&asked);
        assert!(output.status.success());
        let said = stderr(&output);
        let expected = format!("{method} cannot {expected}; transpose-fixed,");
        assert!(said.contains(&expected), "{said}");
    }
}

#[test]
fn a_foot_that_cannot_turn_that_far_tells_the_missing_angle_and_the_limit() {
    let missing = [80.0, 120.0].map(|degrees| {
        let answer = foot_turned_by(degrees).pose(&[]);
        let foot = answer.joint("left_foot");
        let target = &answer.targets[2];
        assert!(target.error < 1e-3, "{target:?}");
        let missing = target.rotation_error_deg.expect("a rotation");

        // An independent computation from the printed transform and the angle about x.
        let axes = Mat4::from_cols_array(&foot.transform).as_dmat4();
        let wanted = glam::DMat3::from_rotation_x(f64::from(degrees).to_radians());
        let turn = glam::DMat3::from_mat4(axes).transpose() * wanted;
        let trace = turn.x_axis.x + turn.y_axis.y + turn.z_axis.z;
        let expected = ((trace - 1.0) / 2.0).acos().to_degrees();
        assert!((f64::from(missing) - expected).abs() < 1e-2, "{missing}, {expected}");

        let why = &answer.why[0];
        assert_eq!((why.cause.as_str(), why.target.as_str()), ("rotation_limits", "left_shin"));
        assert_eq!(why.joints, ["left_foot"]);
        assert!(why.sentence.starts_with("left_foot is ") && why.sentence.contains("about x"));
        assert!(why.remedy.as_ref().expect("a remedy").starts_with("Widen "), "{why:?}");
        assert!(why.rotation_error_with_remedy_deg.expect("tried") < 0.06, "{why:?}");
        missing
    });
    assert!((missing[1] - missing[0] - 40.0).abs() < 5.0, "{missing:?}");
    let reached = foot_turned_by(20.0).pose(&[]);
    assert!(reached.targets[2].rotation_error_deg.expect("a rotation") < 0.01);
    assert_eq!(reached.why, []);
    assert_eq!(reached.targets[0].rotation_error_deg, None);
}

#[test]
fn limits_locked_joints_few_iterations_and_little_influence_are_named() {
    let limited = r#"{"name":"upper","parent":0,"axis":[0,1,0]},
        {"name":"lower","parent":1,"offset":[0,1,0],"axis":[0,1,0],
        "limits":{"x":[0,0],"y":[0,0],"z":[0,0.785]}}"#;
    let near = r#"{"joint":2,"home":[1,0,0],"influence":1}"#;
    let why = first_why(&chain_document(limited, near, ""), &[]);
    assert_eq!((why.cause.as_str(), &why.joints[..]), ("limits", &["lower".to_owned()][..]));
    assert!(why.remedy.expect("a remedy").starts_with("Widen the limit of lower about z by "));

    let locked = r#"{"name":"upper","parent":0,"axis":[0,1,0]},
        {"name":"lower","parent":1,"offset":[0,1,0],"axis":[0,1,0],"locked":true}"#;
    let why = first_why(&chain_document(locked, near, ""), &[]);
    assert_eq!((why.cause.as_str(), why.remedy.as_deref()), ("locked", Some("Unlock lower")));

    let scene = chain_document(two_bones(), near, r#""method":"ccd""#);
    assert_eq!(scene.pose(&[]).why, []);
    let why = first_why(&scene, &["--solver", "ccd", "--iterations", "1"]);
    assert_eq!(why.cause, "out_of_iterations");
    let remedy = why.remedy.expect("a remedy");
    let iterations = remedy.split(' ').nth(1).expect("a number");
    let enough = scene.pose(&["--solver", "ccd", "--iterations", iterations]);
    assert!(enough.report.expect("a report").converged, "{remedy}");

    let half = r#"{"joint":2,"home":[1,0,0],"influence":0.5}"#;
    let why = first_why(&chain_document(two_bones(), half, ""), &[]);
    assert_eq!(why.cause, "influence");
    assert_eq!(why.sentence, "lower is only 50 % of the way from its FK pose to its target");
}

#[test]
fn targets_that_pull_apart_name_each_other() {
    let joints = r#"{"name":"trunk","parent":0,"axis":[0,2,0]},
        {"name":"left","parent":1,"offset":[0,2,0],"axis":[1,0,0]},
        {"name":"right","parent":1,"offset":[0,2,0],"axis":[-1,0,0]}"#;
    let targets = r#"{"joint":2,"home":[2.5,0,0],"influence":1},
        {"joint":3,"home":[-2.5,0,0],"influence":1}"#;
    let why = chain_document(joints, targets, "").pose(&[]).why;
    let causes: Vec<_> = why.iter().map(|why| (why.cause.as_str(), why.target.as_str())).collect();
    assert_eq!(&causes[..2], [("conflict", "left"), ("conflict", "right")]);
    assert_eq!(why[0].joints, ["left", "right"]);
}

#[test]
fn the_fk_pose_has_no_causes() {
    let scene = chain_document(two_bones(), r#"{"joint":2,"home":[3,0,0],"influence":1}"#, "");
    assert_eq!(scene.pose(&["--fk"]).why, []);
}
