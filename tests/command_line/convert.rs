//! `ik-arm convert` and `ik-arm pose --list`, as a person runs them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use ik_arm::io::{self, Example, OpenOptions};
use serde_json::Value;
use tempfile::TempDir;

use crate::run;

struct Desk(TempDir);

impl Desk {
    /// With an example as `NAME.json`.
    fn with(name: &str) -> Self {
        let folder = TempDir::new().expect("a folder");
        let text = Example::find(name).expect("there").text;
        fs::write(folder.path().join(format!("{name}.json")), text).expect("written");
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn convert(&self, from: &str, to: &str, more: &[&str]) -> Output {
        let (from, to) = (self.path(from), self.path(to));
        let both = ["convert", path(&from), "-o", path(&to)];
        run(&[&both, more].concat())
    }
}

fn path(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn list(file: &Path, more: &[&str]) -> Value {
    let output = run(&[&["pose", path(file), "--list"], more].concat());
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

#[test]
fn a_file_of_another_program_becomes_a_document_and_goes_on_from_there() {
    let desk = Desk::with("walk");
    for (from, to) in [
        ("walk.json", "walk.glb"),
        ("walk.glb", "back.json"),
        ("back.json", "back.bvh"),
        ("back.bvh", "again.json"),
    ] {
        let output = desk.convert(from, to, &[]);
        assert!(output.status.success(), "{from} → {to}: {output:?}");
    }
    let opened = |name: &str| {
        io::open(&desk.path(name), &OpenOptions::default()).expect("it opens").document
    };
    let (glb, document) = (opened("walk.glb"), opened("back.json"));
    assert_eq!((document.keys, document.timeline), (glb.keys, glb.timeline));
    let (before, after) = (opened("walk.json"), opened("again.json"));
    let reach = before.rig.reach();
    let end = before.timeline.end;
    for time in [0.0, 0.5 * end, end] {
        let at = |document: &ik_arm::document::Document, scale: f32| {
            let skeleton = document.at(time).skeleton().clone();
            let hand = skeleton.find("left_hand").expect("a joint");
            skeleton.base(hand) * scale
        };
        let (was, is) = (at(&before, 1.0), at(&after, 0.01));
        assert!(was.distance(is) < 1e-4 * reach, "{time}: {was} and {is}");
    }
}

#[test]
fn what_cannot_be_converted_is_a_usage_error() {
    let desk = Desk::with("walk");
    for (to, more, said) in [
        ("a.csv", [].as_slice(), "OUT must end in .json, .glb or .bvh"),
        ("a", &[], "OUT must end in .json, .glb or .bvh"),
        ("a.json", &["--fps", "20"], "--fps does not apply"),
        ("a.glb", &["--unit", "m"], "--unit does not apply"),
        ("a.glb", &["--add-targets"], "--add-targets does not apply"),
        ("a.glb", &["--fps", "0"], "frames per second must be a number like 29.97"),
    ] {
        let output = desk.convert("walk.json", to, more);
        assert_eq!(output.status.code(), Some(2), "{to} {more:?}");
        let error = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(error.contains(said), "{error}");
        assert!(!desk.path(to).exists());
    }
    let output = desk.convert("walk.json", "a.glb", &["--animation", "Run"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).expect("UTF-8").contains("has no animation \"Run\""));
}

#[test]
fn a_person_of_another_program_gets_targets() {
    let desk = Desk::with("walk");
    assert!(desk.convert("walk.json", "walk.bvh", &[]).status.success());
    let output = desk.convert("walk.bvh", "posed.json", &["--add-targets"]);
    assert!(output.status.success(), "{output:?}");
    let targets = list(&desk.path("posed.json"), &[])["targets"].clone();
    assert_eq!(targets.as_array().map(Vec::len), Some(5), "{targets}");
    let walk = desk.path("walk.bvh");
    let goal = ["--add-targets", "--time", "0.4", "--target", "left_forearm=30,120,20"];
    let output = run(&[&["pose", path(&walk)], goal.as_slice()].concat());
    assert!(output.status.success(), "{output:?}");
    let posed: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let errors: Vec<_> = posed["targets"].as_array().expect("a list").iter().collect();
    assert_eq!(errors.len(), 5);
    assert!(errors.iter().all(|it| it["error"].as_f64() < Some(0.1)), "{errors:?}");

    let desk = Desk::with("snake");
    let output = desk.convert("snake.json", "posed.json", &["--add-targets"]);
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(
        error.contains("found head, but no left arm, right arm, left leg or right leg"),
        "{error}"
    );
    assert!(!desk.path("posed.json").exists());
}

#[test]
fn a_list_tells_skeletons_animations_and_targets() {
    let desk = Desk::with("human");
    let told = list(&desk.path("human.json"), &[]);
    assert_eq!(told["skeletons"][0]["joints"], 49);
    assert_eq!(told["animations"], serde_json::json!([]));
    assert_eq!(told["targets"].as_array().expect("a list").len(), 5);

    let desk = Desk::with("walk");
    assert!(desk.convert("walk.json", "walk.glb", &[]).status.success());
    let told = list(&desk.path("walk.glb"), &[]);
    assert_eq!(told["skeletons"][0]["name"], "Armature");
    let animation = &told["animations"][0];
    assert_eq!((&animation["start"], &animation["open"]), (&0.0.into(), &true.into()));
    assert!(animation["moving_joints"].as_u64() > Some(5), "{animation}");
    let told = list(&desk.path("walk.glb"), &["--animation", "0"]);
    assert_eq!(told["animations"][0]["open"], true);
}

#[test]
fn a_list_tells_the_joints_of_all_skeletons_and_a_document_keeps_the_name_of_its_animation() {
    let desk = Desk::with("walk");
    let figures = serde_json::json!({
        "asset": { "version": "2.0" },
        "nodes": [{ "name": "a", "children": [1] }, { "name": "b" }, { "name": "c" }],
        "skins": [{ "name": "long", "joints": [0, 1] }, { "name": "short", "joints": [2] }],
    });
    std::fs::write(desk.path("two.gltf"), figures.to_string()).expect("written");
    let told = |more: &[&str]| list(&desk.path("two.gltf"), more)["skeletons"].clone();
    let of = |open: [bool; 2]| {
        serde_json::json!([
            { "name": "long", "joints": 2, "open": open[0] },
            { "name": "short", "joints": 1, "open": open[1] },
        ])
    };
    assert_eq!(told(&[]), of([true, false]));
    assert_eq!(told(&["--skeleton", "short"]), of([false, true]));

    let walk = ik_arm::io::open(&desk.path("walk.json"), &ik_arm::io::OpenOptions::default());
    let mut walk = walk.expect("it opens").document;
    walk.animation_name = Some("Stroll".to_owned());
    ik_arm::io::save(&walk, &desk.path("stroll.json")).expect("saved");
    assert!(desk.convert("stroll.json", "stroll.glb", &[]).status.success());
    assert!(desk.convert("stroll.glb", "again.json", &[]).status.success());
    for file in ["stroll.glb", "again.json"] {
        assert_eq!(list(&desk.path(file), &[])["animations"][0]["name"], "Stroll", "{file}");
    }
}
