//! Rules for every exported file.

use crate::common::arm::{ArmDocument, LOWER, UPPER};
use std::collections::HashSet;
use std::path::Path;

use glam::{Mat4, Vec3};
use ik_arm::document::{Channel, Document, SkeletonRig, Theme, Timeline};
use ik_arm::io::{self, GlbError, Progress};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::scene::Palette;
use pollster::block_on;
use serde_json::Value;

use crate::common::Random;
use crate::common::documents::example;
use crate::gltf::documents::{all, glb, keyed_arm};
use crate::gltf::glb::{Glb, floats, index};
use crate::gltf::stretch::sheared;

fn each(check: impl Fn(&str, &Document, &Glb)) {
    for (name, document) in all() {
        check(&name, &document, &Glb::new(&glb(&document)));
    }
}

/// The documents with their skins removed, which have the mesh of cones around the bones.
fn each_without_skin(check: impl Fn(&str, &Document, &Glb)) {
    for (name, mut document) in all() {
        document.rig.skin = None;
        check(&name, &document, &Glb::new(&glb(&document)));
    }
}

fn exported(document: &Document) -> Glb {
    Glb::new(&glb(document))
}

fn refusal(document: &Document) -> String {
    block_on(io::glb(document, None, &Progress::default())).expect_err("it is refused").to_string()
}

/// A channel of the animation.
struct Moving {
    node: usize,
    path: String,
    times: Vec<Vec<f32>>,
    /// The values at these times, without the slopes of cubic splines.
    values: Vec<Vec<f32>>,
}

fn channels(glb: &Glb) -> Vec<Moving> {
    let animation = &glb.json["animations"][0];
    let read = |channel: &Value| {
        let sampler = &animation["samplers"][index(&channel["sampler"])];
        let [times, mut values] = ["input", "output"].map(|key| glb.rows(&sampler[key]));
        if sampler["interpolation"] == "CUBICSPLINE" {
            values = values.into_iter().skip(1).step_by(3).collect();
        }
        let target = &channel["target"];
        let path = target["path"].as_str().expect("a path").to_owned();
        Moving { node: index(&target["node"]), path, times, values }
    };
    animation["channels"].as_array().into_iter().flatten().map(read).collect()
}

// For the validator

#[test]
#[ignore = "writes files for the Khronos glTF validator: scripts/validate-gltf.sh"]
fn every_file_is_written_for_the_validator() {
    let folder = std::env::var_os("IK_ARM_GLB_DIR").expect("a folder in IK_ARM_GLB_DIR");
    let sheared = ("sheared".to_owned(), sheared(&mut Random(408)));
    for (name, document) in all().into_iter().chain([sheared]) {
        let path = Path::new(&folder).join(format!("{name}.glb"));
        io::write(&path, &glb(&document)).expect("it is written");
    }
}

// Nodes

#[test]
fn no_node_has_a_scale_or_a_matrix_and_names_are_unique() {
    each(|name, _, glb| {
        let mut names = HashSet::new();
        for node in glb.nodes() {
            assert!(node.get("scale").is_none() && node.get("matrix").is_none(), "{name}: {node}");
            assert!(names.insert(node["name"].as_str().expect("a name")), "{name}: {node}");
        }
    });
}

#[test]
fn the_joints_hang_from_a_plain_node_called_armature_and_the_mesh_from_nothing() {
    each(|name, _, glb| {
        let (armature, mesh) = (glb.node("Armature"), glb.node("Limbs"));
        assert_eq!(glb.local(armature), Mat4::IDENTITY, "{name}");
        assert_eq!(index(&glb.json["skins"][0]["skeleton"]), armature);
        assert_eq!(glb.json["scenes"][0]["nodes"], serde_json::json!([armature, mesh]));
        assert_eq!(glb.nodes()[mesh], serde_json::json!({"name": "Limbs", "mesh": 0, "skin": 0}));
        let mut below = glb.children(armature);
        let mut done = 0;
        while done < below.len() {
            below.extend(glb.children(below[done]));
            done += 1;
        }
        below.sort_unstable();
        assert_eq!(below, glb.joints(), "{name}");
    });
}

#[test]
fn the_rest_pose_is_the_bind_pose() {
    each_without_skin(|name, _, glb| {
        let matrices = glb.rows(&glb.json["skins"][0]["inverseBindMatrices"]);
        let worlds = glb.worlds();
        for (joint, matrix) in glb.joints().into_iter().zip(matrices) {
            let inverse = Mat4::from_cols_slice(&matrix);
            let size = 1.0 + worlds[joint].w_axis.truncate().length();
            let product = worlds[joint] * inverse;
            assert!(product.abs_diff_eq(Mat4::IDENTITY, 1e-5 * size), "{name}: {product}");
        }
    });
}

#[test]
fn joints_have_the_documents_names_and_the_leaves_have_tips() {
    let glb = exported(&example("human"));
    let document = example("human");
    let joints = document.skeleton().joints();
    let parents: HashSet<usize> =
        joints.iter().filter_map(|joint| joint.parent).map(JointId::index).collect();
    for (index, joint) in joints.iter().enumerate() {
        assert_eq!(glb.name(index), joint.name);
        let is_bone_and_leaf = !parents.contains(&index) && joint.axis != Vec3::ZERO;
        let tip = format!("{}_tip", joint.name);
        assert_eq!(glb.nodes().iter().any(|node| node["name"] == *tip), is_bone_and_leaf);
    }
}

#[test]
fn duplicate_names_get_numbers() {
    let (_, document) = all().into_iter().find(|(name, _)| name == "names").expect("there");
    let glb = exported(&document);
    let names: Vec<&str> = (0..glb.nodes().len()).map(|node| glb.name(node)).collect();
    let expected = ["Armature_2", "a", "a_tip", "a_tip_2", "a_tip_tip", "Armature", "Limbs"];
    assert_eq!(names, expected);
}

#[test]
fn an_arm_has_its_four_joints_and_tips_where_lengths_change() {
    let glb = exported(&Document::default());
    let names: Vec<&str> = glb.joints().iter().map(|joint| glb.name(*joint)).collect();
    assert_eq!(names, ["root", "upper", "lower", "hand"]);
    let keyed = exported(&keyed_arm(&mut Random(3)));
    let names: Vec<&str> = keyed.joints().iter().map(|joint| keyed.name(*joint)).collect();
    assert_eq!(names, ["root", "upper", "lower", "hand", "upper_tip", "lower_tip"]);
}

#[test]
fn the_rest_pose_of_an_arm_is_straight_along_x_in_metres_with_y_along_its_bones() {
    let mut document = Document::default();
    document.edit_arm(|arm| arm.root = Vec3::new(10.0, 20.0, 30.0));
    let worlds = exported(&document).worlds();
    let root = document.arm().root * 0.001;
    let bases = [0.0, 0.0, 0.2, 0.5].map(|along| root + Vec3::X * along);
    for (world, base) in worlds.iter().zip(bases) {
        assert!(world.w_axis.truncate().distance(base) < 1e-6, "{world}");
    }
    for bone in [UPPER, LOWER] {
        let world = worlds[bone.index()];
        assert!(world.y_axis.truncate().distance(Vec3::X) < 1e-6, "{world}");
    }
}

#[test]
fn a_joints_y_is_along_its_bone() {
    let document = example("human");
    let glb = exported(&document);
    let bind = document.skeleton().bind_pose();
    for (joint, world) in glb.worlds().iter().take(bind.len()).enumerate() {
        let along =
            (bind.tip(JointId::new(joint)) - bind.base(JointId::new(joint))).normalize_or_zero();
        let y = world.y_axis.truncate();
        assert!(along == Vec3::ZERO || y.distance(along) < 1e-5, "{}: {y}", glb.name(joint));
        assert!(world.w_axis.truncate().distance(bind.base(JointId::new(joint))) < 1e-5);
    }
}

// Motions

#[test]
fn at_a_given_rate_there_is_a_key_in_every_frame_and_time_counts_from_0() {
    for (name, document) in all() {
        let timeline = document.timeline;
        let bytes = block_on(io::glb(&document, Some(timeline.frame_rate), &Progress::default()));
        let glb = Glb::new(&bytes.expect("it is written"));
        for Moving { times, values, .. } in channels(&glb) {
            assert!(times.len() == 1 || times.len() == timeline.frames(), "{name}");
            assert_eq!(times.len(), values.len());
            for (frame, time) in times.iter().enumerate() {
                let expected = frame as f64 / timeline.frame_rate;
                assert_eq!(time[0], expected as f32, "{name}");
            }
        }
    }
}

#[test]
fn rotations_are_unit_quaternions_in_the_hemisphere_of_the_one_before() {
    each(|name, _, glb| {
        for Moving { values, .. } in
            channels(glb).into_iter().filter(|moving| moving.path == "rotation")
        {
            let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
            assert!(values.iter().all(|value| (dot(value, value) - 1.0).abs() < 1e-6), "{name}");
            assert!(values.windows(2).all(|two| dot(&two[0], &two[1]) >= 0.0), "{name}");
        }
    });
}

#[test]
fn every_number_is_finite() {
    each(|name, _, glb| {
        let accessors = glb.json["accessors"].as_array().expect("accessors");
        for accessor in (0..accessors.len()).filter(|n| accessors[*n]["componentType"] == 5126) {
            let rows = glb.rows(&Value::from(accessor));
            assert!(rows.iter().flatten().all(|number| number.is_finite()), "{name}");
        }
    });
}

#[test]
fn only_nodes_that_leave_the_rest_pose_have_channels() {
    let mut document = example("ten-joints");
    for joint in 0..document.skeleton().joints().len() {
        document.skeleton_mut().set_rotation(JointId::new(joint), Vec3::ZERO).expect("angles");
    }
    assert!(exported(&document).json.get("animations").is_none());

    document.skeleton_mut().set_rotation(JointId::new(4), Vec3::X).expect("angles");
    let glb = exported(&document);
    let [Moving { node: 4, path, times, .. }] = &channels(&glb)[..] else {
        panic!("another channel")
    };
    assert_eq!((path.as_str(), &times[..]), ("rotation", &[vec![0.0]][..]));

    for (time, angle) in [(1.0, 0.0), (2.0, 1.0)] {
        document.keys.insert(Channel::Rotation(JointId::new(6)), time, Vec3::Z * angle);
    }
    let moved: Vec<usize> =
        channels(&exported(&document)).iter().map(|moving| moving.node).collect();
    assert_eq!(moved, [4, 6]);
}

#[test]
fn the_frame_rate_of_the_export_can_be_chosen() {
    let document = keyed_arm(&mut Random(5));
    let bytes =
        block_on(io::glb(&document, Some(10.0), &Progress::default())).expect("it is written");
    let glb = Glb::new(&bytes);
    let Moving { times, .. } = &channels(&glb)[0];
    assert_eq!((times.len(), times[1][0], times[20][0]), (21, 0.1, 2.0));
}

// The mesh

#[test]
fn the_mesh_is_around_the_bind_pose() {
    each_without_skin(|name, document, glb| {
        let worlds = glb.worlds();
        let joints = glb.joints();
        let ends: Vec<Vec3> = joints.iter().map(|joint| worlds[*joint].w_axis.truncate()).collect();
        let low = ends.iter().copied().reduce(Vec3::min).expect("a joint");
        let high = ends.iter().copied().reduce(Vec3::max).expect("a joint");
        // The ends of a limb that is drawn as cylinders are thicker than those of bones.
        let part = if document.measured_limb().is_some() { 0.1 } else { 0.05 };
        let room = part * document.rig.reach() * document.metres_per_unit();
        for primitive in glb.json["meshes"][0]["primitives"].as_array().expect("primitives") {
            let accessor = index(&primitive["attributes"]["POSITION"]);
            let positions = glb.rows(&Value::from(accessor));
            let bounds = &glb.json["accessors"][accessor];
            let [least, most] = ["min", "max"].map(|key| floats(&bounds[key]));
            for position in &positions {
                let point = Vec3::from_slice(position);
                let nearest = point.clamp(low, high);
                let room = room + 0.03 * low.distance(high);
                assert!(point.distance(nearest) <= room, "{name}: {point} of {low} to {high}");
                assert!((0..3).all(|n| least[n] <= position[n] && position[n] <= most[n]));
            }
            let normals = glb.rows(&primitive["attributes"]["NORMAL"]);
            assert!(normals.iter().all(|n| (Vec3::from_slice(n).length() - 1.0).abs() < 1e-5));
        }
    });
}

#[test]
fn the_mesh_has_the_colours_of_the_limbs_on_screen() {
    let palette = Palette::new(Theme::Dark);
    let glb = exported(&Document::default());
    for (material, colour) in [(0, palette.upper), (1, palette.lower)] {
        let surface = &glb.json["materials"][material]["pbrMetallicRoughness"];
        let found = floats(&surface["baseColorFactor"]);
        assert_eq!(surface["metallicFactor"], 0.0);
        for (linear, screen) in found.into_iter().zip(colour.channels()) {
            let shown = if linear == 1.0 { 1.0 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
            assert!((shown - screen).abs() < 1e-4);
        }
    }
}

// Documents that cannot be exported

#[test]
fn a_skeleton_without_joints_is_refused() {
    let mut document = Document::new(SkeletonRig::default());
    *document.skeleton_mut() = Skeleton::default();
    assert!(refusal(&document).contains("at least one joint"));
}

#[test]
fn a_joint_that_is_too_far_away_is_named() {
    let mut document = Document::new(SkeletonRig::default());
    let far = Joint { offset: Vec3::X * 3e38, ..Joint::new("far", Some(JointId::new(0)), Vec3::Y) };
    let joints = vec![Joint::new("root", None, Vec3::Y), far];
    *document.skeleton_mut() = Skeleton::from_joints(joints).expect("a skeleton");
    glb(&document);
    document.metres_per_unit = Some(10.0);
    assert_eq!(
        refusal(&document),
        "the position of joint \"far\" must be within ±3.4028235e38 m in the bind pose; bring it \
         nearer, or make metres_per_unit smaller"
    );
}

#[test]
fn huge_and_tiny_skeletons_stay_finite() {
    for size in [1e-44, 1e-30, 1e30, 1e38] {
        let mut document = Document::new(SkeletonRig::default());
        let tip = Joint {
            offset: Vec3::Y * size,
            ..Joint::new("b", Some(JointId::new(0)), Vec3::X * size)
        };
        let joints = vec![Joint::new("a", None, Vec3::Y * size), tip];
        *document.skeleton_mut() = Skeleton::from_joints(joints).expect("a skeleton");
        document.skeleton_mut().set_rotation(JointId::new(0), Vec3::ONE).expect("angles");
        let glb = exported(&document);
        for Moving { values, .. } in channels(&glb) {
            assert!(values.iter().flatten().all(|number| number.is_finite()), "{size}");
        }
    }
}

#[test]
fn too_many_frames_are_refused_before_they_are_computed() {
    let mut document = keyed_arm(&mut Random(8));
    document.timeline = Timeline { start: 0.0, end: 80_000.0, frame_rate: 1000.0 };
    let expected = "a motion of 6 joints must have at most 3333333 frames, got 80000001";
    assert!(refusal(&document).starts_with(expected));
}

#[test]
fn an_export_that_is_cancelled_stops() {
    let progress = Progress::default();
    progress.cancel();
    let stopped = block_on(io::glb(&Document::default(), None, &progress));
    assert!(matches!(stopped, Err(GlbError::Cancelled(_))));
}
