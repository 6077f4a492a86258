//! Skins whose meshes come from files: references, missing and changed files, and packed meshes.

use std::fs;
use std::path::{Path, PathBuf};

use glam::{Affine3A, Vec2, Vec3};
use ik_arm::document::{Document, Skin};
use ik_arm::io::{self, Opened, Progress};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::kinematics::skin::{SkinnedMesh, Skinning, TriangleMesh, VertexWeights};
use ik_arm::rig::{
    AttachedMesh, FileMesh, MeshSkin, PartLook, SkeletonRig, SkinFileError, SkinPart, SkinSource,
    SkinTexture,
};
use pollster::block_on;

use crate::common::Random;

/// A chain of so many joints with a mesh on it, and a small texture.
fn figure(joints: usize, seed: u64) -> Document {
    let mut random = Random(seed);
    let chain = (0..joints).map(|index| Joint {
        offset: if index == 0 { Vec3::ZERO } else { Vec3::Y },
        ..Joint::new(&format!("j{index}"), index.checked_sub(1).map(JointId::new), Vec3::Y)
    });
    let skeleton = Skeleton::from_joints(chain.collect()).expect("a skeleton");
    let count = 60;
    let weights = |random: &mut Random| {
        let some = (0..3).map(|_| (JointId::new(random.below(joints)), random.within(0.1..1.0)));
        VertexWeights::heaviest(some.collect::<Vec<_>>()).0
    };
    let mesh = TriangleMesh {
        positions: (0..count).map(|_| random.vector(3.0)).collect(),
        normals: (0..count).map(|_| random.direction()).collect(),
        texture_coordinates: (0..count)
            .map(|_| random.vector(1.0).truncate())
            .collect::<Vec<Vec2>>(),
        emission_coordinates: (0..count).map(|_| random.vector(1.0).truncate()).collect(),
        colours: (0..count).map(|_| [(); 4].map(|()| random.below(256) as u8)).collect(),
        triangles: (0..count as u32 / 3).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]).collect(),
    };
    let weights = (0..count).map(|_| weights(&mut random)).collect();
    let pose = skeleton.bind_pose_in_skeleton();
    let binds: Vec<Affine3A> = skeleton.ids().map(|joint| pose.full(joint).inverse()).collect();
    let mesh = SkinnedMesh::new(mesh, weights, binds).expect("a mesh");
    let part = |triangles, texture| SkinPart {
        colour: [1.0, 0.5, 0.25],
        texture,
        look: PartLook {
            is_double_sided: triangles > 5,
            alpha_cutoff: 0.25,
            opacity: (triangles > 5).then_some(0.5),
            emission: [0.5, 0.0, 1.0],
        },
        ..SkinPart::white(triangles)
    };
    let mesh = FileMesh {
        mesh,
        parents: skeleton.joints().iter().map(|joint| joint.parent).collect(),
        parts: vec![part(5, Some(texture().into())), part(15, None)],
    };
    let ids = skeleton.ids().map(Some).collect();
    let skin = MeshSkin::new(mesh.into(), None, ids, &skeleton);
    let mut rig = SkeletonRig::new(skeleton);
    rig.skin = Some(Skin::new(SkinSource::Mesh(skin)));
    Document::new(rig)
}

fn texture() -> SkinTexture {
    let mut file = std::io::Cursor::new(Vec::new());
    let pixel = |x, y| image::Rgba([x as u8 * 30, y as u8 * 40, 7, 255]);
    let image = image::RgbaImage::from_fn(4, 3, pixel);
    image.write_to(&mut file, image::ImageFormat::Png).expect("an image");
    SkinTexture::new(file.into_inner(), [4, 3])
}

fn write_glb(document: &Document, path: &Path) {
    let bytes = block_on(io::glb(document, None, &Progress::default())).expect("an export");
    fs::write(path, bytes).expect("a file");
}

fn mesh_skin(document: &Document) -> &MeshSkin {
    match &document.rig.skin.as_ref().expect("a skin").source {
        SkinSource::Mesh(mesh) => mesh,
        SkinSource::Bones(_) => panic!("the mesh is from a file"),
    }
}

fn attached(document: &Document) -> &AttachedMesh {
    mesh_skin(document).mesh().expect("a mesh")
}

fn posed(document: &Document) -> Vec<Vec3> {
    let mesh = &attached(document).mesh;
    mesh.posed(&mesh.pose(document.skeleton()), Skinning::Linear).positions
}

fn warnings(opened: &Opened) -> Vec<String> {
    opened.warnings.iter().map(|it| format!("{}: {}", it.field, it.reason)).collect()
}

/// A folder with `models/figure.glb` and `scene.json`, which refers to it.
struct Project(tempfile::TempDir);

impl Project {
    fn new() -> Self {
        let project = Self(tempfile::tempdir().expect("a folder"));
        fs::create_dir(project.path("models")).expect("a folder");
        write_glb(&figure(4, 1), &project.path("models/figure.glb"));
        let opened = io::open(&project.path("models/figure.glb"), &io::OpenOptions::default())
            .expect("it opens");
        io::save(&opened.document, &project.path("scene.json")).expect("saved");
        project
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn open(&self) -> Opened {
        io::open(&self.path("scene.json"), &io::OpenOptions::default()).expect("it opens")
    }
}

#[test]
fn a_document_names_the_file_of_its_mesh_relative_to_its_own_folder() {
    let project = Project::new();
    let text = fs::read_to_string(project.path("scene.json")).expect("a text");
    assert!(text.contains("\"file\": \"models/figure.glb\""), "{text}");
    assert!(text.len() < 10_000, "the mesh is not in the document: {} bytes", text.len());
    let opened = project.open();
    assert_eq!(warnings(&opened), [""; 0]);
    let imported = io::open(&project.path("models/figure.glb"), &io::OpenOptions::default())
        .expect("it opens");
    assert_eq!(opened.document, imported.document);
    // The whole project can be moved, and the document saved into another folder.
    let elsewhere = tempfile::tempdir().expect("a folder");
    fs::create_dir(elsewhere.path().join("models")).expect("a folder");
    for name in ["scene.json", "models/figure.glb"] {
        fs::copy(project.path(name), elsewhere.path().join(name)).expect("a copy");
    }
    let moved = io::open(&elsewhere.path().join("scene.json"), &io::OpenOptions::default())
        .expect("it opens");
    assert_eq!(warnings(&moved), [""; 0]);
    assert_eq!(attached(&moved.document), attached(&opened.document));
    let deeper = elsewhere.path().join("models/deeper.json");
    io::save(&moved.document, &deeper).expect("saved");
    let text = fs::read_to_string(&deeper).expect("a text");
    assert!(text.contains("\"file\": \"figure.glb\""), "{text}");
}

#[test]
fn a_missing_file_is_told_once_and_the_skeleton_opens_without_its_skin() {
    let project = Project::new();
    fs::rename(project.path("models/figure.glb"), project.path("figure.glb")).expect("moved");
    let opened = project.open();
    let path = project.path("models/figure.glb").display().to_string();
    assert_eq!(
        warnings(&opened),
        [format!(
            "skin.mesh.file: the skin's file {path} is missing: locate it, or remove the skin"
        )]
    );
    assert_eq!(opened.document.skeleton().joints().len(), 4);
    assert!(matches!(mesh_skin(&opened.document).mesh(), Err(SkinFileError::Missing(_))));
    // Saving again keeps the reference.
    io::save(&opened.document, &project.path("again.json")).expect("saved");
    fs::rename(project.path("figure.glb"), project.path("models/figure.glb")).expect("moved back");
    let again =
        io::open(&project.path("again.json"), &io::OpenOptions::default()).expect("it opens");
    assert_eq!(warnings(&again), [""; 0]);
    assert_eq!(attached(&again.document), attached(&project.open().document));
}

#[test]
fn a_changed_file_is_told_and_can_be_taken_as_it_is() {
    let project = Project::new();
    let before = project.open().document;
    write_glb(&figure(4, 2), &project.path("models/figure.glb"));
    let changed = project.open();
    assert!(warnings(&changed)[0].contains("has changed since the document was saved"));
    let skin = mesh_skin(&changed.document);
    assert!(matches!(skin.mesh(), Err(SkinFileError::Changed(_))));
    let file = skin.file().expect("a file");
    let located = io::relocated_skin(&file.path, skin, changed.document.skeleton());
    let located = located.expect("it is read");
    assert_ne!(located.mesh().expect("a mesh").mesh, attached(&before).mesh);
    assert_ne!(located.file().expect("a file").checksum, file.checksum);
}

#[test]
fn a_file_with_another_number_of_joints_or_without_a_mesh_cannot_be_located() {
    let project = Project::new();
    write_glb(&figure(3, 1), &project.path("three.glb"));
    let document = project.open().document;
    let skin = mesh_skin(&document);
    let locate = |name: &str| {
        io::relocated_skin(&project.path(name), skin, document.skeleton())
            .expect_err("refused")
            .to_string()
    };
    // The tip of the chain is a joint of the file, too.
    assert!(locate("three.glb").ends_with("must have a skeleton of 5 joints, got 4"));
    assert!(locate("nothing.glb").contains("is missing"));
    fs::write(project.path("walk.bvh"), "HIERARCHY").expect("a file");
    assert!(locate("walk.bvh").ends_with("has no mesh on the skeleton \"Armature\""));
}

#[test]
fn a_packed_skin_is_read_back_bit_for_bit_without_its_file() {
    for document in [figure(5, 3), Project::new().open().document] {
        let mut document = document;
        let skin = document.rig.skin.as_mut().expect("a skin");
        let SkinSource::Mesh(mesh) = &skin.source else { panic!("the mesh is from a file") };
        skin.source = SkinSource::Mesh(mesh.packed().expect("a mesh"));
        let text = io::to_json(&document).expect("a text");
        let read = io::parse("packed.json", &text, &io::OpenOptions::default()).expect("it opens");
        assert_eq!(warnings(&read), [""; 0]);
        assert_eq!(read.document, document);
    }
}

#[test]
fn weights_of_removed_joints_go_to_their_ancestors_and_stay_there_in_files() {
    let project = Project::new();
    let mut document = project.open().document;
    let before = posed(&document);
    document.dissolve(&[JointId::new(2)]).expect("a joint");
    // The last joint of the file is the tip of the chain.
    let joints = [Some(0), Some(1), None, Some(2), None].map(|it| it.map(JointId::new));
    assert_eq!(mesh_skin(&document).joints(), joints);
    for (before, after) in before.iter().zip(posed(&document)) {
        assert!(before.distance(after) < 1e-5, "nothing moves in the bind pose: {before}, {after}");
    }
    for weights in attached(&document).mesh.weights() {
        assert!(weights.iter().all(|(joint, _)| joint.index() < 3), "{weights:?}");
    }
    io::save(&document, &project.path("scene.json")).expect("saved");
    assert_eq!(project.open().document, document);
    document.delete(&[JointId::new(0)]).expect("a joint");
    assert!(document.skeleton().joints().is_empty());
    assert!(mesh_skin(&document).joints().iter().all(Option::is_none));
}

#[test]
fn damaged_packed_meshes_name_the_field() {
    let mut json: serde_json::Value =
        serde_json::from_str(&io::to_json(&figure(3, 4)).expect("a text")).expect("JSON");
    let mut refused = |pointer: &str, value: serde_json::Value| {
        let field = json.pointer_mut(pointer).expect("a field");
        let before = std::mem::replace(field, value);
        let error = io::parse("x.json", &json.to_string(), &io::OpenOptions::default())
            .expect_err("refused")
            .to_string();
        *json.pointer_mut(pointer).expect("a field") = before;
        error
    };
    for (pointer, value, expected) in [
        (
            "/skin/mesh/packed/positions",
            "AAAA",
            "skin.mesh.packed.positions: must have a multiple of 12 bytes, got 3",
        ),
        (
            "/skin/mesh/packed/triangles",
            "////////////////",
            "skin.mesh.packed.positions: triangle 0 must have vertices below 60",
        ),
        (
            "/skin/mesh/packed/inverse_binds",
            "",
            "skin.mesh.packed.inverse_binds: must have 3 transforms, as `parents`, got 0",
        ),
        ("/skin/mesh/packed/textures/0", "AAAA", "skin.mesh.packed.textures[0]: "),
        ("/skin/mesh/packed/normals", "?", "skin.mesh.packed.normals: data must be base64"),
    ] {
        let error = refused(pointer, value.into());
        assert!(error.contains(expected), "{error}");
    }
    let error = refused("/skin/mesh/joints/1", 9.into());
    assert!(error.contains("skin.mesh.joints[1]: must be a joint from 0 to 2, got 9"), "{error}");
    let error = refused("/skin/mesh/packed", serde_json::Value::Null);
    assert!(error.contains("skin.mesh: must have either `file` or `packed`"), "{error}");
}

#[test]
fn the_path_to_the_file_leads_through_parent_folders_and_links() {
    let project = Project::new();
    let document = project.open().document;
    fs::create_dir(project.path("scenes")).expect("a folder");
    let mut saved = vec![project.path("models/../scenes/one.json")];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(project.path("scenes"), project.path("models/link"))
            .expect("a link");
        saved.push(project.path("models/link/two.json"));
    }
    for path in saved {
        io::save(&document, &path).expect("saved");
        let text = fs::read_to_string(&path).expect("a text");
        assert!(text.contains("\"file\": \"../models/figure.glb\""), "{}", path.display());
        let name = path.file_name().expect("a name");
        let opened = io::open(&project.path("scenes").join(name), &io::OpenOptions::default())
            .expect("it opens");
        assert_eq!(warnings(&opened), [""; 0]);
    }
}

#[test]
fn parts_share_a_texture_also_in_files() {
    let mut document = figure(2, 9);
    let SkinSource::Mesh(skin) = &document.rig.skin.as_ref().expect("a skin").source else {
        panic!("the mesh is from a file")
    };
    let mut mesh = FileMesh::clone(skin.in_file().expect("a mesh"));
    mesh.parts[1].texture = mesh.parts[0].texture.clone();
    let skin = MeshSkin::new(mesh.into(), None, skin.joints().to_vec(), document.skeleton());
    document.rig.skin = Some(Skin::new(SkinSource::Mesh(skin)));
    let text = io::to_json(&document).expect("a text");
    let read = io::parse("x.json", &text, &io::OpenOptions::default()).expect("it opens").document;
    assert_eq!(read, document);
    let textures: Vec<_> =
        attached(&read).parts.iter().filter_map(|part| part.texture.as_ref()).collect();
    assert!(textures.len() == 2 && textures[0].is_same(textures[1]));
}

#[cfg(unix)]
#[test]
fn a_document_cannot_make_the_program_read_a_device() {
    let project = Project::new();
    let text = fs::read_to_string(project.path("scene.json")).expect("a text");
    fs::write(project.path("scene.json"), text.replace("models/figure.glb", "/dev/zero"))
        .expect("a file");
    let opened = project.open();
    assert!(
        warnings(&opened)[0].contains("/dev/zero cannot be read: it must be a regular file"),
        "{:?}",
        warnings(&opened)
    );
}
