//! Import of the meshes of skins, with every form of their numbers.

use std::io::Cursor;

use glam::{Affine3A, DMat4, DQuat, DVec3, Mat3, Mat4, Quat, Vec2, Vec3};
use ik_arm::document::{Document, Overlay, Skin};
use ik_arm::io::{self, Opened};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::skin::{Skinning, TriangleMesh};
use ik_arm::rig::{AttachedMesh, SkinSource};
use serde_json::{Value, json};

use crate::common::Random;
use crate::gltf::documents::{all, glb};
use crate::gltf::text::{Text, base64, push};

fn opened(text: &Text) -> Opened {
    io::parse("test.gltf", &text.embedded(), &io::OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn skin(opened: &Opened) -> &Skin {
    let warnings: Vec<String> = opened.warnings.iter().map(ToString::to_string).collect();
    opened.document.rig.skin.as_ref().unwrap_or_else(|| panic!("a skin; {warnings:?}"))
}

fn attached(opened: &Opened) -> &AttachedMesh {
    skin(opened).mesh().expect("a mesh")
}

pub fn warnings(opened: &Opened) -> Vec<String> {
    opened.warnings.iter().map(|it| format!("{}: {}", it.field, it.reason)).collect()
}

fn little_endian<const N: usize>(numbers: impl IntoIterator<Item = [u8; N]>) -> Vec<u8> {
    numbers.into_iter().flatten().collect()
}

/// A strip of four triangles with six vertices along three joints of [`Text::chain`].
pub struct Strip {
    pub positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    coordinates: Vec<Vec2>,
    /// For each vertex two joints and their weights, which are multiples of 1/255.
    pub joints: Vec<[u8; 4]>,
    pub weights: Vec<[u8; 4]>,
    triangles: Vec<[u32; 3]>,
}

impl Strip {
    pub fn new() -> Self {
        let vertices = || (0..6).map(|at| (at % 2, at / 2));
        Self {
            positions: vertices().map(|(x, y)| Vec3::new(x as f32 * 0.5, y as f32, 0.25)).collect(),
            normals: vertices().map(|(x, _)| Vec3::new(x as f32, 0.0, 1.0).normalize()).collect(),
            coordinates: vertices().map(|(x, y)| Vec2::new(x as f32, y as f32 * 0.5)).collect(),
            joints: vertices().map(|(_, y)| [y as u8, (y as u8 + 1) % 3, 0, 0]).collect(),
            weights: vertices()
                .map(|(x, _)| if x == 0 { [204, 51, 0, 0] } else { [153, 102, 0, 0] })
                .collect(),
            triangles: vec![[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]],
        }
    }

    /// The vertex at a place in the mesh's own space.
    fn vertex_at(&self, place: Vec3) -> usize {
        let apart = |vertex: &usize| self.positions[*vertex].distance(place);
        (0..6).min_by(|a, b| apart(a).total_cmp(&apart(b))).expect("a vertex")
    }

    pub fn corners(&self) -> Vec<u32> {
        self.triangles.as_flattened().to_vec()
    }

    fn floats(vectors: &[Vec3]) -> Vec<f32> {
        vectors.iter().flat_map(Vec3::to_array).collect()
    }

    /// A chain with the strip as its mesh, in the plainest form.
    pub fn text(&self) -> Text {
        let mut text = Text::chain();
        self.add_to(&mut text);
        text
    }

    /// Adds the strip as the mesh of the first skin.
    pub fn add_to(&self, text: &mut Text) {
        let weights: Vec<f32> =
            self.weights.as_flattened().iter().map(|weight| f32::from(*weight) / 255.0).collect();
        let coordinates: Vec<f32> = self.coordinates.iter().flat_map(Vec2::to_array).collect();
        let attributes = json!({
            "POSITION": text.floats(3, &Self::floats(&self.positions)),
            "NORMAL": text.floats(3, &Self::floats(&self.normals)),
            "TEXCOORD_0": text.floats(2, &coordinates),
            "WEIGHTS_0": text.floats(4, &weights),
        });
        let joints = text.accessor(self.joints.as_flattened(), 5121, 6, "VEC4");
        text.json["accessors"][joints]["normalized"] = json!(false);
        let corners = self.corners();
        let bytes = little_endian(corners.iter().map(|corner| corner.to_le_bytes()));
        let indices = text.accessor(&bytes, 5125, corners.len(), "SCALAR");
        text.json["meshes"] = json!([{
            "primitives": [{ "attributes": attributes, "indices": indices }]
        }]);
        attributes_of(text)["JOINTS_0"] = json!(joints);
        let body = push(&mut text.json["nodes"], json!({ "mesh": 0, "skin": 0 }));
        text.json["scenes"][0]["nodes"] = json!([0, body]);
    }
}

fn primitive(text: &mut Text) -> &mut Value {
    &mut text.json["meshes"][0]["primitives"][0]
}

fn attributes_of(text: &mut Text) -> &mut Value {
    &mut primitive(text)["attributes"]
}

#[track_caller]
fn assert_is_strip(opened: &Opened, strip: &Strip, what: &str) {
    let mesh = &attached(opened).mesh;
    let TriangleMesh { positions, normals, texture_coordinates, triangles, .. } = mesh.mesh();
    assert_eq!(triangles, &strip.triangles, "{what}");
    let vertices = positions.iter().zip(normals).zip(texture_coordinates).zip(mesh.weights());
    assert_eq!(positions.len(), 6, "{what}");
    for (vertex, (((position, normal), at), weights)) in vertices.enumerate() {
        assert!(position.distance(strip.positions[vertex]) < 1e-4, "{what}: {position}");
        assert!(normal.distance(strip.normals[vertex]) < 1e-4, "{what}: {normal}");
        assert!(at.distance(strip.coordinates[vertex]) < 1e-4, "{what}: {at}");
        for place in 0..2 {
            let joint = JointId::new(usize::from(strip.joints[vertex][place]));
            let weight = f32::from(strip.weights[vertex][place]) / 255.0;
            assert!((weights.of(joint) - weight).abs() < 1e-4, "{what}: {weights:?}");
        }
    }
}

#[test]
fn every_form_of_an_accessor_gives_the_same_mesh() {
    let strip = Strip::new();
    let plain = opened(&strip.text());
    assert_is_strip(&plain, &strip, "plain");
    assert_eq!(warnings(&plain), [""; 0]);
    let check = |what: &str, change: &dyn Fn(&mut Text)| {
        let mut text = strip.text();
        change(&mut text);
        assert_is_strip(&opened(&text), &strip, what);
        let binary = io::read("test.glb", &text.binary()[..], &io::OpenOptions::default())
            .expect("it opens");
        assert_is_strip(&binary, &strip, what);
    };
    check("joints of two bytes", &|text| {
        let wide = strip.joints.as_flattened().iter().map(|joint| u16::from(*joint).to_le_bytes());
        let joints = text.accessor(&little_endian(wide), 5123, 6, "VEC4");
        text.json["accessors"][joints]["normalized"] = json!(false);
        attributes_of(text)["JOINTS_0"] = json!(joints);
    });
    check("weights of one byte", &|text| {
        let weights = text.accessor(strip.weights.as_flattened(), 5121, 6, "VEC4");
        attributes_of(text)["WEIGHTS_0"] = json!(weights);
    });
    check("weights of two bytes", &|text| {
        let wide =
            strip.weights.as_flattened().iter().map(|it| (u16::from(*it) * 257).to_le_bytes());
        let weights = text.accessor(&little_endian(wide), 5123, 6, "VEC4");
        attributes_of(text)["WEIGHTS_0"] = json!(weights);
    });
    check("indices of one byte", &|text| {
        let corners: Vec<u8> = strip.corners().iter().map(|corner| *corner as u8).collect();
        let indices = text.accessor(&corners, 5121, corners.len(), "SCALAR");
        text.json["accessors"][indices]["normalized"] = json!(false);
        primitive(text)["indices"] = json!(indices);
    });
    check("indices of two bytes", &|text| {
        let corners = strip.corners();
        let bytes = little_endian(corners.iter().map(|corner| (*corner as u16).to_le_bytes()));
        let indices = text.accessor(&bytes, 5123, corners.len(), "SCALAR");
        text.json["accessors"][indices]["normalized"] = json!(false);
        primitive(text)["indices"] = json!(indices);
    });
    check("a triangle strip without indices", &|text| {
        primitive(text)["mode"] = json!(5);
        primitive(text).as_object_mut().expect("an object").remove("indices");
    });
    check("texture coordinates of two bytes", &|text| {
        let numbers = strip.coordinates.iter().flat_map(Vec2::to_array);
        let bytes = numbers.map(|number| ((number * 65535.0).round() as u16).to_le_bytes());
        let coordinates = text.accessor(&little_endian(bytes), 5123, 6, "VEC2");
        attributes_of(text)["TEXCOORD_0"] = json!(coordinates);
    });
    check("quantized normals with a stride", &|text| {
        let number = |number: f32| ((number * 127.0).round() as i8).to_le_bytes();
        let mut bytes = Vec::new();
        for normal in &strip.normals {
            bytes.extend(normal.to_array().map(number).as_flattened());
            bytes.push(99);
        }
        let normals = text.accessor(&bytes, 5120, 6, "VEC3");
        let view = text.json["accessors"][normals]["bufferView"].as_u64().expect("a view") as usize;
        text.json["bufferViews"][view]["byteStride"] = json!(4);
        attributes_of(text)["NORMAL"] = json!(normals);
    });
    check("positions between other numbers", &|text| {
        let mut bytes = vec![7; 4];
        for position in &strip.positions {
            bytes
                .extend(Strip::floats(&[*position]).iter().flat_map(|number| number.to_le_bytes()));
            bytes.extend([9; 8]);
        }
        let positions = text.accessor(&bytes, 5126, 6, "VEC3");
        let view =
            text.json["accessors"][positions]["bufferView"].as_u64().expect("a view") as usize;
        text.json["bufferViews"][view]["byteStride"] = json!(20);
        text.json["accessors"][positions]["byteOffset"] = json!(4);
        attributes_of(text)["POSITION"] = json!(positions);
    });
    for component in [5121, 5123, 5125] {
        for has_view in [true, false] {
            check("sparse positions", &|text| sparse(text, &strip, component, has_view));
        }
    }
}

/// Makes the positions sparse: all are wrong or missing in the view, but the sparse rows overwrite
/// them.
fn sparse(text: &mut Text, strip: &Strip, component: u32, has_view: bool) {
    let positions = text.floats(3, &[5.0; 18]);
    let places: Vec<u8> = (0..6_u32)
        .flat_map(|place| match component {
            5121 => vec![place as u8],
            5123 => (place as u16).to_le_bytes().to_vec(),
            _ => place.to_le_bytes().to_vec(),
        })
        .collect();
    let bytes = little_endian(Strip::floats(&strip.positions).iter().map(|it| it.to_le_bytes()));
    let (places, rows) = (text.view(&places), text.view(&bytes));
    let accessor = &mut text.json["accessors"][positions];
    accessor["sparse"] = json!({
        "count": 6,
        "indices": { "bufferView": places, "componentType": component },
        "values": { "bufferView": rows },
    });
    if !has_view {
        accessor.as_object_mut().expect("an object").remove("bufferView");
    }
    attributes_of(text)["POSITION"] = json!(positions);
}

#[test]
fn a_fan_turns_around_its_first_vertex() {
    let strip = Strip::new();
    let mut text = strip.text();
    primitive(&mut text)["mode"] = json!(6);
    primitive(&mut text).as_object_mut().expect("an object").remove("indices");
    let triangles = &attached(&opened(&text)).mesh.mesh().triangles.clone();
    assert_eq!(triangles[..], [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]);
}

#[test]
fn missing_normals_follow_from_the_triangles() {
    let mut text = Strip::new().text();
    attributes_of(&mut text).as_object_mut().expect("an object").remove("NORMAL");
    let opened = opened(&text);
    for normal in &attached(&opened).mesh.mesh().normals {
        assert!(normal.distance(Vec3::Z) < 1e-6, "{normal}");
    }
}

// Poses

/// A random transform of a node: the file's fields, and the matrix.
fn placed(random: &mut Random) -> (Value, DMat4) {
    let translation = random.vector(1.0);
    let rotation = Quat::from_mat3(&random.rotation()).normalize();
    let scale = Vec3::from_array([(); 3].map(|()| random.within(0.5..2.0)));
    let json = json!({
        "translation": translation.to_array(), "rotation": rotation.to_array(),
        "scale": scale.to_array(),
    });
    let matrix = DMat4::from_scale_rotation_translation(
        scale.as_dvec3(),
        rotation.as_dquat().normalize(),
        translation.as_dvec3(),
    );
    (json, matrix)
}

#[test]
fn the_rest_pose_is_that_of_the_file_with_any_nodes_and_inverse_bind_matrices() {
    let mut random = Random(0x51ce);
    for _ in 0..50 {
        let strip = Strip::new();
        let mut text = strip.text();
        let mut worlds: Vec<DMat4> = Vec::new();
        for node in 0..3 {
            let (fields, local) = placed(&mut random);
            for (key, value) in fields.as_object().expect("an object") {
                text.json["nodes"][node][key] = value.clone();
            }
            worlds.push(worlds.last().copied().unwrap_or(DMat4::IDENTITY) * local);
        }
        let binds: Vec<Mat4> = (0..3).map(|_| placed(&mut random).1.as_mat4()).collect();
        let numbers: Vec<f32> = binds.iter().flat_map(Mat4::to_cols_array).collect();
        let bytes = little_endian(numbers.iter().map(|number| number.to_le_bytes()));
        let accessor = text.accessor(&bytes, 5126, 3, "MAT4");
        text.json["skins"][0]["inverseBindMatrices"] = json!(accessor);
        // The order of the skin's joints is not that of the nodes.
        text.json["skins"][0]["joints"] = json!([1, 2, 0]);
        let opened = opened(&text);
        let mesh = &attached(&opened).mesh;
        let posed = mesh.posed(&mesh.pose(opened.document.skeleton()), Skinning::Linear);
        for (vertex, found) in posed.positions.iter().enumerate() {
            let mut expected = DVec3::ZERO;
            for place in 0..2 {
                let joint = usize::from(strip.joints[vertex][place]);
                let weight = f64::from(strip.weights[vertex][place]) / 255.0;
                let node = [1, 2, 0][joint];
                let matrix = worlds[node] * binds[joint].as_dmat4();
                expected += weight * matrix.transform_point3(strip.positions[vertex].as_dvec3());
            }
            assert!(found.as_dvec3().distance(expected) < 1e-4, "{found}, not {expected}");
        }
    }
}

#[test]
fn meshes_on_nodes_below_a_joint_follow_it_rigidly() {
    let strip = Strip::new();
    let mut text = strip.text();
    // The lamp is a child of the first joint, and not a joint itself.
    text.json["nodes"][3]["mesh"] = json!(1);
    text.json["nodes"][3]["scale"] = json!([1, -2, 1]);
    let flag = text.floats(3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    push(
        &mut text.json["meshes"],
        json!({ "primitives": [{ "attributes": { "POSITION": flag } }] }),
    );
    let mut opened = opened(&text);
    assert_eq!(warnings(&opened), [""; 0]);
    let at = Vec3::new(5.0, 0.0, 0.0);
    let corners = [at, at + Vec3::X, at - 2.0 * Vec3::Y];
    let shown = |document: &Document| {
        let mesh = &document.rig.skin.as_ref().expect("a skin").mesh().expect("a mesh").mesh;
        mesh.posed(&mesh.pose(document.skeleton()), Skinning::Linear)
    };
    let flag = |posed: &TriangleMesh| {
        // Meshes are in the order of their nodes.
        let triangle = posed.triangles[0];
        assert_eq!(posed.triangles.len(), strip.triangles.len() + 1);
        triangle.map(|corner| posed.positions[corner as usize])
    };
    // The scale mirrors the flag; its corners are still counter-clockwise seen from its front, +z.
    let [a, b, c] = flag(&shown(&opened.document));
    assert_eq!([a, b, c], [corners[0], corners[2], corners[1]]);
    let turn = Vec3::new(0.0, 0.0, std::f32::consts::FRAC_PI_2);
    opened.document.rig.skeleton_mut().set_rotation(JointId::new(0), turn).expect("a joint");
    for (found, rest) in flag(&shown(&opened.document)).iter().zip([a, b, c]) {
        let expected = Quat::from_rotation_z(turn.z) * rest;
        assert!(found.distance(expected) < 1e-5, "{found}, not {expected}");
    }
}

#[test]
fn five_joints_are_cut_to_the_four_heaviest_and_counted() {
    let strip = Strip::new();
    let mut text = strip.text();
    let mut joints = [[0_u8; 4]; 6];
    let mut weights = [0.0_f32; 24];
    // The third vertex has all weight of the two first joints in five parts, the others none more.
    joints[2] = [2, 2, 2, 2];
    weights[8..12].copy_from_slice(&[0.1, 0.1, 0.1, 0.1]);
    let accessor = text.accessor(joints.as_flattened(), 5121, 6, "VEC4");
    text.json["accessors"][accessor]["normalized"] = json!(false);
    attributes_of(&mut text)["JOINTS_1"] = json!(accessor);
    let accessor = text.floats(4, &weights);
    attributes_of(&mut text)["WEIGHTS_1"] = json!(accessor);
    let same_joint = opened(&text);
    assert_eq!(warnings(&same_joint), [""; 0], "weights of one joint add up to one");
    assert!((attached(&same_joint).mesh.weights()[2].of(JointId::new(2)) - 0.6 / 1.4).abs() < 1e-6);

    let nodes: Vec<Value> = (0..6)
        .map(|at| json!({ "name": format!("j{at}"), "children": if at < 5 { vec![at + 1] } else { vec![] } }))
        .collect();
    let mut many = Text::new(json!(nodes), &[0, 1, 2, 3, 4, 5]);
    let positions = many.floats(3, &Strip::floats(&strip.positions));
    let first = many.accessor(&[0, 1, 2, 3].repeat(6), 5121, 6, "VEC4");
    let second = many.accessor(&[4, 5, 0, 0].repeat(6), 5121, 6, "VEC4");
    for joints in [first, second] {
        many.json["accessors"][joints]["normalized"] = json!(false);
    }
    let mut of_first = [0.25_f32; 24];
    let mut of_second = [0.0_f32; 24];
    of_first[0..4].copy_from_slice(&[0.3, 0.2, 0.2, 0.05]);
    of_second[0..4].copy_from_slice(&[0.15, 0.1, 0.0, 0.0]);
    let (of_first, of_second) = (many.floats(4, &of_first), many.floats(4, &of_second));
    many.json["meshes"] = json!([{ "primitives": [{ "attributes": {
        "POSITION": positions, "JOINTS_0": first, "WEIGHTS_0": of_first,
        "JOINTS_1": second, "WEIGHTS_1": of_second,
    } }] }]);
    push(&mut many.json["nodes"], json!({ "mesh": 0, "skin": 0 }));
    let cut = opened(&many);
    assert_eq!(
        warnings(&cut),
        [
            "skins[0]: 1 of 6 vertices follow more than four joints; the four heaviest are kept, and up to \
          15.0 % of the weight of a vertex is lost"
        ]
    );
    let kept = attached(&cut).mesh.weights()[0];
    let expected = [(0, 0.3), (1, 0.2), (2, 0.2), (4, 0.15)];
    for ((joint, weight), (index, part)) in kept.iter().zip(expected) {
        assert_eq!(joint.index(), index);
        assert!((weight - part / 0.85).abs() < 1e-6, "{kept:?}");
    }
}

// Materials

fn png(colour: [u8; 3]) -> Vec<u8> {
    encoded(colour, image::ImageFormat::Png)
}

fn encoded(colour: [u8; 3], format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = image::RgbImage::from_pixel(8, 4, image::Rgb(colour));
    image.write_to(&mut bytes, format).expect("an image");
    bytes.into_inner()
}

/// Repeats the only primitive, once with each of the first materials.
fn repeat_with_materials(text: &mut Text, count: usize) {
    let first = primitive(text).clone();
    let with = |material: usize| {
        let mut primitive = first.clone();
        primitive["material"] = json!(material);
        primitive
    };
    text.json["meshes"][0]["primitives"] = (0..count).map(with).collect();
}

#[test]
fn base_colours_and_their_textures_are_read_from_every_place() {
    let strip = Strip::new();
    let folder = tempfile::tempdir().expect("a folder");
    let jpeg = encoded([200, 100, 50], image::ImageFormat::Jpeg);
    std::fs::write(folder.path().join("skin 1.jpg"), &jpeg).expect("a file");
    let mut text = strip.text();
    repeat_with_materials(&mut text, 4);
    let view = text.view(&png([10, 20, 30]));
    text.json["images"] = json!([
        { "bufferView": view, "mimeType": "image/png" },
        { "uri": format!("data:image/png;base64,{}", base64(&png([40, 50, 60]))) },
        { "uri": "skin%201.jpg" },
    ]);
    text.json["textures"] = json!([{ "source": 0 }, { "source": 1 }, { "source": 2 }]);
    let textured = |texture: usize| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } });
    text.json["materials"] = json!([
        textured(0), textured(1), textured(2),
        { "pbrMetallicRoughness": { "baseColorFactor": [0.2140411, 1.0, 0.0, 0.5] } },
    ]);
    let path = folder.path().join("figure.gltf");
    std::fs::write(&path, text.embedded()).expect("a file");
    let opened = io::open(&path, &io::OpenOptions::default()).expect("it opens");
    assert_eq!(warnings(&opened), [""; 0]);
    let parts = &attached(&opened).parts;
    assert_eq!(parts.iter().map(|part| part.triangles).collect::<Vec<_>>(), [4; 4]);
    let near = |found: [u8; 4], expected: [u8; 3]| {
        let gap = |channel: usize| found[channel].abs_diff(expected[channel]) <= 2;
        (0..3).all(gap) && found[3] == 255
    };
    for (part, colour) in parts.iter().zip([[10, 20, 30], [40, 50, 60], [200, 100, 50]]) {
        let texture = part.texture.as_ref().expect("a texture");
        assert_eq!(texture.size, [8, 4]);
        let pixels = io::texture_pixels(texture).expect("pixels");
        assert!(pixels.iter().all(|pixel| near(*pixel, colour)), "{colour:?}");
        assert_eq!(part.colour, [1.0; 3]);
    }
    assert!(parts[3].texture.is_none());
    let [red, green, blue] = parts[3].colour;
    assert!((red - 0.5).abs() < 1e-4 && green == 1.0 && blue == 0.0, "{:?}", parts[3].colour);
    assert_eq!(skin(&opened).colour, [1.0; 3], "the colours of the file are not changed");
}

#[test]
fn what_is_not_read_is_told_in_one_remark() {
    let mut text = Strip::new().text();
    primitive(&mut text)["material"] = json!(0);
    text.json["materials"] = json!([{
        "normalTexture": { "index": 0 },
        "extensions": { "KHR_materials_clearcoat": {} },
    }]);
    push(&mut text.json["meshes"], json!({ "primitives": [] }));
    push(&mut text.json["nodes"], json!({ "mesh": 1 }));
    let opened = opened(&text);
    assert_eq!(
        warnings(&opened),
        [
            "meshes: not read: 1 mesh that follows no joint of the figure, KHR_materials_clearcoat, normal textures"
        ]
    );
}

#[test]
fn both_sides_alpha_emission_and_moved_textures_are_read_and_written() {
    let strip = Strip::new();
    let mut text = strip.text();
    repeat_with_materials(&mut text, 5);
    let uri = format!("data:image/png;base64,{}", base64(&png([10, 20, 30])));
    text.json["images"] = json!([{ "uri": uri }]);
    text.json["textures"] = json!([{ "source": 0 }]);
    let transform = json!({ "offset": [0.25, -1.0], "rotation": 0.5, "scale": [2.0, 3.0] });
    let moved = json!({ "index": 0, "extensions": { "KHR_texture_transform": transform } });
    text.json["extensionsRequired"] = json!(["KHR_texture_transform"]);
    let masked = |cutoff: Option<f64>, opacity: f64, texture: Value| {
        let mut material = json!({ "alphaMode": "MASK", "pbrMetallicRoughness": {
            "baseColorFactor": [1.0, 1.0, 1.0, opacity], "baseColorTexture": texture
        } });
        if let Some(cutoff) = cutoff {
            material["alphaCutoff"] = json!(cutoff);
        }
        material
    };
    text.json["materials"] = json!([
        { "doubleSided": true },
        masked(None, 0.8, moved),
        masked(Some(0.3), 1.0, json!({ "index": 0 })),
        // Hidden: no texel is as opaque as that.
        masked(Some(0.9), 0.5, json!({ "index": 0 })),
        { "alphaMode": "BLEND", "emissiveFactor": [0.0, 0.2140411, 1.0],
          "pbrMetallicRoughness": { "baseColorFactor": [1.0, 1.0, 1.0, 0.25] } },
    ]);
    let opened = opened(&text);
    assert_eq!(warnings(&opened), [""; 0]);
    let exported = glb(&opened.document);
    let again = io::read("x.glb", &exported[..], &io::OpenOptions::default()).expect("reads");
    for opened in [&opened, &again] {
        let parts = &attached(opened).parts;
        let told: Vec<_> = parts
            .iter()
            .map(|part| {
                (part.look.is_double_sided, (part.look.alpha_cutoff * 1000.0).round() as u32)
            })
            .collect();
        assert_eq!(told, [(true, 0), (false, 625), (false, 300), (false, 0)]);
        let opacities: Vec<_> = parts.iter().map(|part| part.look.opacity).collect();
        assert_eq!(opacities, [None, None, None, Some(0.25)]);
        let emission = parts[3].look.emission;
        assert!((emission[1] - 0.5).abs() < 1e-4 && emission[2] == 1.0, "{emission:?}");
        let coordinates = &attached(opened).mesh.mesh().texture_coordinates;
        let count = strip.coordinates.len();
        for (found, own) in coordinates[count..2 * count].iter().zip(&strip.coordinates) {
            let (sin, cos) = 0.5_f32.sin_cos();
            let at = *own * Vec2::new(2.0, 3.0);
            let turned = Vec2::new(cos * at.x + sin * at.y, cos * at.y - sin * at.x);
            let expected = turned + Vec2::new(0.25, -1.0);
            assert!(found.distance(expected) < 1e-5, "{found}, not {expected}");
        }
    }
}

#[test]
fn textures_of_emission_are_read_saved_and_written() {
    let mut text = Strip::new().text();
    repeat_with_materials(&mut text, 4);
    let image = |colour| format!("data:image/png;base64,{}", base64(&png(colour)));
    text.json["images"] = json!([{ "uri": image([10, 20, 30]) }, { "uri": image([200, 0, 0]) }]);
    text.json["textures"] = json!([{ "source": 0 }, { "source": 1 }]);
    let base = json!({ "baseColorTexture": { "index": 0 } });
    let shine = json!([1, 1, 1]);
    text.json["materials"] = json!([
        { "emissiveTexture": { "index": 1 }, "emissiveFactor": shine, "pbrMetallicRoughness": base },
        { "emissiveTexture": { "index": 1 }, "emissiveFactor": shine },
        // With coordinates of its own, which are moved, and one that is not there, so that it does
        // not shine all over.
        { "emissiveTexture": { "index": 1, "texCoord": 1, "extensions": {
              "KHR_texture_transform": { "offset": [0.25, -0.5], "scale": [2, 2] } } },
          "emissiveFactor": shine, "pbrMetallicRoughness": base },
        { "emissiveTexture": { "index": 9 }, "emissiveFactor": shine },
    ]);
    let own: Vec<Vec2> =
        (0..6).map(|at| Vec2::new(at as f32 * 0.1, 0.7 - at as f32 * 0.1)).collect();
    let numbers: Vec<f32> = own.iter().flat_map(Vec2::to_array).collect();
    let accessor = text.floats(2, &numbers);
    for primitive in text.json["meshes"][0]["primitives"].as_array_mut().expect("primitives") {
        primitive["attributes"]["TEXCOORD_1"] = json!(accessor);
    }
    let opened = opened(&text);
    let told = warnings(&opened).join("\n");
    assert_eq!(warnings(&opened).len(), 1, "{told}");
    assert!(told.contains("must be below 2, the number of textures, got 9"), "{told}");
    let exported = glb(&opened.document);
    let again = io::read("x.glb", &exported[..], &io::OpenOptions::default()).expect("reads");
    let mut packed = opened.document.clone();
    let skin = packed.rig.skin.as_ref().expect("a skin").mesh_skin().expect("a mesh");
    let skin = Skin::new(SkinSource::Mesh(skin.packed().expect("a mesh")));
    packed.rig.skin = Some(skin);
    for document in [&opened.document, &again.document, &documents_again(&packed)] {
        let mesh = document.rig.skin.as_ref().expect("a skin").mesh().expect("a mesh");
        let look: Vec<_> = mesh
            .parts
            .iter()
            .map(|part| {
                (part.texture.is_some(), part.emission_texture.is_some(), part.look.emission[0])
            })
            .collect();
        let shining = [(true, true, 1.0), (false, true, 1.0), (true, true, 1.0)];
        assert_eq!(look, [&shining[..], &[(false, false, 0.0)]].concat());
        let file =
            |part: usize| &mesh.parts[part].emission_texture.as_ref().expect("a texture").file;
        assert_eq!((file(0), file(1)), (&png([200, 0, 0]), &png([200, 0, 0])));
        let strip = Strip::new();
        let TriangleMesh { texture_coordinates, emission_coordinates, triangles, .. } =
            mesh.mesh.mesh();
        let mut corners = triangles.as_flattened().iter().map(|corner| *corner as usize);
        for (number, part) in mesh.parts.iter().enumerate() {
            for corner in corners.by_ref().take(3 * part.triangles) {
                let vertex = strip.vertex_at(mesh.mesh.mesh().positions[corner]);
                let base = strip.coordinates[vertex];
                let expected = match number {
                    2 => own[vertex] * 2.0 + Vec2::new(0.25, -0.5),
                    _ => base,
                };
                // The last part has no image, and so no coordinates in an exported file.
                if number < 3 {
                    let gap = texture_coordinates[corner].distance(base)
                        + emission_coordinates[corner].distance(expected);
                    assert!(gap < 1e-5, "part {number}, vertex {vertex}: {gap}");
                }
            }
        }
    }
}

#[test]
fn colours_of_vertices_are_read_in_every_form_and_written() {
    let strip = Strip::new();
    let linear = [0.0, 0.1, 0.5, 1.0, 0.25, 0.01];
    let srgb = |linear: f32| match linear {
        ..0.003_130_8 => 12.92 * linear,
        _ => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
    };
    let expected = |vertex: usize, places: f32| -> [u8; 3] {
        let of = |channel: usize| {
            let stored = (linear[(vertex + channel) % 6] * places).round() / places;
            (255.0 * srgb(stored)).round() as u8
        };
        [of(0), of(1), of(2)]
    };
    let channels =
        |vertex: usize, count: usize| (0..count).map(move |at| linear[(vertex + at) % 6]);
    let byte = |number: f32| (255.0 * number).round() as u8;
    let short = |number: f32| (65535.0 * number).round() as u16;
    for (form, places) in [("floats", 1e6), ("bytes", 255.0), ("shorts", 65535.0)] {
        let mut text = strip.text();
        let numbers = |count: usize| (0..6).flat_map(move |vertex| channels(vertex, count));
        let accessor = match form {
            "floats" => text.floats(3, &numbers(3).collect::<Vec<_>>()),
            "bytes" => {
                let bytes: Vec<u8> = numbers(4).map(byte).collect();
                text.accessor(&bytes, 5121, 6, "VEC4")
            }
            _ => {
                let bytes = little_endian(numbers(4).map(|number| short(number).to_le_bytes()));
                text.accessor(&bytes, 5123, 6, "VEC4")
            }
        };
        attributes_of(&mut text)["COLOR_0"] = json!(accessor);
        let opened = opened(&text);
        assert_eq!(warnings(&opened), [""; 0]);
        assert_eq!(skin(&opened).colour, [1.0; 3], "the file has colours");
        let exported = glb(&opened.document);
        let again = io::read("x.glb", &exported[..], &io::OpenOptions::default()).expect("reads");
        let packed = documents_again(&opened.document);
        for document in [&opened.document, &again.document, &packed] {
            let mesh = &document.rig.skin.as_ref().expect("a skin").mesh().expect("a mesh").mesh;
            for (vertex, found) in mesh.mesh().colours.iter().enumerate() {
                assert_eq!(found[..3], expected(vertex, places), "{form}, vertex {vertex}");
            }
            assert_eq!(mesh.mesh().colours.len(), 6);
        }
    }
}

#[test]
fn a_texture_that_cannot_be_decoded_is_left_out_with_the_reason() {
    let mut text = Strip::new().text();
    primitive(&mut text)["material"] = json!(0);
    text.json["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    text.json["textures"] = json!([{ "source": 0 }]);
    text.json["images"] = json!([{ "uri": "data:image/png;base64,AAAA" }]);
    let opened = opened(&text);
    let warnings = warnings(&opened);
    assert!(warnings[0].starts_with("images[0]: not read: "), "{warnings:?}");
    assert!(attached(&opened).parts[0].texture.is_none());
}

#[test]
fn a_texture_is_decoded_when_it_is_drawn_and_drawn_as_white_if_its_pixels_are_broken() {
    // 400 MB of pixels, of which the file holds 32.
    let mut file = png([10, 20, 30]);
    file[16..24].copy_from_slice(&[16_384_u32.to_be_bytes(), 6_144_u32.to_be_bytes()].concat());
    let checksum = crc32fast::hash(&file[12..29]).to_be_bytes();
    file[29..33].copy_from_slice(&checksum);
    let mut text = Strip::new().text();
    primitive(&mut text)["material"] = json!(0);
    text.json["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    text.json["textures"] = json!([{ "source": 0 }]);
    let uri = format!("data:image/png;base64,{}", base64(&file));
    text.json["images"] = json!([{ "uri": uri }]);
    let read = opened(&text);
    assert_eq!(warnings(&read), [""; 0]);
    let texture = attached(&read).parts[0].texture.as_ref().expect("a texture");
    assert_eq!((texture.size, &texture.file), ([16_384, 6_144], &file));
    let told: Vec<_> =
        io::undrawn_textures(&read.document).iter().map(ToString::to_string).collect();
    assert!(told.len() == 1 && told[0].starts_with("a texture is drawn as white: "), "{told:?}");
}

// Skins

#[test]
fn a_mesh_has_the_scales_that_the_chosen_animation_gives_and_keeps_them_in_documents() {
    let mut text = Strip::new().text();
    let times = text.floats(1, &[0.0, 1.0]);
    // One animation doubles the figure and the other halves it.
    for (name, scale) in [("two", 2.0), ("half", 0.5)] {
        let scales = text.floats(3, &[scale; 6]);
        text.json.as_object_mut().expect("an object").entry("animations").or_insert(json!([]));
        let sampler = json!({ "input": times, "output": scales });
        let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "scale" } });
        let animation = json!({ "name": name, "samplers": [sampler], "channels": [channel] });
        push(&mut text.json["animations"], animation);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let [file, saved] = ["x.gltf", "x.json"].map(|name| folder.path().join(name));
    std::fs::write(&file, text.embedded()).expect("written");
    for (name, scale) in [("two", 2.0), ("half", 0.5)] {
        let opened = io::open(&file, &io::OpenOptions::of_animation(name)).expect("it opens");
        io::save(&opened.document, &saved).expect("saved");
        let again = io::open(&saved, &io::OpenOptions::default()).expect("it opens");
        assert_eq!(warnings(&again), [""; 0]);
        for opened in [&opened, &again] {
            let mesh = &attached(opened).mesh;
            let posed = mesh.posed(&mesh.pose(opened.document.skeleton()), Skinning::Linear);
            let strip = Strip::new();
            for (vertex, found) in posed.positions.iter().enumerate() {
                // Without inverse bind matrices, a joint that is so high lifts the mesh.
                let lifted = (0..2).map(|place| {
                    let height = f32::from(strip.joints[vertex][place]);
                    height * f32::from(strip.weights[vertex][place]) / 255.0
                });
                let expected = scale * (strip.positions[vertex] + Vec3::Y * lifted.sum::<f32>());
                assert!(found.distance(expected) < 1e-5, "{name}: {found}, not {expected}");
            }
        }
    }
}

#[test]
fn of_several_figures_each_has_its_own_mesh() {
    let mut text = Strip::new().text();
    let of_other = json!({ "name": "other root", "children": [] });
    let node = push(&mut text.json["nodes"], of_other);
    push(&mut text.json["skins"], json!({ "name": "other", "joints": [node] }));
    let corner = text.floats(3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let joints = text.accessor(&[0; 12], 5121, 3, "VEC4");
    text.json["accessors"][joints]["normalized"] = json!(false);
    let weights = text.floats(4, &[1.0, 0.0, 0.0, 0.0].repeat(3));
    push(
        &mut text.json["meshes"],
        json!({ "primitives": [{
        "attributes": { "POSITION": corner, "JOINTS_0": joints, "WEIGHTS_0": weights }
    }] }),
    );
    push(&mut text.json["nodes"], json!({ "mesh": 1, "skin": 1 }));
    for (name, triangles) in [("skin", 4), ("other", 1)] {
        let opened = io::parse("x.gltf", &text.embedded(), &io::OpenOptions::of_skeleton(name))
            .expect("it opens");
        assert_eq!(attached(&opened).mesh.mesh().triangles.len(), triangles, "{name}");
    }
}

#[test]
fn all_skins_of_a_figure_are_shown_each_with_its_own_inverse_bind_matrices() {
    let mut random = Random(390);
    for case in 0..30 {
        let strip = Strip::new();
        let mut text = strip.text();
        let mut worlds: Vec<DMat4> = Vec::new();
        for node in 0..3 {
            let (at, turn) = (random.vector(1.0), Quat::from_mat3(&random.rotation()).normalize());
            let size = random.within(0.5..2.0);
            text.json["nodes"][node]["translation"] = json!(at.to_array());
            text.json["nodes"][node]["rotation"] = json!(turn.to_array());
            text.json["nodes"][node]["scale"] = json!([size, size, size]);
            let (turn, size) = (turn.as_dquat().normalize(), DVec3::splat(size.into()));
            let local = DMat4::from_scale_rotation_translation(size, turn, at.as_dvec3());
            worlds.push(worlds.last().copied().unwrap_or(DMat4::IDENTITY) * local);
        }
        let times = text.floats(1, &[0.0, 0.5, 1.0]);
        let turns: Vec<f32> =
            (0..3).flat_map(|_| Quat::from_scaled_axis(random.vector(2.0)).to_array()).collect();
        let turned = text.floats(4, &turns);
        text.animate(1, "rotation", "LINEAR", times, turned);
        // The same mesh on three skins, each with joints in an order of its own. The second has the
        // matrices of the first, the third other ones.
        let orders = [[0, 1, 2], [2, 0, 1], [1, 2, 0]];
        let first: Vec<Mat4> = (0..3).map(|_| placed(&mut random).1.as_mat4()).collect();
        let third: Vec<Mat4> = (0..3).map(|_| placed(&mut random).1.as_mat4()).collect();
        let binds = [&first, &first, &third];
        text.json["skins"] = json!([]);
        for (order, binds) in orders.iter().zip(binds) {
            let numbers: Vec<f32> =
                order.iter().flat_map(|node: &usize| binds[*node].to_cols_array()).collect();
            let bytes = little_endian(numbers.iter().map(|number| number.to_le_bytes()));
            let accessor = text.accessor(&bytes, 5126, 3, "MAT4");
            let skin = json!({ "joints": order, "inverseBindMatrices": accessor });
            let skin = push(&mut text.json["skins"], skin);
            if skin > 0 {
                push(&mut text.json["nodes"], json!({ "mesh": 0, "skin": skin }));
            }
        }
        let opened = opened(&text);
        assert_eq!(warnings(&opened), [""; 0]);
        assert_eq!(opened.skeletons.len(), 1);
        let exported = glb(&opened.document);
        let again = io::read("x.glb", &exported[..], &io::OpenOptions::default()).expect("reads");
        let packed = documents_again(&opened.document);
        for (document, sets) in [(&opened.document, 2), (&again.document, 2), (&packed, 2)] {
            let mesh = &document.rig.skin.as_ref().expect("a skin").mesh().expect("a mesh").mesh;
            assert_eq!(mesh.bind_sets().len(), sets, "case {case}");
            for time in [0.0, 0.2, 0.5, 0.7, 1.0] {
                let quarter = |index: usize| {
                    DQuat::from_array(std::array::from_fn(|at| f64::from(turns[4 * index + at])))
                        .normalize()
                };
                let turn = match time {
                    ..0.5 => quarter(0).slerp(quarter(1), time / 0.5),
                    _ => quarter(1).slerp(quarter(2), time / 0.5 - 1.0),
                };
                let node = &text.json["nodes"][1];
                let vector = |key: &str| {
                    let numbers = node[key].as_array().expect("numbers");
                    DVec3::from_array(std::array::from_fn(|at| numbers[at].as_f64().expect("f64")))
                };
                let local = DMat4::from_scale_rotation_translation(
                    vector("scale"),
                    turn,
                    vector("translation"),
                );
                let turned = [
                    worlds[0],
                    worlds[0] * local,
                    worlds[0] * local * worlds[1].inverse() * worlds[2],
                ];
                let posed = document.at(time).into_document();
                let skeleton = posed.skeleton();
                let found = mesh.posed(&mesh.pose(skeleton), Skinning::Linear).positions;
                assert_eq!(found.len(), 18);
                let mut expected: Vec<DVec3> = Vec::new();
                for skin in 0..3 {
                    for (vertex, position) in strip.positions.iter().enumerate() {
                        let shares = (0..2).map(|place| {
                            let node = orders[skin][usize::from(strip.joints[vertex][place])];
                            let weight = f64::from(strip.weights[vertex][place]) / 255.0;
                            let matrix = turned[node] * binds[skin][node].as_dmat4();
                            weight * matrix.transform_point3(position.as_dvec3())
                        });
                        expected.push(shares.sum());
                    }
                }
                for at in expected {
                    let nearest = found.iter().map(|it| it.as_dvec3().distance(at));
                    let nearest = nearest.fold(f64::INFINITY, f64::min);
                    assert!(nearest < 1e-3, "case {case} at {time}: {nearest} from {at}");
                }
            }
        }
    }
}

/// A document, saved with its mesh in itself and read again.
pub fn documents_again(document: &Document) -> Document {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("x.json");
    io::save(document, &path).expect("saved");
    io::open(&path, &io::OpenOptions::default()).expect("it opens").document
}

#[test]
fn a_mesh_that_cannot_be_read_is_left_out_with_the_reason() {
    let refusal = |change: &dyn Fn(&mut Text)| {
        let mut text = Strip::new().text();
        change(&mut text);
        let opened = opened(&text);
        assert_eq!(opened.document.skeleton().joints().len(), 3);
        assert!(opened.document.rig.skin.is_none());
        warnings(&opened).remove(0)
    };
    let indices = refusal(&|text| {
        let far = text.accessor(&[0, 1, 9], 5121, 3, "SCALAR");
        text.json["accessors"][far]["normalized"] = json!(false);
        primitive(text)["indices"] = json!(far);
    });
    assert!(
        indices.ends_with("must be below 6, the number of vertices, got 9; the skin is left out"),
        "{indices}"
    );
    let joints = refusal(&|text| {
        let far = text.accessor(&[7; 24], 5121, 6, "VEC4");
        text.json["accessors"][far]["normalized"] = json!(false);
        attributes_of(text)["JOINTS_0"] = json!(far);
    });
    assert!(joints.contains("must be below 3, the number of joints, got 7"), "{joints}");
    let short = refusal(&|text| {
        let short = text.floats(3, &[0.0; 9]);
        attributes_of(text)["NORMAL"] = json!(short);
    });
    assert!(short.contains("attributes.NORMAL: must have 6 rows like POSITION, got 3"), "{short}");
    let infinite = refusal(&|text| {
        let far = text.floats(3, &[f32::INFINITY; 18]);
        attributes_of(text)["POSITION"] = json!(far);
    });
    assert!(infinite.contains("texture coordinates must be finite"), "{infinite}");
    let packed = refusal(&|text| {
        text.json["extensionsRequired"] = json!(["EXT_meshopt_compression"]);
    });
    assert!(packed.starts_with("extensionsRequired: "), "{packed}");
    let sparse = refusal(&|text| {
        let strip = Strip::new();
        self::sparse(text, &strip, 5121, true);
        text.json["accessors"].as_array_mut().expect("a list").last_mut().expect("one")["count"] =
            json!(3);
    });
    assert!(sparse.contains("must be below 3, the number of rows, got 3"), "{sparse}");
}

// Round trips

/// The posed vertices of the corners of all triangles, in order.
pub fn corners(document: &Document, time: f64) -> Vec<Vec3> {
    let at = document.at(time);
    let rig = &at.document().rig;
    let mesh = &rig.skin.as_ref().expect("a skin").mesh().expect("a mesh").mesh;
    let posed = mesh.posed(&mesh.pose(at.skeleton()), Skinning::Linear);
    posed.triangles.as_flattened().iter().map(|corner| posed.positions[*corner as usize]).collect()
}

#[test]
fn an_exported_skin_has_the_same_vertices_at_every_key_when_it_is_opened() {
    let with_skin = all().into_iter().filter(|(_, document)| document.rig.skin.is_some());
    let mut count = 0;
    let mut random = Random(0x1a57);
    for (name, mut document) in with_skin {
        // A scale that differs between axes cannot be exported: nodes only turn and move.
        let mirror = if random.coin() { -1.0 } else { 1.0 };
        let linear = random.rotation() * Mat3::from_diagonal(Vec3::new(mirror, 1.0, 1.0));
        let transform =
            Affine3A::from_mat3_translation(linear * random.within(0.2..3.0), Vec3::ONE);
        document.skeleton_mut().set_transform(transform).expect("finite");
        let read = io::read("x.glb", &glb(&document)[..], &io::OpenOptions::default())
            .expect("it opens")
            .document;
        let size = document.rig.skin.as_ref().expect("a skin").mesh().expect("a mesh");
        let scale = transform.matrix3.determinant().abs().cbrt() * document.metres_per_unit();
        let size = size.mesh.mesh().size() * scale;
        let frames = if document.is_animated() { document.timeline.frames() } else { 1 };
        for frame in (0..frames).step_by(frames.div_ceil(20)) {
            let time = document.timeline.time(frame);
            let expected = corners(&document, time);
            let found = corners(&read, time - document.timeline.start);
            assert_eq!(found.len(), expected.len(), "{name}");
            for (found, expected) in found.iter().zip(expected) {
                let expected = expected * document.metres_per_unit();
                let gap = found.distance(expected);
                assert!(gap < 1e-4 * size, "{name}, frame {frame}: {found}, not {expected}");
            }
        }
        count += 1;
    }
    assert!(count >= 4, "{count}");
}

#[test]
fn parts_and_textures_survive_export_and_import() {
    let strip = Strip::new();
    let mut text = strip.text();
    let mut second = primitive(&mut text).clone();
    second["material"] = json!(1);
    primitive(&mut text)["material"] = json!(0);
    push(&mut text.json["meshes"][0]["primitives"], second);
    let view = text.view(&png([10, 200, 30]));
    text.json["images"] = json!([{ "bufferView": view, "mimeType": "image/png" }]);
    text.json["textures"] = json!([{ "source": 0 }]);
    text.json["materials"] = json!([
        { "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "baseColorFactor": [1, 0.25, 1, 1] } },
        { "pbrMetallicRoughness": { "baseColorFactor": [0, 0.5, 1, 1] } },
    ]);
    let before = opened(&text);
    let after = io::read("x.glb", &glb(&before.document)[..], &io::OpenOptions::default())
        .expect("it opens");
    assert_eq!(warnings(&after), [""; 0]);
    let (before_parts, after_parts) = (&attached(&before).parts, &attached(&after).parts);
    assert_eq!(before_parts.len(), 2);
    for (before, after) in before_parts.iter().zip(after_parts) {
        assert_eq!((before.triangles, &before.texture), (after.triangles, &after.texture));
        let gap = |channel: usize| (before.colour[channel] - after.colour[channel]).abs();
        assert!((0..3).all(|channel| gap(channel) < 1e-5), "{before:?}, {after:?}");
    }
    let coordinates = &attached(&after).mesh.mesh().texture_coordinates;
    assert_eq!(coordinates[..6], strip.coordinates[..]);
}

#[test]
fn a_skin_of_a_file_is_shown_instead_of_the_bones_and_blended_linearly() {
    let opened = opened(&Strip::new().text());
    let display = opened.document.display;
    assert!(display.shows(Overlay::Skin) && !display.shows(Overlay::Bones));
    assert_eq!(skin(&opened).skinning, Skinning::Linear);
    let SkinSource::Mesh(mesh) = &skin(&opened).source else { panic!("from a file") };
    assert!(mesh.file().is_none(), "a text without a path can only be packed");
}

#[test]
fn the_bones_are_shown_with_a_skin_that_is_next_to_nothing() {
    for (scale, shows_bones) in [(1.0, false), (0.02, true)] {
        let mut strip = Strip::new();
        strip.positions.iter_mut().for_each(|position| *position *= scale);
        // All of it on the first joint, so that the others do not pull it apart.
        strip.joints.fill([0; 4]);
        strip.weights.fill([255, 0, 0, 0]);
        let document = opened(&strip.text()).document;
        assert!(document.display.shows(Overlay::Skin));
        assert_eq!(document.display.shows(Overlay::Bones), shows_bones, "{scale}");
    }
}

#[test]
fn triangles_of_a_mirrored_node_are_turned_around() {
    let strip = Strip::new();
    let mut text = strip.text();
    text.json["nodes"][4]["scale"] = json!([-1, 1, 1]);
    let opened = opened(&text);
    let mesh = attached(&opened).mesh.mesh();
    assert_eq!(mesh.positions, strip.positions, "the place of the node makes no difference");
    let turned: Vec<[u32; 3]> = strip.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    assert_eq!(mesh.triangles, turned);
}

#[test]
fn meshes_beyond_the_limits_are_refused_before_they_are_read() {
    let mut text = Strip::new().text();
    let first = primitive(&mut text).clone();
    text.json["meshes"][0]["primitives"] = json!(vec![first; 10_001]);
    let opened = opened(&text);
    let said = warnings(&opened).remove(0);
    assert!(said.contains("a skin must have at most 10000 primitives, got 10001"), "{said}");
}
