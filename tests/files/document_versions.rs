//! Files of version 1 open as files of version 2 with the same content, and are saved as version 2.

use std::fs;
use std::path::{Path, PathBuf};

use ik_arm::document::TwistReferenceKind;
use ik_arm::io::{self, Opened};
use ik_arm::kinematics::chain_ik::Root;
use ik_arm::kinematics::limb_ik::ElbowReference;

use crate::common::damage::message;

const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

fn open(path: &Path) -> Opened {
    io::open(path, &io::OpenOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Files of version 1, each with the file of version 2 that has the same content: an example, an
/// example as it was, or a saved document.
fn versions() -> Vec<(PathBuf, PathBuf)> {
    let data = Path::new(FOLDER).join("tests/data");
    let mut files = Vec::new();
    for folder in ["", "hard"] {
        for file in fs::read_dir(data.join("version-1").join(folder)).expect("a folder") {
            let path = file.expect("a file").path();
            let Some(name) = path.file_name().filter(|_| path.is_file()) else {
                continue;
            };
            let asset = Path::new(FOLDER).join("assets").join(folder).join(name);
            let saved = data.join("version-2").join(name);
            let former = data.join("version-2").join("assets").join(name);
            let same = [former, asset, saved].into_iter().find(|path| path.is_file());
            files.push((path.clone(), same.expect("a file of version 2")));
        }
    }
    files
}

#[test]
fn a_file_of_version_1_opens_as_the_same_document_and_is_saved_as_version_2() {
    let versions = versions();
    assert_eq!(versions.len(), 18 + 6);
    for (first, second) in versions {
        let name = first.display();
        let text = fs::read_to_string(&first).expect("text");
        assert!(text.contains("\"version\": 1,"), "{name}");
        let (first, second) = (open(&first), open(&second));
        assert_eq!(first, second, "{name}");
        assert_eq!(first.warnings, [], "{name}");
        let [first, second] =
            [first, second].map(|opened| io::to_json(&opened.document).expect("finite numbers"));
        // Texts, because equal numbers may differ in the sign of 0.
        assert_eq!(first, second, "{name}");
        assert!(first.contains("\"version\": 2,"), "{name}");
    }
}

#[test]
fn a_saved_document_of_version_2_is_saved_as_the_same_text() {
    for (_, path) in versions() {
        if path.parent().is_some_and(|folder| folder.ends_with("version-2")) {
            let text = fs::read_to_string(&path).expect("text");
            let json = io::to_json(&open(&path).document).expect("finite numbers");
            assert_eq!(without_paths(&json), without_paths(&text), "{}", path.display());
        }
    }
}

/// The lines of a document but those of `follow_path`, which became a list.
fn without_paths(text: &str) -> Vec<&str> {
    let mut is_path = false;
    let is_other = |line: &&str| {
        if line.starts_with("  \"") {
            is_path = line.starts_with("  \"follow_path\"");
        }
        !is_path
    };
    text.lines().filter(is_other).collect()
}

/// The targets of older files posed nothing by themselves: their influence is 0 unless a file says
/// otherwise.
#[test]
fn skeletons_of_older_files_have_the_pose_of_their_joint_angles() {
    let mut skeletons = 0;
    for (path, _) in versions() {
        let document = open(&path).document;
        for time in [0.0, 0.7, 2.0] {
            let rig = document.at(time).into_document().skeleton_rig;
            let evaluated = rig.evaluate(time);
            assert_eq!(evaluated.solved, evaluated.fk, "{}", path.display());
            if rig.follow_paths.is_empty() {
                assert_eq!(evaluated.fk, rig.skeleton, "{}", path.display());
            }
            skeletons += rig.targets.len();
        }
    }
    assert!(skeletons > 20, "{skeletons}");
}

#[test]
fn a_root_that_older_files_call_fixed_turns() {
    for version in [1, 2] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("fixed.json");
        let text = format!(
            "{{\"format\":\"ik-arm\",\"version\":{version},\"rig\":\"skeleton\",\
             \"solver\":{{\"root\":\"fixed\"}}}}"
        );
        fs::write(&path, text).expect("written");
        let Opened { document, warnings, .. } = open(&path);
        assert_eq!((document.skeleton_rig.solver.root, warnings), (Root::Turns, vec![]));
        assert!(io::to_json(&document).expect("finite numbers").contains("\"root\": \"turns\""));
    }
}

#[test]
fn the_reference_up_is_read_by_its_former_name_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let documents = ["limb", "up"].map(|name| {
        let path = folder.path().join("reference.json");
        let text = format!(
            "{{\"format\":\"ik-arm\",\"version\":2,\"rig\":\"skeleton\",\
             \"arm\":{{\"twist_reference\":{{\"kind\":\"{name}\"}}}},\
             \"skeleton\":{{\"joints\":[{{\"name\":\"a\",\"axis\":[1,0,0]}},\
             {{\"name\":\"b\",\"parent\":0,\"axis\":[1,0,0]}}]}},\
             \"targets\":[{{\"joint\":1,\"home\":[1,1,0],\"limb\":{{\"reference\":\"{name}\"}}}}]}}"
        );
        fs::write(&path, text).expect("written");
        let Opened { document, warnings, .. } = open(&path);
        assert_eq!(warnings, []);
        document
    });
    let [former, document] = &documents;
    assert_eq!(former, document);
    assert_eq!(document.arm.twist_reference, TwistReferenceKind::Up);
    let limb = document.skeleton_rig.targets[0].limb().expect("a limb");
    assert_eq!(limb.reference, ElbowReference::Up);
    let saved = io::to_json(document).expect("finite numbers");
    assert!(saved.contains("\"kind\": \"up\"") && saved.contains("\"reference\": \"up\""));
}

fn version_1(fields: &str) -> String {
    format!("{{\"format\":\"ik-arm\",\"version\":1,\"rig\":\"arm\",\n{fields}}}")
}

#[test]
fn errors_and_warnings_have_the_positions_of_the_file() {
    for (fields, expected) in [
        (
            "\"arm\":{\"elbow_spin\":0,\"softening\":{\"softness\":1}}",
            "line 2, column 47: arm.soft_reach.softness: must be from 0 to less than 1, got 1",
        ),
        (
            "\"arm\":{\"weight\":\"1\"}",
            "line 2, column 17: arm.influence: invalid type: string \"1\", expected a number",
        ),
        (
            "\"arm\":{\"swivel\":{\"carried\":{\"direction\":[1,0,0],\"outward\":[1,0,0]}}}",
            "line 2, column 59: arm.twist_reference.transported.outward: must be perpendicular to \
             `direction`, got [1, 0, 0]",
        ),
        (
            "\"keys\":[{\"channel\":\"elbow_spin\",\"knots\":[[0,1,2]]}]",
            "line 2, column 42: channels[0].keys[0]: must have one number after the time, got 2",
        ),
        ("\"arm\":{\"weight\":1,}", "line 2, column 19: arm: not JSON: trailing comma"),
    ] {
        let error = io::parse("1.json", &version_1(fields), &io::OpenOptions::default())
            .expect_err("refused");
        assert_eq!(message(error), format!("1.json, {expected}"), "{fields}");
    }
    let text = version_1("\"arm\":{\"weight\":1,\n \"wrist\":{\"roll\":0,\"elbow_spin\":1}}");
    let warnings = io::parse("1.json", &text, &io::OpenOptions::default()).expect("opens").warnings;
    let expected = "line 3, column 33: arm.hand_orientation.elbow_spin: unknown field, ignored";
    assert_eq!(warnings.iter().map(ToString::to_string).collect::<Vec<_>>(), [expected]);
}

#[test]
fn a_name_of_version_1_in_a_file_of_version_2_is_unknown_and_the_warning_has_the_new_name() {
    let text = "{\"format\":\"ik-arm\",\"version\":2,\"rig\":\"arm\",\n\"arm\":{\"elbow_spin\":1,\n\
                \"twist_reference\":{\"carried\":{}}},\"keys\":[]}";
    let opened = io::parse("2.json", text, &io::OpenOptions::default()).expect("opens");
    assert_eq!(opened.document.arm.twist, 0.0);
    let warnings: Vec<_> = opened.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        warnings,
        [
            "line 2, column 21: arm.elbow_spin: unknown field, ignored; version 2 calls it `twist`",
            "line 3, column 30: arm.twist_reference.carried: unknown field, ignored; version 2 calls \
             it `transported`",
            "line 3, column 42: keys: unknown field, ignored; version 2 calls it `channels`",
        ]
    );
}

#[test]
fn every_field_of_a_saved_document_is_documented() {
    fn fields(value: &serde_json::Value, names: &mut std::collections::BTreeSet<String>) {
        match value {
            serde_json::Value::Object(object) => {
                names.extend(object.keys().cloned());
                object.values().for_each(|value| fields(value, names));
            }
            serde_json::Value::Array(array) => array.iter().for_each(|value| fields(value, names)),
            _ => {}
        }
    }
    let docs = fs::read_to_string(Path::new(FOLDER).join("docs/files.md")).expect("text");
    let (documents, _) = docs.split_once("## Version 1").expect("a heading");
    let mut names = std::collections::BTreeSet::new();
    for (_, path) in versions() {
        let json = io::to_json(&open(&path).document).expect("finite numbers");
        fields(&serde_json::from_str(&json).expect("JSON"), &mut names);
    }
    assert!(names.len() > 60, "{names:?}");
    for name in names {
        let is_documented =
            documents.contains(&format!("`{name}`")) || documents.contains(&format!(".{name}`"));
        assert!(is_documented, "{name}");
    }
}

#[test]
fn the_example_in_the_documentation_opens_without_a_warning() {
    let docs = fs::read_to_string(Path::new(FOLDER).join("docs/files.md")).expect("text");
    let (_, example) = docs.split_once("```json\n").expect("an example");
    let (example, _) = example.split_once("```").expect("its end");
    assert_eq!(
        io::parse("files.md", example, &io::OpenOptions::default()).expect("opens").warnings,
        []
    );
}
