//! Work, files and outputs that must not make a command hang or end without a word.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::{program, run, stderr};

/// Far more than a bounded command takes, and far less than an unbounded one.
const SOON: Duration = Duration::from_secs(60);

struct Desk(TempDir);

impl Desk {
    fn with(name: &str, document: &Value) -> Self {
        let desk = Self(TempDir::new().expect("a folder"));
        fs::write(desk.path(name), document.to_string()).expect("written");
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        self.path(name).display().to_string()
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("a folder").map(|it| it.expect("there"));
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
    }
}

fn target(joint: usize, home: [f64; 3]) -> Value {
    json!({ "joint": joint, "home": home, "influence": 1, "enabled": true })
}

fn document(joints: Vec<Value>, targets: Vec<Value>, solver: Value) -> Value {
    json!({
        "format": "ik-arm", "version": 2, "rig": "skeleton",
        "skeleton": { "joints": joints }, "targets": targets, "solver": solver,
        "timeline": { "start": 0, "end": 3600, "frame_rate": 30 },
    })
}

/// A root with children that each have a target.
fn star(joints: usize, method: &str) -> Value {
    let angle = |index: usize| index as f64;
    let root = json!({ "name": "root", "parent": null, "axis": [0, 1, 0] });
    let child = |index| {
        let axis = [angle(index).cos(), 0.2, angle(index).sin()];
        json!({ "name": format!("ray_{index}"), "parent": 0, "axis": axis })
    };
    let home = |index| [2.0 * angle(index).cos(), 1.0, angle(index).sin()];
    let joints_of = std::iter::once(root).chain((1..joints).map(child)).collect();
    let targets = (1..joints).map(|index| target(index, home(index))).collect();
    document(joints_of, targets, json!({ "method": method }))
}

/// A chain whose solver takes steps so small that it would iterate for minutes.
fn slow_chain() -> Value {
    let joint = |index: usize| {
        let parent = index.checked_sub(1);
        let offset = [0, i32::from(index > 0), 0];
        json!({ "name": format!("joint_{index}"), "parent": parent, "offset": offset, "axis": [0, 1, 0] })
    };
    let solver = json!({
        "method": "transpose-fixed", "step": 1e-7, "tolerance": 1e-30, "iterations": 1_000_000_000,
    });
    document((0..6).map(joint).collect(), vec![target(5, [3.0, 1.0, 1.0])], solver)
}

fn timed(arguments: &[&str]) -> (Output, Duration) {
    let started = Instant::now();
    (run(arguments), started.elapsed())
}

#[test]
fn a_list_of_what_a_file_has_solves_nothing() {
    for method in ["dls", "fabrik"] {
        let desk = Desk::with("star.json", &star(10_000, method));
        let (output, time) = timed(&["pose", &desk.text("star.json"), "--list"]);
        assert!(output.status.success(), "{output:?}");
        assert!(time < SOON, "{method}: {time:?}");
        let list: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(list["targets"].as_array().expect("a list").len(), 9_999);
    }
}

#[test]
fn a_pose_whose_iterations_are_too_much_work_is_refused_in_words() {
    let desk = Desk::with("star.json", &star(10_000, "dls"));
    let (output, time) = timed(&["pose", &desk.text("star.json")]);
    assert!(time < SOON, "{time:?}");
    assert!(output.status.success(), "it is the FK pose: {}", stderr(&output));
    let said = stderr(&output);
    let expected =
        format!("ik-arm: {}: targets are not solved: 9999 targets", desk.text("star.json"));
    assert!(said.starts_with(&expected) && said.contains("more work for dls"), "{said}");
}

#[test]
fn a_star_of_ten_thousand_joints_is_posed_soon() {
    let desk = Desk::with("star.json", &star(10_000, "fabrik"));
    let (output, time) = timed(&["pose", &desk.text("star.json")]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(time < SOON, "{time:?}");
}

#[test]
fn a_file_that_asks_for_a_billion_iterations_is_posed_within_a_bound_that_is_told() {
    let desk = Desk::with("slow.json", &slow_chain());
    let (output, time) = timed(&["pose", &desk.text("slow.json")]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(time < SOON, "{time:?}");
    let said = stderr(&output);
    assert!(said.contains("slow.json: transpose-fixed stopped at the bound on work"), "{said}");
}

#[test]
fn a_command_that_takes_too_long_names_file_and_limit_and_fails() {
    let desk = Desk::with("slow.json", &slow_chain());
    let file = desk.text("slow.json");
    let solver = ["--solver", "transpose-fixed", "--time-limit", "0.5"];
    let (output, time) = timed(&[&["pose", &file], &solver[..]].concat());
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{output:?}");
    assert!(time < SOON, "{time:?}");
    let expected = format!(
        "ik-arm: {file}: not done within the time limit of 0.5 s; --time-limit SECONDS sets another\n"
    );
    assert_eq!(stderr(&output), expected);
    for wrong in ["0", "-1", "inf", "soon"] {
        let output = run(&["pose", &file, "--time-limit", wrong]);
        assert_eq!(output.status.code(), Some(2), "{wrong}");
    }
}

#[test]
fn jobs_that_take_too_long_leave_no_file() {
    let mut document = slow_chain();
    document["targets"][0]["motion"] = json!({ "path": "circle", "radius": 0.5, "period": 2 });
    let desk = Desk::with("slow.json", &document);
    for (command, out) in [("export", "out.csv"), ("convert", "out.glb"), ("bake", "out.json")] {
        let (from, to) = (desk.text("slow.json"), desk.text(out));
        let (output, time) = timed(&[command, &from, "-o", &to, "--time-limit", "0.5"]);
        assert_eq!(output.status.code(), Some(1), "{command}: {output:?}");
        assert!(time < 2 * SOON, "{command}: {time:?}");
        assert!(stderr(&output).contains("slow.json: not done within the time limit of 0.5 s"));
        assert_eq!(desk.names(), ["slow.json"], "{command}");
    }
}

/// Runs a command with a limit on its time, in case it waits for ever.
fn run_briefly(arguments: &[&str]) -> Output {
    let mut child = Command::new("timeout");
    child.arg("20").arg(env!("CARGO_BIN_EXE_ik-arm")).args(arguments).stdin(Stdio::null());
    child.output().expect("timeout runs")
}

#[test]
#[cfg(target_os = "linux")]
fn pipes_and_devices_are_refused_by_name() {
    let desk = Desk::with("star.json", &star(3, "fabrik"));
    let pipe = desk.text("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let folder = desk.0.path().display().to_string();
    for (input, kind) in [
        (pipe.as_str(), "a pipe (standard input is read with -)"),
        ("/dev/zero", "a device"),
        (&folder, "a folder"),
    ] {
        for command in [&["pose", input][..], &["convert", input, "-o", &desk.text("x.glb")]] {
            let output = run_briefly(command);
            let expected =
                format!("ik-arm: {input} cannot be read: it must be a regular file, got {kind}\n");
            assert_eq!((output.status.code(), stderr(&output)), (Some(1), expected));
        }
    }
    // A file of the system without a length, which would be read for ever.
    if Path::new("/proc/kmsg").exists() {
        let output = run_briefly(&["pose", "/proc/kmsg"]);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        assert!(stderr(&output).contains("/proc/kmsg"), "{output:?}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn the_mesh_of_a_skin_is_not_read_from_a_pipe() {
    let mut scene = star(3, "fabrik");
    scene["skin"] = json!({
        "mesh": { "file": "pipe", "checksum": 1, "skeleton": "", "joints": [0, 1, 2] },
    });
    let desk = Desk::with("scene.json", &scene);
    let made = Command::new("mkfifo").arg(desk.path("pipe")).status().expect("mkfifo runs");
    assert!(made.success());
    let output = run_briefly(&["pose", &desk.text("scene.json")]);
    let said = stderr(&output);
    assert!(output.status.success(), "{output:?}");
    assert!(said.contains("/pipe cannot be read: it must be a regular file, got a pipe"), "{said}");
}

#[test]
#[cfg(target_os = "linux")]
fn version_and_help_that_cannot_be_printed_are_an_error() {
    for argument in ["--version", "--help", "pose --help"] {
        let full = fs::File::options().write(true).open("/dev/full").expect("Linux has it");
        let output = program()
            .args(argument.split(' '))
            .stdout(full)
            .stderr(Stdio::piped())
            .spawn()
            .and_then(std::process::Child::wait_with_output)
            .expect("the program runs");
        assert_eq!(output.status.code(), Some(1), "{argument}");
        let said = stderr(&output);
        assert!(said.starts_with("ik-arm: cannot write to standard output: No space"), "{said}");
    }
}

#[test]
fn errors_and_notes_of_exports_name_the_input() {
    let desk = Desk::with("star.json", &star(3, "fabrik"));
    let from = desk.text("star.json");
    let output = run(&["export", &from, "-o", &desk.text("star.obj")]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(stderr(&output).starts_with(&format!("ik-arm: {from}: ")), "{}", stderr(&output));
    let output = run(&["convert", &from, "-o", &desk.text("star.bvh")]);
    let said = stderr(&output);
    assert!(said.lines().all(|line| line.starts_with(&format!("ik-arm: {from}"))), "{said}");
}
