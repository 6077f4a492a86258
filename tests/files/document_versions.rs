//! Files of earlier releases open, and are saved as they were. Files of version 1 are refused.

use std::fs;
use std::path::{Path, PathBuf};

use ik_arm::document::TwistReferenceKind;
use ik_arm::io::{self, Opened};
use ik_arm::kinematics::chain_ik::Root;

use crate::common::damage::message;

const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

fn open(path: &Path) -> Opened {
    io::open(path, &io::OpenOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Documents of earlier releases.
fn former_documents() -> Vec<PathBuf> {
    documents_in(&["tests/data/version-2", "tests/data/version-2/assets"])
}

fn documents_in(folders: &[&str]) -> Vec<PathBuf> {
    let files = folders.iter().flat_map(|folder| {
        fs::read_dir(Path::new(FOLDER).join(folder))
            .expect("a folder")
            .map(|it| it.expect("a file"))
    });
    let paths = files.map(|file| file.path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "json")).collect()
}

#[test]
fn a_file_of_version_1_is_refused_with_the_version_that_is_read() {
    let text = "{\"format\":\"ik-arm\",\n\"version\":1,\"rig\":\"arm\",\"arm\":{\"elbow_spin\":1}}";
    let error =
        io::parse("1.json", text, &io::OpenOptions::default()).expect_err("a former version");
    let expected =
        "1.json, line 2, column 11: version: must be 2 or 3, the versions that are read, got 1";
    assert_eq!(message(error), expected);
}

#[test]
fn a_document_of_version_2_is_saved_as_the_same_text_of_version_3() {
    for path in documents_in(&["tests/data/version-2"]) {
        let text = fs::read_to_string(&path).expect("text");
        let json = io::to_json(&open(&path).document).expect("finite numbers");
        let text = text.replacen("\"version\": 2", "\"version\": 3", 1);
        assert_eq!(without_paths(&json), without_paths(&text), "{}", path.display());
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
    for path in former_documents() {
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
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("fixed.json");
    let text = "{\"format\":\"ik-arm\",\"version\":2,\"rig\":\"skeleton\",\
                \"solver\":{\"root\":\"fixed\"}}";
    fs::write(&path, text).expect("written");
    let Opened { document, warnings, .. } = open(&path);
    assert_eq!((document.skeleton_rig.solver.root, warnings), (Root::Turns, vec![]));
    assert!(io::to_json(&document).expect("finite numbers").contains("\"root\": \"turns\""));
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
    assert_eq!(limb.reference, TwistReferenceKind::Up);
    let saved = io::to_json(document).expect("finite numbers");
    assert!(saved.contains("\"kind\": \"up\"") && saved.contains("\"reference\": \"up\""));
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
    let (described, _) = docs.split_once("# Scotty3D").expect("a heading");
    let mut names = std::collections::BTreeSet::new();
    let former = former_documents().into_iter().map(|path| open(&path));
    let examples = io::Example::ALL.into_iter().map(|example| example.open().expect("opens"));
    for opened in former.chain(examples) {
        let json = io::to_json(&opened.document).expect("finite numbers");
        fields(&serde_json::from_str(&json).expect("JSON"), &mut names);
    }
    assert!(names.len() > 60, "{names:?}");
    for name in names {
        let is_documented =
            described.contains(&format!("`{name}`")) || described.contains(&format!(".{name}`"));
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
