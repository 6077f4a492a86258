//! Meshes that Draco has compressed: by the encoder of its authors, and by another one in every form.

use std::fs;
use std::path::Path;

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder,
    PointAttribute, PointIndex,
};
use glam::Vec3;
use ik_arm::document::{Document, Skin};
use ik_arm::io::{self, OpenOptions};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::skin::{SkinnedMesh, VertexWeights};
use serde_json::json;

use crate::common::Random;
use crate::common::damage::message;
use crate::gltf::skin::{Strip, warnings};
use crate::gltf::text::Text;

fn data(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/draco").join(name);
    fs::read(path).expect("a file of the tests")
}

fn document(bytes: &[u8]) -> Document {
    let opened = io::read("x.glb", bytes, &OpenOptions::default()).expect("it opens");
    assert_eq!(warnings(&opened), [""; 0]);
    opened.document
}

fn mesh(document: &Document) -> &SkinnedMesh {
    let skin = document.rig.skin.as_ref().and_then(Skin::mesh_skin).expect("a mesh");
    &skin.in_file().expect("a mesh").mesh
}

/// The triangles by their places: compression changes their order, and with which corner they begin.
fn triangles(mesh: &SkinnedMesh) -> Vec<[(Vec3, Vec3, VertexWeights); 3]> {
    let corner = |vertex: u32| {
        let vertex = vertex as usize;
        (mesh.mesh().positions[vertex], mesh.mesh().normals[vertex], mesh.weights()[vertex])
    };
    let key = |at: Vec3| (at * 1e3).round().to_array().map(|number| number as i64);
    let mut all: Vec<_> = mesh
        .mesh()
        .triangles
        .iter()
        .map(|corners| {
            let mut corners = corners.map(corner);
            let first = (0..3).min_by_key(|at| key(corners[*at].0)).expect("three");
            corners.rotate_left(first);
            corners
        })
        .collect();
    all.sort_by_key(|corners| corners.map(|(at, ..)| key(at)));
    all
}

fn assert_alike(plain: &SkinnedMesh, packed: &SkinnedMesh, near: f32) {
    let (plain, packed) = (triangles(plain), triangles(packed));
    assert_eq!(plain.len(), packed.len());
    for (one, other) in plain.iter().flatten().zip(packed.iter().flatten()) {
        assert!(one.0.distance(other.0) < near, "{} {}", one.0, other.0);
        assert!(one.1.distance(other.1) < 0.02, "{} {}", one.1, other.1);
        for (joint, weight) in one.2.iter() {
            assert!((other.2.of(joint) - weight).abs() < 2e-3, "{:?} {:?}", one.2, other.2);
        }
    }
}

#[test]
fn a_figure_that_dracos_authors_encoder_has_compressed_is_the_figure() {
    let [plain, packed] = ["plain.glb", "packed.glb"].map(|name| document(&data(name)));
    assert_eq!(plain.skeleton(), packed.skeleton());
    let (plain, packed) = (mesh(&plain), mesh(&packed));
    let size = plain.mesh().size();
    // Positions have 14 bits. So places are compared one by one instead of by their order.
    assert_eq!(plain.mesh().triangles.len(), packed.mesh().triangles.len());
    let corners = |mesh: &SkinnedMesh| mesh.mesh().triangles.as_flattened().to_vec();
    let known: Vec<u32> = corners(plain);
    for corner in corners(packed).into_iter().step_by(7) {
        let at = packed.mesh().positions[corner as usize];
        let apart = |vertex: &&u32| plain.mesh().positions[**vertex as usize].distance(at);
        let nearest = *known.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).expect("one");
        assert!(apart(&&nearest) < size / 4000.0, "{at}: {}", apart(&&nearest));
        let (one, other) = (plain.weights()[nearest as usize], packed.weights()[corner as usize]);
        for (joint, weight) in one.iter() {
            assert!((other.of(joint) - weight).abs() < 2e-3, "{one:?} {other:?}");
        }
    }
}

/// Compresses the strip of a file. Positions have their exact numbers.
fn packed(strip: &Strip, text: &mut Text, speed: i32) {
    let mut mesh = Mesh::new();
    let count = strip.positions.len();
    mesh.set_num_points(count);
    let mut add = |kind, width: u8, number: DataType, rows: Vec<Vec<u8>>| {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, width, number, false, count);
        for (index, row) in rows.iter().enumerate() {
            attribute.buffer_mut().write(index * row.len(), row);
        }
        mesh.add_attribute(attribute)
    };
    let floats = |rows: &[Vec<f32>]| -> Vec<Vec<u8>> {
        rows.iter().map(|row| row.iter().flat_map(|it| it.to_le_bytes()).collect()).collect()
    };
    let points: Vec<Vec<f32>> = strip.positions.iter().map(|it| it.to_array().to_vec()).collect();
    let weights: Vec<Vec<f32>> = strip
        .weights
        .iter()
        .map(|row| row.iter().map(|weight| f32::from(*weight) / 255.0).collect())
        .collect();
    let joints: Vec<Vec<u8>> = strip.joints.iter().map(|row| row.to_vec()).collect();
    let ids = [
        add(GeometryAttributeType::Position, 3, DataType::Float32, floats(&points)),
        add(GeometryAttributeType::Generic, 4, DataType::Uint8, joints),
        add(GeometryAttributeType::Generic, 4, DataType::Float32, floats(&weights)),
    ];
    let corners = strip.corners();
    mesh.set_num_faces(corners.len() / 3);
    for (face, corners) in corners.chunks(3).enumerate() {
        let face_corners = [corners[0], corners[1], corners[2]].map(PointIndex);
        mesh.set_face(FaceIndex(face as u32), face_corners);
    }
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut options = EncoderOptions::new();
    options.set_compression_level(10 - speed);
    let mut bytes = EncoderBuffer::new();
    encoder.encode(&options, &mut bytes).expect("encoded");
    let view = text.view(bytes.data());
    let names = ["POSITION", "JOINTS_0", "WEIGHTS_0"];
    let primitive = &mut text.json["meshes"][0]["primitives"][0];
    let attributes = primitive["attributes"].clone();
    let ids: serde_json::Map<_, _> =
        names.iter().zip(ids).map(|(name, id)| ((*name).to_owned(), json!(id))).collect();
    primitive["extensions"] =
        json!({ "KHR_draco_mesh_compression": { "bufferView": view, "attributes": ids } });
    for name in names {
        let accessor = attributes[name].as_u64().expect("an accessor") as usize;
        let accessor = text.json["accessors"][accessor].as_object_mut().expect("an accessor");
        accessor.remove("bufferView");
    }
    // What is not compressed would not fit the order of the decoded vertices.
    let attributes = text.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut();
    let attributes = attributes.expect("attributes");
    attributes.remove("NORMAL");
    attributes.remove("TEXCOORD_0");
    text.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
}

#[test]
fn every_form_of_compression_gives_the_same_mesh() {
    for speed in 0..=10 {
        let strip = Strip::new();
        let mut plain = strip.text();
        let attributes = plain.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut();
        attributes.expect("attributes").remove("NORMAL");
        let mut text = strip.text();
        packed(&strip, &mut text, speed);
        assert_alike(mesh(&document(&plain.binary())), mesh(&document(&text.binary())), 1e-3);
    }
}

#[test]
fn damaged_compression_leaves_the_mesh_out_with_the_reason() {
    let bytes = data("packed.glb");
    let mut random = Random(0xd4a);
    let json_end = 20 + u32::from_le_bytes(bytes[12..16].try_into().expect("four")) as usize;
    let mut left_out = 0;
    for _ in 0..300 {
        let mut damaged = bytes.clone();
        for _ in 0..1 + random.below(20) {
            let at = json_end + 8 + random.below(damaged.len() - json_end - 8);
            damaged[at] = random.next() as u8;
        }
        match io::read("x.glb", &damaged[..], &OpenOptions::default()) {
            Ok(opened) => {
                let told = warnings(&opened);
                left_out += usize::from(told.iter().any(|it| it.contains("cannot be decoded")));
            }
            Err(error) => {
                message(error);
            }
        }
    }
    assert!(left_out > 50, "{left_out}");
    let strip = Strip::new();
    let mut text = strip.text();
    packed(&strip, &mut text, 5);
    text.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] =
        json!(77);
    let opened = io::read("x.glb", &text.binary()[..], &OpenOptions::default()).expect("it opens");
    assert!(opened.document.rig.skin.is_none());
    let told = warnings(&opened);
    assert!(told[0].contains("KHR_draco_mesh_compression.bufferView"), "{told:?}");
    let mut text = strip.text();
    packed(&strip, &mut text, 5);
    text.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
        ["POSITION"] = json!(77);
    let opened = io::read("x.glb", &text.binary()[..], &OpenOptions::default()).expect("it opens");
    let told = warnings(&opened);
    assert!(told[0].contains("attributes.POSITION: must be the id of an attribute"), "{told:?}");
    let joints =
        (0..3).map(JointId::new).filter(|it| opened.document.skeleton().joint(*it).is_some());
    assert_eq!(joints.count(), 3, "the skeleton opens");
}
