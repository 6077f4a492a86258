//! `ik-arm render` as a user runs it: the built program, its pictures, and its exit codes.
#![cfg(feature = "app")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn ik_arm(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the program runs")
}

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ik-arm"));
    command.args(arguments).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command
}

fn render(out: &Path, arguments: &[&str]) -> Output {
    let out = out.to_str().expect("a path in UTF-8");
    let small: &[&str] = if arguments.contains(&"--size") { &[] } else { &["--size", "160x100"] };
    ik_arm(&[&["render", "-o", out], small, arguments].concat())
}

fn picture(arguments: &[&str]) -> image::RgbaImage {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("arm.png");
    let output = render(&out, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", complaint(&output));
    assert!(output.stdout.is_empty(), "a picture alone prints nothing");
    image::open(out).expect("a picture").into_rgba8()
}

fn complaint(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_picture_has_the_size_that_was_asked_for() {
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
        ["--elbow-spin", "-90"],
        ["--root", "-50,80,-20"],
        ["--upper", "350"],
        ["--lower", "120.5"],
        ["--guides", "none"],
        ["--guides", "cursor,pointer,inner,outer"],
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
fn a_negative_number_is_a_number_however_it_is_given() {
    assert_eq!(picture(&["--hand", "-1,2,3"]), picture(&["--hand=-1,2,3"]));
}

#[test]
fn extreme_arms_are_drawn() {
    for arguments in [
        ["--hand", "3e38,3e38,-3e38", "--upper", "3e38"],
        ["--hand", "0,0,0", "--upper", "300"],
        ["--hand", "1e-38,0,0", "--lower", "1e-30"],
        ["--root", "1e30,0,-1e30", "--elbow-spin", "1e30"],
    ] {
        picture(&arguments);
    }
}

#[test]
fn an_argument_that_means_nothing_is_a_usage_error_that_says_what_would_be_right() {
    for (arguments, right) in [
        (["--size", "0x10"], "each side 1 to 8192"),
        (["--size", "8193x10"], "each side 1 to 8192"),
        (["--size", "800"], "1280x800"),
        (["--hand", "1,2"], "three numbers"),
        (["--hand", "1,2,x"], "three numbers"),
        (["--hand", "nan,0,0"], "three numbers"),
        (["--root", "1e39,0,0"], "three numbers"),
        (["--elbow-spin", "inf"], "number"),
        (["--upper", "0"], "above 0"),
        (["--lower", "-3"], "above 0"),
        (["--guides", "cursor,elbow"], "cursor, pointer, inner, outer"),
        (["--guides", ""], "cursor, pointer, inner, outer"),
        (["--view", "left"], "perspective"),
        (["--theme", "blue"], "dark"),
        (["--frames", "5"], "--timings"),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let output = render(&folder.path().join("arm.png"), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(complaint(&output).contains(right), "{arguments:?}: {}", complaint(&output));
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "{arguments:?}");
    }
    assert_eq!(ik_arm(&["render"]).status.code(), Some(2), "no output and no timings");
}

#[test]
fn a_picture_that_cannot_be_written_is_an_error_that_names_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    for out in [folder.path().join("missing/arm.png"), folder.path().to_owned()] {
        let output = render(&out, &[]);
        assert_eq!(output.status.code(), Some(1));
        let named = out.to_str().expect("a path in UTF-8");
        assert!(complaint(&output).contains(named), "{}", complaint(&output));
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
    let output = ik_arm(&["render", "--size", "64x64", "--frames", "3", "--timings"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let line: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(line["frames"], 3);
    let milliseconds = |name: &str| line[name].as_f64().expect("a number");
    assert!(milliseconds("frame_ms_median") >= milliseconds("cpu_ms_median"));
    assert!(milliseconds("cpu_ms_median") > 0.0);
    assert!(!line["adapter"].as_str().expect("a name").is_empty());
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
    assert!(complaint(&output).contains("mesa-vulkan-drivers"), "{}", complaint(&output));
    assert!(!out.exists());
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_display_it_points_to_render() {
    for arguments in [&[][..], &["gui"]] {
        let output = ik_arm(arguments);
        assert_eq!(output.status.code(), Some(1));
        assert!(complaint(&output).contains("ik-arm render"), "{}", complaint(&output));
        assert!(!complaint(&output).contains(".cargo"), "{}", complaint(&output));
    }
}
