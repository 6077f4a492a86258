//! `ik-arm render` as a user runs it: the built program, its pictures, and its exit codes.

use crate::common::arm::channels;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

use crate::{program, stderr};

fn run_without_display(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the program runs")
}

fn command(arguments: &[&str]) -> Command {
    let mut command = program();
    command.args(arguments).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command
}

fn render(out: &Path, arguments: &[&str]) -> Output {
    let out = out.to_str().expect("a path in UTF-8");
    let small: &[&str] = if arguments.contains(&"--size") { &[] } else { &["--size", "160x100"] };
    run_without_display(&[&["render", "-o", out], small, arguments].concat())
}

fn picture(arguments: &[&str]) -> image::RgbaImage {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("arm.png");
    let output = render(&out, arguments);
    assert!(output.status.success(), "{arguments:?}: {output:?}");
    assert!(output.stdout.is_empty(), "a picture alone prints nothing");
    image::open(out).expect("a picture").into_rgba8()
}

#[test]
fn a_picture_has_the_requested_size() {
    for size in ["1x1", "3x500", "641x77"] {
        let image = picture(&["--size", size]);
        assert_eq!(format!("{}x{}", image.width(), image.height()), size);
    }
}

#[test]
fn every_argument_changes_the_picture() {
    let plain = picture(&[]);
    for arguments in [
        ["--hand", "-100,200,-50"],
        ["--twist", "-90"],
        ["--root", "-50,80,-20"],
        ["--upper", "350"],
        ["--lower", "120.5"],
        ["--guides", "none"],
        ["--guides", "cursor,pointer,inner,outer,circle"],
        ["--view", "front"],
        ["--view", "right"],
        ["--view", "top"],
        ["--theme", "light"],
    ] {
        assert_ne!(picture(&arguments), plain, "{arguments:?} changes nothing");
    }
    assert_eq!(picture(&["--hand", "250,120,60", "--theme", "dark"]), plain);
}

#[test]
fn a_negative_number_is_accepted_with_and_without_an_equals_sign() {
    assert_eq!(picture(&["--hand", "-1,2,3"]), picture(&["--hand=-1,2,3"]));
}

#[test]
fn extreme_arms_are_drawn() {
    for arguments in [
        ["--hand", "3e38,3e38,-3e38", "--upper", "3e38"],
        ["--hand", "0,0,0", "--upper", "300"],
        ["--hand", "1e-38,0,0", "--lower", "1e-30"],
        ["--root", "1e30,0,-1e30", "--twist", "1e30"],
    ] {
        picture(&arguments);
    }
}

#[test]
fn an_invalid_argument_is_a_usage_error_that_states_the_rule() {
    for (arguments, right) in [
        (["--size", "0x10"], "each side 1 to 8192"),
        (["--size", "8193x10"], "each side 1 to 8192"),
        (["--size", "800"], "1280x800"),
        (["--hand", "1,2"], "three numbers"),
        (["--hand", "1,2,x"], "three numbers"),
        (["--hand", "nan,0,0"], "three numbers"),
        (["--root", "1e39,0,0"], "three numbers"),
        (["--twist", "inf"], "number"),
        (["--upper", "0"], "above 0"),
        (["--lower", "-3"], "above 0"),
        (["--guides", "cursor,elbow"], "cursor, pointer, inner, outer, circle"),
        (["--guides", ""], "cursor, pointer, inner, outer, circle"),
        (["--view", "left"], "perspective"),
        (["--theme", "blue"], "dark"),
        (["--frames", "5"], "--timings"),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let output = render(&folder.path().join("arm.png"), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(right), "{arguments:?}: {}", stderr(&output));
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "{arguments:?}");
    }
    assert_eq!(run_without_display(&["render"]).status.code(), Some(2), "no output and no timings");
}

#[test]
fn a_picture_that_cannot_be_written_is_an_error_that_names_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    for out in [folder.path().join("missing/arm.png"), folder.path().to_owned()] {
        let output = render(&out, &[]);
        assert_eq!(output.status.code(), Some(1));
        let named = out.to_str().expect("a path in UTF-8");
        assert!(stderr(&output).contains(named), "{}", stderr(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "nothing half-written");
}

#[test]
fn a_picture_replaces_the_one_before_and_follows_a_link() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("arm.png");
    fs::write(&out, "before").expect("written");
    assert!(render(&out, &[]).status.success());
    image::open(&out).expect("a picture");
    #[cfg(unix)]
    {
        let link = folder.path().join("link.png");
        std::os::unix::fs::symlink(&out, &link).expect("a link");
        assert!(render(&link, &["--theme", "light"]).status.success());
        assert!(link.symlink_metadata().expect("there").is_symlink());
        assert_eq!(fs::read(&link).expect("read"), fs::read(&out).expect("read"));
    }
}

#[test]
fn timings_are_one_line_of_json_and_need_no_picture() {
    let output = run_without_display(&["render", "--size", "64x64", "--frames", "3", "--timings"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let line: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(line["frames"], 3);
    let milliseconds = |name: &str| line[name].as_f64().expect("a number");
    assert!(milliseconds("frame_ms_median") >= milliseconds("cpu_ms_median"));
    assert!(milliseconds("cpu_ms_median") > 0.0);
    assert!(!line["adapter"].as_str().expect("a name").is_empty());
}

/// Drivers write there, too: Mesa where `XDG_RUNTIME_DIR` is not set, and OpenGL's.
#[test]
fn nothing_is_written_to_standard_error_when_all_is_well() {
    let folder = tempfile::tempdir().expect("a folder");
    let arm = file(&folder, "arm.json", ik_arm::io::Example::ALL[0].text);
    let out = folder.path().join("arm.png");
    let out = out.to_str().expect("a path in UTF-8");
    for arguments in [&["render", "-o", out, "--size", "64x64"][..], &["export", &arm, "-o", out]] {
        let output = command(arguments)
            .env_remove("XDG_RUNTIME_DIR")
            .env_remove("NODEVICE_SELECT")
            .env_remove("RUST_LOG")
            .output()
            .expect("the program runs");
        assert!(output.status.success(), "{arguments:?}");
        assert_eq!(stderr(&output), "", "{arguments:?}");
    }
}

#[test]
fn without_a_graphics_adapter_it_says_what_to_install() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("arm.png");
    let output = command(&["render", "-o", out.to_str().expect("a path in UTF-8")])
        .env("WGPU_BACKEND", "vulkan")
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .output()
        .expect("the program runs");
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("mesa-vulkan-drivers"), "{}", stderr(&output));
    assert!(!out.exists());
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_display_it_points_to_render() {
    let folder = tempfile::tempdir().expect("a folder");
    let bent = file(&folder, "bent.js3d", BONE);
    for arguments in [&[][..], &["gui"], &["gui", &bent], &[&bent], &[&bent, "--skeleton", "bent"]]
    {
        let output = run_without_display(arguments);
        assert_eq!(output.status.code(), Some(1));
        assert!(stderr(&output).contains("ik-arm render"), "{}", stderr(&output));
        assert!(!stderr(&output).contains(".cargo"), "{}", stderr(&output));
    }
}

#[test]
fn a_file_in_place_of_a_command_must_be_there() {
    let output = run_without_display(&["solv"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("solv"), "{}", stderr(&output));
    let output = run_without_display(&["render", "human.json", "solve"]);
    assert_eq!(output.status.code(), Some(2));
}

// Files

const BONE: &str = r#"{"scene":{"skinned_meshes":{
    "thin":{"skeleton":{"bones":[{"extent":[0,1,0]}]}},
    "bent":{"skeleton":{"bones":[{"extent":[0,1,0],"pose":[0,0,50]}]}}}}}"#;

fn file(folder: &tempfile::TempDir, name: &str, text: &str) -> String {
    let path = folder.path().join(name);
    fs::write(&path, text).expect("written");
    path.to_str().expect("a path in UTF-8").to_owned()
}

#[test]
fn every_example_is_drawn_and_looks_like_no_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let pictures = ik_arm::io::Example::ALL.map(|example| {
        let path = file(&folder, example.name, example.text);
        (example.name, picture(&[&path]))
    });
    for (index, (name, image)) in pictures.iter().enumerate() {
        for (other, same) in &pictures[..index] {
            assert_ne!(image, same, "{name} looks like {other}");
        }
    }
}

#[test]
fn a_document_of_the_arm_is_drawn_from_its_own_camera() {
    let folder = tempfile::tempdir().expect("a folder");
    let json = |yaw: f32| {
        let mut document = ik_arm::document::Document::default();
        document.camera.yaw = yaw;
        ik_arm::io::to_json(&document).expect("written")
    };
    let (near, far) = (file(&folder, "a.json", &json(0.1)), file(&folder, "b.json", &json(1.0)));
    assert_ne!(picture(&[&near]), picture(&[&far]));
    assert_eq!(picture(&[&near, "--view", "top"]), picture(&["--view", "top"]));
}

#[test]
fn a_view_guides_a_theme_and_a_skeleton_change_the_picture_of_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = file(&folder, "scene.js3d", BONE);
    let plain = picture(&[&scene]);
    for arguments in [["--view", "front"], ["--theme", "light"], ["--skeleton", "bent"]] {
        assert_ne!(picture(&[&[scene.as_str()], &arguments[..]].concat()), plain, "{arguments:?}");
    }
    assert_eq!(picture(&[&scene, "--skeleton", "thin"]), plain);
    let arm = file(&folder, "arm.json", ik_arm::io::Example::ALL[0].text);
    assert_ne!(picture(&[&arm]), picture(&[&arm, "--guides", "none"]));
    assert_ne!(picture(&[&arm]), picture(&[&arm, "--guides", "outer"]));
}

#[test]
fn a_file_that_cannot_be_drawn_is_an_error_with_its_position() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = file(&folder, "scene.js3d", BONE);
    let broken = file(&folder, "broken.js3d", "{\"scene\":\n5}");
    for (arguments, said) in [
        ([broken.as_str(), "--theme", "dark"], "broken.js3d, line 2, column 1: scene: "),
        ([&scene, "--skeleton", "fat"], "no skeleton called \"fat\"; it has \"thin\", \"bent\""),
        (["missing.json", "--theme", "dark"], "missing.json cannot be read: "),
    ] {
        let out = folder.path().join("out.png");
        let output = render(&out, &arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
        assert!(!out.exists());
    }
}

#[test]
fn an_arm_of_arguments_and_a_file_are_a_usage_error_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = file(&folder, "scene.js3d", BONE);
    for arguments in [
        [scene.as_str(), "--hand", "1,2,3"],
        [&scene, "--upper", "200"],
        [&scene, "--lower", "300"],
        [&scene, "--root", "0,0,0"],
        [&scene, "--twist", "0"],
    ] {
        let output = render(&folder.path().join("out.png"), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
    let output = render(&folder.path().join("out.png"), &["--skeleton", "thin"]);
    assert_eq!(output.status.code(), Some(2), "a skeleton of no file");
}

// Times

#[test]
fn a_time_moves_keyed_channels() {
    use ik_arm::document::{Document, Overlay};
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = Document::default();
    document.display = document.display.with(Overlay::Trail, false);
    for (time, x) in [(-1.0, -100.0), (0.0, 100.0), (2.0, 300.0), (3.0, 0.0)] {
        document.keys.insert(channels::HAND, time, glam::Vec3::new(x, 200.0, 50.0));
    }
    let json = |document: &Document| ik_arm::io::to_json(document).expect("written");
    let moving = file(&folder, "moving.json", &json(&document));
    for time in [-0.5, 0.0, 1.0] {
        let mut posed = document.at(time).into_document();
        posed.keys = Default::default();
        let still = file(&folder, "still.json", &json(&posed));
        assert_eq!(picture(&[&moving, "--time", &time.to_string()]), picture(&[&still]), "{time}");
    }
    assert_eq!(picture(&[&moving]), picture(&[&moving, "--time", "0"]));
    assert_ne!(picture(&[&moving]), picture(&[&moving, "--time", "1"]));
    // The trail is drawn as the document's display has it.
    document.display = document.display.with(Overlay::Trail, true);
    let trailing = file(&folder, "trailing.json", &json(&document));
    assert_ne!(picture(&[&moving]), picture(&[&trailing]));
}

#[test]
fn a_time_moves_a_path_follower_within_the_view() {
    let folder = tempfile::tempdir().expect("a folder");
    let snake = file(&folder, "snake.json", crate::common::documents::KEYED_SNAKE);
    assert_ne!(picture(&[&snake]), picture(&[&snake, "--time", "3"]));
    assert_ne!(
        picture(&[&snake, "--view", "top"]),
        picture(&[&snake, "--view", "top", "--time", "3"])
    );
    let output = render(&folder.path().join("out.png"), &["--time", "inf"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_crowd_is_timed_and_drawn_by_either_solver() {
    for solver in ["cpu", "gpu"] {
        let arguments = ["--crowd", "250", "--frames", "3", "--timings", "--solve", solver];
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("crowd.png");
        let output = render(&out, &arguments);
        assert!(output.status.success(), "{}", stderr(&output));
        let line: Value = serde_json::from_slice(&output.stdout).expect("a line of JSON");
        let names: Vec<_> = line.as_object().expect("an object").keys().collect();
        assert_eq!(names, ["adapter", "arms", "frame_ms_median", "frames", "solve_ms_median"]);
        assert_eq!((&line["arms"], &line["frames"]), (&250.into(), &3.into()));
        let [solve, frame] =
            ["solve_ms_median", "frame_ms_median"].map(|name| line[name].as_f64().expect("ms"));
        assert!(0.0 < solve && solve < frame, "{line}");
        assert!(stderr(&output).contains("frame 3 of 3"), "progress is on stderr");
        let image = image::open(out).expect("a picture").into_rgba8();
        assert!(image != picture(&[]), "the crowd is drawn");
    }
}

#[test]
fn an_invalid_crowd_is_refused() {
    for (arguments, why) in [
        (&["--crowd", "0"][..], "0 is not in 1..=1000000"),
        (&["--crowd", "1000001"], "1000001 is not in 1..=1000000"),
        (&["--crowd", "5", "--hand", "1,2,3"], "cannot be used with"),
        (&["--solve", "tpu", "--crowd", "5"], "invalid value 'tpu'"),
    ] {
        let output = run_without_display(&[&["render", "--timings"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(why), "{}", stderr(&output));
    }
}
