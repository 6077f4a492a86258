//! Dialogs, saved pictures and copied poses.

use crate::common::arm::{ArmEdit, Step};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::document::TwistReferenceKind;
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::kinematics::two_bone::TwoBone;
use ik_arm::session::{Dialog, Effect, PathDialog};
use serde_json::json;

use crate::bench::Bench;

const CTRL: Modifiers = Modifiers::COMMAND;

#[test]
fn about_tells_version_graphics_and_licence() {
    let mut bench = Bench::new();
    bench.choose(&["Help", "About"]);
    for text in [concat!("ik-arm ", env!("CARGO_PKG_VERSION")), "Test adapter", "MIT or Apache"] {
        assert!(bench.says(text), "{text}");
    }
    bench.key(Key::Escape);
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None);
    assert!(!bench.says("MIT or Apache"));
}

#[test]
fn f1_lists_the_keys_and_esc_closes_the_list() {
    let mut bench = Bench::new();
    bench.key(Key::F1);
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), Some(&Dialog::Shortcuts));
    for text in ["Ctrl+7", "Shift+arrows", "Lock to an axis", "Next number, after typing"] {
        assert!(bench.says(text), "{text}");
    }
    bench.key(Key::Escape);
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None);
}

#[test]
fn f1_works_while_a_slider_has_the_keyboard() {
    let mut bench = Bench::new();
    bench.focus(Role::Slider, "Hand x");
    bench.key(Key::F1);
    assert_eq!(bench.session().shell().dialog(), Some(&Dialog::Shortcuts));
}

#[test]
fn a_picture_is_saved_where_the_typed_path_says() {
    for by_enter in [true, false] {
        let mut bench = Bench::new();
        bench.choose(&["File", "Save picture…"]);
        assert!(bench.node(Role::TextInput, "PNG file").is_focused());
        bench.key_with(CTRL, Key::A);
        bench.type_text("out/a b.png");
        let path = "out/a b.png".to_owned();
        assert_eq!(
            bench.session().shell().dialog(),
            Some(&Dialog::Path(PathDialog::SavePicture { path: path.clone() }))
        );
        if by_enter {
            bench.key(Key::Enter);
        } else {
            bench.click(Role::Button, "Save");
        }
        bench.settle();
        assert_eq!(bench.effects(), [Effect::SavePicture(path)]);
        assert_eq!(bench.session().shell().dialog(), None);
        assert!(bench.says("Saving out/a b.png"));
    }
}

#[test]
fn without_a_path_nothing_can_be_saved() {
    for typed in ["", "   "] {
        let mut bench = Bench::new();
        bench.key_with(CTRL, Key::P);
        bench.settle();
        bench.key_with(CTRL, Key::A);
        bench.key(Key::Delete);
        bench.type_text(typed);
        bench.settle();
        assert!(bench.node(Role::Button, "Save").accesskit_node().is_disabled());
        bench.click(Role::Button, "Save");
        let save = bench.rect(Role::Button, "Save").center();
        bench.move_to(save + egui::vec2(0.0, 200.0));
        bench.wait(0.5);
        bench.move_to(save);
        bench.wait(1.0);
        assert!(bench.says("Enter a path first"), "the tooltip says why");
        bench.focus(Role::TextInput, "PNG file");
        bench.key(Key::Enter);
        bench.settle();
        assert_eq!(bench.effects(), []);
        assert!(bench.session().shell().dialog().is_some());
    }
}

#[test]
fn the_picture_dialog_asks_the_system_for_a_path_and_closes() {
    let mut bench = Bench::new();
    bench.key_with(CTRL, Key::P);
    bench.settle();
    bench.click(Role::Button, "Browse…");
    assert_eq!(
        bench.effects(),
        [Effect::ChoosePath(PathDialog::SavePicture { path: "ik-arm.png".to_owned() })]
    );
    bench.click(Role::Button, "Cancel");
    assert_eq!(bench.session().shell().dialog(), None);
    bench.key_with(CTRL, Key::P);
    bench.settle();
    bench.key(Key::Escape);
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None);
    assert_eq!(bench.effects(), []);
}

#[test]
fn a_copied_pose_is_a_json_line_that_holds_the_pose() {
    for by_key in [true, false] {
        let mut bench = Bench::after([
            ArmEdit::SetHand(Vec3::new(0.1, -200.25, 1e-7)),
            ArmEdit::SetRoot(Vec3::new(1.0, 2.0, 3.0)),
            ArmEdit::SetUpper(123.5),
            ArmEdit::SetTwist(1.0),
        ]);
        if by_key {
            bench.frame([Event::Copy]);
        } else {
            bench.choose(&["Edit", "Copy pose as JSON line"]);
        }
        let effects = bench.effects();
        let [Effect::CopyText(line)] = effects.as_slice() else {
            panic!("{effects:?}");
        };
        assert!(!line.contains('\n'));
        let pose: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let expected = json!({
            "hand": [0.1_f32, -200.25_f32, 1e-7_f32],
            "root": [1.0, 2.0, 3.0],
            "upper": 123.5,
            "lower": 300.0,
            "twist_deg": 1.0_f32.to_degrees(),
        });
        for (field, expected) in expected.as_object().expect("fields") {
            let numbers = |value: &serde_json::Value| -> Vec<f64> {
                let number = |it: &serde_json::Value| it.as_f64().expect("a number");
                value
                    .as_array()
                    .map_or_else(|| vec![number(value)], |it| it.iter().map(number).collect())
            };
            let pairs = numbers(&pose[field]).into_iter().zip(numbers(expected));
            for (found, expected) in pairs {
                assert!((found - expected).abs() < 1e-4, "{field}: {found} for {expected}");
            }
        }
        assert!(bench.says("Pose copied"));
    }
}

/// The pose that a session copies to the clipboard.
fn copied(actions: impl IntoIterator<Item = impl Into<Step>>) -> serde_json::Value {
    let mut bench = Bench::after(actions);
    bench.frame([Event::Copy]);
    let effects = bench.effects();
    let [Effect::CopyText(line)] = &effects[..] else { panic!("{effects:?}") };
    serde_json::from_str(line).expect("JSON")
}

#[test]
fn a_copied_pose_has_its_twist_reference_and_softness() {
    let soft_reach = SoftReach::new(0.25, 1.5, 0.5).expect("a softening");
    let line = copied([
        ArmEdit::SetTwistReference(TwistReferenceKind::Pole),
        ArmEdit::SetPole(Vec3::new(1.0, 2.0, 3.0)),
        ArmEdit::SetSoftReach(soft_reach),
    ]);
    assert_eq!(line["reference"], json!({ "pole": [1.0, 2.0, 3.0] }));
    assert_eq!(line["softness"], json!(0.25_f32));
    assert_eq!(line["max_stretch"], json!(1.5_f32));
    assert_eq!(line["min_elbow_angle_deg"], json!(0.5_f32.to_degrees()));
    let transported = copied([ArmEdit::SetTwistReference(TwistReferenceKind::Transport)]);
    assert_eq!(transported["reference"], json!("stereographic"), "a line has no past");
}

#[test]
fn a_copied_pose_keeps_an_elbow_that_depends_on_earlier_poses() {
    // Straight up the arm keeps the heading that it had: +z. A line begins with +x.
    let upwards = [Vec3::new(0.0, 100.0, 300.0), Vec3::new(0.0, 300.0, 0.0)].map(ArmEdit::SetHand);
    let twist = copied(upwards)["twist_deg"].as_f64().expect("a number");
    let elbow = TwoBone::new(200.0, 300.0).expect("lengths");
    let elbow = elbow.solve(Vec3::Y * 300.0, twist.to_radians() as f32).elbow;
    assert!(elbow.z < -100.0 && elbow.x.abs() < 1e-3, "{elbow}");
}

#[test]
fn copying_in_a_field_copies_the_fields_text_alone() {
    let mut bench = Bench::new();
    bench.click(Role::SpinButton, "Hand x value");
    bench.frame([Event::Copy]);
    assert_eq!(bench.effects(), []);
}

#[test]
fn ctrl_q_quits() {
    let mut bench = Bench::new();
    bench.key_with(CTRL, Key::Q);
    assert_eq!(bench.effects(), [Effect::Quit]);
}

#[test]
fn the_open_dialog_names_its_folder_before_a_path_is_typed() {
    let mut bench = Bench::new();
    bench.key_with(CTRL, Key::O);
    bench.settle();
    let folder = std::env::current_dir().expect("a folder");
    assert!(bench.shows(Role::Label, &format!("In {}", folder.display())));
}
