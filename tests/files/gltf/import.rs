//! Import of files from other programs.

use std::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

use glam::{Quat, Vec3};
use ik_arm::document::Channel;
use ik_arm::io::{self, Opened};
use ik_arm::kinematics::skeleton::{JointId, Skeleton};
use ik_arm::kinematics::skin::Skinning;
use serde_json::{Value, json};

use crate::common::damage::message;
use crate::gltf::text::{Text, base64, glb, push};

fn open(text: &Text) -> Opened {
    io::parse("test.gltf", &text.embedded(), &io::OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn skeleton(text: &Text) -> Skeleton {
    open(text).document.skeleton().clone()
}

fn refusal(text: &str) -> String {
    message(io::parse("x.gltf", text, &io::OpenOptions::default()).expect_err("it is refused"))
}

/// Base of a joint at a time, by the joint's name.
fn base(opened: &Opened, time: f64, name: &str) -> Vec3 {
    let document = opened.document.at(time).into_document();
    let skeleton = document.skeleton();
    skeleton.base(skeleton.find(name).expect("a joint"))
}

#[track_caller]
fn assert_near(found: Vec3, expected: Vec3) {
    assert!(found.distance(expected) < 1e-5, "{found}, not {expected}");
}

/// Quaternions about z by quarter turns.
fn quarters(turns: &[f32]) -> Vec<f32> {
    turns.iter().flat_map(|turn| Quat::from_rotation_z(turn * FRAC_PI_2).to_array()).collect()
}

// Joints

#[test]
fn a_text_and_a_binary_file_give_the_same_joints() {
    let text = Text::chain();
    let opened = open(&text);
    let joints = opened.document.skeleton().joints();
    let told: Vec<_> = joints
        .iter()
        .map(|joint| (joint.name.as_str(), joint.parent.map(JointId::index)))
        .collect();
    assert_eq!(told, [("a", None), ("b", Some(0)), ("c", Some(1))]);
    assert_eq!(
        joints.iter().map(|joint| joint.axis).collect::<Vec<_>>(),
        [Vec3::Y, Vec3::Y, Vec3::Y * 0.5]
    );
    assert_eq!(
        (opened.skeletons.as_slice(), opened.order.as_slice()),
        (&["skin".to_owned()][..], &[0, 1, 2].map(JointId::new)[..])
    );
    assert_eq!(
        io::read("x.glb", &text.binary()[..], &io::OpenOptions::default()).expect("it opens"),
        opened
    );
}

#[test]
fn nodes_between_joints_and_scaled_ones_above_are_in_the_offsets() {
    let text = Text::new(
        json!([
            { "children": [1], "scale": [2, 2, 2], "translation": [0, 0, 7] },
            { "name": "hip", "children": [2], "translation": [1, 0, 0] },
            { "children": [3], "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2] },
            { "name": "knee", "translation": [0, 1, 0] },
        ]),
        &[3, 1],
    );
    let opened = open(&text);
    let joints = opened.document.skeleton().joints();
    assert_eq!((joints[0].name.as_str(), joints[1].name.as_str()), ("hip", "knee"));
    assert_eq!(
        (joints[1].parent, opened.order.as_slice()),
        (Some(JointId::new(0)), &[1, 0].map(JointId::new)[..])
    );
    assert_near(joints[0].offset, Vec3::new(2.0, 0.0, 7.0));
    assert_near(joints[1].offset, Vec3::new(-2.0, 0.0, 0.0));
    assert_near(joints[0].axis, joints[1].offset);
    assert!(joints.iter().all(|joint| joint.rotation == Vec3::ZERO));
    assert_near(joints[1].frame.y_axis, Vec3::NEG_X);
}

#[test]
fn a_matrix_stands_for_translation_rotation_and_scale() {
    let matrix = [0, 3, 0, 0, -3, 0, 0, 0, 0, 0, 3, 0, 1, 2, 3, 1];
    let text = Text::new(
        json!([{ "matrix": matrix, "children": [1] }, { "translation": [1, 0, 0] }]),
        &[0, 1],
    );
    let skeleton = skeleton(&text);
    assert_near(skeleton.base(JointId::new(0)), Vec3::new(1.0, 2.0, 3.0));
    assert_near(skeleton.base(JointId::new(1)), Vec3::new(1.0, 5.0, 3.0));
}

#[test]
fn names_are_made_unique_and_unnamed_joints_get_one() {
    let text =
        Text::new(json!([{ "name": "a" }, { "name": "a" }, {}, { "name": " " }]), &[0, 1, 2, 3]);
    let skeleton = skeleton(&text);
    let names: Vec<&str> = skeleton.joints().iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["a", "a_2", "joint_2", "joint_3"]);
    assert!(skeleton.joints().iter().all(|joint| joint.parent.is_none()));
}

#[test]
fn a_bone_ends_at_the_only_child_or_the_one_along_y() {
    let with = |children: Value| {
        let mut nodes = vec![json!({ "name": "a", "children": [] })];
        for (index, child) in children.as_array().expect("children").iter().enumerate() {
            nodes[0]["children"].as_array_mut().expect("a list").push(json!(index + 1));
            nodes.push(json!({ "translation": child }));
        }
        let all: Vec<usize> = (0..nodes.len()).collect();
        skeleton(&Text::new(Value::from(nodes), &all)).joints()[0].axis
    };
    assert_eq!(with(json!([[1, 2, 3]])), Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(with(json!([[9, 0, 0], [0, 2, 0]])), Vec3::Y * 2.0);
    assert_eq!(with(json!([[4, 1, 0], [-4, 1, 0], [0, 0, 0]])), Vec3::ZERO);
}

#[test]
fn a_leaf_called_the_tip_of_its_parent_ends_the_bone() {
    let text = Text::new(
        json!([
            { "name": "a", "children": [1, 2] },
            { "name": "a_tip", "translation": [0, 3, 0] },
            { "name": "b", "translation": [1, 0, 0] },
        ]),
        &[0, 1, 2],
    );
    let opened = open(&text);
    let joints = opened.document.skeleton().joints();
    assert_eq!(
        (joints.len(), joints[0].axis, joints[1].parent),
        (2, Vec3::Y * 3.0, Some(JointId::new(0)))
    );
    assert_eq!(opened.order, [0, 1].map(JointId::new));
}

#[test]
fn of_several_figures_the_first_is_read_or_the_one_that_is_named() {
    let mut text = Text::new(
        json!([{ "name": "a", "children": [1] }, { "name": "a1" }, { "name": "b" }, { "name": "c" }]),
        &[],
    );
    text.json["skins"] = json!([
        { "joints": [0, 1] }, { "name": "b", "joints": [2] }, { "name": "b", "joints": [3] },
    ]);
    push(&mut text.json["nodes"], json!({ "name": "lamp", "skin": 0 }));
    let named = |name: Option<&str>| {
        let skeleton = name.map(str::to_owned);
        let options = io::OpenOptions { skeleton, ..io::OpenOptions::default() };
        io::parse("x.gltf", &text.embedded(), &options)
    };
    let count = |name| {
        let opened = named(name).expect("it opens");
        assert_eq!(opened.skeletons, ["lamp", "b", "b_2"]);
        let joints = opened.document.skeleton().joints().to_vec();
        (joints.len(), joints[0].name.clone())
    };
    assert_eq!(count(None), (2, "a".to_owned()));
    assert_eq!(count(Some("b")), (1, "b".to_owned()));
    assert_eq!(count(Some("b_2")), (1, "c".to_owned()));
    let error = named(Some("d")).expect_err("there is none").to_string();
    assert_eq!(error, "x.gltf has no skeleton called \"d\"; it has \"lamp\", \"b\", \"b_2\"");
}

#[test]
fn skins_that_share_joints_or_a_hierarchy_are_one_figure_by_any_of_their_names() {
    // A body and its hair below the head, a hat beside the body, and another body.
    let mut text = Text::new(
        json!([
            { "name": "armature", "children": [1, 4] },
            { "name": "hips", "children": [2] },
            { "name": "head", "children": [3] },
            { "name": "hair" },
            { "name": "hat" },
            { "name": "other" },
        ]),
        &[],
    );
    text.json["skins"] = json!([
        { "name": "hair", "joints": [3] },
        { "name": "other", "joints": [5] },
        { "name": "hat", "joints": [4] },
        { "name": "body", "joints": [1, 2] },
        { "name": "face", "joints": [2, 1] },
    ]);
    for (name, expected) in [
        ("hair", &["hips", "head", "hair", "hat"][..]),
        ("face", &["hips", "head", "hair", "hat"]),
        ("other", &["other"]),
    ] {
        let options = io::OpenOptions::of_skeleton(name);
        let opened = io::parse("x.gltf", &text.embedded(), &options).expect("it opens");
        assert_eq!(opened.skeletons, ["hair", "other"]);
        let joints = opened.document.skeleton().joints();
        let mut names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        assert_eq!(opened.order.len(), names.len());
        names.sort_by_key(|name| expected.iter().position(|other| other == name));
        assert_eq!(names, expected);
    }
}

// Motions

#[test]
fn rotations_take_the_shorter_way_and_steps_hold() {
    let mut text = Text::chain();
    let times = text.floats(1, &[1.0, 2.0]);
    let mut turned = quarters(&[0.0, 1.0]);
    turned[4..].iter_mut().for_each(|number| *number = -*number);
    let turned = text.floats(4, &turned);
    let moved = text.floats(3, &[0.0, 1.0, 0.0, 0.0, 2.0, 0.0]);
    text.animate(0, "rotation", "LINEAR", times, turned);
    text.animate(2, "translation", "STEP", times, moved);
    let opened = open(&text);
    let timeline = opened.document.timeline;
    assert_eq!((timeline.start, timeline.end, timeline.frame_rate), (1.0, 2.0, 24.0));
    let tracks: Vec<Channel> = opened.document.keys.tracks().map(|(channel, _)| channel).collect();
    assert_eq!(tracks, [Channel::Rotation(JointId::new(0)), Channel::Offset(JointId::new(2))]);
    let eighth = Quat::from_rotation_z(FRAC_PI_2 / 2.0) * Vec3::Y;
    assert_near(base(&opened, 1.5, "b"), eighth);
    assert_near(base(&opened, 1.5, "c"), eighth * 2.0);
    assert_near(base(&opened, 2.0, "c"), Vec3::NEG_X * 3.0);
}

#[test]
fn an_accessor_without_a_buffer_view_is_zeros() {
    let mut text = Text::chain();
    let times = text.floats(1, &[0.0, 1.0]);
    let moved = text.floats(3, &[0.0, 1.0, 0.0, 0.0, 2.0, 0.0]);
    text.animate(1, "translation", "LINEAR", times, moved);
    text.json["accessors"][moved].as_object_mut().expect("an object").remove("bufferView");
    let opened = open(&text);
    assert_near(base(&opened, 0.5, "b"), Vec3::ZERO);
    assert_near(base(&opened, 0.5, "c"), Vec3::Y);
}

#[test]
fn cubic_splines_have_the_slopes_of_their_keys() {
    let mut text = Text::chain();
    let times = text.floats(1, &[0.0, 2.0]);
    let rows = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, 0.0, 0.0]];
    let last = [[0.0, 5.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
    let values = text.floats(3, &[rows, last].concat().concat());
    text.animate(1, "translation", "CUBICSPLINE", times, values);
    let opened = open(&text);
    for s in [0.0_f32, 0.25, 0.5, 0.75, 1.0] {
        let (leaving, arriving) = (s.powi(3) - 2.0 * s * s + s, s.powi(3) - s * s);
        let expected = Vec3::new(2.0 * leaving * 3.0, 1.0 + 2.0 * arriving * 5.0, 0.0);
        assert_near(base(&opened, 2.0 * f64::from(s), "b"), expected);
    }
}

#[test]
fn normalized_integers_are_rotations() {
    let turn = |text: &mut Text, bytes: &[u8], component| {
        let times = text.floats(1, &[0.0, 1.0]);
        let values = text.accessor(bytes, component, 2, "VEC4");
        text.animate(0, "rotation", "LINEAR", times, values);
        base(&open(text), 1.0, "b")
    };
    let none_then_quarter = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2];
    let scaled = |largest: f32| none_then_quarter.map(|number| (number * largest).round());
    let words = |largest: f32| -> Vec<u8> {
        scaled(largest).iter().flat_map(|number| (*number as u16).to_le_bytes()).collect()
    };
    let bytes = |largest| scaled(largest).map(|number| number as u8).to_vec();
    for (values, component) in
        [(bytes(127.0), 5120), (bytes(255.0), 5121), (words(32767.0), 5122), (words(65535.0), 5123)]
    {
        assert_near(turn(&mut Text::chain(), &values, component), Vec3::NEG_X);
    }
}

#[test]
fn interleaved_accessors_are_read_by_their_stride() {
    let mut text = Text::chain();
    let times = text.floats(1, &[0.0, 1.0]);
    let rows = [[9.0, 0.0, 1.0, 0.0, 9.0], [9.0, 1.0, 1.0, 0.0, 9.0]].concat();
    let values = text.floats(1, &rows);
    text.json["bufferViews"][values]["byteStride"] = json!(20);
    let moved = json!({ "bufferView": values, "byteOffset": 4, "componentType": 5126, "count": 2,
                        "type": "VEC3" });
    text.json["accessors"][values] = moved;
    text.animate(1, "translation", "LINEAR", times, values);
    assert_near(base(&open(&text), 1.0, "b"), Vec3::new(1.0, 1.0, 0.0));
}

#[test]
fn an_animated_scale_moves_the_descendants() {
    let mut text = Text::chain();
    let times = text.floats(1, &[0.0, 1.0]);
    let scales = text.floats(3, &[1.0, 1.0, 1.0, 2.0, 3.0, 2.0]);
    text.animate(0, "scale", "LINEAR", times, scales);
    let opened = open(&text);
    assert_near(base(&opened, 1.0, "b"), Vec3::Y * 3.0);
    assert_near(base(&opened, 1.0, "c"), Vec3::Y * 6.0);
}

#[test]
fn constant_channels_have_no_keys_but_are_posed() {
    let mut text = Text::chain();
    let times = text.floats(1, &[0.0, 1.0]);
    let turned = text.floats(4, &quarters(&[1.0, 1.0]));
    let also = text.floats(4, &quarters(&[0.0, 1.0]));
    text.animate(0, "rotation", "LINEAR", times, turned);
    text.animate(1, "rotation", "LINEAR", times, also);
    let opened = open(&text);
    let tracks: Vec<Channel> = opened.document.keys.tracks().map(|(channel, _)| channel).collect();
    assert_eq!(tracks, [Channel::Rotation(JointId::new(1))]);
    assert_near(opened.document.skeleton().base(JointId::new(2)), Vec3::NEG_X * 2.0);
}

#[test]
fn angles_continue_past_half_a_turn() {
    let mut text = Text::chain();
    let times: Vec<f32> = (0..=12).map(|key| key as f32 * 0.25).collect();
    let turns: Vec<f32> = (0..=12).map(|key| key as f32 * 0.5).collect();
    let times = text.floats(1, &times);
    let turned = text.floats(4, &quarters(&turns));
    text.animate(0, "rotation", "LINEAR", times, turned);
    let document = open(&text).document;
    let last = document.keys.value(Channel::Rotation(JointId::new(0)), 3.0).expect("keyed");
    assert!((last.z - 6.0 * FRAC_PI_2).abs() < 1e-4, "{last}");
}

#[test]
fn the_frame_rate_is_the_lowest_that_has_every_key_and_need_not_be_whole() {
    for (rate, expected) in [24.0_f32, 25.0, 30.0, 60.0, 100.0, 120.0, 29.97, 33.33, 119.88]
        .map(|rate| (rate, f64::from(rate)))
    {
        let mut text = Text::chain();
        let times: Vec<f32> = (3..40).map(|key| key as f32 / rate).collect();
        let moved: Vec<f32> = (3..40).flat_map(|key| [0.0, key as f32, 0.0]).collect();
        let (times, moved) = (text.floats(1, &times), text.floats(3, &moved));
        text.animate(1, "translation", "LINEAR", times, moved);
        let timeline = open(&text).document.timeline;
        assert!((timeline.frame_rate / expected - 1.0).abs() < 1e-6, "{timeline:?}");
        assert!((timeline.duration() - 36.0 / f64::from(rate)).abs() < 1e-5, "{timeline:?}");
    }
}

/// A chain with an animation for each of `turns`: node 0 turns by so many quarters in a second.
fn with_animations(turns: &[f32]) -> Text {
    let mut text = Text::chain();
    let times = text.floats(1, &[0.0, 1.0]);
    let mut animations = Vec::new();
    for (index, turn) in turns.iter().enumerate() {
        text.json.as_object_mut().expect("an object").remove("animations");
        let turned = text.floats(4, &quarters(&[0.0, *turn]));
        text.animate(0, "rotation", "LINEAR", times, turned);
        let mut animation = text.json["animations"][0].clone();
        animation["name"] = json!(format!("turn {index}"));
        animations.push(animation);
    }
    text.json["animations"] = json!(animations);
    text
}

#[test]
fn the_first_animation_that_moves_is_read_and_any_other_on_request() {
    let turns: Vec<f32> = (0..14).map(|index| index as f32 / 14.0).collect();
    let text = with_animations(&turns);
    let opened = open(&text);
    assert_eq!((opened.animations.len(), opened.animation), (14, Some(1)));
    assert_eq!(opened.warnings.len(), 1);
    assert_eq!(opened.warnings[0].reason, "\"turn 1\" is read, one of 14");
    let still = &opened.animations[0];
    assert_eq!((still.name.as_str(), still.moving_joints, still.moves()), ("turn 0", 0, false));
    for (index, turn) in turns.iter().enumerate() {
        for said in [format!("turn {index}"), index.to_string()] {
            let options = io::OpenOptions::of_animation(&said);
            let opened = io::parse("x.gltf", &text.embedded(), &options).expect("it opens");
            assert_eq!(opened.animation, Some(index));
            let turned = opened.document.keys.value(Channel::Rotation(JointId::new(0)), 1.0);
            let turned = turned.unwrap_or_default();
            assert!((turned.z - turn * FRAC_PI_2).abs() < 1e-5, "{said}: {turned}");
        }
    }
    for said in ["turn 14", "14", "-1", ""] {
        let options = io::OpenOptions::of_animation(said);
        let error = io::parse("x.gltf", &text.embedded(), &options).expect_err("none");
        let start = format!("x.gltf has no animation {said:?}; it has \"turn 0\", \"turn 1\"");
        assert!(error.to_string().starts_with(&start), "{error}");
    }
}

#[test]
fn a_damaged_animation_does_not_keep_the_others_from_being_read() {
    let mut text = with_animations(&[1.0, 0.5]);
    text.json["animations"][0]["samplers"][0]["output"] = json!(999);
    let opened = open(&text);
    assert_eq!(opened.animation, Some(1));
    let options = io::OpenOptions::of_animation("0");
    assert!(io::parse("x.gltf", &text.embedded(), &options).is_err());
}

/// Four nodes in a row below `hips`, 1 m apart, and a node beside them.
fn without_skin() -> Text {
    let mut nodes = vec![json!({ "name": "scene", "children": [1, 6] })];
    for (index, name) in ["hips", "spine", "neck", "head"].into_iter().enumerate() {
        let children = if index < 3 { json!([index + 2]) } else { json!([5]) };
        nodes.push(json!({ "name": name, "translation": [0, 1, 0], "children": children }));
    }
    nodes.push(json!({ "name": "hat", "translation": [0, 1, 0] }));
    nodes.push(json!({ "name": "lamp" }));
    let mut text = Text::new(json!(nodes), &[]);
    text.json["skins"] = json!([]);
    text
}

#[test]
fn without_a_skin_the_nodes_that_move_are_the_joints_up_to_their_common_ancestor() {
    let mut text = without_skin();
    let times = text.floats(1, &[0.0, 1.0]);
    let turned = text.floats(4, &quarters(&[0.0, 1.0]));
    for node in [2, 4] {
        text.animate(node, "rotation", "LINEAR", times, turned);
    }
    let opened = open(&text);
    let joints = opened.document.skeleton().joints();
    let told: Vec<_> = joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(told, ["spine", "neck", "head"]);
    assert_eq!(opened.skeletons, ["scene"]);
    assert_near(base(&opened, 0.0, "head"), Vec3::new(0.0, 4.0, 0.0));
    assert_near(base(&opened, 1.0, "head"), Vec3::new(-2.0, 2.0, 0.0));
}

/// A triangle, as the only mesh of a file.
fn with_triangle(text: &mut Text) {
    let corners = text.floats(3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    text.json["meshes"] = json!([{ "primitives": [{ "attributes": { "POSITION": corners } }] }]);
}

fn names(opened: &Opened) -> Vec<String> {
    opened.document.skeleton().joints().iter().map(|joint| joint.name.clone()).collect()
}

/// Corners of all triangles in the world.
fn corners(opened: &Opened, time: f64) -> Vec<Vec3> {
    let skin = opened.document.rig.skin.as_ref().expect("a skin");
    let mesh = &skin.mesh().expect("a mesh").mesh;
    let posed = opened.document.at(time);
    let posed = mesh.posed(&mesh.pose(posed.skeleton()), Skinning::Linear);
    posed.triangles.iter().flatten().map(|corner| posed.positions[*corner as usize]).collect()
}

#[test]
fn meshes_beside_moving_nodes_stay_at_a_joint_of_their_own() {
    let mut text = Text::new(
        json!([
            { "name": "scene", "children": [1, 4] },
            { "name": "helicopter", "translation": [0, 5, 0], "children": [2, 3] },
            { "name": "body", "mesh": 0 },
            { "name": "rotor", "translation": [0, 2, 0], "mesh": 0 },
            { "name": "sun" },
            { "name": "ground", "children": [6] },
            { "name": "stone", "translation": [9, 0, 0], "mesh": 0 },
        ]),
        &[],
    );
    text.json["skins"] = json!([]);
    with_triangle(&mut text);
    let times = text.floats(1, &[0.0, 1.0]);
    let turned = text.floats(4, &quarters(&[0.0, 1.0]));
    text.animate(3, "rotation", "LINEAR", times, turned);
    let opened = open(&text);
    assert_eq!(opened.warnings, []);
    assert_eq!(names(&opened), ["helicopter", "rotor", "ground"]);
    let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let quarter = |at: Vec3| Vec3::new(-at.y, at.x, at.z);
    let expected = [
        triangle.map(|at| at + 5.0 * Vec3::Y),
        triangle.map(|at| quarter(at) + 7.0 * Vec3::Y),
        triangle.map(|at| at + 9.0 * Vec3::X),
    ];
    for (found, expected) in corners(&opened, 1.0).iter().zip(expected.as_flattened()) {
        assert_near(*found, *expected);
    }
}

#[test]
fn without_skin_and_motion_the_nodes_with_meshes_are_joints_or_else_all_named_ones() {
    let nodes = json!([
        { "name": "robot", "children": [1, 4] },
        { "name": "base", "mesh": 0, "children": [2] },
        { "name": "turn", "translation": [0, 1, 0], "children": [3] },
        { "name": "link", "translation": [0, 1, 0], "mesh": 0 },
        { "name": "camera", "camera": 0 },
    ]);
    let mut text = Text::new(nodes, &[]);
    text.json["skins"] = json!([]);
    with_triangle(&mut text);
    let mut opened = open(&text);
    assert_eq!(names(&opened), ["base", "turn", "link"]);
    assert_eq!(corners(&opened, 0.0).len(), 6);
    // The meshes follow the joints.
    let turn = opened.document.skeleton().find("turn").expect("a joint");
    let quarter = Vec3::new(0.0, 0.0, FRAC_PI_2);
    opened.document.skeleton_mut().change(turn, |turn| turn.rotation = quarter).expect("a joint");
    assert_near(corners(&opened, 0.0)[3], Vec3::new(-1.0, 1.0, 0.0));

    for node in [1, 3] {
        text.json["nodes"][node].as_object_mut().expect("an object").remove("mesh");
    }
    assert_eq!(names(&open(&text)), ["robot", "base", "turn", "link"]);

    let mut one = Text::new(json!([{ "name": "alone" }]), &[]);
    one.json["skins"] = json!([]);
    let refused = refusal(&one.embedded());
    assert!(refused.contains("nodes: must have at least one node with a mesh, or"), "{refused}");
}

#[test]
fn all_bones_of_a_humanoid_are_joints_and_a_figure_of_vrm_0_faces_the_viewer() {
    let nodes = json!([
        { "name": "root", "children": [1, 4] },
        { "name": "hips", "translation": [0, 1, 0], "children": [2] },
        { "name": "spine", "translation": [0, 0.5, 0], "children": [3] },
        { "name": "head", "translation": [0, 0.5, -0.25] },
        { "name": "springs", "children": [5] },
        { "name": "collider" },
    ]);
    let mut text = Text::new(nodes, &[]);
    text.json["skins"] = json!([]);
    let humanoid = json!({ "humanoid": { "humanBones": {
        "hips": { "node": 1 }, "spine": { "node": 2 }, "head": { "node": 3 }, "jaw": { "node": 77 }
    } } });
    text.json["extensions"] = json!({ "VRMC_vrm": humanoid });
    let is_at = |opened: &Opened, z: f32| {
        assert_eq!(names(opened), ["hips", "spine", "head"]);
        assert_near(base(opened, 0.0, "head"), Vec3::new(0.0, 2.0, z));
    };
    is_at(&open(&text), -0.25);

    // A motion moves one of them.
    let mut moved = text.json.clone();
    moved["extensions"] = json!({ "VRMC_vrm_animation": humanoid });
    let mut motion = Text::new(json!([]), &[]);
    let times = motion.floats(1, &[0.0, 1.0]);
    let turned = motion.floats(4, &quarters(&[0.0, 1.0]));
    for (key, value) in moved.as_object().expect("an object") {
        if !["accessors", "bufferViews", "buffers"].contains(&key.as_str()) {
            motion.json[key] = value.clone();
        }
    }
    motion.animate(1, "rotation", "LINEAR", times, turned);
    is_at(&open(&motion), -0.25);

    let told = |opened: &Opened| {
        let joints = opened.document.skeleton().joints().iter();
        joints.map(|joint| joint.human_bone.clone().unwrap_or_default()).collect::<Vec<_>>()
    };
    assert_eq!(told(&open(&text)), ["hips", "spine", "head"]);
    let saved = io::to_json(&open(&text).document).expect("saved");
    let again = io::parse("x.json", &saved, &io::OpenOptions::default()).expect("it opens");
    assert_eq!(told(&again), ["hips", "spine", "head"], "documents keep the bones");
    let bone = |(bone, node): (&str, usize)| json!({ "bone": bone, "node": node });
    let bones: Vec<_> = [("hips", 1), ("spine", 2), ("head", 3)].into_iter().map(bone).collect();
    text.json["extensions"] = json!({ "VRM": { "humanoid": { "humanBones": bones } } });
    is_at(&open(&text), 0.25);
    assert_eq!(told(&open(&text)), ["hips", "spine", "head"]);

    // Nonsense in an extension is no error.
    text.json["extensions"] =
        json!({ "VRM": 5, "VRMC_vrm": { "humanoid": { "humanBones": [1] } } });
    assert_eq!(open(&text).document.skeleton().joints().len(), 6);
}

#[test]
fn nodes_that_move_become_joints_though_the_skin_does_not_list_them() {
    let mut text = without_skin();
    text.json["skins"] = json!([{ "name": "body", "joints": [2, 3] }]);
    let times = text.floats(1, &[0.0, 1.0]);
    let turned = text.floats(4, &quarters(&[0.0, 1.0]));
    let moved = text.floats(3, &[0.0, 1.0, 0.0, 5.0, 1.0, 0.0]);
    text.animate(1, "translation", "LINEAR", times, moved);
    text.animate(5, "rotation", "LINEAR", times, turned);
    let opened = open(&text);
    let skeleton = opened.document.skeleton();
    let names: Vec<_> = opened
        .order
        .iter()
        .map(|joint| skeleton.joint(*joint).expect("there").name.as_str())
        .collect();
    assert_eq!(names, ["spine", "neck", "hips", "hat"]);
    assert_near(base(&opened, 1.0, "neck"), Vec3::new(5.0, 3.0, 0.0));
    assert_near(base(&opened, 1.0, "hat"), Vec3::new(5.0, 5.0, 0.0));
    assert!(opened.document.keys.has(Channel::Rotation(skeleton.find("hat").expect("a joint"))));
    assert_eq!(opened.warnings, []);

    // A node in another tree is left out, with a remark.
    text.json["nodes"][0]["children"] = json!([1]);
    text.animate(6, "translation", "LINEAR", times, moved);
    let opened = open(&text);
    assert_eq!(opened.document.skeleton().joints().len(), 4);
    let [remark] = &opened.warnings[..] else { panic!("one: {:?}", opened.warnings) };
    let reason = "moves, but is not in the hierarchy of the skeleton, and is left out";
    assert_eq!((remark.field.as_str(), remark.reason.as_str()), ("nodes[6]", reason));
}

// Other files

fn moving() -> Text {
    let mut text = Text::chain();
    let times = text.floats(1, &[0.0, 1.0]);
    let turned = text.floats(4, &quarters(&[0.0, 1.0]));
    text.animate(0, "rotation", "LINEAR", times, turned);
    text
}

#[test]
fn a_buffer_can_be_a_file_in_the_same_folder() {
    let text = moving();
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a b.bin"), text.bytes()).expect("written");
    let path = folder.path().join("x.gltf");
    std::fs::write(&path, text.with_uri("./a%20b.bin")).expect("written");
    let opened = io::open(&path, &io::OpenOptions::default()).expect("it opens");
    assert_near(base(&opened, 1.0, "c"), Vec3::NEG_X * 2.0);
}

#[test]
fn a_buffer_that_is_not_in_the_files_own_folder_is_refused() {
    let text = moving();
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a.bin"), text.bytes()).expect("written");
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).expect("made");
    let path = inner.join("x.gltf");
    let absolute = folder.path().join("a.bin");
    for uri in [
        "../a.bin",
        "b/../../a.bin",
        "%2e%2e/a.bin",
        "file:///a.bin",
        "http://a/a.bin",
        "a\\b.bin",
        "%zz",
        "",
        ".",
        absolute.to_str().expect("a name"),
        "none.bin",
    ] {
        std::fs::write(&path, text.with_uri(uri)).expect("written");
        let error = message(io::open(&path, &io::OpenOptions::default()).expect_err(uri));
        assert!(error.contains("buffers[0].uri: "), "{error}");
    }
    let error = refusal(&text.with_uri("a.bin"));
    assert!(error.contains("buffers[0].uri: must not be another file"), "{error}");
}

/// The size in bytes of a file that is too large for any format but glTF.
const LARGE: usize = 70 << 20;

#[test]
fn textures_do_not_count_in_the_size_of_a_file() {
    let mut text = moving();
    let image = text.view(&vec![7; LARGE]);
    text.json["images"] = json!([{ "bufferView": image, "mimeType": "image/png" }]);
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in [("a.glb", text.binary()), ("a.gltf", text.embedded().into_bytes())] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("written");
        let opened =
            io::open(&path, &io::OpenOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(opened.document.skeleton(), open(&moving()).document.skeleton());
        assert_eq!(opened.document.keys, open(&moving()).document.keys);
    }
}

#[test]
fn a_file_of_2_gb_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, start) in [("large.glb", &b"glTF\x02\0\0\0"[..]), ("large.gltf", b" {")] {
        let path = folder.path().join(name);
        std::fs::write(&path, start).expect("written");
        let file = std::fs::OpenOptions::new().write(true).open(&path).expect("opened");
        file.set_len(2 << 30).expect("made long");
        let error = io::open(&path, &io::OpenOptions::default()).expect_err("it is refused");
        assert!(error.to_string().ends_with("must be at most 1024 MB large"), "{error}");
    }
}

#[test]
fn buffers_that_are_larger_than_1_gb_together_are_refused() {
    let mut text = moving();
    text.json["buffers"] = json!([null, { "byteLength": 1 << 30, "uri": "data:;base64," }]);
    text.json["bufferViews"][1]["buffer"] = json!(1);
    let error = refusal(&text.embedded());
    assert!(
        error.ends_with(
            "buffers[1].byteLength: must add up to at most 1024 MB with those before it"
        ),
        "{error}"
    );
}

#[test]
fn compressed_data_are_named_with_what_unpacks_them() {
    let (extension, tool) = ("EXT_meshopt_compression", "gltfpack");
    let mut text = moving();
    text.json["extensionsRequired"] = json!([extension]);
    let packed = json!({ "byteLength": 100, "extensions": { extension: { "fallback": true } } });
    text.json["buffers"] = json!([null, packed]);
    text.json["bufferViews"][1]["buffer"] = json!(1);
    let error = refusal(&text.embedded());
    assert!(error.contains(extension) && error.contains(tool), "{error}");
}

// Errors

/// The error of a file with one invalid value.
fn error_with_value(pointer: &str, value: Value) -> String {
    let mut text = moving();
    let embedded = text.embedded();
    text.json = serde_json::from_str(&embedded).expect("JSON");
    let (path, key) = pointer.rsplit_once('/').expect("a pointer");
    match text.json.pointer_mut(path).expect("there") {
        Value::Array(list) => list[key.parse::<usize>().expect("an index")] = value,
        parent => parent[key] = value,
    }
    let error = refusal(&text.json.to_string());
    let (_, said) = error.split_once(": ").expect("a place");
    said.to_owned()
}

#[test]
fn errors_name_the_field() {
    let infinite = base64(&f32::INFINITY.to_le_bytes());
    for (pointer, value, said) in [
        ("/asset/version", json!("3.0"), "asset.version: must be 2 or 2.x, got \"3.0\""),
        ("/skins/0/joints", json!([]), "skins[0].joints: must have at least one joint"),
        (
            "/skins/0/joints/1",
            json!(9),
            "skins[0].joints[1]: must be below 4, the number of nodes, got 9",
        ),
        (
            "/skins/0/joints/1",
            json!(0),
            "skins[0].joints[1]: joints must be unique, got node 0 twice",
        ),
        ("/skins/0/joints/1", json!(-1), "skins[0].joints[1]: invalid type: integer `-1`"),
        (
            "/nodes/1/children/0",
            json!(9),
            "nodes[1].children[0]: must be below 4, the number of nodes, got 9",
        ),
        (
            "/nodes/1/children/0",
            json!(3),
            "nodes[1].children[0]: node 3 must have one parent, got 0 and 1",
        ),
        ("/nodes/2/children", json!([0]), "nodes[0]: must not be its own ancestor"),
        ("/nodes/1/rotation", json!([0, 0, 0, 0]), "nodes[1].rotation: must not be four zeros"),
        ("/nodes/1/rotation", json!([0, 0, 1]), "nodes[1].rotation: found 3 numbers"),
        ("/nodes/1/scale", json!([1, 1e39, 1]), "nodes[1].scale[1]: must be within ±3.4028235e38"),
        ("/nodes/1/translation", json!([3e38, 3e38, "1"]), "nodes[1].translation[2]: invalid type"),
        ("/nodes/0/scale", json!([1, 3.4e38, 1]), "nodes[2]: must be within ±3.4028235e38 m"),
        (
            "/nodes/0/matrix",
            json!(vec![1; 16]),
            "nodes[0].matrix: last row must be [0, 0, 0, 1], got",
        ),
        (
            "/animations/0/channels/0/sampler",
            json!(4),
            "animations[0].channels[0].sampler: must be below 1",
        ),
        (
            "/animations/0/channels/0/target/node",
            json!(4),
            "animations[0].channels[0].target.node: must be below 4",
        ),
        (
            "/animations/0/samplers/0/input",
            json!(7),
            "accessors[7]: must be below 2, the number of accessors, got 7",
        ),
        (
            "/animations/0/samplers/0/interpolation",
            json!("CUBIC"),
            "animations[0].samplers[0].inter",
        ),
        (
            "/animations/0/samplers/0/output",
            json!(0),
            "accessors[0].type: must be \"VEC4\", got \"SCALAR\"",
        ),
        (
            "/accessors/0/componentType",
            json!(5124),
            "accessors[0].componentType: must be 5120 to 5123",
        ),
        (
            "/accessors/0/componentType",
            json!(5123),
            "accessors[0].componentType: must be 5126 (float) for times",
        ),
        (
            "/accessors/1/componentType",
            json!(5125),
            "accessors[1].componentType: must be 5126 (float) for values",
        ),
        ("/accessors/0/count", json!(0), "accessors[0].count: must be 1 or more, got 0"),
        (
            "/accessors/1/count",
            json!(1),
            "accessors[1].count: must be 1 for each of the 2 times, got 1",
        ),
        (
            "/accessors/1/count",
            json!(3),
            "accessors[1].count: must fit into the 32 bytes of bufferViews[1], got 3 of 16",
        ),
        (
            "/accessors/1/count",
            json!(4294967295_u32),
            "accessors[1].count: must fit into the 32 bytes of bufferViews[1], got 4294967295 of",
        ),
        (
            "/accessors/1/byteOffset",
            json!(4294967295_u32),
            "accessors[1].count: must fit into the 32 bytes of bufferViews[1], got 2 of 16",
        ),
        ("/accessors/1/byteOffset", json!(1e300), "accessors[1].byteOffset: invalid type"),
        ("/accessors/1/sparse", json!({}), "accessors[1].sparse: missing field `count`"),
        (
            "/accessors/1/bufferView",
            json!(5),
            "accessors[1].bufferView: must be below 2, the number of buffer views, got 5",
        ),
        (
            "/bufferViews/1/buffer",
            json!(5),
            "bufferViews[1].buffer: must be below 1, the number of buffers, got 5",
        ),
        (
            "/bufferViews/1/byteLength",
            json!(999),
            "bufferViews[1].byteLength: must fit into the 40 bytes of buffers[0], got 999",
        ),
        (
            "/bufferViews/1/byteOffset",
            json!(4294967295_u32),
            "bufferViews[1].byteLength: must fit into the 40 bytes of buffers[0], got 32",
        ),
        (
            "/bufferViews/1/byteStride",
            json!(12),
            "bufferViews[1].byteStride: must be from 4 to 252 and at least 16, got 12",
        ),
        (
            "/buffers/0/byteLength",
            json!(999),
            "buffers[0].byteLength: must be at most 40, the size of the buffer, got 999",
        ),
        (
            "/buffers/0/uri",
            Value::Null,
            "buffers[0].uri: must be given, except for the first buffer of a",
        ),
        (
            "/buffers/0/uri",
            json!("data:;base64,!"),
            "buffers[0].uri: data must be base64: Invalid symbol 33, offset 0.",
        ),
        (
            "/buffers/0/uri",
            json!("data:,abc"),
            "buffers[0].uri: must be data:…;base64,…, got data:,…",
        ),
        (
            "/buffers/0/uri",
            json!(format!("data:;base64,{}", infinite.trim_end_matches('=').repeat(40))),
            "accessors[0]: times must be finite, got inf as time 0",
        ),
    ] {
        let found = error_with_value(pointer, value);
        assert!(found.starts_with(said), "{pointer}: {found}");
    }
}

#[test]
fn keys_at_repeated_or_unsorted_times_are_sorted_and_the_last_one_counts_with_one_remark() {
    let sorted = ([0.0, 0.5, 1.0], [0.0, 2.0, 1.0]);
    for (times, heights) in [
        (vec![0.0, 0.5, 0.5, 1.0], vec![0.0, 9.0, 2.0, 1.0]),
        (vec![0.5, 1.0, 0.0], vec![2.0, 1.0, 0.0]),
        (vec![1.0, 0.0, 1.0, 0.5, 0.0], vec![7.0, 5.0, 1.0, 2.0, 0.0]),
    ] {
        for interpolation in ["LINEAR", "STEP", "CUBICSPLINE"] {
            let open_with = |times: &[f32], heights: &[f32]| {
                let mut text = Text::chain();
                let rows = heights.iter().flat_map(|height| match interpolation {
                    "CUBICSPLINE" => vec![0.1, 0.2, 0.3, 0.0, *height, 0.0, 0.3, 0.2, 0.1],
                    _ => vec![0.0, *height, 0.0],
                });
                let rows: Vec<f32> = rows.collect();
                let (times, moved) = (text.floats(1, times), text.floats(3, &rows));
                for node in [0, 1] {
                    text.animate(node, "translation", interpolation, times, moved);
                }
                open(&text)
            };
            let (expected, found) = (open_with(&sorted.0, &sorted.1), open_with(&times, &heights));
            assert_eq!(found.document.keys, expected.document.keys, "{times:?} {interpolation}");
            let [remark] = &found.warnings[..] else { panic!("one: {:?}", found.warnings) };
            assert!(remark.reason.starts_with("times must increase; the keys are sorted"));
        }
    }
}

#[test]
fn invalid_rotations_and_times_are_refused() {
    let with = |times: [f32; 2], turned: [f32; 8]| {
        let mut text = Text::chain();
        let (times, turned) = (text.floats(1, &times), text.floats(4, &turned));
        text.animate(0, "rotation", "LINEAR", times, turned);
        refusal(&text.embedded())
    };
    let none = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let said = with([1.0, f32::NAN], none);
    assert!(said.contains("accessors[0]: times must be finite, got NaN as time 1"), "{said}");
    assert!(
        with([0.0, 1e9], none)
            .contains("animations[0]: must be within ±86400 s, got 0 to 1000000000 s")
    );
    let mut zero = none;
    zero[7] = 0.0;
    assert!(with([0.0, 1.0], zero).contains("accessors[1]: rotation 1 must not be four zeros"));
    zero[7] = f32::NAN;
    assert!(with([0.0, 1.0], zero).contains("accessors[1]: value 1 must be finite, got"));
}

#[test]
fn too_many_joints_nodes_and_frames_are_refused() {
    for joints in [10_001, 20_001] {
        let mut text = Text::chain();
        text.json["nodes"] = Value::from(vec![json!({}); joints]);
        text.json["skins"][0]["joints"] = Value::from((0..joints).collect::<Vec<_>>());
        assert!(refusal(&text.embedded()).ends_with("a skeleton must have at most 10000 joints"));
    }

    let many =
        format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}{{}}]}}", "{},".repeat(200_000));
    assert!(refusal(&many).contains("must have at most 200000 entries"));

    let mut text = Text::chain();
    let times = text.floats(1, &[0.0, 80_000.03]);
    let turned = text.floats(4, &quarters(&[0.0, 1.0]));
    text.animate(0, "rotation", "LINEAR", times, turned);
    // Only below uneven scales joints have keys at every frame.
    text.json["nodes"][0]["scale"] = json!([1, 2, 1]);
    let error = refusal(&text.embedded());
    assert!(
        error.contains("animations[0]: must have at most 1333333 frames and keys of 3 nodes, got "),
        "{error}"
    );
}

#[test]
fn errors_in_a_binary_file_have_no_line() {
    let json = br#"{"asset":{"version":"2.0"},"skins":[{"joints":[0]}]}"#;
    let said = |bytes: &[u8]| {
        message(io::read("x.glb", bytes, &io::OpenOptions::default()).expect_err("it is refused"))
    };
    assert_eq!(
        said(&glb(json, b"")),
        "x.glb, skins[0].joints[0]: must be below 0, the number of nodes, got 0"
    );
    let whole = moving().binary();
    let changed = |at: usize, byte: u8| {
        let mut bytes = whole.clone();
        bytes[at] = byte;
        bytes
    };
    for (bytes, expected) in [
        (&b"glTF\x02"[..], "x.glb, header must have 12 bytes, got 5"),
        (&changed(4, 1), "x.glb is a file of glTF 1, and only "),
        (&changed(4, 3), "x.glb, glTF version must be 2, got 3"),
        (&changed(11, 1), "bytes, as its header says, got "),
        (&changed(16, b'X'), "x.glb, first chunk must be of the type JSON"),
        (&changed(15, 1), "x.glb, JSON chunk must have "),
        (&changed(20, 0xff), "x.glb, JSON chunk must be UTF-8: "),
        (&changed(20, b'x'), "x.glb, not JSON: expected value"),
        (&whole[..whole.len() - 1], "bytes, as its header says, got "),
    ] {
        assert!(said(bytes).contains(expected), "{}", said(bytes));
    }
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_out_of_the_files_folder_is_refused_and_one_inside_is_followed() {
    let text = moving();
    let outside = tempfile::tempdir().expect("a folder");
    let secret = outside.path().join("secret.bin");
    std::fs::write(&secret, text.bytes()).expect("written");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.gltf");
    std::os::unix::fs::symlink(&secret, folder.path().join("out.bin")).expect("a link");
    std::fs::write(&path, text.with_uri("out.bin")).expect("written");
    let error =
        io::open(&path, &io::OpenOptions::default()).expect_err("it is refused").to_string();
    assert!(error.contains("must be in the file's own folder, got "), "{error}");
    assert!(error.contains("out.bin, a link to ") && error.contains("secret.bin"), "{error}");

    std::fs::write(folder.path().join("real.bin"), text.bytes()).expect("written");
    std::os::unix::fs::symlink("real.bin", folder.path().join("in.bin")).expect("a link");
    std::fs::write(&path, text.with_uri("in.bin")).expect("written");
    io::open(&path, &io::OpenOptions::default()).expect("it opens");
}

#[test]
fn a_file_that_needs_a_later_version_is_refused_and_unread_extensions_are_told_by_name() {
    let with = |more: &dyn Fn(&mut Value)| {
        let mut json: Value = serde_json::from_str(&Text::chain().embedded()).expect("JSON");
        more(&mut json);
        json.to_string()
    };
    let later = with(&|json| json["asset"]["minVersion"] = json!("2.1"));
    let error = refusal(&later);
    assert!(error.contains("asset.minVersion: must be 2.0, the version that is read, got \"2.1\""));
    let read = with(&|json| json["asset"]["minVersion"] = json!("2.0"));
    io::parse("x.gltf", &read, &io::OpenOptions::default()).expect("it opens");

    let required = with(&|json| {
        json["extensionsRequired"] = json!(["KHR_mesh_quantization", "VENDOR_everything_else"]);
    });
    let opened = io::parse("x.gltf", &required, &io::OpenOptions::default()).expect("it opens");
    let told: Vec<_> = opened.warnings.iter().map(ToString::to_string).collect();
    let told: Vec<_> = told.iter().filter(|it| it.contains("extensionsRequired")).collect();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].ends_with("VENDOR_everything_else is not read: what it changes is missing"));
}
