//! The bones of imported rigs: from joint to joint, and nothing floats.

use glam::Vec3;
use ik_arm::document::{Document, SkeletonRig, Theme, Track};
use ik_arm::io::{self, OpenOptions};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::scene::{Scene, Solid};
use ik_arm::session::Overlays;
use serde_json::{Value, json};

use crate::common::{Random, skeletons};

/// A file of another program with a skin on those nodes that are no ends. A node is its name, its
/// parent and its translation; the names of ends begin with `end`.
fn file(nodes: &[(&str, Option<usize>, [f32; 3])]) -> Value {
    let children = |parent: usize| -> Vec<usize> {
        (0..nodes.len()).filter(|node| nodes[*node].1 == Some(parent)).collect()
    };
    let node = |(index, (name, _, at)): (usize, &(&str, Option<usize>, [f32; 3]))| {
        let mut node = json!({ "name": name, "translation": at });
        if !children(index).is_empty() {
            node["children"] = json!(children(index));
        }
        node
    };
    let joints: Vec<usize> =
        (0..nodes.len()).filter(|node| !nodes[*node].0.starts_with("end")).collect();
    json!({
        "asset": { "version": "2.0", "generator": "another program" },
        "nodes": nodes.iter().enumerate().map(node).collect::<Vec<_>>(),
        "skins": [{ "joints": joints }],
    })
}

fn open(file: &Value) -> Document {
    let text = file.to_string();
    io::parse("x.gltf", &text, &OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}"))
        .document
}

fn bone(document: &Document, name: &str) -> Vec3 {
    let skeleton = document.skeleton();
    skeleton[skeleton.find(name).expect("a joint")].axis
}

#[track_caller]
fn assert_near(found: Vec3, expected: Vec3) {
    assert!(found.distance(expected) < 1e-6, "{found}, not {expected}");
}

#[test]
fn a_bone_goes_to_the_child_that_bends_least_from_the_chain() {
    let document = open(&file(&[
        ("hip", None, [0.0, 1.0, 0.0]),
        ("chest", Some(0), [0.0, 0.4, 0.1]),
        ("shoulder.L", Some(1), [0.2, 0.1, 0.0]),
        ("shoulder.R", Some(1), [-0.2, 0.1, 0.0]),
        ("neck", Some(1), [0.0, 0.2, 0.0]),
        ("arm.L", Some(2), [0.3, 0.0, 0.0]),
        ("arm.R", Some(3), [-0.3, 0.0, 0.0]),
    ]));
    assert_near(bone(&document, "chest"), Vec3::new(0.0, 0.2, 0.0));
}

#[test]
fn where_no_child_goes_straight_on_a_bone_goes_to_the_one_with_the_most_joints_below() {
    let document = open(&file(&[
        ("pelvis", None, [0.0, 1.0, 0.0]),
        ("leg", Some(0), [0.1, 0.0, 0.1]),
        ("tail", Some(0), [0.0, 0.0, -0.2]),
        ("spine", Some(0), [0.1, 0.1, 0.2]),
        ("chest", Some(3), [0.0, 0.1, 0.3]),
    ]));
    assert_near(bone(&document, "pelvis"), Vec3::new(0.1, 0.1, 0.2));
}

#[test]
fn a_root_with_equal_branches_has_no_bone() {
    let legs = |count: usize| {
        let mut nodes = vec![("body", None, [0.0, 0.3, 0.0])];
        for leg in 0..count {
            let angle = 0.3 + leg as f32;
            nodes.push(("leg", Some(0), [angle.cos(), 0.0, angle.sin()]));
            nodes.push(("foot", Some(2 * leg + 1), [angle.cos(), -0.3, angle.sin()]));
        }
        nodes
    };
    assert_near(bone(&open(&file(&legs(6))), "body"), Vec3::ZERO);
    assert_ne!(bone(&open(&file(&legs(1))), "body"), Vec3::ZERO);
}

#[test]
fn the_origin_that_a_body_stands_on_has_no_bone() {
    let document = open(&file(&[
        ("armature", None, [0.0, 0.0, 0.0]),
        ("hip", Some(0), [0.0, 1.0, 0.0]),
        ("leg.L", Some(1), [0.1, 0.0, 0.0]),
        ("leg.R", Some(1), [-0.1, 0.0, 0.0]),
    ]));
    assert_near(bone(&document, "armature"), Vec3::ZERO);
    let chain = [("base", None, [0.0; 3]), ("waist", Some(0), [0.0, 1.0, 0.0])];
    assert_near(bone(&open(&file(&chain)), "base"), Vec3::Y);
}

#[test]
fn leaves_end_at_nodes_outside_the_skin_else_like_their_siblings_else_half_as_long_as_their_way() {
    let nodes = [
        ("hand", None, [0.0, 0.0, 0.0]),
        ("one", Some(0), [0.1, 0.0, 0.0]),
        ("two", Some(0), [0.1, 0.1, 0.0]),
        ("three", Some(0), [0.0, 0.2, 0.0]),
        ("end of one", Some(1), [0.04, 0.03, 0.0]),
        ("three's tip", Some(3), [0.0, 0.1, 0.0]),
    ];
    let document = open(&file(&nodes));
    assert_near(bone(&document, "one"), Vec3::new(0.04, 0.03, 0.0));
    // The siblings' bones are 0.05 and 0.1 long.
    assert_near(bone(&document, "two"), Vec3::new(1.0, 1.0, 0.0).normalize() * 0.075);
    assert_near(bone(&document, "three's tip"), Vec3::Y * 0.05);

    let mut own = file(&nodes);
    own["asset"]["generator"] = json!("ik-arm 0.1.0");
    assert_near(bone(&open(&own), "two"), Vec3::ZERO);
    let mut drawn = file(&nodes);
    drawn["nodes"][4]["camera"] = json!(0);
    assert_near(bone(&open(&drawn), "one"), Vec3::X * 0.1);
}

#[test]
fn the_bone_of_a_head_with_eyes_goes_on_to_its_end() {
    let document = open(&file(&[
        ("neck", None, [0.0, 1.5, 0.0]),
        ("head", Some(0), [0.0, 0.1, 0.0]),
        ("eye.L", Some(1), [0.03, 0.07, 0.09]),
        ("end of head", Some(1), [0.0, 0.2, 0.01]),
        ("eye.R", Some(1), [-0.03, 0.07, 0.09]),
    ]));
    assert_near(bone(&document, "head"), Vec3::new(0.0, 0.2, 0.01));
}

/// A chain of a BVH file whose inner joints slide along their parents.
fn sliding(random: &mut Random, joints: usize, frames: usize) -> String {
    let mut hierarchy = String::new();
    for joint in 0..joints {
        let kind = if joint == 0 { "ROOT" } else { "JOINT" };
        hierarchy += &format!(
            "{kind} j{joint}\n{{\nOFFSET 0 1 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation \
             Xrotation Yrotation\n"
        );
    }
    hierarchy += "End Site\n{\nOFFSET 0 1 0\n}\n";
    hierarchy += &"}\n".repeat(joints);
    let mut rows = String::new();
    for _ in 0..frames {
        for _ in 0..joints {
            let (at, turn) = (random.vector(2.0), random.vector(90.0));
            rows += &format!("{} {} {} {} {} {} ", at.x, at.y, at.z, turn.x, turn.y, turn.z);
        }
        rows += "\n";
    }
    format!("HIERARCHY\n{hierarchy}MOTION\nFrames: {frames}\nFrame Time: 0.04\n{rows}")
}

#[test]
fn the_bone_of_a_joint_follows_a_child_that_moves() {
    let mut random = Random(61);
    for _ in 0..20 {
        let text = sliding(&mut random, 5, 6);
        let document =
            io::parse("x.bvh", &text, &OpenOptions::default()).expect("it opens").document;
        for _ in 0..20 {
            let time = f64::from(random.within(-0.05..0.3));
            let pose = document.at(time).skeleton().pose();
            // The root's child moves, so that the root is an origin without a bone.
            for joint in 1..4 {
                let (tip, base) =
                    (pose.tip(JointId::new(joint)), pose.base(JointId::new(joint + 1)));
                assert!(tip.distance(base) < 1e-5 * (1.0 + base.length()), "{joint} at {time}");
            }
        }
    }
}

/// The end points of a solid in the world.
fn ends(solid: &Solid) -> [Vec3; 2] {
    [Vec3::ZERO, Vec3::X * solid.shape.length].map(|end| solid.transform.transform_point3(end))
}

#[test]
fn every_joint_is_drawn_in_touch_with_its_parent() {
    let mut random = Random(62);
    for _ in 0..100 {
        let (skeleton, _) = skeletons::tree(&mut random, 4, 1.0);
        let rig = SkeletonRig::new(skeleton);
        let document = Document::new(rig);
        let posed = document.at(0.0);
        let scene = Scene::new(&posed, &Overlays::new(&Track::new(&document), &posed), Theme::Dark);
        let pose = document.skeleton().pose();
        for (joint, parent) in
            document.skeleton().iter().filter_map(|(id, joint)| Some((id, joint.parent?)))
        {
            let (base, above) = (pose.base(joint), [pose.base(parent), pose.tip(parent)]);
            let is_near = |a: Vec3, b: Vec3| a.distance(b) < 1e-4;
            let links = |solid: &Solid| {
                let [from, to] = ends(solid);
                is_near(to, base) && above.iter().any(|end| is_near(*end, from))
            };
            // Inside the parent's bone it touches it without a rod.
            let along = (above[1] - above[0]).normalize_or_zero();
            let part = (base - above[0]).dot(along).clamp(0.0, above[0].distance(above[1]));
            let is_inside = base.distance(above[0] + along * part) < 0.25;
            assert!(is_inside || scene.solids.iter().any(links), "{joint:?} floats");
        }
    }
}
