//! Files of earlier releases open, and are saved as they were. Files of version 1 are refused.

use crate::common::arm::ArmDocument;
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
fn a_document_of_version_2_is_saved_as_version_3_and_opens_as_the_same() {
    for path in former_documents() {
        let document = open(&path).document;
        let json = io::to_json(&document).expect("finite numbers");
        assert!(json.contains("\"version\": 3"));
        let again = io::parse("again.json", &json, &io::OpenOptions::default()).expect("opens");
        assert_eq!((&again.document, again.warnings), (&document, vec![]), "{}", path.display());
    }
}

/// What a former document says, as JSON.
fn said(path: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(path).expect("text")).expect("JSON")
}

#[test]
fn the_arm_of_a_former_document_has_its_hand_twist_and_lengths() {
    let mut arms = 0;
    for path in former_documents() {
        let said = said(&path);
        if said["rig"] != "arm" {
            continue;
        }
        arms += 1;
        let arm = open(&path).document.arm();
        let said = said["arm"].as_object().expect("an arm");
        for (field, found) in [
            ("cursor", arm.cursor.in_root.to_array().to_vec()),
            ("root", arm.root.to_array().to_vec()),
            ("upper", vec![arm.bones.upper()]),
            ("lower", vec![arm.bones.lower()]),
            ("twist", vec![arm.twist]),
        ] {
            let Some(said) = said.get(field) else { continue };
            let one = std::slice::from_ref(said);
            let numbers = said.as_array().map_or(one, Vec::as_slice).iter();
            let expected: Vec<_> =
                numbers.map(|it| it.as_f64().expect("a number") as f32).collect();
            // A twist of a million turns has no angle in f32.
            let is_extreme = field == "twist" && expected[0].abs() > 1e7;
            assert!(found == expected || is_extreme, "{field} of {}", path.display());
        }
    }
    assert!(arms >= 3, "{arms}");
}

/// The targets of older files posed nothing by themselves: their influence is 0 unless a file says
/// otherwise.
#[test]
fn skeletons_of_older_files_have_the_pose_of_their_joint_angles() {
    let mut skeletons = 0;
    for path in former_documents().into_iter().filter(|path| said(path)["rig"] == "skeleton") {
        let document = open(&path).document;
        for time in [0.0, 0.7, 2.0] {
            let rig = document.at(time).into_document().rig;
            let evaluated = rig.evaluate(time);
            assert_eq!(evaluated.solved, evaluated.fk, "{}", path.display());
            if rig.follow_paths.is_empty() {
                assert_eq!(evaluated.fk, rig.skeleton, "{}", path.display());
            }
            skeletons += rig.targets.len();
        }
    }
    assert!(skeletons > 0, "{skeletons}");
}

#[test]
fn a_root_that_older_files_call_fixed_turns() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("fixed.json");
    let text = "{\"format\":\"ik-arm\",\"version\":2,\"rig\":\"skeleton\",\
                \"solver\":{\"root\":\"fixed\"}}";
    fs::write(&path, text).expect("written");
    let Opened { document, warnings, .. } = open(&path);
    assert_eq!((document.rig.solver.root, warnings), (Root::Turns, vec![]));
    assert!(io::to_json(&document).expect("finite numbers").contains("\"root\": \"turns\""));
}

#[test]
fn the_reference_up_is_read_by_its_former_name_too() {
    let named = |name: &str, rig: &str| {
        let text = format!("{{\"format\":\"ik-arm\",\"version\":2,{rig}}}").replace("NAME", name);
        let Opened { document, warnings, .. } =
            io::parse("former.json", &text, &io::OpenOptions::default()).expect("it opens");
        assert_eq!(warnings, []);
        document
    };
    let arm = r#""rig":"arm","arm":{"twist_reference":{"kind":"NAME"}}"#;
    let skeleton = r#""rig":"skeleton","skeleton":{"joints":[{"name":"a","axis":[1,0,0]},
        {"name":"b","parent":0,"axis":[1,0,0]}]},
        "targets":[{"joint":1,"home":[1,1,0],"limb":{"reference":"NAME"}}]"#;
    for rig in [arm, skeleton] {
        let document = named("up", rig);
        assert_eq!(named("limb", rig), document);
        let limb = document.rig.targets[0].limb().expect("a limb");
        assert_eq!(limb.reference, TwistReferenceKind::Up);
        assert!(io::to_json(&document).expect("finite numbers").contains("\"reference\": \"up\""));
    }
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
