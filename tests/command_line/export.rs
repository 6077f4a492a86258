//! `ik-arm export` as a user runs it: the files it makes, what it says, and how it ends.

use crate::common::arm::channels;
use std::fs;
use std::io::{BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use glam::Vec3;
use ik_arm::document::{Channel, Document, Timeline};
use ik_arm::export::{ExportError, ExportOptions, export};
use ik_arm::io::{self, Example, FileBatch, Progress};
use pollster::block_on;
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
        let file = folder.path().join("file");
        fs::write(&file, text).expect("written");
        Self { folder, file }
    }

    /// The arm, its hand at three frames.
    fn moving() -> Self {
        Self::new(&io::to_json(&moving()).expect("written"))
    }

    fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, out: &str, arguments: &[&str]) -> Command {
        let mut command = program();
        command.arg("export").arg(&self.file).arg("-o").arg(self.out(out)).args(arguments);
        command
    }

    fn run(&self, out: &str, arguments: &[&str]) -> Output {
        self.command(out, arguments).output().expect("the program runs")
    }

    /// Standard error of a successful export.
    fn export(&self, out: &str, arguments: &[&str]) -> String {
        let output = self.run(out, arguments);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        assert!(output.stdout.is_empty());
        complaint(&output)
    }

    /// All that is in the folder, in order.
    fn names(&self) -> Vec<String> {
        names(self.folder.path())
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> = entries
        .map(|entry| entry.expect("there").file_name().into_string().expect("UTF-8"))
        .collect();
    names.sort();
    names
}

fn moving() -> Document {
    let timeline = Timeline { start: 1.0, end: 1.2, frame_rate: 10.0 };
    let mut document = Document { timeline, ..Document::default() };
    for (time, x) in [(1.0, 100.0), (1.2, 300.0)] {
        document.keys.insert(channels::HAND, time, Vec3::new(x, 200.0, 50.0));
    }
    document
}

/// The program's own lines of standard error; drivers may write others.
fn complaint(output: &Output) -> String {
    let said = stderr(output);
    let is_ours = |line: &&str| line.starts_with("ik-arm: ") || line.starts_with("error: invalid");
    said.lines().filter(is_ours).collect::<Vec<_>>().join("\n")
}

fn pixels(path: &Path) -> image::RgbaImage {
    image::open(path).expect("a picture").into_rgba8()
}

// Files

#[test]
fn every_format_is_written_and_nothing_else() {
    let desk = Desk::moving();
    for (out, arguments) in [
        ("a.bvh", [].as_slice()),
        ("a.csv", &["--fps", "20"]),
        ("a.png", &["--size", "64x40"]),
        ("a.apng", &["--size", "64x40", "--theme", "light"]),
        ("b_##.PNG", &["--size", "64x40"]),
    ] {
        assert_eq!(desk.export(out, arguments), "");
    }
    let expected =
        ["a.apng", "a.bvh", "a.csv", "a.png", "b_00.PNG", "b_01.PNG", "b_02.PNG", "file"];
    assert_eq!(desk.names(), expected);
    let csv = fs::read_to_string(desk.out("a.csv")).expect("read");
    assert_eq!(csv.lines().count(), 1 + 5);
}

#[test]
fn frame_rates_need_not_be_whole() {
    for (said, step) in
        [("29.97", "0.033366700"), ("30000/1001", "0.03336666"), ("24", "0.041666667")]
    {
        let desk = Desk::moving();
        desk.export("a.bvh", &["--fps", said]);
        let text = fs::read_to_string(desk.out("a.bvh")).expect("read");
        let line = text.lines().find(|line| line.starts_with("Frame Time")).expect("there");
        assert!(line.contains(step), "{said}: {line}");
        let rate =
            said.split('/').map(|it| it.parse::<f64>().expect("a number")).reduce(|a, b| a / b);
        let opened =
            io::open(&desk.out("a.bvh"), &io::OpenOptions::default()).expect("it opens").document;
        assert!((opened.timeline.frame_rate - rate.expect("a rate")).abs() < 1e-9, "{said}");
    }
}

#[test]
fn bvh_round_trips_in_the_chosen_unit() {
    let desk = Desk::new(Example::find("human").expect("there").text);
    desk.export("a.bvh", &["--unit", "m"]);
    desk.export("b.bvh", &[]);
    let size = |name: &str| {
        let opened = io::open(&desk.out(name), &io::OpenOptions::default()).expect("it opens");
        assert!(!opened.skeletons.is_empty(), "it is not saved over");
        opened.document.rig.reach()
    };
    assert!((size("b.bvh") / size("a.bvh") - 100.0).abs() < 1e-3);
    let again = Desk::new(&fs::read_to_string(desk.out("b.bvh")).expect("read"));
    again.export("c.bvh", &[]);
    let read = |path| fs::read_to_string(path).expect("read");
    assert_eq!(read(again.out("c.bvh")).lines().count(), read(desk.out("b.bvh")).lines().count());
}

#[test]
fn standard_input_is_exported() {
    let desk = Desk::new("");
    let mut child = program()
        .args(["export", "-", "-o"])
        .arg(desk.out("a.csv"))
        .stdin(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let text = Example::find("ten-joints").expect("there").text;
    child.stdin.take().expect("piped").write_all(text.as_bytes()).expect("written");
    assert!(child.wait().expect("it ends").success());
    assert!(desk.out("a.csv").exists());
}

#[test]
fn what_the_format_cannot_hold_is_reported_on_stderr() {
    let mut document = Example::find("ten-joints").expect("there").open().expect("opens").document;
    let last = document.skeleton().ids().last().expect("joints");
    for (time, length) in [(0.0, 1.0), (1.0, 2.0)] {
        document.keys.insert(Channel::Length(last), time, Vec3::new(length, 0.0, 0.0));
    }
    let desk = Desk::new(&io::to_json(&document).expect("written"));
    let said = desk.export("a.bvh", &[]);
    let (_, note) = said.split_once("file: ").expect("the input is named");
    assert!(note.starts_with("the last bone of "), "{said}");
}

// Pictures

#[test]
fn an_animated_picture_has_every_frame_and_loops() {
    let desk = Desk::moving();
    desk.export("a.apng", &["--size", "80x50", "--fps", "20"]);
    desk.export("a_#.png", &["--size", "80x50", "--fps", "20"]);
    let file = BufReader::new(fs::File::open(desk.out("a.apng")).expect("there"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let control = reader.info().animation_control.expect("animated");
    assert_eq!((control.num_frames, control.num_plays), (5, 0));
    let mut frame = vec![0; reader.output_buffer_size().expect("a size")];
    for index in 0..5 {
        let info = reader.next_frame(&mut frame).expect("a frame");
        let delay = reader.info().frame_control.expect("a frame's own");
        assert_eq!((info.width, info.height), (80, 50));
        assert_eq!((delay.delay_num, delay.delay_den), (1, 20));
        let still = pixels(&desk.out(&format!("a_{index}.png")));
        assert_eq!(&frame, still.as_raw(), "frame {index}");
    }
    assert!(reader.next_frame(&mut frame).is_err());
    assert_ne!(pixels(&desk.out("a_0.png")), pixels(&desk.out("a_4.png")));
}

#[test]
fn a_picture_is_taken_at_a_time_or_at_the_start() {
    let desk = Desk::moving();
    let picture = |arguments: &[&str]| {
        desk.export("a.png", &[&["--size", "80x50"], arguments].concat());
        pixels(&desk.out("a.png"))
    };
    let start = picture(&[]);
    assert_eq!(start, picture(&["--time", "1"]));
    assert_eq!(start, picture(&["--time", "-7.5"]));
    assert_ne!(start, picture(&["--time", "1.2"]));
}

#[test]
fn a_view_frames_the_whole_motion_for_pictures_alone() {
    let desk = Desk::moving();
    let picture = |arguments: &[&str]| {
        desk.export("a.png", &[&["--size", "80x50"], arguments].concat());
        pixels(&desk.out("a.png"))
    };
    let views = ["front", "right", "top", "perspective"].map(|view| picture(&["--view", view]));
    for (index, view) in views.iter().enumerate() {
        assert!(!views[index + 1..].contains(view), "view {index}");
    }
    let output = desk.run("a.bvh", &["--view", "top"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(complaint(&output).contains("--view does not apply"), "{output:?}");
}

#[test]
fn a_sequence_replaces_all_existing_files_or_none() {
    let desk = Desk::moving();
    fs::write(desk.out("a_00.png"), "before").expect("written");
    fs::create_dir(desk.out("a_01.png")).expect("a folder");
    let output = desk.run("a_##.png", &["--size", "40x40"]);
    assert_eq!(output.status.code(), Some(1), "{}", complaint(&output));
    assert!(complaint(&output).contains("a_01.png could not be written"), "{}", complaint(&output));
    assert_eq!(desk.names(), ["a_00.png", "a_01.png", "file"]);
    assert_eq!(fs::read_to_string(desk.out("a_00.png")).expect("read"), "before");
    fs::remove_dir(desk.out("a_01.png")).expect("removed");
    desk.export("a_##.png", &["--size", "40x40"]);
    assert_eq!(desk.names(), ["a_00.png", "a_01.png", "a_02.png", "file"]);
    assert_eq!(pixels(&desk.out("a_00.png")).width(), 40);
}

#[test]
fn a_dropped_batch_leaves_no_file() {
    let desk = Desk::moving();
    let batch = FileBatch::beside(&desk.out("x")).expect("a folder");
    batch.add("x".as_ref(), b"new").expect("written");
    drop(batch);
    assert_eq!(desk.names(), ["file"]);
}

// No file

#[test]
fn a_cancelled_export_leaves_no_file() {
    let desk = Desk::moving();
    let options = ExportOptions { size: (40, 40), ..ExportOptions::default() };
    for name in ["a.bvh", "a.csv", "a.png", "a_##.png", "a.apng"] {
        let progress = Progress::default();
        progress.cancel();
        let stopped = block_on(export(&moving(), &desk.out(name), &options, &progress));
        assert!(matches!(stopped, Err(ExportError::Cancelled(_))), "{name} {stopped:?}");
    }
    assert_eq!(desk.names(), ["file"]);
}

#[test]
fn an_export_cancelled_midway_leaves_no_file() {
    let desk = Desk::moving();
    let mut document = moving();
    document.timeline.end = 100.0;
    let options = ExportOptions { size: (40, 40), fps: Some(1000.0), ..ExportOptions::default() };
    for name in ["a_##.png", "a.apng"] {
        let progress = Progress::default();
        let stopped = std::thread::scope(|scope| {
            let job =
                scope.spawn(|| block_on(export(&document, &desk.out(name), &options, &progress)));
            while progress.part() == 0.0 && !job.is_finished() {
                std::thread::yield_now();
            }
            assert!(desk.names().len() > 1, "{name}: a temporary file is there");
            progress.cancel();
            job.join().expect("no panic")
        });
        assert!(matches!(stopped, Err(ExportError::Cancelled(_))), "{name} {stopped:?}");
        assert_eq!(desk.names(), ["file"], "{name}");
    }
}

#[test]
#[cfg(unix)]
fn an_interrupted_export_leaves_no_file_and_exits_with_130() {
    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;

    let mut document = moving();
    document.timeline.end = 1000.0;
    let desk = Desk::new(&io::to_json(&document).expect("written"));
    for out in ["a.apng", "a_####.png"] {
        let mut command = desk.command(out, &["--size", "40x40"]);
        let child = command.stderr(Stdio::piped()).spawn().expect("the program runs");
        // Once something is there, Ctrl+C is listened to.
        while desk.names().len() == 1 {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        kill(Pid::from_raw(child.id().cast_signed()), Signal::SIGINT).expect("the program runs");
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(130), "{}", complaint(&output));
        assert!(complaint(&output).starts_with("ik-arm: cancelled; "), "{}", complaint(&output));
        assert_eq!(desk.names(), ["file"]);
    }
}

#[test]
fn a_missing_folder_is_an_error_that_names_the_file() {
    let desk = Desk::moving();
    assert_not_written(&desk, &desk.out("missing"));
    assert_eq!(desk.names(), ["file"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_read_only_folder_is_an_error_that_names_the_file() {
    use std::os::unix::fs::PermissionsExt as _;

    let desk = Desk::moving();
    let locked = desk.out("locked");
    fs::create_dir(&locked).expect("a folder");
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o500)).expect("locked");
    // Root may write there, too; but nobody may among the kernel's own files.
    let is_root = fs::write(locked.join("probe"), "").is_ok();
    let folder = if is_root { Path::new("/proc/self") } else { &locked };
    assert_not_written(&desk, folder);
    assert_eq!(desk.names(), ["file", "locked"]);
    assert!(is_root || names(&locked).is_empty());
}

fn assert_not_written(desk: &Desk, folder: &Path) {
    for name in ["a.bvh", "a.csv", "a.png", "a_##.png", "a.apng"] {
        let out = folder.join(name);
        let arguments: &[&str] = if name.contains("png") { &["--size", "40x40"] } else { &[] };
        let output = desk.run(out.to_str().expect("UTF-8"), arguments);
        assert_eq!(output.status.code(), Some(1), "{name}");
        let expected = format!("ik-arm: {} could not be written: ", out.display());
        assert!(complaint(&output).starts_with(&expected), "{}", complaint(&output));
    }
}

#[test]
fn an_unknown_extension_is_an_error_that_lists_the_known_ones() {
    let desk = Desk::new("no document at all");
    for out in ["a.mp4", "a"] {
        let output = desk.run(out, &[]);
        assert_eq!(output.status.code(), Some(1));
        let said = complaint(&output);
        assert!(said.ends_with("must be one of .glb, .bvh, .csv, .obj, .png, .apng"), "{said}");
    }
    let output = desk.run("a.csv", &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(complaint(&output).contains("file, line 1, column 2: not JSON"), "{output:?}");
}

#[test]
fn an_argument_that_the_format_does_not_use_is_a_usage_error() {
    let desk = Desk::moving();
    for (out, arguments) in [
        ("a.png", ["--fps", "5"]),
        ("a.csv", ["--size", "10x10"]),
        ("a.bvh", ["--theme", "dark"]),
        ("a.apng", ["--time", "1"]),
        ("a_#.png", ["--time", "1"]),
        ("a.csv", ["--unit", "m"]),
        ("a.csv", ["--fps", "0"]),
        ("a.csv", ["--fps", "1001"]),
        ("a.png", ["--time", "inf"]),
        ("a.bvh", ["--unit", "mile"]),
    ] {
        let output = desk.run(out, &arguments);
        assert_eq!(output.status.code(), Some(2), "{out} {arguments:?} {}", complaint(&output));
        assert!(complaint(&output).contains(arguments[0]), "{}", complaint(&output));
    }
    assert_eq!(desk.names(), ["file"]);
}
