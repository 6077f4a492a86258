//! `ik-arm bake` as a user runs it: the document it makes, what it says, and how it ends.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};

use glam::Vec3;
use ik_arm::document::{Channel, Document, SkeletonRig, Target, TargetMotion, TargetPath};
use ik_arm::io::{self};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::rig::{LimbSettings, TargetKind};
use tempfile::TempDir;

use crate::{program, stderr};

/// A folder with a file in it.
struct Desk {
    folder: TempDir,
    file: PathBuf,
}

impl Desk {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("scene.json");
        fs::write(&file, text).expect("written");
        Self { folder, file }
    }

    fn with(document: &Document) -> Self {
        Self::new(&io::to_json(document).expect("written"))
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("baked.json")
    }

    fn run(&self, arguments: &[&str]) -> Output {
        run(&self.file, &self.out(), arguments)
    }

    /// Standard error of a successful bake, and the baked document.
    fn bake(&self, arguments: &[&str]) -> (String, Document) {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        assert!(output.stdout.is_empty());
        (
            complaint(&output),
            io::open(&self.out(), &io::OpenOptions::default()).expect("it opens").document,
        )
    }

    /// Standard error of a bake that fails and writes nothing.
    fn refusal(&self, arguments: &[&str], code: i32) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(code), "{}", complaint(&output));
        assert!(!self.out().exists());
        complaint(&output)
    }
}

fn run(file: &Path, out: &Path, arguments: &[&str]) -> Output {
    let mut command = program();
    command.arg("bake").arg(file).arg("-o").arg(out).args(arguments);
    command.output().expect("the program runs")
}

fn complaint(output: &Output) -> String {
    stderr(output).trim_end().to_owned()
}

/// A leg whose foot goes around a circle, stretched where the circle is out of reach.
fn leg(max_stretch: f32) -> Document {
    let mut skeleton = Skeleton::default();
    let mut add = |name: &str, parent, offset, axis| {
        let joint = Joint::new(name, parent, axis);
        skeleton.add(Joint { offset, ..joint }).expect("a joint")
    };
    let thigh = add("thigh", None, Vec3::Y, Vec3::NEG_Y * 0.5);
    let shin = add("shin", Some(thigh), Vec3::NEG_Y * 0.5, Vec3::NEG_Y * 0.5);
    let mut rig = SkeletonRig::new(skeleton);
    let soft_reach = SoftReach::new(0.0, max_stretch, 0.0).expect("in range");
    let kind = TargetKind::Limb(LimbSettings { soft_reach, ..LimbSettings::default() });
    let motion = TargetMotion { path: TargetPath::Circle, radius: 0.2, period: 2.0 };
    let target = Target::new(shin, Vec3::new(0.1, 0.3, 0.0), 0.2);
    rig.targets.push(Target { kind, motion, influence: 1.0, ..target });
    Document::new(rig)
}

/// Largest distance between the tips of all joints in two documents, over the frames of one.
fn largest_distance(one: &Document, other: &Document) -> f32 {
    let tips = |document: &Document, time: f64| {
        let pose = document.at(time).skeleton().pose();
        pose.ids().map(|joint| pose.tip(joint)).collect::<Vec<_>>()
    };
    let frames = (0..one.timeline.frames()).map(|frame| one.timeline.time(frame));
    let distances = frames.flat_map(|time| {
        tips(one, time).into_iter().zip(tips(other, time)).map(|(one, other)| one.distance(other))
    });
    distances.fold(0.0, f32::max)
}

/// The numbers in a text.
fn numbers(text: &str) -> Vec<f32> {
    let words = text.split([' ', ',']);
    words.filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn a_baked_document_moves_as_before_by_keys_and_the_keys_are_counted() {
    let document = leg(1.0);
    let (said, mut baked) = Desk::with(&document).bake(&[]);
    baked.rig.targets.clear();
    assert!(said.starts_with("ik-arm: 241 frames baked: "), "{said}");
    let [_, keys, at_frames, error] = numbers(&said)[..] else { panic!("{said}") };
    let joints = [0, 1].map(|joint| Channel::Rotation(JointId::new(joint)));
    let left = joints.map(|channel| baked.keys.track(channel).expect("keys").knots().len());
    assert_eq!((keys as usize, at_frames), (left.iter().sum(), 2.0 * 241.0));
    assert!(keys < 0.5 * at_frames, "{said}");
    let most = largest_distance(&document, &baked);
    assert!(most <= 1e-3 && (most - error).abs() < 1e-5, "{most}: {said}");
}

#[test]
fn the_frame_rate_and_the_tolerance_can_be_chosen() {
    let desk = Desk::with(&leg(1.0));
    let (said, _) = desk.bake(&["--fps", "10"]);
    assert!(said.starts_with("ik-arm: 81 frames baked: "), "{said}");
    let keys = ["0.00001", "0.001", "0.1"].map(|tolerance| {
        let (said, _) = desk.bake(&["--tolerance", tolerance]);
        numbers(&said)[1]
    });
    assert!(keys[0] > keys[1] && keys[1] > keys[2], "{keys:?}");
}

#[test]
fn a_path_is_baked() {
    let text = crate::common::documents::KEYED_SNAKE;
    let (said, baked) = Desk::new(text).bake(&["--fps", "5", "--tolerance", "0.01"]);
    assert!(said.starts_with("ik-arm: 91 frames baked: "), "{said}");
    assert_eq!(baked.rig.follow_paths, []);
}

#[test]
fn stretch_that_keys_cannot_hold_is_listed() {
    let (said, _) = Desk::with(&leg(1.5)).bake(&[]);
    let lines: Vec<&str> = said.lines().skip(1).collect();
    assert_eq!(lines.len(), 2, "{said}");
    for (line, bone) in lines.into_iter().zip(["thigh", "shin"]) {
        let start = format!("ik-arm: the stretch of the bone of {bone:?}, up to 0.0");
        assert!(line.starts_with(&start) && line.ends_with(", has no keys"), "{line}");
    }
}

#[test]
fn what_cannot_be_baked_is_refused() {
    let mut idle = leg(1.0);
    idle.rig.targets[0].enabled = false;
    let desk = Desk::with(&idle);
    assert!(desk.refusal(&[], 1).contains(": nothing to bake: no target and no path poses"));
    let why = ": the tolerance must be from 0.00001 to 1 of the reach, got 0";
    assert_eq!(
        desk.refusal(&["--tolerance", "0"], 1),
        format!("ik-arm: {}{why}", desk.file.display())
    );
    assert!(desk.refusal(&["--tolerance", "much"], 2).contains("number must be finite"));
    assert!(
        desk.refusal(&["--fps", "0"], 2).contains("frames per second must be a number like 29.97")
    );

    let out = desk.folder.path().join("baked.glb");
    let output = run(&desk.file, &out, &[]);
    assert_eq!(output.status.code(), Some(2));
    let why = "ik-arm: bake writes a document, so OUT must end in .json, got ";
    assert_eq!(complaint(&output), format!("{why}{}", out.display()));
}

/// True if a process handles a signal, by its number.
#[cfg(target_os = "linux")]
fn handles(process: u32, signal: i32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    caught.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_leaves_no_file() {
    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;

    let mut document = leg(1.0);
    document.timeline.end = 3600.0;
    document.timeline.frame_rate = 200.0;
    let desk = Desk::with(&document);
    let mut command = program();
    command.arg("bake").arg(&desk.file).arg("-o").arg(desk.out());
    let child = command.stderr(Stdio::piped()).spawn().expect("the program runs");
    while !handles(child.id(), Signal::SIGINT as i32) {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    kill(Pid::from_raw(child.id().cast_signed()), Signal::SIGINT).expect("it is sent");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130), "{}", complaint(&output));
    let said = format!("ik-arm: cancelled; {} is not written", desk.out().display());
    assert_eq!(complaint(&output), said);
    assert!(!desk.out().exists());
}
