//! Damaged files: each is an error or a document.

use ik_arm::io;

use ik_arm::kinematics::skeleton::JointId;

use crate::common::damage::{message, mutations};
use crate::common::documents::example;
use crate::common::{Random, cases};
use crate::gltf::documents::{glb, keyed_arm};
use crate::gltf::text;

fn open(bytes: &[u8]) {
    match io::read("damaged", bytes, &io::OpenOptions::default()) {
        Err(error) => {
            message(error);
        }
        Ok(opened) => {
            let document = opened.document;
            for time in [-1.0, 0.0, 0.3, 1.0, 1e9] {
                let skeleton = document.at(time).into_document().skeleton().clone();
                assert!(skeleton.joints().iter().all(|joint| joint.offset.is_finite()));
            }
        }
    }
}

/// Offset of the end of the JSON in a `.glb` file.
fn end_of_json(bytes: &[u8]) -> usize {
    20 + u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize
}

#[test]
fn cut_and_flipped_binary_files_are_errors_or_documents() {
    let mut random = Random(3);
    let files = [glb(&keyed_arm(&mut Random(1))), glb(&example("human")), glb(&example("snake"))];
    for round in 0..cases(500) {
        let mut bytes = files[round % files.len()].clone();
        let length = bytes.len();
        let json = end_of_json(&bytes);
        let places = match round % 4 {
            0 => {
                bytes.truncate(random.below(length));
                0..0
            }
            1 => 0..20,
            2 => 20..json,
            _ => json..length,
        };
        for _ in 0..=random.below(4) {
            if !places.is_empty() {
                let at = places.start + random.below(places.end - places.start);
                bytes[at] = random.next() as u8;
            }
        }
        open(&bytes);
    }
}

#[test]
fn five_hundred_binary_files_with_other_values_are_errors_or_documents() {
    let mut random = Random(4);
    for whole in [glb(&keyed_arm(&mut Random(1))), glb(&example("two-targets"))] {
        let end = end_of_json(&whole);
        let json = String::from_utf8(whole[20..end].to_vec()).expect("UTF-8");
        for mutated in mutations(&json, &mut random, 250) {
            open(&text::glb(&mutated, &whole[end + 8..]));
        }
    }
}

#[test]
fn deep_nesting_is_an_error_and_a_deep_tree_is_not() {
    for open_bracket in ["[", "{\"a\":"] {
        let text =
            format!("{{\"asset\":{{\"version\":\"2.0\"}},\"x\":{}", open_bracket.repeat(1_000_000));
        let error = message(
            io::parse("deep", &text, &io::OpenOptions::default()).expect_err("it is refused"),
        );
        assert!(error.contains("not JSON"), "{error}");
    }
    let node = |index| format!("{{\"children\":[{}],\"translation\":[0,1,0]}},", index + 1);
    let nodes: String = (0..150_000).map(node).collect();
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{nodes}{{}}],\"skins\":[{{\"joints\":[150000]}}]}}"
    );
    let opened = io::parse("deep", &text, &io::OpenOptions::default()).expect("it opens");
    assert_eq!(opened.document.skeleton().base(JointId::new(0)), glam::Vec3::Y * 150_000.0);
}

#[test]
fn accessors_shared_by_too_many_channels_are_refused_early() {
    let mut text = text::Text::chain();
    let nodes: Vec<_> = (0..10_000).map(|_| serde_json::json!({})).collect();
    text.json["nodes"] = nodes.into();
    text.json["skins"][0]["joints"] = (0..10_000).collect::<Vec<_>>().into();
    let times: Vec<f32> = (0..20_000).map(|key| key as f32).collect();
    let input = text.floats(1, &times);
    let output = text.floats(3, &vec![1.0; 60_000]);
    for node in 0..10_000 {
        text.animate(node, "translation", "LINEAR", input, output);
    }
    let error = io::read("many", &text.binary()[..], &io::OpenOptions::default())
        .expect_err("it is refused");
    assert!(message(error).contains("must have at most 20000000 keys"));
}

#[test]
fn a_hundred_thousand_skins_of_one_joint_are_read_in_time() {
    // Each shares a joint with the next, from the last to the first.
    let count = 100_000;
    let nodes = "{},".repeat(count);
    let skins: Vec<String> =
        (0..count).rev().map(|skin| format!("{{\"joints\":[{},{}]}}", skin, skin + 1)).collect();
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{nodes}{{}}],\"skins\":[{}]}}",
        skins.join(",")
    );
    let error = io::parse("x.gltf", &text, &io::OpenOptions::default()).expect_err("refused");
    assert!(error.to_string().contains("must have at most"), "{error}");
}
