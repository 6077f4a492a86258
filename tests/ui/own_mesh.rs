//! A mesh of one's own: joints are placed in it by clicks, and it follows them once it is bound.

use egui::accesskit::Role;
use egui::{Modifiers, Pos2};
use egui_kittest::kittest::NodeT;
use glam::Vec3;
use ik_arm::document::{Overlay, Skin};
use ik_arm::io::{self, OpenOptions};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::skin::SkinnedMesh;
use ik_arm::rig::MeshSkin;
use ik_arm::session::{FileAction, SelectAction, TransactionAction};

use crate::bench::Bench;
use crate::common::documents::example;

/// The Human as a mesh without joints.
fn mesh_alone() -> Bench {
    let text = io::to_obj(&example("human"), 0.0, None).expect("exported").bytes;
    let opened = io::read("human.obj", &text[..], &OpenOptions::default()).expect("it opens");
    let document = Box::new(opened.document);
    Bench::after([FileAction::Opened { document, file: None, contents: None }])
}

fn mesh_skin(bench: &Bench) -> &MeshSkin {
    bench.session().rig().skin.as_ref().and_then(Skin::mesh_skin).expect("a mesh")
}

fn mesh(bench: &Bench) -> &SkinnedMesh {
    &mesh_skin(bench).mesh().expect("a mesh").mesh
}

/// The vertices in the world.
fn vertices(bench: &Bench) -> Vec<Vec3> {
    let mesh = mesh(bench);
    let skinning = bench.session().rig().skin.as_ref().expect("a skin").skinning;
    mesh.posed(&mesh.pose(bench.session().posed().skeleton()), skinning).positions
}

/// Where a joint of the Human is seen.
fn place(bench: &Bench, joint: &str) -> Pos2 {
    let human = example("human").at(0.0).skeleton().clone();
    let pose = human.pose();
    bench.on_screen(pose.tip(human.find(joint).expect("a joint")))
}

fn ctrl_click(bench: &mut Bench, at: Pos2) {
    bench.hold(Modifiers::COMMAND);
    bench.click_at(at);
    bench.hold(Modifiers::NONE);
    bench.settle();
}

fn assert_stays(before: &[Vec3], after: &[Vec3], what: &str) {
    for (before, after) in before.iter().zip(after) {
        assert!(before.distance(*after) < 1e-4, "{what}: {before} {after}");
    }
}

#[test]
fn clicks_place_joints_in_the_middle_of_the_mesh_and_bind_lets_it_follow_them() {
    let mut bench = mesh_alone();
    let before = vertices(&bench);
    bench.apply([SelectAction::Joints(Vec::new())]);
    assert!(bench.says("Click on the mesh to place the first joint"));
    let beside = bench.viewport().left_center() + egui::vec2(20.0, 0.0);
    bench.click_at(beside);
    bench.settle();
    assert_eq!(bench.session().skeleton().joints().len(), 1, "beside the mesh is no place");
    let [belly, chest, head] = ["spine", "chest", "neck"].map(|joint| place(&bench, joint));
    bench.click_at(belly);
    bench.settle();
    let joints = |bench: &Bench| bench.session().skeleton().joints().len();
    assert_eq!(joints(&bench), 1);
    assert!(bench.session().shown().display.shows(Overlay::Bones), "the joint is seen");
    assert_stays(&before, &vertices(&bench), "the mesh stays where it is");
    // The body is about as deep in front of the joint as behind it.
    let root = bench.session().skeleton_pose().base(JointId::new(0));
    let ray = bench.ray(belly);
    let hits: Vec<f32> = {
        let mesh = mesh(&bench);
        let posed = mesh.posed(&mesh.pose(bench.session().posed().skeleton()), Default::default());
        let mut at = ray.origin;
        let mut hits = Vec::new();
        while let Some(hit) = posed.hit(at, ray.direction) {
            at += ray.direction * (hit.along + 1e-4);
            hits.push((at - ray.origin).dot(ray.direction) / ray.direction.length_squared());
        }
        hits
    };
    let along = (root - ray.origin).dot(ray.direction) / ray.direction.length_squared();
    let middle = 0.5 * (hits[0] + hits[hits.len() - 1]);
    assert!((along - middle).abs() < 1e-2, "{along} {hits:?}");

    assert!(bench.says("Click on the mesh to place the next joint"));
    bench.click_at(chest);
    bench.settle();
    assert_eq!(joints(&bench), 2, "a click with the first joint selected adds a bone");
    ctrl_click(&mut bench, head);
    assert_eq!(joints(&bench), 3);
    assert_stays(&before, &vertices(&bench), "the mesh does not follow the bones yet");

    assert!(bench.says("Ctrl+click on the mesh to add joints"));
    bench.click(Role::Button, "Bind mesh");
    bench.settle();
    assert!(!bench.shows(Role::Button, "Bind mesh"), "it is bound");
    assert!(bench.session().shown().display.shows(Overlay::SkinWeights), "a heat map");
    assert_stays(&before, &vertices(&bench), "bound, it stays where it is");
    let followed = |joint: usize| {
        let weights = mesh(&bench).weights().iter();
        weights.filter(|weights| weights.first() == JointId::new(joint)).count()
    };
    assert!(followed(1) > 500 && followed(2) > 500, "{} {}", followed(1), followed(2));
    assert!(mesh_skin(&bench).file().is_none(), "the document has the weights");
    bench.apply([TransactionAction::Undo]);
    assert!(bench.shows(Role::Button, "Bind mesh"));
    assert!(!bench.session().shown().display.shows(Overlay::SkinWeights));
}

#[test]
fn the_panel_binds_and_unbinds() {
    let mut bench = mesh_alone();
    bench.apply([SelectAction::Joints(Vec::new())]);
    bench.reveal(Role::Button, "Bind");
    assert!(bench.node(Role::Button, "Bind").accesskit_node().is_disabled(), "without bones");
    // With the root selected, the first click adds a bone from where the root is.
    bench.apply([SelectAction::Joints(vec![JointId::new(0)])]);
    let at = place(&bench, "chest");
    bench.click_at(at);
    bench.settle();
    assert_eq!(bench.session().skeleton().joints().len(), 2);
    assert!(bench.session().shown().display.shows(Overlay::Bones), "the bone is seen");
    bench.reveal(Role::Button, "Bind");
    bench.click(Role::Button, "Bind");
    bench.settle();
    let before = vertices(&bench);
    assert_ne!(mesh_skin(&bench).sole_joint(), Some(JointId::new(0)));
    bench.reveal(Role::Button, "Unbind");
    bench.click(Role::Button, "Unbind");
    bench.settle();
    assert_eq!(mesh_skin(&bench).sole_joint(), Some(JointId::new(0)));
    assert_stays(&before, &vertices(&bench), "unbound, it stays where it is");
}
