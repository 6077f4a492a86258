//! OBJ: meshes are those that a reader of the tests has, with their materials; joints placed in them
//! can be bound, saved and exported.

use std::fs;
use std::path::PathBuf;

use glam::{DVec3, Vec2, Vec3};
use ik_arm::document::{Document, Overlay, Skin};
use ik_arm::io::{self, OpenOptions, Opened, Progress};
use ik_arm::kinematics::skeleton::{Joint, JointId};
use ik_arm::kinematics::skin::{SkinnedMesh, Skinning};
use ik_arm::rig::{MeshSkin, SkinPart, SkinSource};
use pollster::block_on;
use tempfile::TempDir;

use crate::common::Random;
use crate::common::damage::{message, mutations, wrong_lines};
use crate::common::documents::example;

fn open(text: &str) -> Opened {
    io::parse("test.obj", text, &OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refusal(text: &str) -> String {
    message(io::parse("test.obj", text, &OpenOptions::default()).expect_err("it is refused"))
}

fn mesh_skin(document: &Document) -> &MeshSkin {
    document.rig.skin.as_ref().and_then(Skin::mesh_skin).expect("a mesh")
}

fn mesh(document: &Document) -> &SkinnedMesh {
    &mesh_skin(document).mesh().expect("a mesh").mesh
}

fn parts(document: &Document) -> &[SkinPart] {
    &mesh_skin(document).mesh().expect("a mesh").parts
}

/// A corner as the file tells it.
#[derive(Clone, Copy)]
struct Corner {
    position: Vec3,
    coordinates: Option<Vec2>,
    normal: Option<Vec3>,
}

/// A random file with the corners of its triangles, by material.
struct Twin {
    text: String,
    triangles: Vec<(String, [Corner; 3])>,
}

impl Twin {
    fn random(random: &mut Random) -> Self {
        let mut text = "# random\n\nmtllib none.mtl\no thing\n".to_owned();
        let positions: Vec<Vec3> = (0..4 + random.below(20)).map(|_| random.vector(3.0)).collect();
        let coordinates: Vec<Vec2> =
            (0..3 + random.below(9)).map(|_| random.vector(1.0).truncate()).collect();
        let normals: Vec<Vec3> = (0..3 + random.below(9)).map(|_| random.direction()).collect();
        for it in &positions {
            text += &format!("v {} {} {}\n", it.x, it.y, it.z);
        }
        for it in &coordinates {
            text += &format!("vt {} {}\n", it.x, 1.0 - it.y);
        }
        for it in &normals {
            text += &format!("vn  {} {} {} # up\n", it.x, it.y, it.z);
        }
        let mut triangles = Vec::new();
        let mut material = String::new();
        for _ in 0..1 + random.below(12) {
            if random.chance(0.4) {
                material = random.one_of(&["red", "blue paint", "none"]).to_owned();
                text += &format!("usemtl {material}\n");
            }
            let [has_coordinates, has_normals, is_backwards] = [(); 3].map(|()| random.coin());
            let mut face = Vec::new();
            text += "f";
            for _ in 0..3 + random.below(4) {
                let picks = [positions.len(), coordinates.len(), normals.len()]
                    .map(|count| (random.below(count), count));
                let index = |(at, count): (usize, usize)| match is_backwards {
                    true => format!("{}", at as i64 - count as i64),
                    false => format!("{}", at + 1),
                };
                let [position, at, normal] = picks.map(index);
                text += &match (has_coordinates, has_normals) {
                    (true, true) => format!(" {position}/{at}/{normal}"),
                    (true, false) => format!(" {position}/{at}"),
                    (false, true) => format!(" {position}//{normal}"),
                    (false, false) => format!(" {position}"),
                };
                face.push(Corner {
                    position: positions[picks[0].0],
                    coordinates: has_coordinates.then(|| coordinates[picks[1].0]),
                    normal: has_normals.then(|| normals[picks[2].0]),
                });
            }
            // A line may go on in the next one.
            text += if random.chance(0.2) { " \\\n\n" } else { "\n" };
            for second in 1..face.len() - 1 {
                triangles.push((material.clone(), [face[0], face[second], face[second + 1]]));
            }
        }
        Self { text, triangles }
    }
}

#[test]
fn triangles_are_those_of_a_reader_of_the_tests_by_material() {
    let mut random = Random(0x0b1);
    for case in 0..200 {
        let Twin { text, triangles } = Twin::random(&mut random);
        let document = open(&text).document;
        let mesh = mesh(&document).mesh();
        let mut names: Vec<&String> = Vec::new();
        for (name, _) in &triangles {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let sorted =
            names.iter().flat_map(|name| triangles.iter().filter(move |it| it.0 == **name));
        let corners = sorted.flat_map(|(_, corners)| corners);
        let counts = names.iter().map(|name| triangles.iter().filter(|it| it.0 == **name).count());
        let found: Vec<usize> = parts(&document).iter().map(|part| part.triangles).collect();
        assert_eq!(found, counts.collect::<Vec<_>>(), "case {case}\n{text}");
        let vertices = mesh.triangles.as_flattened();
        assert_eq!(vertices.len(), 3 * triangles.len());
        for (vertex, corner) in vertices.iter().map(|it| *it as usize).zip(corners) {
            assert!(mesh.positions[vertex].distance(corner.position) < 1e-6, "case {case}");
            if let Some(at) = corner.coordinates {
                assert!(mesh.texture_coordinates[vertex].distance(at) < 1e-6, "case {case}");
            }
            let normal =
                corner.normal.unwrap_or_else(|| smooth_normal(&triangles, corner.position));
            let gap = mesh.normals[vertex].distance(normal);
            assert!(gap < 1e-4, "case {case}: {} {normal}\n{text}", mesh.normals[vertex]);
        }
    }
}

/// The mean of the normals of all triangles at a position, by their areas; up without any.
fn smooth_normal(triangles: &[(String, [Corner; 3])], position: Vec3) -> Vec3 {
    let mut sum = DVec3::ZERO;
    for corners in triangles.iter().map(|(_, corners)| corners) {
        let [a, b, c] = corners.map(|corner| corner.position.as_dvec3());
        let at = corners.iter().filter(|corner| corner.position == position).count();
        sum += (b - a).cross(c - a) * at as f64;
    }
    sum.normalize_or(DVec3::Y).as_vec3()
}

#[test]
fn materials_colours_and_images_are_read_from_the_files_beside_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("images")).expect("a folder");
    image::RgbaImage::from_pixel(2, 2, image::Rgba([0, 255, 0, 255]))
        .save(at("images/green.png"))
        .expect("an image");
    let materials = "newmtl red\nKd 1 0 0\nKe 0 0.5 0\nd 0.25\nnewmtl green\n\
                     map_Kd -s 1 1 1 images\\green.png\nKd 1 two 3\nnewmtl clear\nTr 0.75\n\
                     map_Kd ../outside.png\n";
    fs::write(at("x.mtl"), materials).expect("written");
    let text = "mtllib x.mtl\nmtllib missing.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n\
                usemtl red\nf 1 2 3\nusemtl green\nf 1 3 2\nusemtl clear\nf 1 2 3\n\
                usemtl blue\nf 1 2 3\n";
    fs::write(at("x.obj"), text).expect("written");
    let opened = io::open(&at("x.obj"), &OpenOptions::default()).expect("it opens");
    let [red, green, clear, _] = parts(&opened.document) else { panic!("four parts") };
    assert_eq!(
        (red.colour, red.look.emission, red.look.opacity),
        ([1.0, 0.0, 0.0], [0.0, 0.5, 0.0], Some(0.25))
    );
    assert_eq!(green.texture.as_ref().map(|it| it.size), Some([2, 2]));
    assert_eq!((clear.look.opacity, clear.texture.is_some()), (Some(0.25), false));
    assert_eq!(mesh(&opened.document).mesh().colours[1], [0, 255, 0, 255]);
    let remarks: Vec<String> = opened.warnings.iter().map(ToString::to_string).collect();
    let told = |what: &str| remarks.iter().any(|remark| remark.contains(what));
    for what in [
        "missing.mtl cannot be read",
        "x.mtl, line 7: Kd must have 3 finite numbers",
        "../outside.png",
        "usemtl: no .mtl file has the material \"blue\"; its faces are white",
    ] {
        assert!(told(what), "{what}: {remarks:?}");
    }
    assert_eq!(remarks.len(), 4, "{remarks:?}");
}

#[test]
fn what_programs_write_beside_the_specification_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("a.mtl"), "newmtl Steel #7\nKd 1 0 0\nTr 0.25\nd 0.5\nTr 0\n").expect("written");
    fs::write(at("my b.mtl"), "newmtl glass\nd -halo 0.25\n").expect("written");
    let text = "g\n# a comment \\\nv 0 0 0\nv 1 0 0 # right\nv 0 1 0\nvt 0.5\nvn nan nan -nan(ind)\n\
                mtllib a.mtl my b.mtl\nusemtl Steel #7\nf 1/1/1 2/1/1 3/1/1 # one\n\
                usemtl glass\nf 1 2 3\n";
    fs::write(at("x.obj"), text).expect("written");
    let opened = io::open(&at("x.obj"), &OpenOptions::default()).expect("it opens");
    assert!(opened.warnings.is_empty(), "{:?}", opened.warnings);
    let [steel, glass] = parts(&opened.document) else { panic!("two parts") };
    assert_eq!((steel.colour, steel.look.opacity), ([1.0, 0.0, 0.0], Some(0.5)));
    assert_eq!(glass.look.opacity, Some(0.25));
    let mesh = mesh(&opened.document).mesh();
    assert_eq!(mesh.positions[0], Vec3::ZERO);
    assert_eq!(mesh.texture_coordinates[0], Vec2::new(0.5, 1.0));
    assert!(mesh.normals.iter().all(|normal| normal.distance(Vec3::Z) < 1e-6));
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (line, expected) in [
        ("v 1 2", "v must have 3 finite numbers, x y z, got too few"),
        ("v 1 2 nan", "got \"nan\""),
        ("vt x", "vt must have a finite number, u, got \"x\""),
        ("vt 1 x", "vt must have 2 finite numbers, u v, got \"x\""),
        ("vn 1e99 0 0", "vn must have 3 finite numbers"),
        ("f 1 2", "f must have at least three corners, got 2"),
        ("f", "f must have at least three corners, got none"),
        ("f 1 2 4", "the v of a corner must be from 1 to 3, or from -3 to -1, got 4"),
        ("f 1 2 0", "got 0"),
        ("f -4 2 3", "got -4"),
        ("f 1/1 2 3", "a corner must not have a vt, because there is none before it, got 1"),
        ("f /1 2 3", "a corner must begin with the index of a v, got /1"),
        ("f 99999999999999999999 2 3", "got 99999999999999999999"),
    ] {
        let error = refusal(&format!("{start}{line}\nf 1 2 3\n"));
        assert!(error.contains("line 4") && error.contains(expected), "{line}: {error}");
    }
    assert!(refusal(start).contains("must have at least one face (f)"));
    let named = OpenOptions::of_skeleton("body");
    let error = io::parse("x.obj", &format!("{start}f 1 2 3"), &named).expect_err("refused");
    assert!(error.to_string().contains("no skeleton called \"body\""), "{error}");
}

#[test]
fn damaged_files_open_or_are_refused_and_never_panic() {
    let mut random = Random(0x0b2);
    let words = [
        "f 1 2 3",
        "f 1/2/3 -1 7",
        "v",
        "v 1e38 1e38 1e38",
        "usemtl",
        "mtllib ../x",
        "\\",
        "f 1 1 1",
    ];
    let mut opened = 0;
    for _ in 0..20 {
        let Twin { text, .. } = Twin::random(&mut random);
        let wrong = wrong_lines(&text, &words, &mut random, 40);
        for bytes in mutations(&text, &mut random, 60).into_iter().chain(wrong) {
            match io::read("x.obj", &bytes[..], &OpenOptions::default()) {
                Ok(found) => {
                    opened += 1;
                    let again = io::to_json(&found.document).expect("it is saved");
                    io::parse("x.json", &again, &OpenOptions::default()).expect("it opens again");
                }
                Err(error) => {
                    message(error);
                }
            }
        }
    }
    assert!(opened > 200, "{opened}");
}

/// The Human as an OBJ file, and the document of its mesh.
fn human(folder: &TempDir) -> (PathBuf, Document) {
    let document = example("human");
    let exported = io::to_obj(&document, 0.0, None).expect("exported");
    let path = folder.path().join("human.obj");
    fs::write(&path, exported.bytes).expect("written");
    let opened = io::open(&path, &OpenOptions::default()).expect("it opens");
    assert!(opened.warnings.is_empty(), "{:?}", opened.warnings);
    (path, opened.document)
}

#[test]
fn an_exported_skin_opens_as_the_same_mesh_and_documents_refer_to_its_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, document) = human(&folder);
    let source = example("human");
    let skin = &source.rig.skin.as_ref().expect("a skin");
    let posed = &skin.mesh().expect("a mesh").mesh;
    let posed = posed.posed(&posed.pose(source.at(0.0).skeleton()), skin.skinning);
    let mesh = mesh(&document).mesh();
    assert_eq!(mesh.triangles.len(), posed.triangles.len());
    let corners = mesh.triangles.as_flattened().iter().zip(posed.triangles.as_flattened());
    for (found, expected) in corners {
        let gap = mesh.positions[*found as usize].distance(posed.positions[*expected as usize]);
        assert!(gap < 1e-5, "{gap}");
    }
    assert_eq!(document.skeleton().joints().len(), 1);
    let saved = folder.path().join("saved.json");
    io::save(&document, &saved).expect("saved");
    let again = io::open(&saved, &OpenOptions::default()).expect("it opens");
    assert!(again.warnings.is_empty(), "{:?}", again.warnings);
    assert_eq!(mesh_skin(&again.document).in_file(), mesh_skin(&document).in_file());
    fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let changed = io::open(&saved, &OpenOptions::default()).expect("it opens");
    assert!(changed.warnings[0].to_string().contains("has changed"), "{:?}", changed.warnings);
}

#[test]
fn a_mesh_that_was_bound_is_saved_and_exported_with_its_weights() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, mut document) = human(&folder);
    // The joints of the Human, as if they had been placed by hand.
    let posed = example("human").at(0.0).skeleton().clone();
    for (id, joint) in posed.iter().skip(1) {
        let placed = Joint { parent: joint.parent, ..Joint::clone(joint) };
        let added = document.skeleton_mut().add(placed).expect("a joint");
        assert_eq!(added, id);
    }
    let root = posed[JointId::new(0)].clone();
    let placed = |it: &mut Joint| (it.offset, it.rotation) = (root.offset, root.rotation);
    document.skeleton_mut().change(JointId::new(0), placed).expect("finite");
    let bound = mesh_skin(&document)
        .reattached(document.skeleton(), |mesh| mesh.bound(document.skeleton(), Skinning::Linear))
        .expect("bound")
        .expect("a mesh");
    document.rig.skin = Some(Skin::new(SkinSource::Mesh(bound)));
    document.display = document.display.with(Overlay::Skin, true);
    let saved = folder.path().join("bound.json");
    io::save(&document, &saved).expect("saved");
    fs::remove_file(folder.path().join("human.obj")).expect("removed");
    let again = io::open(&saved, &OpenOptions::default()).expect("it opens");
    assert!(again.warnings.is_empty(), "{:?}", again.warnings);
    assert_eq!(mesh(&again.document).weights(), mesh(&document).weights());
    let turned = |document: &Document| {
        let mut document = document.clone();
        let joint =
            document.skeleton().find("left_forearm").or(document.skeleton().find("forearm_l"));
        let joint = joint.unwrap_or(JointId::new(8));
        let name = document.skeleton()[joint].name.clone();
        document.skeleton_mut().set_rotation(joint, Vec3::new(0.3, 0.2, 0.4)).expect("finite");
        (name, document)
    };
    let (_, document) = turned(&document);
    let bytes = block_on(io::glb(&document, None, &Progress::default())).expect("exported");
    let glb = io::read("x.glb", &bytes[..], &OpenOptions::default()).expect("it opens").document;
    let [before, after] = [&document, &glb].map(|document| {
        let mesh = mesh(document);
        let posed = mesh.posed(&mesh.pose(document.at(0.0).skeleton()), Skinning::Linear);
        let at = |corner: &u32| posed.positions[*corner as usize];
        posed.triangles.as_flattened().iter().map(at).collect::<Vec<Vec3>>()
    });
    assert_eq!(before.len(), after.len());
    for (one, other) in before.iter().zip(&after) {
        let metres = document.metres_per_unit();
        assert!((*one * metres).distance(*other) < 1e-4, "{one}, {other}");
    }
}
