//! The program's own files: round trips, and errors with their positions.

use crate::common::arm::{Arm, ArmDocument, Cursor};
use std::fs;

use glam::Vec3;
use ik_arm::document::{Camera, Channel, Document, Overlay, Timeline};
use ik_arm::io::{self, Example, ExampleGroup, Opened};
use ik_arm::kinematics::chain_ik::{Root, SolverOptions};
use ik_arm::kinematics::skeleton::{Joint, JointId};
use ik_arm::kinematics::spline::{Interpolation, Knot, Slopes};

use crate::common::damage::{message, mutations};
use crate::common::documents::example;
use crate::common::{Random, documents};

fn open(text: &str) -> Opened {
    io::parse("test.json", text, &io::OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn with(fields: &str) -> String {
    format!("{{\"format\":\"ik-arm\",\"version\":3,\n{fields}}}")
}

fn refusal(text: &str) -> String {
    message(io::parse("test.json", text, &io::OpenOptions::default()).expect_err("it is refused"))
}

// Writing and reading again

#[test]
fn every_document_is_read_again_bit_for_bit() {
    for seed in 0..500 {
        let document = documents::document(&mut Random(seed));
        let json = io::to_json(&document).expect("it is written");
        let opened = open(&json);
        assert_eq!(opened.document, document, "{json}");
        assert_eq!(opened.warnings, []);
        assert_eq!(opened.order, document.skeleton().ids().collect::<Vec<_>>());
        // Equal numbers may differ in the sign of 0; their texts do not.
        assert_eq!(io::to_json(&opened.document).expect("written"), json);
    }
}

#[test]
fn a_minus_zero_keeps_its_sign() {
    let mut document = Document::default();
    document.edit_arm(|arm| arm.cursor = Cursor::unpinned(Vec3::new(-0.0, 1.0, 0.0)));
    document
        .skeleton_mut()
        .change(JointId::new(0), |root| root.rotation.y = -0.0)
        .expect("possible");
    let opened = open(&io::to_json(&document).expect("written")).document;
    assert!(
        opened.arm().cursor_in_root().x.is_sign_negative()
            && opened.arm().cursor_in_root().z.is_sign_positive()
    );
    assert!(opened.skeleton().joints()[0].rotation.y.is_sign_negative());
}

#[test]
fn a_document_with_a_number_that_is_not_finite_is_not_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = Document::default();
    document.camera.yaw = f32::NAN;
    let error = io::save(&document, &folder.path().join("x.json")).expect_err("refused");
    assert_eq!(error.to_string(), "the document cannot be written: number must be finite, got NaN");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[test]
fn a_file_is_formatted_for_human_readers() {
    let json = io::to_json(&Document::default()).expect("written");
    assert!(
        json.starts_with("{\n  \"format\": \"ik-arm\",\n  \"version\": 3,\n  \"skeleton\": {\n")
    );
    assert!(json.contains("\n    \"home\": [250.0, 120.0, 60.0],\n"), "{json}");
    assert!(json.contains("\n    \"joints\": [{\n      \"name\": \"root\",\n"), "{json}");
    assert!(json.ends_with("]\n}\n"));
}

// Files written by hand

#[test]
fn fields_left_out_have_their_defaults() {
    let small = "{\"format\":\"ik-arm\",\"version\":3,\"rig\":\"arm\"}";
    assert_eq!(open(small).document, Document::default());
}

#[test]
fn joints_need_only_a_name_and_sit_on_their_parents_tips() {
    let opened = open(&with(
        r#""skeleton":{"joints":[{"name":"a","axis":[0,1,0]},{"name":"b","parent":0,"axis":[0,2,0]},
           {"name":"c","parent":1},{"name":"d","parent":0,"offset":[0,0,0]}]}"#,
    ));
    let rig = &opened.document.rig;
    let base = |joint| rig.skeleton.base(joint);
    assert_eq!(
        [
            base(JointId::new(0)),
            base(JointId::new(1)),
            base(JointId::new(2)),
            base(JointId::new(3))
        ]
        .map(|base| base.y),
        [0.0, 1.0, 3.0, 0.0]
    );
    assert_eq!(*rig.skeleton.joints()[0], Joint::new("a", None, Vec3::Y));
    assert_eq!(rig.skeleton.joints()[1].radius, 0.2);
    assert_eq!((rig.targets.len(), rig.solver), (0, SolverOptions::default()));
}

#[test]
fn a_file_without_a_camera_shows_the_whole_skeleton() {
    let opened =
        open(&with(r#""skeleton":{"joints":[{"name":"a","offset":[50,0,0],"axis":[0,0.01,0]}]}"#));
    let Camera { target, distance, .. } = opened.document.camera;
    assert!(target.distance(Vec3::new(50.0, 0.005, 0.0)) < 1e-5);
    assert!((0.005..0.1).contains(&distance), "{distance}");
}

#[test]
fn a_byte_order_mark_is_accepted() {
    assert_eq!(open(&format!("\u{feff}{}", with("\"targets\":[]"))).warnings, []);
}

#[test]
fn unknown_fields_and_angles_outside_limits_only_warn() {
    let opened = open(&with(concat!(
        "\"colour\":{\"a\":[[[]]]},\n",
        "\"skeleton\":{\"joints\":[{\"name\":\"a\",\"rotation\":[1,0,0],\n",
        "  \"limits\":{\"x\":[0,0.5],\"w\":3}}]},\n",
        " \"camera\":{\"fov\":  90}"
    )));
    let warnings: Vec<_> = opened.warnings.iter().map(ToString::to_string).collect();
    let unknown = "unknown field, ignored";
    assert_eq!(
        warnings,
        [
            format!("line 2, column 10: colour: {unknown}"),
            format!("line 4, column 29: skeleton.joints[0].limits.w: {unknown}"),
            format!("line 5, column 20: camera.fov: {unknown}"),
            "line 3, column 46: skeleton.joints[0].rotation: must be within the joint's limits; clamped"
                .to_owned(),
        ]
    );
    assert_eq!(opened.document.skeleton().joints()[0].rotation.x, 0.5);
}

#[test]
fn only_the_first_of_many_warnings_are_listed() {
    let unknown: Vec<_> = (0..5000).map(|n| format!("\"u{n}\":0")).collect();
    let warnings = open(&with(&unknown.join(",\n"))).warnings;
    assert_eq!(warnings.len(), 21);
    assert_eq!(warnings[19].field, "u19");
    assert_eq!(warnings[20].reason, "and 4980 more like this");
}

// Files that are refused

#[test]
fn a_file_that_is_no_document_is_refused_with_the_reason() {
    for (text, expected) in [
        ("", "line 1, column 1: the file is empty"),
        ("  \n ", "line 2, column 2: the file is empty"),
        ("hello", "line 1, column 1: not JSON: expected value"),
        ("[1]", "line 1, column 1: invalid type: sequence, expected an object: {…}"),
        (
            "{\"a\":1}",
            "line 1, column 1: must have \"format\" (a document of ik-arm), \"scene\" (a .js3d file of \
             Scotty3D) or \"asset\" (glTF)",
        ),
        (
            "{\n\"format\":\"png\",\"version\":3}",
            "line 2, column 10: format: must be \"ik-arm\", got \"png\"",
        ),
        (
            "{\"format\":\"ik-arm\",\n \"version\": 4, \"rig\": {}}",
            "line 2, column 13: version: must be at most 3, got 4, which needs a newer ik-arm",
        ),
        (
            "{\"format\":\"ik-arm\",\"version\":0}",
            "line 1, column 30: version: must be 2 or 3, the versions that are read, got 0",
        ),
        ("{\"format\":\"ik-arm\"}", "line 1, column 1: missing field `version`"),
        (
            "{\"format\":\"ik-arm\",\"version\":\"1\"}",
            "line 1, column 30: version: invalid type: string \"1\", expected a whole number from 0 to \
             4294967295",
        ),
        (
            "{\"format\":\"ik-arm\",\"version\":2}",
            "line 1, column 1: must have `rig`, \"arm\" or \"skeleton\"",
        ),
        (
            "{\"format\":\"ik-arm\",\"version\":2,\"rig\":\"leg\"}",
            "line 1, column 38: rig: unknown variant `leg`, expected `arm` or `skeleton`",
        ),
    ] {
        assert_eq!(refusal(text), format!("test.json, {expected}"), "{text}");
    }
}

#[test]
fn a_json_error_has_its_position() {
    for (fields, expected) in [
        ("\"targets\":[,]", "line 2, column 12: targets[0]: not JSON: expected value"),
        ("\"arm\":{\"upper\":01}", "line 2, column 17: arm.upper: not JSON: invalid number"),
        ("\"arm\":{\"upper\":1,}", "line 2, column 18: arm: not JSON: trailing comma"),
        ("\"a\":nul", "line 2, column 8: a: not JSON: expected ident"),
    ] {
        assert_eq!(refusal(&with(fields)), format!("test.json, {expected}"), "{fields}");
    }
    let end = refusal(&format!("{} x", with("\"targets\":[]")));
    assert_eq!(end, "test.json, line 2, column 15: not JSON: trailing characters");
    let cut = refusal(with("\"targets\":[").trim_end_matches('}'));
    assert_eq!(cut, "test.json, line 2, column 11: targets: not JSON: EOF while parsing a list");
}

#[test]
fn a_field_of_the_wrong_type_is_named_with_the_expected_one() {
    for (fields, expected) in [
        ("\"arm\":[]", "line 2, column 7: arm: invalid type: sequence, expected an object: {…}"),
        (
            "\"arm\":{\"upper\": \"2\"}",
            "line 2, column 17: arm.upper: invalid type: string \"2\", expected a number",
        ),
        (
            "\"arm\":{\"root\":[1,\n2]}",
            "line 2, column 15: arm.root: found 2 numbers, expected three: [x, y, z]",
        ),
        (
            "\"arm\":{\"root\":[1,\n2,null]}",
            "line 3, column 3: arm.root[2]: invalid type: null, expected a number",
        ),
        (
            "\"arm\":{\"root\":[1,2,\n 1e39]}",
            "line 3, column 2: arm.root[2]: must be within ±3.4028235e38",
        ),
        (
            "\"skeleton\":{\"joints\":[\n[\"a\"]]}",
            "line 3, column 1: skeleton.joints[0]: invalid type: sequence, expected an object: {…}",
        ),
        (
            "\"skeleton\":{\"joints\":[\n{\"axis\":[0,1,0]}]}",
            "line 3, column 1: skeleton.joints[0]: missing field `name`",
        ),
        (
            "\"skeleton\":{\"joints\":[\n{\"name\":\"a\",\"parent\":-1}]}",
            "line 3, column 22: skeleton.joints[0].parent: invalid type: integer `-1`, expected a whole \
             number from 0 to 4294967295",
        ),
        (
            "\"skeleton\":{\"transform\":[1,2,3]}",
            "line 2, column 25: skeleton.transform: found 3 numbers, expected 12: […]",
        ),
        (
            "\"overlays\":[\"cursor\",\"elbow\"]",
            "line 2, column 22: overlays[1]: unknown variant `elbow`, expected one of `cursor`, \
             `pointer`, `inner_limit`, `outer_limit`, `elbow_circle`, `grid_xy`, `grid_xz`, \
             `grid_yz`, `ground`, `axes`, `labels`, `shadow`, `trail`, `paths`, `onion_skins`, \
             `singularity_globe`, `twist_references`, `cylinders`, `hand`, `frames`, `fk_pose`, \
             `by_itself`, `skin`, `bones`, `wireframe`, `skin_weights`, `compare_skinning`, \
             `stiffness`, `balance`, `reach_region`, `joint_limits`",
        ),
        ("\"targets\":[],\n\"targets\":[]", "line 3, column 9: duplicate field `targets`"),
    ] {
        assert_eq!(refusal(&with(fields)), format!("test.json, {expected}"), "{fields}");
    }
}

#[test]
fn an_invalid_value_of_a_former_arm_is_named_with_the_rule() {
    for (fields, expected) in [
        (
            "\"arm\":{\"lower\":-3}".to_owned(),
            "line 2, column 16: arm.lower: must be finite and above 0, got -3",
        ),
        (
            "\"arm\":{\"facing\":{\"direction\":[1,0,0],\"heading\":[0,1]}}".to_owned(),
            "line 2, column 48: arm.facing.heading: must be `direction` as seen from above, got \
             [0, 1]",
        ),
        (
            "\"arm\":{\"twist_reference\":{\"transported\":{\"direction\":[1,0,0],\"outward\":[1,0,0]}}}"
                .to_owned(),
            "line 2, column 72: arm.twist_reference.transported.outward: must be perpendicular to \
             `direction`, got [1, 0, 0]",
        ),
        (
            "\"arm\":{\"soft_reach\":{\"softness\":1}}".to_owned(),
            "line 2, column 33: arm.soft_reach.softness: must be from 0 to less than 1, got 1",
        ),
        (
            "\"arm\":{\"influence\":1.5}".to_owned(),
            "line 2, column 20: arm.influence: must be from 0 to 1, got 1.5",
        ),
        (
            "\"arm\":{\"fk\":{\"stretch\":0}}".to_owned(),
            "line 2, column 24: arm.fk.stretch: must be above 0, got 0",
        ),
        (
            "\"arm\":{\"facing\":{\"direction\":[2,0,0],\"heading\":[1,0]}}".to_owned(),
            "line 2, column 30: arm.facing.direction: must have length 1, got 2",
        ),
    ] {
        let text = with(&fields).replace("\"version\":3", "\"version\":2,\"rig\":\"arm\"");
        assert_eq!(refusal(&text), format!("test.json, {expected}"), "{fields}");
    }
}

#[test]
fn an_invalid_value_is_named_with_the_rule() {
    let joints = |joints: &str| format!("\"skeleton\":{{\"joints\":[\n{joints}]}}");
    let a = "{\"name\":\"a\",\"axis\":[0,1,0]}";
    let limit = "{\"name\":\"a\",\n\"limits\":{\"y\":[1,\n0]}}";
    let aimed = |target: &str| format!("{},\n\"targets\":[{target}]", joints(a));
    for (fields, expected) in [
        (
            joints(&format!("{a},\n{{\"name\":\"b\",\"parent\":1}}")),
            "line 4, column 22: skeleton.joints[1].parent: the parent of joint 1 must precede it, \
             got 1",
        ),
        (
            joints(&format!("{a},\n{a}")),
            "line 4, column 9: skeleton.joints[1].name: names of joints must be unique, got \"a\" twice",
        ),
        (
            joints("{\"name\": \" \"}"),
            "line 3, column 10: skeleton.joints[0].name: the name of a joint must not be empty",
        ),
        (
            joints("{\"name\":\"a\",\"radius\":-1}"),
            "line 3, column 22: skeleton.joints[0].radius: the radius of joint 0 must be finite \
             and 0 or more, got -1",
        ),
        (
            joints("{\"name\":\"a\",\"frame\":[2,0,0,0,1,0,0,0,1]}"),
            "line 3, column 21: skeleton.joints[0].frame: the frame of joint 0 must be a \
             right-handed orthonormal basis",
        ),
        (
            joints("{\"name\":\"a\",\"stiffness\":[0,1,0]}"),
            "line 3, column 25: skeleton.joints[0].stiffness: the stiffness of joint 0 must be 0 or \
             more and below 1, got [0, 1, 0]",
        ),
        (
            joints("{\"name\":\"a\",\"cone\":{\"x\":1,\"z\":3,\"twist\":[-1,1]}}"),
            "line 3, column 20: skeleton.joints[0].cone: the cone of joint 0 must have x and z above 0 \
             and at most 170°, and a finite twist, the lower bound first and at most a full turn wide, \
             and its middle at most 170° from the bone at rest; got x 57.29578°, z 171.88734°, twist \
             -57.29578° to 57.29578°, middle 0°",
        ),
        (
            joints(
                "{\"name\":\"a\",\"limits\":{\"x\":[0,1]},\"cone\":{\"x\":1,\"z\":1,\"twist\":[0,1]}}",
            ),
            "line 3, column 41: skeleton.joints[0].cone: must not have limits, too: a joint has a cone or \
             ranges of angles",
        ),
        (
            "\"solver\":{\"posture_rate\":-1}".to_owned(),
            "line 2, column 26: solver.posture_rate: must be 0 or more, got -1",
        ),
        (
            "\"solver\":{\"root_stiffness\":1}".to_owned(),
            "line 2, column 28: solver.root_stiffness: must be 0 or more and below 1, got 1",
        ),
        (
            "\"balance\":{\"influence\":1.5}".to_owned(),
            "line 2, column 24: balance.influence: must be from 0 to 1, got 1.5",
        ),
        (
            "\"balance\":{\"over\":\"hands\"}".to_owned(),
            "line 2, column 19: balance.over: must be \"feet\" or two numbers, x and z of a point",
        ),
        (
            joints(limit),
            "line 4, column 15: skeleton.joints[0].limits.y: the limit of joint 0 about y must be \
             finite, the lower bound first, got 1 to 0",
        ),
        (
            aimed("{\"joint\":1,\"home\":[0,0,0]}"),
            "line 4, column 21: targets[0].joint: must be 0, the only joint, got 1",
        ),
        (
            aimed("{\"joint\":0,\"home\":[0,0,0]},{\"home\":[1,1,1],\"joint\":0}"),
            "line 4, column 63: targets[1].joint: must have one target, got a second for joint 0",
        ),
        (
            aimed("{\"joint\":0,\"home\":[0,0,0],\"weight\":0}"),
            "line 4, column 47: targets[0].weight: must be above 0, or 0 with a rotation or an aim, got \
             0",
        ),
        (
            aimed("{\"joint\":0,\"home\":[0,0,0],\"motion\":{\"path\":\"circle\",\"period\":-1}}"),
            "line 4, column 73: targets[0].motion.period: must be above 0, got -1",
        ),
        (
            "\"solver\":{\"method\":\"newton\"}".to_owned(),
            "line 2, column 20: solver.method: must be one of transpose-fixed, transpose, dls, \
             ccd, fabrik, relaxation, two-bone, got \"newton\"",
        ),
        (
            "\"solver\":{\"iterations\":0}".to_owned(),
            "line 2, column 24: solver.iterations: must be 1 or more, or null for the \
             method's default, got 0",
        ),
        (
            "\"solver\":{\"iterations_per_frame\":1001}".to_owned(),
            "line 2, column 34: solver.iterations_per_frame: must be from 1 to 1000, got 1001",
        ),
        (
            "\"solver\":{\"damping\":0}".to_owned(),
            "line 2, column 21: solver.damping: must be above 0, got 0",
        ),
        (
            "\"follow_path\":{\"radius\":1,\"amplitude\":1,\"waves\":3,\"period\":0}".to_owned(),
            "line 2, column 60: follow_path.period: must be above 0, got 0",
        ),
        (
            "\"camera\":{\"pitch\":2}".to_owned(),
            "line 2, column 19: camera.pitch: must be from -1.5707964 to 1.5707964, got 2",
        ),
        (
            "\"camera\":{\"distance\":0}".to_owned(),
            "line 2, column 22: camera.distance: must be above 0, got 0",
        ),
    ] {
        assert_eq!(refusal(&with(&fields)), format!("test.json, {expected}"), "{fields}");
    }
}

#[test]
fn more_joints_than_a_skeleton_can_have_are_refused() {
    let joints = |count| {
        let joints: Vec<_> = (0..count).map(|n| format!("{{\"name\":\"{n}\"}}")).collect();
        with(&format!("\"skeleton\":{{\"joints\":[{}]}}", joints.join(",")))
    };
    assert_eq!(open(&joints(10_000)).order.len(), 10_000);
    let expected = "line 2, column 22: skeleton.joints: a skeleton must have at most 10000 joints";
    assert_eq!(refusal(&joints(10_001)), format!("test.json, {expected}"));
}

#[test]
fn invalid_utf_8_has_its_position() {
    let error = io::read("x.json", &b"{\n \"\xc3\xa9\":\"\xff\"}"[..], &io::OpenOptions::default())
        .expect_err("refused");
    let expected = "text must be UTF-8, got byte 0xff";
    assert_eq!(message(error), format!("x.json, line 2, column 7: {expected}"));
}

#[test]
fn deep_nesting_is_an_error_or_ignored_and_no_crash() {
    let deep = "[".repeat(1_000_000);
    for fields in [format!("\"x\":{deep}"), format!("\"skeleton\":{{\"joints\":{deep}")] {
        assert!(refusal(&with(&fields)).starts_with("test.json, line 2, column "));
    }
    let closed = format!("\"x\":{deep}{}", "]".repeat(1_000_000));
    assert_eq!(open(&with(&closed)).warnings[0].field, "x");
    refusal(&deep);
}

#[test]
fn a_text_that_is_in_memory_already_has_no_limit() {
    let document = Document::default();
    let text = io::to_json(&document).expect("written") + &" ".repeat(65 << 20);
    let parsed = io::parse("long", &text, &io::OpenOptions::default()).expect("it is read");
    assert_eq!(parsed.document, document);
    let error =
        io::read("long", text.as_bytes(), &io::OpenOptions::default()).expect_err("refused");
    assert_eq!(error.to_string(), "long must be at most 64 MB large");
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = folder.path().join("missing.json");
    let error = io::open(&missing, &io::OpenOptions::default()).expect_err("refused").to_string();
    assert!(error.starts_with(&format!("{} cannot be read: ", missing.display())), "{error}");

    let error =
        io::open(folder.path(), &io::OpenOptions::default()).expect_err("refused").to_string();
    assert!(error.contains(" cannot be read: "), "{error}");

    let huge = folder.path().join("huge.json");
    fs::File::create(&huge).and_then(|file| file.set_len((64 << 20) + 1)).expect("made");
    let error = io::open(&huge, &io::OpenOptions::default()).expect_err("refused").to_string();
    assert_eq!(error, format!("{} must be at most 64 MB large", huge.display()));
    let endless = io::read("endless", std::io::repeat(b' '), &io::OpenOptions::default())
        .expect_err("refused");
    assert_eq!(endless.to_string(), "endless must be at most 64 MB large");
}

#[test]
fn a_document_has_no_skeletons_to_choose_from() {
    let error =
        io::parse("a.json", &with("\"targets\":[]"), &io::OpenOptions::of_skeleton("Human"))
            .expect_err("refused");
    let expected = "a.json has no skeleton called \"Human\"; it has one skeleton, without a name";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn damaged_files_open_or_are_refused_and_never_crash() {
    for seed in 0..30 {
        let document = documents::document(&mut Random(seed));
        let json = io::to_json(&document).expect("written");
        for damaged in mutations(&json, &mut Random(seed), 40) {
            let _ = io::read("x", &*damaged, &io::OpenOptions::default()).map_err(message);
        }
    }
    for example in Example::ALL {
        for damaged in mutations(example.text, &mut Random(7), 150) {
            let _ = io::read("x", &*damaged, &io::OpenOptions::default()).map_err(message);
        }
    }
}

// Saving

#[test]
fn a_saved_document_is_opened_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.json");
    let document = documents::document(&mut Random(3));
    fs::write(&path, "before").expect("written");
    io::save(&document, &path).expect("saved");
    assert_eq!(io::open(&path, &io::OpenOptions::default()).expect("opened").document, document);
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing beside it");
}

#[test]
fn a_document_that_cannot_be_saved_names_the_file_and_leaves_it_unchanged() {
    let folder = tempfile::tempdir().expect("a folder");
    let nowhere = folder.path().join("no/arm.json");
    let error = io::save(&Document::default(), &nowhere).expect_err("refused").to_string();
    let parent = folder.path().join("no");
    let expected = format!("could not be written: there is no folder {}", parent.display());
    assert_eq!(error, format!("{} {expected}", nowhere.display()));

    let error = io::save(&Document::default(), folder.path()).expect_err("refused").to_string();
    assert!(error.starts_with(&format!("{} could not be written: ", folder.path().display())));
}

#[cfg(unix)]
#[test]
fn a_saved_file_keeps_its_permissions_and_a_link_stays_a_link() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    let folder = tempfile::tempdir().expect("a folder");
    let (path, link) = (folder.path().join("arm.json"), folder.path().join("link.json"));
    fs::write(&path, "before").expect("written");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).expect("set");
    symlink(&path, &link).expect("a link");

    io::save(&Document::default(), &link).expect("saved");

    assert!(link.symlink_metadata().expect("there").is_symlink());
    assert_eq!(path.metadata().expect("there").permissions().mode() & 0o777, 0o640);
    assert_eq!(
        io::open(&path, &io::OpenOptions::default()).expect("opened").document,
        Document::default()
    );
}

// Examples

#[test]
fn every_example_opens_without_a_warning_and_is_saved_unchanged() {
    for example in Example::ALL {
        let opened = example.open().unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(opened.warnings, [], "{}", example.name);
        let again = open(&io::to_json(&opened.document).expect("written"));
        assert_eq!(again.document, opened.document, "{}", example.name);
        let folder = match example.group {
            ExampleGroup::Basics => "assets",
            ExampleGroup::WhyNot => "assets/why",
            ExampleGroup::InsideSolver => "assets/inside",
            ExampleGroup::HardCases => "assets/hard",
        };
        let path = format!("{}/{folder}/{}.json", env!("CARGO_MANIFEST_DIR"), example.name);
        assert_eq!(fs::read_to_string(path).expect("named as its file"), example.text);
    }
}

#[test]
fn the_examples_hold_what_their_names_say() {
    let rig = |name| example(name).rig;
    let count = |name| (rig(name).skeleton.joints().len(), rig(name).targets.len());
    let arm = example("arm");
    assert_eq!(arm, Document::default());
    assert_eq!(count("two-targets"), (9, 2));
    assert_eq!(count("human"), (49, 5));
    assert_eq!(count("snake"), (24, 0));
    assert_eq!(count("ten-joints"), (10, 1));
    assert_eq!(count("degenerate"), (17, 5));
    let snake = rig("snake");
    assert!(!snake.follow_paths.is_empty() && snake.solver.root == Root::Free);
    let degenerate = rig("degenerate").skeleton;
    assert!(degenerate.transform().matrix3.determinant() < 0.0);
    assert!(degenerate.joints().iter().any(|joint| joint.axis == Vec3::ZERO));
}

#[test]
fn the_human_stands_on_the_ground_within_its_limits() {
    let human = example("human").rig;
    let joints = human.skeleton.joints();
    assert!(human.body_follows && joints[0].axis == Vec3::ZERO);
    assert!(joints.iter().filter(|joint| joint.limits.is_limited()).count() >= 12);
    let heights: Vec<_> = human.skeleton.pose().points().map(|point| point.y).collect();
    let highest = heights.iter().copied().fold(f32::MIN, f32::max);
    let lowest = heights.iter().copied().fold(f32::MAX, f32::min);
    assert!((1.7..1.8).contains(&highest) && (0.0..0.05).contains(&lowest), "{lowest} {highest}");
}

#[test]
fn the_snake_lies_in_an_s() {
    let snake = example("snake").rig;
    let posed = snake.skeleton_at(0.0).pose();
    let turn = |index: usize| {
        let (joint, next) = (JointId::new(index), JointId::new(index + 1));
        let (before, after) =
            (posed.tip(joint) - posed.base(joint), posed.tip(next) - posed.tip(joint));
        before.cross(after).y
    };
    let turns: Vec<_> = (0..23).map(turn).collect();
    let left = turns.iter().filter(|turn| **turn > 1e-4).count();
    let right = turns.iter().filter(|turn| **turn < -1e-4).count();
    assert!(left >= 5 && right >= 5, "{turns:?}");
}

// The arm

#[test]
fn a_target_is_at_its_pin_if_the_file_says_so() {
    let (home, pin) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0));
    for (fields, expected) in [
        ("", (home, false)),
        (r#","pin":[4,5,6]"#, (pin, false)),
        (r#","pin":[4,5,6],"pinned":true"#, (pin, true)),
        (r#","pin":[4,5,6],"pinned":false"#, (pin, false)),
        (r#","pinned":true"#, (home, true)),
    ] {
        let opened = open(&with(&format!(
            r#""skeleton":{{"joints":[{{"name":"a","axis":[0,1,0]}}]}},
               "targets":[{{"joint":0,"home":[1,2,3]{fields}}}]"#
        )));
        let target = &opened.document.rig.targets[0];
        let (at, is_pinned) = expected;
        assert_eq!((target.home, target.pin, target.is_pinned), (home, at, is_pinned), "{fields}");
        assert_eq!(opened.warnings, []);
    }
}

#[test]
fn a_file_has_the_pin_of_a_target_only_where_it_is_needed() {
    let point = Vec3::new(4.0, 5.0, 6.0);
    let default = Arm::default().cursor;
    for (cursor, expected) in [
        (Cursor::unpinned(default.in_root), [].as_slice()),
        (Cursor { is_pinned: true, in_world: point, ..default }, &["pin", "pinned"]),
        (Cursor { in_world: point, ..default }, &["pin"]),
    ] {
        let arm = Arm { cursor, ..Arm::default() };
        let json = io::to_json(&arm.document()).expect("written");
        let file: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        let fields = ["pin", "pinned"].into_iter();
        let found: Vec<_> =
            fields.filter(|field| file["targets"][0].get(field).is_some()).collect();
        assert_eq!(found, expected);
    }
}

// Keys

/// Target and twist of the joint of [`of_one_bone`].
const HAND: Channel = Channel::Target(JointId::new(0));
const TWIST: Channel = Channel::TargetTwist(JointId::new(0));

/// A document of a joint with a limb target.
fn of_one_bone(fields: &str) -> String {
    with(&format!(
        r#""skeleton":{{"joints":[{{"name":"a","axis":[0,1,0]}}]}},
           "targets":[{{"joint":0,"home":[0,1,0],"limb":{{}}}}],{fields}"#
    ))
}

#[test]
fn frame_rates_need_not_be_whole_and_are_kept_exactly() {
    for (rate, said) in
        [(30.0, "\"frame_rate\": 30"), (29.97, "29.97"), (30e3 / 1001.0, "29.97002997")]
    {
        let mut document = Document::default();
        document.timeline = Timeline { frame_rate: rate, end: 9.0, ..document.timeline };
        let text = io::to_json(&document).expect("written");
        assert!(text.contains(said) && !text.contains("rate\": 30.0"), "{text}");
        assert_eq!(open(&text).document.timeline.frame_rate, rate);
    }
}

#[test]
fn a_key_has_one_number_or_three_and_an_absent_channel_has_no_keys() {
    let opened = open(&with(
        r#""skeleton":{"joints":[{"name":"a","axis":[0,1,0]}]},
           "targets":[{"joint":0,"home":[0,1,0],"limb":{}}],
           "channels":[{"channel":"target","joint":0,"keys":[[0,1,2,3],[1.5,4,5,6]]},
                   {"channel":"target_twist","joint":0,"keys":[[0.1,7]]},
                   {"channel":"rotation","joint":0,"keys":[[2,0,0,1],[1,0,0,3]]},
                   {"channel":"enabled","joint":0,"keys":[[1,0]]},
                   {"channel":"overlay","overlay":"cursor","keys":[[1,1]]},
                   {"channel":"offset","joint":0,"keys":[]}],
           "timeline":{"start":1,"frame_rate":24},"metres_per_unit":0.01"#,
    ));
    assert_eq!(opened.warnings, []);
    let document = opened.document;
    let keys = &document.keys;
    let value = |channel, time| keys.value(channel, time).expect("keyed").to_array();
    assert_eq!(value(HAND, 1.5), [4.0, 5.0, 6.0]);
    assert_eq!(value(TWIST, 9.0), [7.0, 0.0, 0.0]);
    assert_eq!(value(Channel::Rotation(JointId::new(0)), 1.5), [0.0, 0.0, 2.0]);
    assert_eq!(value(Channel::Enabled(JointId::new(0)), 1.5), [0.0; 3]);
    assert_eq!(value(Channel::Overlay(Overlay::Cursor), 0.0), [1.0, 0.0, 0.0]);
    assert!(!keys.has(Channel::Offset(JointId::new(0))));
    assert_eq!(document.timeline, Timeline { start: 1.0, end: 9.0, frame_rate: 24.0 });
    assert_eq!((document.metres_per_unit, document.metres_per_unit()), (Some(0.01), 0.01));
}

#[test]
fn a_key_with_a_curve_of_its_own_is_an_object_and_is_saved_as_one() {
    let opened = open(&of_one_bone(
        r#""channels":[{"channel":"target","joint":0,"keys":[
               {"key":[0,1,2,3],"interpolation":"linear"},
               {"key":[1,4,5,6],"arriving":[1,0,0],"leaving":[0,2,0]},
               [2,7,8,9]]},
             {"channel":"target_twist","joint":0,"keys":[{"key":[0,1],"interpolation":"step","leaving":[3]}]}]"#,
    ));
    assert_eq!(opened.warnings, []);
    let keys = &opened.document.keys;
    let key = |channel, time| keys.key(channel, time).expect("a key");
    let slopes = |arriving, leaving| Some(Slopes { arriving, leaving });
    assert_eq!(key(HAND, 0.0).interpolation, Interpolation::Linear);
    assert_eq!(key(HAND, 1.0).slopes, slopes(Vec3::X, Vec3::Y * 2.0));
    assert_eq!(key(HAND, 2.0), Knot::new(2.0, Vec3::new(7.0, 8.0, 9.0)));
    assert_eq!(key(TWIST, 0.0).interpolation, Interpolation::Step);
    assert_eq!(key(TWIST, 0.0).slopes, slopes(Vec3::X * 3.0, Vec3::X * 3.0));
    let text = io::to_json(&opened.document).expect("it can be saved");
    let again =
        io::parse("again.json", &text, &io::OpenOptions::default()).expect("it opens").document;
    assert_eq!(again.keys, opened.document.keys);
    assert_eq!(text.matches("\"key\"").count(), 3, "a plain key stays a row: {text}");
}

#[test]
fn automatic_keys_keep_their_word_and_keys_without_one_are_catmull_rom() {
    let opened = open(&of_one_bone(
        r#""channels":[{"channel":"target_twist","joint":0,"keys":[
               {"key":[0,1],"interpolation":"auto"},[1,2],{"key":[2,2],"interpolation":"smooth"}]}]"#,
    ));
    assert_eq!(opened.warnings, []);
    let kinds = |document: &Document| -> Vec<Interpolation> {
        let track = document.keys.track(TWIST).expect("keys");
        track.knots().iter().map(|knot| knot.interpolation).collect()
    };
    let (auto, smooth) = (Interpolation::Auto, Interpolation::Smooth);
    assert_eq!(kinds(&opened.document), [auto, smooth, smooth]);
    let text = io::to_json(&opened.document).expect("it can be saved");
    assert_eq!(text.matches("\"auto\"").count(), 1, "{text}");
    let again = io::parse("again.json", &text, &io::OpenOptions::default()).expect("it opens");
    assert_eq!(again.document.keys, opened.document.keys);
}

#[test]
fn invalid_keys_are_named() {
    let skeleton = r#""skeleton":{"joints":[{"name":"a","axis":[0,1,0]}]},"channels":"#;
    for (keys, reason) in [
        (
            r#"[{"channel":"foot","keys":[]}]"#,
            "line 2, column 76: channels[0].channel: must be the name of a channel, got \"foot\"",
        ),
        (
            r#"[{"channel":"offset","joint":0,"keys":[[0,1,2]]}]"#,
            "channels[0].keys[0]: must have three numbers after the time, got 2",
        ),
        (
            r#"[{"channel":"length","joint":0,"keys":[[0,1],[1,0]]}]"#,
            "channels[0].keys[1]: length must be above 0, got 0",
        ),
        (
            r#"[{"channel":"overlay","overlay":"axes","keys":[[0,0.5]]}]"#,
            "switch must be 0 or 1, got 0.5",
        ),
        (r#"[{"channel":"overlay","keys":[]}]"#, "channels[0]: must have `overlay`"),
        (r#"[{"channel":"rotation","keys":[]}]"#, "channels[0]: must have `joint`"),
        (
            r#"[{"channel":"offset","joint":1,"keys":[]}]"#,
            "channels[0].joint: must be 0, the only joint, got 1",
        ),
        (
            r#"[{"channel":"target","joint":0,"keys":[]}]"#,
            "channels[0].joint: must be a joint with a target, got 0",
        ),
        (
            r#"[{"channel":"offset","joint":0,"keys":[[0,1,2,3]]},{"channel":"offset","joint":0,"keys":[[0,1,2,3]]}]"#,
            "channels[1]: channel must have one entry, got a second",
        ),
        (
            r#"[{"channel":"length","joint":0,"keys":[{"key":[0,1],"interpolation":"curly"}]}]"#,
            "channels[0].keys[0].interpolation: unknown variant `curly`, expected one of",
        ),
        (
            r#"[{"channel":"length","joint":0,"keys":[{"key":[0,1],"leaving":[1,2,3]}]}]"#,
            "channels[0].keys[0].leaving: must have one number, got 3",
        ),
        (
            r#"[{"channel":"length","joint":0,"keys":[{"interpolation":"step"}]}]"#,
            "channels[0].keys[0]: missing field `key`",
        ),
        (
            r#"[{"channel":"length","joint":0,"keys":["soon"]}]"#,
            "expected a time and the value at it: [seconds, x, …], or an object with `key`",
        ),
        (
            r#"[{"channel":"offset","joint":0,"keys":[[]]}]"#,
            "channels[0].keys[0]: invalid length 0",
        ),
        (
            r#"[{"channel":"offset","joint":0,"keys":[[1e999,0,0,0]]}]"#,
            "channels[0].keys[0][0]: must be within",
        ),
    ] {
        let said = refusal(&with(&format!("{skeleton}{keys}")));
        assert!(said.contains(reason), "{keys}: {said}");
    }
    for timeline in ["\"end\":-1", "\"frame_rate\":0", "\"frame_rate\":1001", "\"start\":1e9"] {
        let said = refusal(&with(&format!("\"timeline\":{{{timeline}}}")));
        assert!(said.contains("timeline: must start before it ends"), "{said}");
    }
    assert!(
        refusal(&with("\"metres_per_unit\":0")).contains("metres_per_unit: must be above 0, got 0")
    );
}

#[test]
fn blobs_of_older_releases_are_one_or_two_spheres() {
    let document = |blob: &str| {
        with(&format!(
            r#""rig":"skeleton","skeleton":{{"joints":[{{"name":"a","axis":[0,1,0],"radius":0.1}}]}},
            "skin":{{"bones":{{"blobs":[{{"joint":0,{blob}}}]}}}}"#
        ))
    };
    for (older, spheres) in [
        (r#""base":[1,2,3],"radius":0.5"#, "[[1,2,3,0.5]]"),
        (r#""base":[1,2,3],"tip":[4,5,6],"radius":0.5"#, "[[1,2,3,0.5],[4,5,6,0.5]]"),
        (
            r#""base":[1,2,3],"tip":[4,5,6],"radius":0.5,"tip_radius":0.25"#,
            "[[1,2,3,0.5],[4,5,6,0.25]]",
        ),
        (r#""base":[1,2,3],"radius":0.5,"tip_radius":0.25"#, "[[1,2,3,0.5],[1,2,3,0.25]]"),
    ] {
        let [older, now] = [older.to_owned(), format!("\"spheres\":{spheres}")]
            .map(|blob| open(&document(&blob)).document.rig.skin);
        assert!(older.is_some());
        assert_eq!(older, now, "{spheres}");
    }
    for blob in [r#""tip":[4,5,6]"#, r#""base":[1,2,3]"#] {
        let message = refusal(&document(blob));
        assert!(message.contains("must have `spheres`, or `base` and `radius`"), "{message}");
    }
}
