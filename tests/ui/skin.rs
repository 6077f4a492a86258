//! The skin of a skeleton: made, changed and shown in the panel, and picked with the mouse.

use egui::accesskit::Role;
use glam::Vec3;
use ik_arm::document::{Overlay, Skin};
use ik_arm::io::Example;
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::skin::Skinning;
use ik_arm::rig::SkinSource;
use ik_arm::session::{EditAction, FileAction, PlaybackAction, SelectAction};

use crate::bench::Bench;

fn chain() -> Bench {
    Bench::after([FileAction::OpenExample(Example::find("ten-joints").expect("an example"))])
}

fn with_skin() -> Bench {
    let mut bench = chain();
    bench.reveal(Role::Button, "Add skin");
    bench.click(Role::Button, "Add skin");
    bench.settle();
    bench
}

fn skin(bench: &Bench) -> Option<&Skin> {
    bench.session().skeleton_rig().skin.as_ref()
}

fn shows(bench: &Bench, overlay: Overlay) -> bool {
    bench.session().shown().display.shows(overlay)
}

#[test]
fn one_button_gives_a_skeleton_a_skin_and_another_removes_it() {
    let mut bench = with_skin();
    let vertices =
        skin(&bench).expect("a skin").mesh().expect("a mesh").mesh.mesh().positions.len();
    assert!(vertices > 100, "{vertices}");
    assert!(shows(&bench, Overlay::Skin));
    bench.choose(&["Edit", "Undo Add skin"]);
    assert!(skin(&bench).is_none());
    bench.choose(&["Edit", "Redo Add skin"]);
    bench.reveal(Role::Button, "Remove skin");
    bench.click(Role::Button, "Remove skin");
    assert!(skin(&bench).is_none());
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
    bench.reveal(Role::Slider, "Skin detail");
    bench.enter("Skin detail", "3");
    let finer = vertices(&bench);
    assert!(finer > before * 3 / 2, "{before} to {finer}");
    let longest =
        |bench: &Bench| skin(bench).expect("a skin").mesh().expect("a mesh").mesh.mesh().size();
    let size = longest(&bench);
    bench.apply([EditAction::SetAxis { joint: JointId::new(9), axis: Vec3::Y * 3.0 }]);
    assert!(longest(&bench) > size, "{size}");
}

#[test]
fn a_dragged_thickness_is_one_undo_step() {
    let mut bench = with_skin();
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
    assert_eq!(bench.session().selection(), [joint]);
}

#[test]
fn weights_need_a_selected_joint_and_have_a_legend() {
    let mut bench = with_skin();
    bench.apply([EditAction::ShowOverlay(Overlay::SkinWeights, true)]);
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
