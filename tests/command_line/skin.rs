//! `ik-arm skin`, and skins in `ik-arm export`, as a user runs them.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use glam::Vec3;
use ik_arm::io::{self};
use ik_arm::kinematics::skin::{Skinning, VertexWeights};
use ik_arm::rig::SkinSource;
use tempfile::TempDir;

use crate::common::documents::example;
use crate::{program, stderr};

struct Desk(TempDir);

impl Desk {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The file of an example, without its skin if it has one.
    fn example(&self, name: &str) -> PathBuf {
        let mut document = example(name);
        document.rig.skin = None;
        let path = self.path(&format!("{name}.json"));
        io::save(&document, &path).expect("saved");
        path
    }
}

fn run(arguments: &[&str], paths: &[&Path]) -> Output {
    program().args(arguments).args(paths).output().expect("it runs")
}

fn skin(file: &Path, out: &Path, arguments: &[&str]) -> Output {
    let out = out.to_str().expect("a path");
    run(&[&["skin", "-o", out], arguments].concat(), &[file])
}

#[test]
fn a_document_gets_a_skin_around_its_bones() {
    let desk = Desk::new();
    let (file, out) = (desk.example("ten-joints"), desk.path("out.json"));
    let arguments = ["--detail", "1.5", "--thickness", "0.8", "--skinning", "spread-twist"];
    let output = skin(&file, &out, &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document = io::open(&out, &io::OpenOptions::default()).expect("opens").document;
    let skin = document.rig.skin.expect("a skin");
    let SkinSource::Bones(bones) = &skin.source else { panic!("a skin from bones") };
    assert_eq!(bones.shape().detail, 1.5);
    assert_eq!(bones.shape().thickness, 0.8);
    assert_eq!(skin.skinning, Skinning::SpreadTwist);
    let mesh = skin.mesh().expect("a mesh").mesh.mesh().clone();
    let sizes = format!("{} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len());
    assert!(stderr(&output).contains(&sizes), "{}", stderr(&output));
}

#[test]
fn a_skin_that_cannot_be_made_is_refused_and_nothing_is_written() {
    let desk = Desk::new();
    let (file, out) = (desk.example("ten-joints"), desk.path("out.json"));
    let refused = |file: &Path, arguments: &[&str], expected: &str| {
        let output = skin(file, &out, arguments);
        assert_ne!(output.status.code(), Some(0));
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
        assert!(!out.exists());
    };
    refused(&file, &["--detail", "0.1"], "skin detail must be from 1.2 to 16, got 0.1");
    refused(&file, &["--thickness", "-1"], "skin thickness must be finite and above 0, got -1");
    refused(&file, &["--blend", "soft"], "invalid value 'soft'");
    let wrong = run(&["skin", "-o", "out.glb"], &[&file]);
    assert!(stderr(&wrong).contains("OUT must end in .json"), "{}", stderr(&wrong));
}

/// Positions, normals and triangles of an OBJ file.
fn read_obj(path: &Path) -> (Vec<Vec3>, Vec<Vec3>, Vec<[usize; 3]>) {
    let text = fs::read_to_string(path).expect("text");
    let vector = |rest: &str| {
        let numbers: Vec<f32> =
            rest.split_whitespace().map(|number| number.parse().expect("a number")).collect();
        Vec3::from_slice(&numbers)
    };
    let corner = |corner: &str| corner.split('/').next().and_then(|it| it.parse().ok());
    let (mut positions, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for line in text.lines() {
        match line.split_once(' ') {
            Some(("v", rest)) => positions.push(vector(rest)),
            Some(("vn", rest)) => normals.push(vector(rest)),
            Some(("f", rest)) => {
                let corners: Vec<usize> = rest.split_whitespace().filter_map(corner).collect();
                triangles.push([corners[0] - 1, corners[1] - 1, corners[2] - 1]);
            }
            _ => {}
        }
    }
    (positions, normals, triangles)
}

#[test]
fn an_obj_holds_the_posed_mesh_in_world_space_closed_with_outward_normals() {
    let desk = Desk::new();
    let (file, skinned) = (desk.example("two-targets"), desk.path("skinned.json"));
    assert!(skin(&file, &skinned, &[]).status.success());
    let document = io::open(&skinned, &io::OpenOptions::default()).expect("opens").document;
    for (argument, skinning) in [
        ("linear", Skinning::Linear),
        ("dual-quaternion", Skinning::DualQuaternion),
        ("spread-twist", Skinning::SpreadTwist),
    ] {
        let out = desk.path("out.obj");
        let arguments = ["export", "--time", "0.5", "--skinning", argument, "-o"];
        let output = run(&arguments, &[&out, &skinned]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let (positions, normals, triangles) = read_obj(&out);
        let rig = document.at(0.5).into_document().rig;
        let mesh = rig.skin.as_ref().expect("skin").mesh().expect("mesh").mesh.clone();
        let posed = mesh.posed(&mesh.pose(&rig.skeleton_at(0.5)), skinning);
        assert_eq!(positions, posed.positions, "{argument}");
        assert_eq!(normals.len(), positions.len());
        let mut edges: HashMap<(usize, usize), i32> = HashMap::new();
        for [a, b, c] in &triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*from, *to)).or_default() += 1;
            }
        }
        assert!(
            edges
                .iter()
                .all(|((from, to), count)| { *count == 1 && edges.contains_key(&(*to, *from)) })
        );
    }
}

#[test]
fn a_skeleton_without_a_skin_has_no_obj() {
    let desk = Desk::new();
    let out = desk.path("out.obj");
    let output = run(&["export", "-o"], &[&out, &desk.example("two-targets")]);
    assert_ne!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("ik-arm skin makes one"), "{}", stderr(&output));
    assert!(!out.exists());
    let wrong = run(&["export", "--skinning", "linear", "-o", "a.glb"], &[&desk.example("arm")]);
    assert!(stderr(&wrong).contains("--skinning does not apply"), "{}", stderr(&wrong));
}

#[test]
fn a_motion_whose_bind_pose_is_tangled_gets_its_skin_in_its_first_frame() {
    let desk = Desk::new();
    // Arms along the neck, which the first frame stretches to the sides.
    let arm = |side: &str, x: f32| {
        format!(
            "JOINT {side}Arm {{ OFFSET {x} 26 0 CHANNELS 3 Zrotation Xrotation Yrotation \
             JOINT {side}Hand {{ OFFSET 0 50 0 CHANNELS 3 Zrotation Xrotation Yrotation \
             End Site {{ OFFSET 0 15 0 }} }} }} "
        )
    };
    let text = format!(
        "HIERARCHY ROOT Hips {{ OFFSET 0 0 0 CHANNELS 3 Zrotation Xrotation Yrotation \
         JOINT Chest {{ OFFSET 0 20 0 CHANNELS 3 Zrotation Xrotation Yrotation \
         JOINT Neck {{ OFFSET 0 30 0 CHANNELS 3 Zrotation Xrotation Yrotation \
         End Site {{ OFFSET 0 30 0 }} }} {}{} }} }} MOTION Frames: 1 Frame Time: 0.04 \
         0 0 0 0 0 0 0 0 0 -90 0 0 0 0 0 90 0 0 0 0 0",
        arm("Left", 2.0),
        arm("Right", -2.0)
    );
    let (file, out) = (desk.path("tangled.bvh"), desk.path("out.json"));
    fs::write(&file, text).expect("written");
    let output = skin(&file, &out, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document = io::open(&out, &io::OpenOptions::default()).expect("opens").document;
    let skin = document.rig.skin.as_ref().expect("a skin");
    let SkinSource::Bones(bones) = &skin.source else { panic!("a skin from bones") };
    assert_eq!(bones.shape().pose.len(), 2, "of the two arms");
    let mesh = &skin.mesh().expect("a mesh").mesh;
    let is_arm = |vertex: u32, side: &str| {
        let joint = mesh.weights()[vertex as usize].first();
        document.skeleton()[joint].name.starts_with(side)
    };
    let ties = |corners: &[u32; 3]| {
        let has = |side| corners.iter().any(|corner| is_arm(*corner, side));
        has("LeftHand") && has("Right") || has("RightHand") && has("Left")
    };
    assert!(!mesh.mesh().triangles.iter().any(ties), "no triangle ties a hand to the other arm");
}

#[test]
fn bind_gives_the_mesh_of_a_file_new_weights_and_keeps_it_in_the_document() {
    let desk = Desk::new();
    let (figure, out) = (desk.path("human.glb"), desk.path("bound.json"));
    let file = desk.path("human.json");
    io::save(&example("human"), &file).expect("saved");
    let exported = run(&["convert", "-o", figure.to_str().expect("a path")], &[&file]);
    assert!(exported.status.success(), "{}", stderr(&exported));
    let output = skin(&figure, &out, &["--bind"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    fs::remove_file(&figure).expect("removed");
    let document = io::open(&out, &io::OpenOptions::default()).expect("opens").document;
    let mesh = document.rig.skin.as_ref().and_then(|skin| skin.mesh_skin()).expect("a mesh");
    let weights = mesh.mesh().expect("in the document").mesh.weights().to_vec();
    let followed: HashSet<_> = weights.iter().map(VertexWeights::first).collect();
    assert!(followed.len() > 12, "{followed:?}");

    let without = skin(&desk.example("ten-joints"), &out, &["--bind"]);
    assert_eq!(without.status.code(), Some(1));
    assert!(stderr(&without).contains("there must be a mesh from a file"), "{}", stderr(&without));
    let both = skin(&desk.example("ten-joints"), &out, &["--bind", "--detail", "2"]);
    assert_eq!(both.status.code(), Some(2));
}
