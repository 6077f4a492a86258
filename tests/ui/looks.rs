//! Appearance: everything is drawn; the harness panics at a letter that no font has.

use std::fs;
use std::path::Path;

use crate::common::arm::ArmEdit;
use crate::common::documents::open_example;
use egui::accesskit::Role;
use egui::{FontDefinitions, Key, Order, PointerButton, vec2};
use egui_kittest::SnapshotResults;
use glam::Vec3;
use ik_arm::document::{Overlay, Theme};
use ik_arm::io::Example;
use ik_arm::session::{
    Action, DisplayEdit, FileAction, Navigation, SelectAction, ShellAction, SolverAction,
    TargetEdit,
};
use skrifa::MetadataProvider as _;

use crate::bench::{Bench, SMALL};
use crate::panel::{CHECKBOXES, MENUS, SLIDERS};
use ik_arm::kinematics::skeleton::JointId;

const THEMES: [Theme; 2] = [Theme::Dark, Theme::Light];

fn in_theme(theme: Theme) -> Bench {
    Bench::after([ShellAction::SetTheme(theme)])
}

/// Holds the mouse over a widget until its tooltip shows.
pub fn has_tooltip(bench: &mut Bench, role: Role, name: &str) -> bool {
    bench.move_to(bench.viewport().left_bottom() + vec2(30.0, -30.0));
    bench.wait(0.05);
    bench.move_to(bench.rect(role, name).center());
    bench.frame([]);
    bench.wait(0.7);
    let layers = bench.harness.ctx.memory(|memory| memory.areas().visible_layer_ids());
    layers.iter().any(|layer| layer.order == Order::Tooltip)
}

#[test]
fn every_control_has_a_tooltip_that_can_be_read() {
    for theme in THEMES {
        let mut bench = in_theme(theme);
        for name in SLIDERS {
            assert!(has_tooltip(&mut bench, Role::Slider, name), "{name}");
        }
        bench.toggle(&["Display", "Lengths", "Root"]);
        for (name, _) in CHECKBOXES {
            assert!(has_tooltip(&mut bench, Role::CheckBox, name), "{name}");
        }
        for name in ["Reset pose", "Reset all", "View from the left"] {
            assert!(has_tooltip(&mut bench, Role::Button, name), "{name}");
        }
        assert!(has_tooltip(&mut bench, Role::SpinButton, "Hand x value"));
        bench.unfold_formulas();
        for name in
            ["Yaw theta z", "Distance D", "Level h c", "Sum L", "Along h e", "Elbow angle phi"]
        {
            bench.reveal(Role::Label, name);
            assert!(has_tooltip(&mut bench, Role::Label, name), "{name}");
        }
    }
}

#[test]
fn every_menu_and_dialog_can_be_read_in_both_themes() {
    for theme in THEMES {
        let mut bench = in_theme(theme);
        for (menu, _) in MENUS {
            bench.choose(&[menu]);
            bench.key(Key::Escape);
            bench.settle();
        }
        bench.choose(&["Edit", "Navigation"]);
        for navigation in Navigation::ALL {
            assert!(has_tooltip(&mut bench, Role::RadioButton, navigation.name()));
        }
        for navigation in Navigation::ALL {
            let mut bench = in_theme(theme);
            bench.apply([ShellAction::SetNavigation(navigation)]);
            bench.choose(&["Help", "Shortcuts"]);
            bench.wait(0.5);
            assert!(bench.says(navigation.help()[0]));
        }
        for path in [["Help", "About"], ["File", "Save picture…"]] {
            let mut bench = in_theme(theme);
            bench.choose(&path);
            bench.wait(0.5);
        }
    }
}

#[test]
fn the_built_in_fonts_have_every_letter_of_the_panels() {
    let fonts = FontDefinitions::default().font_data;
    let fonts: Vec<_> = fonts
        .values()
        .filter_map(|data| skrifa::FontRef::new((*data.font).as_ref()).ok())
        .collect();
    let has = |letter: char| fonts.iter().any(|font| font.charmap().map(letter).is_some());
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src/ui")];
    let mut files = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            files += 1;
            let source = fs::read_to_string(&path).expect("a source file");
            let lines = source.lines().filter(|line| !line.trim_start().starts_with("//"));
            let missing = lines.flat_map(str::chars).find(|letter| !has(*letter));
            assert_eq!(missing, None, "{}", path.display());
        }
    }
    assert!(files > 20, "{files}");
}

#[test]
fn every_sentence_of_the_status_line_can_be_read() {
    let mut bench = Bench::new();
    for hand in [Vec3::ZERO, Vec3::splat(900.0), Vec3::new(-1e30, 1e-30, 0.0)] {
        bench.apply([ArmEdit::SetHand(hand)]);
    }
    bench.apply([ArmEdit::SetUpper(-1.0)]);
    bench.apply([DisplayEdit::ResetPose]);
    for key in [Key::X, Key::Y, Key::Z] {
        let at = bench.cursor_on_screen();
        bench.drag(PointerButton::Primary, at, at + vec2(20.0, 5.0));
        bench.key(key);
        bench.type_text("1");
        bench.key(Key::Escape);
        bench.release(PointerButton::Primary);
    }
}

#[test]
fn nothing_moves_when_a_number_changes_its_width() {
    let unfolded = || {
        let mut bench = Bench::new();
        bench.unfold_formulas();
        bench
    };
    let mut bench = unfolded();
    let places = |bench: &Bench| {
        let controls = SLIDERS.map(|name| bench.rect(Role::Slider, name));
        (controls, bench.viewport(), bench.rect(Role::CheckBox, "Elbow circle"))
    };
    let before = places(&bench);
    for hand in [Vec3::ZERO, Vec3::splat(-123_456.8), Vec3::new(1.0, 480.0, 3.0)] {
        bench.apply([ArmEdit::SetHand(hand), ArmEdit::SetRoot(hand)]);
        assert_eq!(places(&bench), before, "{hand}");
        bench.click(Role::SpinButton, "Hand x value");
        bench.type_text("12345678901234567890");
        assert_eq!(places(&bench), before, "while typing");
        bench.key(Key::Escape);
        let labels = ["Yaw theta z", "Level h c", "Elbow angle phi"]
            .map(|name| bench.rect(Role::Label, name).top());
        let fresh = unfolded();
        let expected = ["Yaw theta z", "Level h c", "Elbow angle phi"]
            .map(|name| fresh.rect(Role::Label, name).top());
        assert_eq!(labels, expected, "{hand}");
    }
}

#[test]
fn panels_that_scroll_end_at_a_whole_row() {
    for height in (600..660).step_by(7) {
        for example in ["arm", "human"] {
            let mut bench = Bench::of_size(vec2(1280.0, height as f32));
            bench.apply([open_example(example)]);
            bench.settle();
            let picture = bench.harness.render().expect("a picture");
            // Above the line between the panels.
            let y = bench.viewport().bottom() as u32 - 3;
            let panel = picture.get_pixel(12, y);
            // Left of the scroll bar.
            let right = bench.viewport().left() as u32 - 16;
            let other = (13..right).find(|x| picture.get_pixel(*x, y) != panel);
            assert_eq!(other, None, "{example}, {height} points high");
        }
    }
}

#[test]
fn the_panels_leave_the_viewport_room_at_960_by_600() {
    let bench = Bench::of_size(SMALL);
    let viewport = bench.viewport();
    assert!(viewport.width() > 350.0 && viewport.height() > 450.0, "{viewport:?}");
    for name in SLIDERS {
        let rail = bench.rect(Role::Slider, name);
        assert!(rail.right() < viewport.left() && rail.width() > 60.0, "{name}: {rail:?}");
    }
}

#[test]
fn the_panels_look_as_they_did() {
    let mut results = SnapshotResults::new();
    let human = Example::find("human").expect("an example");
    let mut target = human.open().expect("it opens").document.rig.targets[0];
    target.home += Vec3::new(0.1, 0.3, 0.1);
    let skeleton = [
        Action::from(FileAction::OpenExample(human)),
        SelectAction::Joints(vec![JointId::new(8)]).into(),
        TargetEdit::SetTarget(target).into(),
        SolverAction::Step.into(),
        SolverAction::Step.into(),
        SolverAction::Show(1).into(),
    ];
    for theme in THEMES {
        let rigs = [
            ("panels", vec![DisplayEdit::ShowOverlay(Overlay::InnerLimit, true).into()]),
            ("skeleton", skeleton.to_vec()),
        ];
        for (name, actions) in rigs {
            let mut bench = in_theme(theme);
            bench.apply(actions);
            bench.snapshot(name, theme, &mut results);
        }
    }
}
