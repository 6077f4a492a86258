//! Keyboard and screen reader: Tab, names, and accessibility actions.

use crate::common::arm::{Arm, ArmEdit, ArmSession};
use egui::accesskit::{Action as Ask, Role};
use egui::{Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;

use crate::bench::{Bench, SMALL, bits};
use crate::panel::{CHECKBOXES, SLIDERS};

fn shown(bench: &Bench, slider: &str) -> f64 {
    bench.node(Role::Slider, slider).accesskit_node().numeric_value().expect("a number")
}

#[test]
fn every_slider_tells_its_value_and_its_range() {
    let bench = Bench::new();
    let values = [250.0, 120.0, 60.0, 0.0, 0.0, 0.0, 0.0, 200.0, 300.0];
    for (slider, value) in SLIDERS.into_iter().zip(values) {
        let node = bench.node(Role::Slider, slider).accesskit_node();
        let range = match slider {
            "Socket twist" => (-180.0, 180.0),
            "Upper length" | "Lower length" => (10.0, 1000.0),
            _ => (-500.0, 500.0),
        };
        assert_eq!(node.numeric_value(), Some(value), "{slider}");
        let ends = (node.min_numeric_value(), node.max_numeric_value());
        assert_eq!(ends, (Some(range.0), Some(range.1)), "{slider}");
        for ask in [Ask::SetValue, Ask::Increment, Ask::Decrement, Ask::Focus] {
            assert!(node.data().supports_action(ask), "{slider}: {ask:?}");
        }
    }
}

#[test]
fn a_screen_reader_sets_raises_and_lowers_each_slider() {
    for slider in SLIDERS {
        let mut bench = Bench::new();
        bench.node(Role::Slider, slider).set_value_accesskit(77.0);
        bench.frame([]);
        assert!((shown(&bench, slider) - 77.0).abs() < 1e-4, "{slider}");
        bench.node(Role::Slider, slider).increment_accesskit();
        bench.frame([]);
        assert!((shown(&bench, slider) - 78.0).abs() < 1e-4, "{slider}");
        for _ in 0..2 {
            bench.node(Role::Slider, slider).decrement_accesskit();
            bench.frame([]);
        }
        assert!((shown(&bench, slider) - 76.0).abs() < 1e-4, "{slider}");
        let changed = SLIDERS.map(|slider| shown(&bench, slider));
        let before = Bench::new();
        for (other, changed) in SLIDERS.into_iter().zip(changed) {
            assert_eq!(changed == shown(&before, other), other != slider, "{slider}: {other}");
        }
    }
}

#[test]
fn values_set_by_a_screen_reader_are_validated() {
    let mut bench = Bench::new();
    for value in [-3.0, 0.0, f64::NAN, f64::INFINITY, 1e300] {
        bench.node(Role::Slider, "Upper length").set_value_accesskit(value);
        bench.frame([]);
        assert_eq!(&bench.session().arm(), &Arm::default(), "{value}");
        assert!(bench.says("must be finite and above 0"));
    }
    bench.node(Role::Slider, "Hand x").set_value_accesskit(f64::NAN);
    bench.frame([]);
    assert_eq!(&bench.session().arm(), &Arm::default());
    bench.node(Role::Slider, "Hand y").set_value_accesskit(12_345.5);
    bench.frame([]);
    assert_eq!(bits(bench.hand()), bits(Vec3::new(250.0, 12_345.5, 60.0)));
}

#[test]
fn everything_that_can_be_acted_on_has_a_name() {
    for mut bench in [Bench::new(), Bench::of_size(SMALL)] {
        bench.harness.check_accessibility();
        for menu in ["File", "Edit", "View", "Help"] {
            bench.choose(&[menu]);
            bench.harness.check_accessibility();
            bench.key(Key::Escape);
            bench.settle();
        }
        for path in [["File", "Save picture…"], ["Help", "Shortcuts"], ["Help", "About"]] {
            bench.choose(&path);
            bench.harness.check_accessibility();
            bench.key(Key::Escape);
            bench.settle();
            bench.key(Key::Escape);
            bench.settle();
        }
    }
}

#[test]
fn tab_goes_through_the_controls_in_reading_order_and_back() {
    let mut bench = Bench::new();
    bench.toggle(&["Display"]);
    let numbers = SLIDERS.map(|name| format!("{name} value"));
    let mut expected = Vec::new();
    for (slider, number) in SLIDERS.into_iter().zip(&numbers) {
        expected.push((Role::Slider, slider));
        expected.push((Role::SpinButton, number.as_str()));
    }
    expected.extend(CHECKBOXES.map(|(name, _)| (Role::CheckBox, name)));
    expected.extend([(Role::Button, "Reset pose"), (Role::Button, "Reset all")]);

    let mut visited = Vec::new();
    for _ in 0..80 {
        bench.key(Key::Tab);
        let Some(focused) = bench.focused() else {
            panic!("Tab focuses nothing after {visited:?}");
        };
        assert_ne!(focused.0, Role::Label, "a label does nothing: {focused:?}");
        if visited.first() == Some(&focused) {
            break;
        }
        visited.push(focused);
    }
    let (boxes, others): (Vec<_>, Vec<_>) = visited
        .iter()
        .map(|(role, name)| (*role, name.as_str()))
        .filter(|control| expected.contains(control))
        .partition(|control| control.0 == Role::CheckBox);
    // The checkboxes are in two columns and have no single reading order.
    assert_eq!(boxes.len(), CHECKBOXES.len(), "{boxes:?}");
    expected.retain(|control| control.0 != Role::CheckBox);
    assert_eq!(others, expected);

    bench.focus(Role::Slider, "Hand z");
    bench.key_with(Modifiers::SHIFT, Key::Tab);
    assert_eq!(bench.focused(), Some((Role::SpinButton, "Hand y value".to_owned())));
    assert_eq!(&bench.session().arm(), &Arm::default());
}

#[test]
fn the_arm_can_be_posed_by_keyboard_alone() {
    let mut bench = Bench::new();
    while bench.focused() != Some((Role::Slider, "Hand y".to_owned())) {
        bench.key(Key::Tab);
    }
    bench.key(Key::PageUp);
    bench.key(Key::ArrowRight);
    bench.key_with(Modifiers::SHIFT, Key::ArrowLeft);
    assert!((bench.hand().y - 130.9).abs() < 1e-4);
    bench.key(Key::Tab);
    bench.type_text("-40.5");
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bits(bench.hand()), bits(Vec3::new(250.0, -40.5, 60.0)));
}

#[test]
fn the_viewport_is_an_image_that_says_how_far_the_arm_reaches() {
    let bench = Bench::after([ArmEdit::SetHand(Vec3::new(0.0, 600.0, 0.0))]);
    let name = "Viewport. The hand cannot reach that far: the target is 600 from the shoulder, the bones are 500 long.";
    let rect = bench.rect(Role::Image, name);
    // The mouse grabs the panels beside the view at its edges.
    assert_eq!(rect, bench.viewport().shrink(4.0));
}

#[test]
fn at_960_by_600_the_panel_scrolls_to_what_the_keyboard_reaches() {
    let mut bench = Bench::of_size(SMALL);
    bench.toggle(&["Display"]);
    bench.node(Role::Button, "Reset all").scroll_to_me();
    bench.settle();
    let last = bench.rect(Role::Button, "Reset all");
    assert!(last.bottom() < 570.0, "{last:?}");
    let over = bench.rect(Role::CheckBox, "Shadow").center();
    bench.move_to(over);
    for _ in 0..20 {
        bench.wheel(5.0);
    }
    bench.wait(0.5);
    let first = bench.rect(Role::Slider, "Hand x");
    assert!(first.top() > 30.0, "{first:?}");
    bench.drag_and_drop(PointerButton::Primary, first.center(), first.center() + vec2(20.0, 0.0));
    assert_ne!(bench.hand().x, 250.0);
}
