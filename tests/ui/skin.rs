//! The skin of a skeleton: made, changed and shown in the panel, and picked with the mouse.

use egui::accesskit::Role;
use glam::Vec3;
use ik_arm::document::{Overlay, Skin};
use ik_arm::io::{self, Example, Progress};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::skin::Skinning;
use ik_arm::rig::SkinSource;
use ik_arm::session::{
    Dialog, DisplayEdit, Effect, FileAction, JointEdit, PathDialog, PlaybackAction, SelectAction,
    TransactionAction,
};
use pollster::block_on;

use crate::bench::Bench;
use crate::common::documents::example;

fn chain() -> Bench {
    Bench::example("ten-joints")
}

fn with_skin() -> Bench {
    let mut bench = chain();
    bench.reveal(Role::CheckBox, "Show skin");
    bench.click(Role::CheckBox, "Show skin");
    bench.toggle(&["Skin"]);
    bench
}

fn skin(bench: &Bench) -> Option<&Skin> {
    bench.session().rig().skin.as_ref()
}

fn shows(bench: &Bench, overlay: Overlay) -> bool {
    bench.session().shown().display.shows(overlay)
}

#[test]
fn a_switch_gives_a_skeleton_a_skin_and_a_button_removes_it() {
    let mut bench = with_skin();
    let vertices =
        skin(&bench).expect("a skin").mesh().expect("a mesh").mesh.mesh().positions.len();
    assert!(vertices > 100, "{vertices}");
    assert!(shows(&bench, Overlay::Skin));
    bench.choose(&["Edit", "Undo Add skin"]);
    assert!(skin(&bench).is_none());
    bench.choose(&["Edit", "Redo Add skin"]);
    bench.toggle(&["Shape and colour"]);
    bench.reveal(Role::Button, "Remove skin");
    bench.click(Role::Button, "Remove skin");
    assert!(skin(&bench).is_none());
}

#[test]
fn the_switch_hides_the_skin_and_shows_it_again() {
    for mut bench in [Bench::new(), chain()] {
        for (is_shown, made) in [(true, true), (false, false), (true, false)] {
            let before = skin(&bench).cloned();
            bench.reveal(Role::CheckBox, "Show skin");
            bench.click(Role::CheckBox, "Show skin");
            assert_eq!(shows(&bench, Overlay::Skin), is_shown);
            assert_eq!(skin(&bench).cloned() != before, made, "it is made once");
        }
    }
}

#[test]
fn the_panel_shows_skin_bones_or_both() {
    let mut bench = with_skin();
    for (name, expected) in
        [("Both", (true, true)), ("Bones", (false, true)), ("Skin", (true, false))]
    {
        bench.reveal(Role::Button, name);
        bench.click(Role::Button, name);
        let shown = (shows(&bench, Overlay::Skin), shows(&bench, Overlay::Bones));
        assert_eq!(shown, expected, "{name}");
    }
}

#[test]
fn the_list_chooses_how_joints_are_blended() {
    let mut bench = with_skin();
    bench.toggle(&["Shape and colour"]);
    for (name, skinning) in [("Linear", Skinning::Linear), ("Spread twist", Skinning::SpreadTwist)]
    {
        bench.reveal(Role::ComboBox, "Blend");
        bench.click(Role::ComboBox, "Blend");
        bench.click(Role::Button, name);
        assert_eq!(skin(&bench).expect("a skin").skinning, skinning);
    }
}

#[test]
fn a_changed_detail_or_bone_makes_the_skin_again() {
    let mut bench = with_skin();
    let vertices = |bench: &Bench| {
        skin(bench).expect("a skin").mesh().expect("a mesh").mesh.mesh().positions.len()
    };
    let before = vertices(&bench);
    bench.toggle(&["Shape and colour"]);
    bench.reveal(Role::Slider, "Skin detail");
    bench.enter("Skin detail", "3");
    let finer = vertices(&bench);
    assert!(finer > before * 3 / 2, "{before} to {finer}");
    let longest =
        |bench: &Bench| skin(bench).expect("a skin").mesh().expect("a mesh").mesh.mesh().size();
    let size = longest(&bench);
    bench.apply([JointEdit::SetAxis { joint: JointId::new(9), axis: Vec3::Y * 3.0 }]);
    assert!(longest(&bench) > size, "{size}");
}

#[test]
fn a_dragged_thickness_is_one_undo_step() {
    let mut bench = with_skin();
    bench.toggle(&["Shape and colour"]);
    bench.reveal(Role::Slider, "Skin thickness");
    bench.enter("Skin thickness", "1.5");
    assert_eq!(thickness(&bench), 1.5);
    bench.choose(&["Edit", "Undo Change skin"]);
    assert_eq!(thickness(&bench), 1.0);
}

fn thickness(bench: &Bench) -> f32 {
    match &skin(bench).expect("a skin").source {
        SkinSource::Bones(bones) => bones.shape().thickness,
        SkinSource::Mesh(_) => panic!("the skin is from bones"),
    }
}

#[test]
fn a_click_on_the_skin_selects_the_joint_with_the_greatest_weight_there() {
    let mut bench = with_skin();
    let joint = JointId::new(4);
    let pose = bench.session().skeleton_pose();
    let middle = pose.base(joint).midpoint(pose.tip(joint));
    let at = bench.on_screen(middle);
    bench.apply([SelectAction::Joints(vec![])]);
    bench.click_at(at);
    assert_eq!(bench.session().selection().joints(), [joint]);
}

#[test]
fn weights_need_a_selected_joint_and_have_a_legend() {
    let mut bench = with_skin();
    bench.apply([DisplayEdit::ShowOverlay(Overlay::SkinWeights, true)]);
    bench.apply([SelectAction::Joints(vec![])]);
    bench.settle();
    assert!(bench.says("Select a joint to see its weights."));
    bench.apply([SelectAction::Joints(vec![JointId::new(2)])]);
    bench.settle();
    let name = bench.session().skeleton()[JointId::new(2)].name.clone();
    assert!(bench.shows(Role::Image, &format!("Weight of {name}, from 0 to 1")));
}

#[test]
fn the_candy_wrapper_plots_the_area_of_its_middle() {
    let example = Example::find("candy-wrapper").expect("an example");
    let mut bench = Bench::after([FileAction::OpenExample(example)]);
    bench.apply([PlaybackAction::SetTime(3.0)]);
    bench.settle();
    let areas = bench.session().skin_areas().expect("areas");
    let [linear, dual, spread] = areas.at(3.0);
    assert!(linear < 0.1, "linear {linear}");
    assert!(dual > 0.9, "dual quaternions {dual}");
    assert!(spread > 0.95, "spread twist {spread}");
    let at_rest = areas.at(0.0);
    assert!(at_rest.iter().all(|area| (area - 1.0).abs() < 1e-3), "{at_rest:?}");
    let said = format!(
        "Area of the cross-section: Linear {:.0} %, Dual quaternions {:.0} %, Spread twist {:.0} %",
        100.0 * linear,
        100.0 * dual,
        100.0 * spread
    );
    assert!(bench.shows(Role::Image, &said), "{said}");
}

/// A folder with `figure.glb`, and a bench that shows a document that refers to it.
fn with_file() -> (tempfile::TempDir, Bench) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("figure.glb");
    let human = example("two-targets");
    let bytes = block_on(io::glb(&human, None, &Progress::default())).expect("an export");
    std::fs::write(&path, bytes).expect("a file");
    let document =
        Box::new(io::open(&path, &io::OpenOptions::default()).expect("it opens").document);
    (folder, Bench::after([FileAction::Opened { document, file: None, contents: None }]))
}

#[test]
fn a_mesh_of_a_file_is_named_and_packed_into_the_document_in_one_step() {
    let (folder, mut bench) = with_file();
    bench.reveal(Role::Button, "Pack skin into file");
    assert!(bench.says("figure.glb"));
    bench.click(Role::Button, "Pack skin into file");
    assert!(bench.says("in this document"));
    assert!(!bench.shows(Role::Button, "Pack skin into file"));
    drop(folder);
    let text = io::to_json(bench.session().document()).expect("a text");
    let read = io::parse("x.json", &text, &io::OpenOptions::default()).expect("it opens").document;
    assert!(read.rig.skin.expect("a skin").mesh().is_ok());
    bench.choose(&["Edit", "Undo Pack skin into file"]);
    assert!(bench.shows(Role::Button, "Pack skin into file"));
}

#[test]
fn a_missing_mesh_is_told_in_the_panel_and_located_in_a_dialog() {
    let (folder, bench) = with_file();
    let scene = folder.path().join("scene.json");
    let (old, new) = (folder.path().join("figure.glb"), folder.path().join("moved.glb"));
    io::save(bench.session().document(), &scene).expect("saved");
    std::fs::rename(&old, &new).expect("moved");
    let document =
        Box::new(io::open(&scene, &io::OpenOptions::default()).expect("it opens").document);
    let mut bench =
        Bench::after([FileAction::Opened { document, file: Some(scene), contents: None }]);
    bench.reveal(Role::Button, "Locate…");
    let missing =
        format!("the skin's file {} is missing: locate it, or remove the skin", old.display());
    assert!(bench.says(&missing));
    bench.click(Role::Button, "Locate…");
    assert!(matches!(
        bench.session().shell().dialog(),
        Some(Dialog::Path(PathDialog::LocateSkin { .. }))
    ));
    assert!(bench.says("File with the mesh: .glb, .gltf, .js3d, .obj or .urdf"));

    // What the window does with the path of the dialog.
    let locate = |bench: &mut Bench, path: &std::path::Path| {
        let effect = bench.tell(FileAction::LocateSkin(path.to_owned()));
        assert_eq!(effect, Some(Effect::LocateSkin(path.to_owned())));
        let rig = bench.session().rig();
        let SkinSource::Mesh(skin) = &rig.skin.as_ref().expect("a skin").source else {
            panic!("the mesh is from a file");
        };
        let before = skin.file().cloned();
        let read = Box::new(io::relocated_skin(path, skin, &rig.skeleton));
        bench.tell(FileAction::SkinLocated { path: path.to_owned(), before, read });
    };
    locate(&mut bench, &old);
    assert!(matches!(
        bench.session().shell().dialog(),
        Some(Dialog::Path(PathDialog::LocateSkin { problem: Some(_), .. }))
    ));
    locate(&mut bench, &new);
    assert!(bench.session().shell().dialog().is_none());
    assert!(skin(&bench).expect("a skin").mesh().is_ok());
    assert_eq!(bench.session().history().undo_label(), Some("Change skin"));
    bench.apply([TransactionAction::Undo]);
    assert!(skin(&bench).expect("a skin").mesh().is_err());
}
