//! The left panel, the menu bar and the Explain panel.

use crate::common::arm::{Arm, ArmEdit, ArmSession, Step};
use egui::Key;
use egui::accesskit::Role;
use glam::Vec3;
use ik_arm::document::{Camera, Document, Overlay, Theme, TwistReferenceKind};
use ik_arm::kinematics::two_bone::Reach;
use ik_arm::session::{
    Dialog, DisplayEdit, Effect, FrameBudget, Navigation, PanelTab, Preferences, ShellAction,
    ViewAction,
};

use crate::bench::{Bench, LARGE, SMALL};

pub const SLIDERS: [&str; 9] = [
    "Hand x",
    "Hand y",
    "Hand z",
    "Socket twist",
    "Root x",
    "Root y",
    "Root z",
    "Upper length",
    "Lower length",
];

pub const CHECKBOXES: [(&str, Overlay); 13] = [
    ("Cursor", Overlay::Cursor),
    ("Pointer", Overlay::Pointer),
    ("Inner limit", Overlay::InnerLimit),
    ("Outer limit", Overlay::OuterLimit),
    ("Elbow circle", Overlay::ElbowCircle),
    ("XY grid", Overlay::GridXy),
    ("XZ grid", Overlay::GridXz),
    ("YZ grid", Overlay::GridYz),
    ("Ground", Overlay::Ground),
    ("Axes", Overlay::Axes),
    ("Labels", Overlay::Labels),
    ("Shadow", Overlay::Shadow),
    ("Hand", Overlay::Hand),
];

pub const MENUS: [(&str, &[&str]); 4] = [
    ("File", &["Save picture…", "Quit"]),
    ("Edit", &["Copy pose as JSON line", "Navigation"]),
    (
        "View",
        &[
            "Front",
            "Right",
            "Top",
            "Back",
            "Left",
            "Bottom",
            "Toggle orthographic",
            "Frame selection",
            "Frame all",
            "Light theme",
            "Dark theme",
            "While moving",
            "Explain panel",
            "Timeline",
            "Graph editor",
        ],
    ),
    ("Help", &["Shortcuts", "About"]),
];

#[test]
fn every_control_of_the_left_panel_is_there_by_name() {
    for mut bench in [Bench::new(), Bench::of_size(SMALL)] {
        for name in SLIDERS {
            assert!(bench.shows(Role::Slider, name), "no slider {name}");
            assert!(bench.shows(Role::SpinButton, &format!("{name} value")), "no number {name}");
        }
        bench.toggle(&["Display"]);
        for (name, _) in CHECKBOXES {
            assert!(bench.shows(Role::CheckBox, name), "no checkbox {name}");
        }
        for name in ["Reset pose", "Reset all", "File", "Edit", "View", "Help"] {
            assert!(bench.shows(Role::Button, name), "no button {name}");
        }
        bench.settle();
    }
}

#[test]
fn the_whole_left_panel_is_in_sight_at_1280_by_800() {
    let mut bench = Bench::first(LARGE, Preferences::default());
    bench.toggle(&["Limb"]);
    let last = bench.rect(Role::Button, "Reset all");
    assert!(
        last.bottom() < bench.viewport().bottom() && last.right() < bench.viewport().left(),
        "{last:?} in {:?}",
        bench.viewport()
    );
}

#[test]
fn the_menus_have_the_expected_items() {
    for (menu, items) in MENUS {
        let mut bench = Bench::new();
        // The transport bar has a button of the same name as an item.
        let is_open = items.iter().any(|item| bench.says(item) && *item != "Timeline");
        assert!(!is_open, "{menu} is open");
        bench.choose(&[menu]);
        for item in items {
            assert!(bench.says(item), "{item} is not in {menu}");
        }
        bench.key(Key::Escape);
        bench.settle();
        assert!(!bench.says(items[0]), "Esc leaves {menu} open");
    }
}

#[test]
fn each_checkbox_toggles_its_overlay_and_no_other() {
    let mut bench = Bench::new();
    bench.toggle(&["Display", "Lengths", "Root"]);
    for (name, layer) in CHECKBOXES {
        for _ in 0..2 {
            let before = bench.session().document().display;
            bench.click(Role::CheckBox, name);
            let expected = before.with(layer, !before.shows(layer));
            assert_eq!(bench.session().document().display, expected, "{name}");
        }
    }
    assert_eq!(bench.session().document().display, Document::default().display);
    assert_eq!(&bench.session().arm(), &Arm::default());
}

#[test]
fn a_checkbox_answers_to_the_keyboard() {
    let mut bench = Bench::new();
    bench.focus(Role::CheckBox, "Outer limit");
    bench.key(Key::Space);
    assert!(bench.session().document().display.shows(Overlay::OuterLimit));
}

#[test]
fn reset_pose_resets_the_arm_and_leaves_what_is_shown() {
    let camera = Camera { yaw: 1.0, ..Camera::default() };
    let actions = [
        Step::from(ArmEdit::SetHand(Vec3::new(1.0, 2.0, 3.0))),
        ArmEdit::SetRoot(Vec3::splat(9.0)).into(),
        ArmEdit::SetTwist(2.0).into(),
        ArmEdit::SetUpper(77.0).into(),
        DisplayEdit::ShowOverlay(Overlay::OuterLimit, true).into(),
        ViewAction::SetCamera(camera).into(),
    ];
    let mut bench = Bench::after(actions);
    bench.toggle(&["Limb"]);
    bench.click(Role::Button, "Reset pose");
    assert_eq!(&bench.session().arm(), &Arm::default());
    assert!(bench.session().document().display.shows(Overlay::OuterLimit));
    assert_eq!(bench.session().camera(), &camera);
}

#[test]
fn reset_all_resets_everything_but_the_preferences() {
    let actions = [
        Step::from(ArmEdit::SetLower(77.0)),
        DisplayEdit::ShowOverlay(Overlay::Axes, false).into(),
        ViewAction::SetCamera(Camera { yaw: 1.0, ..Camera::default() }).into(),
        ShellAction::SetTheme(Theme::Light).into(),
    ];
    let mut bench = Bench::after(actions);
    bench.toggle(&["Limb"]);
    bench.click(Role::Button, "Reset all");
    assert_eq!(bench.session().document(), &Document::default());
    assert_eq!(bench.session().preferences().theme, Theme::Light);
}

#[test]
fn the_menus_do_what_they_say() {
    let mut bench = Bench::new();
    bench.choose(&["View", "Light theme"]);
    assert_eq!(bench.session().preferences().theme, Theme::Light);
    assert!(!bench.harness.ctx.global_style().visuals.dark_mode);
    bench.choose(&["View", "Dark theme"]);
    assert_eq!(bench.session().preferences().theme, Theme::Dark);
    for navigation in Navigation::ALL {
        bench.choose(&["Edit", "Navigation", navigation.name()]);
        assert_eq!(bench.session().preferences().navigation, navigation);
        bench.key(Key::Escape);
        bench.settle();
    }
    for budget in FrameBudget::ALL {
        bench.choose(&["View", "While moving", budget.name()]);
        assert_eq!(bench.session().preferences().frame_budget, budget);
        bench.key(Key::Escape);
        bench.settle();
    }
    bench.choose(&["Help", "About"]);
    assert_eq!(bench.session().shell().dialog(), Some(&Dialog::About));
    bench.key(Key::Escape);
    bench.choose(&["Help", "Shortcuts"]);
    assert_eq!(bench.session().shell().dialog(), Some(&Dialog::Shortcuts));
    bench.key(Key::Escape);
    bench.choose(&["File", "Quit"]);
    assert_eq!(bench.effects(), [Effect::Quit]);
}

#[test]
fn the_explain_panel_closes_and_opens_from_the_view_menu() {
    let mut bench = Bench::new();
    let narrow = bench.viewport();
    assert!(bench.says("Elbow triangle"));
    bench.choose(&["View", "Explain panel"]);
    assert!(!bench.session().preferences().explain);
    assert!(!bench.says("Elbow triangle"));
    assert!(bench.viewport().right() > narrow.right() + 200.0, "the viewport takes the room");
    bench.key(Key::Escape);
    bench.choose(&["View", "Explain panel"]);
    assert!(bench.session().preferences().explain);
    assert_eq!(bench.viewport(), narrow);
}

#[test]
fn the_explain_panel_says_in_a_sentence_how_far_the_arm_reaches() {
    for (hand, reach, sentence) in [
        (Vec3::new(250.0, 120.0, 60.0), Reach::Reached, "The hand is at its target."),
        (
            Vec3::new(537.2, 0.0, 0.0),
            Reach::TooFar,
            "The hand cannot reach that far: the target is 537 from the shoulder, the bones are 500 long.",
        ),
        (
            Vec3::new(60.0, 0.0, 0.0),
            Reach::TooClose,
            "The hand cannot come that near: the target is 60 from the shoulder, the bones fold to 100.",
        ),
    ] {
        let bench = Bench::after([ArmEdit::SetHand(hand)]);
        assert_eq!(bench.session().pose().reach, Some(reach));
        assert!(bench.shows(Role::Label, sentence), "{sentence}");
        assert!(bench.shows(Role::Image, &format!("Viewport. {sentence}")), "{sentence}");
    }
}

#[test]
fn the_explain_panel_names_the_quantities_and_shows_their_values() {
    let mut bench = Bench::after([ArmEdit::SetHand(Vec3::new(300.0, 0.0, 400.0))]);
    bench.unfold_formulas();
    for name in [
        "Yaw theta z",
        "Level h c",
        "Pitch theta y",
        "Distance D",
        "Upper d 1",
        "Lower d 2",
        "Sum L",
        "Difference delta",
        "Along h e",
        "Height o e",
        "Shoulder theta e",
        "Elbow angle phi",
    ] {
        assert!(bench.shows(Role::Label, name), "{name}");
    }
    for value in ["53.1°", "0.0°", "500.0", "180.0°"] {
        assert!(bench.shows(Role::Label, value), "{value}");
    }
    assert!(bench.says("Triangle: upper limb 200.0, lower limb 300.0, distance 500.0, angle at the shoulder 0.0 degrees, angle at the elbow 180.0 degrees"));
    bench.show_tab(PanelTab::Reach);
    assert!(bench.says("Reach: Cursor at 500.0; the hand reaches from 100.0 to 500.0"));
}

#[test]
fn a_panel_can_be_made_wider() {
    let mut bench = Bench::new();
    let edge = bench.viewport().left_center() - egui::vec2(3.0, 0.0);
    bench.drag_and_drop(egui::PointerButton::Primary, edge, edge + egui::vec2(60.0, 0.0));
    bench.settle();
    assert!((bench.viewport().left() - edge.x - 63.0).abs() < 12.0, "{:?}", bench.viewport());
    assert_eq!(bench.session().document(), &Document::default());
}

#[test]
fn nothing_covers_the_title_of_the_socket_twist_with_any_reference() {
    for size in [LARGE, SMALL] {
        for kind in TwistReferenceKind::ALL {
            let mut bench = Bench::of_size(size);
            bench.apply([ArmEdit::SetTwistReference(kind)]);
            let title = bench.rect(Role::DisclosureTriangle, "Socket twist");
            // The title's row is sensitive over its whole width; its text is this wide.
            let title = title.with_max_x(title.left() + 100.0);
            let choice = bench.rect(Role::ComboBox, "Twist reference");
            assert!(!title.intersects(choice), "{kind:?}: {title:?} {choice:?}");
            if bench.shows(Role::Label, "Reference") {
                let label = bench.rect(Role::Label, "Reference");
                assert!(
                    !title.intersects(label) && !label.intersects(choice),
                    "{kind:?}: {label:?}"
                );
            }
            assert!(choice.right() < bench.viewport().left(), "{kind:?}: {choice:?}");
        }
    }
}
