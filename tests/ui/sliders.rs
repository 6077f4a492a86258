//! The nine sliders' rails, by mouse and keyboard.

use crate::common::arm::{Arm, ArmEdit, ArmSession};
use core::f32::consts::TAU;

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use glam::Vec3;
use ik_arm::session::TransactionAction;

use crate::bench::Bench;
use crate::panel::SLIDERS;

/// A point of a slider's rail, from 0 at its left to 1 at its right.
fn on_rail(bench: &Bench, name: &str, part: f32) -> Pos2 {
    let rail = bench.rect(Role::Slider, name);
    pos2(rail.left() + rail.width() * part, rail.center().y)
}

pub fn value(arm: &Arm, slider: &str) -> f32 {
    match slider {
        "Hand x" => arm.cursor_in_root().x,
        "Hand y" => arm.cursor_in_root().y,
        "Hand z" => arm.cursor_in_root().z,
        "Socket twist" => arm.twist.to_degrees(),
        "Root x" => arm.root.x,
        "Root y" => arm.root.y,
        "Root z" => arm.root.z,
        "Upper length" => arm.bones.upper(),
        _ => arm.bones.lower(),
    }
}

/// The arm's settings without its last pointer, which follows from them.
pub fn is_same_but(slider: &str, a: &Arm, b: &Arm) -> bool {
    SLIDERS
        .into_iter()
        .filter(|other| *other != slider)
        .all(|other| value(a, other).to_bits() == value(b, other).to_bits())
}

/// A pose of awkward numbers, some beyond every thumb's range.
pub fn awkward() -> [ArmEdit; 5] {
    [
        ArmEdit::SetHand(Vec3::new(123.456_79, -987.654_3, 0.1)),
        ArmEdit::SetRoot(Vec3::new(-1_234.567_9, 0.333_333_34, 1e-7)),
        ArmEdit::SetTwist(1.234_567_9),
        ArmEdit::SetUpper(1_234.567_9),
        ArmEdit::SetLower(3.333_333_3),
    ]
}

#[test]
fn dragging_a_rail_moves_the_hand_in_the_same_frame() {
    let mut bench = Bench::new();
    bench.move_to(on_rail(&bench, "Hand y", 0.7));
    bench.press(PointerButton::Primary);
    let mut last = bench.hand().y;
    assert!((last - 210.0).abs() < 40.0, "the thumb comes to the press: {last}");
    for step in 1..=10 {
        bench.move_to(on_rail(&bench, "Hand y", 0.7 + 0.02 * step as f32));
        assert!(bench.hand().y > last, "{} after {last}", bench.hand().y);
        last = bench.hand().y;
        let pose = bench.session().pose();
        assert!((pose.hand.y - last).abs() < 1e-3 || last > 400.0, "the arm follows: {pose:?}");
        assert!(bench.session().history().is_editing());
        let shown = bench.node(Role::SpinButton, "Hand y value").value();
        assert_eq!(shown, Some(format!("{last:.1}")), "the number is of this frame");
    }
    bench.release(PointerButton::Primary);
    assert!(!bench.session().history().is_editing());
    assert_eq!(bench.hand().y, last);
}

#[test]
fn each_slider_changes_its_own_number_and_no_other_bit() {
    for slider in SLIDERS {
        let mut bench = Bench::after([
            ArmEdit::SetHand(Vec3::new(123.456_79, -87.654_32, 0.1)),
            ArmEdit::SetRoot(Vec3::new(-12.345_679, 0.333_333_34, 1e-7)),
            ArmEdit::SetTwist(1.234_567_9),
        ]);
        let before = bench.session().arm();
        let (from, to) = (on_rail(&bench, slider, 0.5), on_rail(&bench, slider, 0.8));
        bench.drag_and_drop(PointerButton::Primary, from, to);
        let after = bench.session().arm();
        assert_ne!(value(&after, slider), value(&before, slider), "{slider}");
        assert!(is_same_but(slider, &after, &before), "{slider}: {after:?}");
    }
}

#[test]
fn a_dragged_label_turns_its_number_and_with_shift_ten_times_as_finely() {
    for (modifiers, degrees) in [(Modifiers::NONE, 36.0), (Modifiers::SHIFT, 3.6)] {
        let mut bench = Bench::new();
        let at = bench.rect(Role::Label, "Twist").center();
        bench.hold(modifiers);
        bench.move_to(at);
        bench.press(PointerButton::Primary);
        for step in 1..=20 {
            bench.move_to(at + vec2(5.0 * step as f32, 0.0));
        }
        assert!(bench.session().history().is_editing());
        let twist = bench.session().arm().twist.to_degrees();
        assert!((twist - degrees).abs() <= 0.1 * degrees, "{twist}");
        bench.release(PointerButton::Primary);
        assert!(!bench.session().history().is_editing());
        bench.apply([TransactionAction::Undo]);
        assert_eq!(bench.session().arm(), Arm::default(), "it is one step");
    }
}

#[test]
fn esc_cancels_the_drag_of_a_label() {
    let mut bench = Bench::after(awkward());
    let before = bench.session().arm();
    let at = bench.rect(Role::Label, "Twist").center();
    bench.drag(PointerButton::Primary, at, at + vec2(40.0, 0.0));
    assert_ne!(bench.session().arm(), before);
    bench.key(Key::Escape);
    bench.move_to(at + vec2(80.0, 0.0));
    bench.release(PointerButton::Primary);
    bench.settle();
    assert_eq!(bench.session().arm(), before);
}

#[test]
fn a_click_on_a_rail_goes_there() {
    let mut bench = Bench::new();
    bench.click_at(on_rail(&bench, "Root x", 0.5));
    assert_eq!(bench.session().arm().root, Vec3::ZERO);
    bench.wait(1.0);
    bench.click_at(on_rail(&bench, "Root x", 1.0));
    assert_eq!(bench.session().arm().root, Vec3::new(500.0, 0.0, 0.0));
    assert!(!bench.session().history().is_editing());
}

#[test]
fn esc_cancels_the_drag_of_a_rail_and_further_movement_changes_nothing() {
    let mut bench = Bench::after(awkward());
    let before = bench.session().arm();
    let (from, to) = (on_rail(&bench, "Hand x", 0.4), on_rail(&bench, "Hand x", 0.7));
    bench.drag(PointerButton::Primary, from, to);
    assert_ne!(&bench.session().arm(), &before);
    bench.key(Key::Escape);
    assert_eq!(&bench.session().arm(), &before);
    assert!(!bench.session().history().is_editing());
    bench.move_to(on_rail(&bench, "Hand x", 0.2));
    bench.move_to(on_rail(&bench, "Hand x", 0.9));
    bench.release(PointerButton::Primary);
    bench.settle();
    assert_eq!(&bench.session().arm(), &before);
}

#[test]
fn esc_cancels_a_press_on_a_rail() {
    let mut bench = Bench::new();
    bench.move_to(on_rail(&bench, "Hand x", 0.2));
    bench.press(PointerButton::Primary);
    assert_ne!(&bench.session().arm(), &Arm::default());
    bench.key(Key::Escape);
    bench.release(PointerButton::Primary);
    bench.settle();
    assert_eq!(&bench.session().arm(), &Arm::default());
}

#[test]
fn a_press_and_its_release_in_one_frame_are_a_click_on_the_rail() {
    let mut bench = Bench::new();
    bench.move_to(on_rail(&bench, "Root x", 1.0));
    let events = [true, false].map(|down| bench.button(PointerButton::Primary, down));
    bench.frame(events);
    bench.move_to(on_rail(&bench, "Root x", 0.3));
    assert_eq!(bench.session().arm().root.x, 500.0);
    assert!(!bench.session().history().is_editing());
}

#[test]
fn space_and_enter_on_a_rail_change_nothing() {
    let mut bench = Bench::new();
    bench.move_to(on_rail(&bench, "Hand x", 0.2));
    bench.focus(Role::Slider, "Hand x");
    bench.key(Key::Space);
    bench.key(Key::Enter);
    assert_eq!(&bench.session().arm(), &Arm::default());
}

#[test]
fn esc_cancels_the_drag_of_a_number_too() {
    let mut bench = Bench::new();
    let at = bench.rect(Role::SpinButton, "Hand z value").center();
    bench.drag(PointerButton::Primary, at, at + egui::vec2(40.0, 0.0));
    assert_ne!(bench.hand().z, 60.0);
    bench.key(Key::Escape);
    bench.move_to(at - egui::vec2(40.0, 0.0));
    bench.release(PointerButton::Primary);
    assert_eq!(&bench.session().arm(), &Arm::default());
}

#[test]
fn a_double_click_on_rail_or_label_resets() {
    for slider in SLIDERS {
        for on_label in [false, true] {
            let mut bench = Bench::after(awkward());
            let before = bench.session().arm();
            bench.reveal(Role::Slider, slider);
            let rail = bench.rect(Role::Slider, slider);
            let label = pos2(rail.left() - 12.0, rail.center().y);
            bench.double_click_at(if on_label { label } else { on_rail(&bench, slider, 0.3) });
            let after = bench.session().arm();
            assert_eq!(value(&after, slider), value(&Arm::default(), slider), "{slider}");
            assert!(is_same_but(slider, &after, &before), "{slider}: {after:?}");
            assert!(!bench.session().history().is_editing());
        }
    }
}

#[test]
fn arrows_step_by_one_with_shift_by_a_tenth_and_page_keys_by_ten() {
    for slider in SLIDERS {
        let mut bench = Bench::after([ArmEdit::SetTwist(TAU / 4.0)]);
        bench.focus(Role::Slider, slider);
        for (modifiers, key, step) in [
            (Modifiers::NONE, Key::ArrowRight, 1.0),
            (Modifiers::NONE, Key::ArrowUp, 1.0),
            (Modifiers::NONE, Key::ArrowLeft, -1.0),
            (Modifiers::NONE, Key::ArrowDown, -1.0),
            (Modifiers::SHIFT, Key::ArrowRight, 0.1),
            (Modifiers::SHIFT, Key::ArrowUp, 0.1),
            (Modifiers::SHIFT, Key::ArrowLeft, -0.1),
            (Modifiers::SHIFT, Key::ArrowDown, -0.1),
            (Modifiers::NONE, Key::PageUp, 10.0),
            (Modifiers::NONE, Key::PageDown, -10.0),
        ] {
            let before = value(&bench.session().arm(), slider);
            bench.key_with(modifiers, key);
            let stepped = value(&bench.session().arm(), slider) - before;
            assert!((stepped - step).abs() < 1e-4, "{slider}: {key:?} steps by {stepped}");
        }
        assert_eq!(bench.focused(), Some((Role::Slider, slider.to_owned())));
    }
}

#[test]
fn home_and_end_go_to_the_ends_of_the_range() {
    for (slider, low, high) in [
        ("Hand x", -500.0, 500.0),
        ("Root y", -500.0, 500.0),
        ("Upper length", 10.0, 1000.0),
        ("Lower length", 10.0, 1000.0),
    ] {
        let mut bench = Bench::new();
        bench.focus(Role::Slider, slider);
        bench.key(Key::Home);
        assert_eq!(value(&bench.session().arm(), slider), low, "{slider}");
        bench.key(Key::End);
        assert_eq!(value(&bench.session().arm(), slider), high, "{slider}");
    }
}

#[test]
fn the_hands_ranges_follow_the_lengths() {
    let mut bench = Bench::new();
    bench.enter("Upper length", "900");
    for (slider, end) in [("Hand x", 1.0), ("Hand z", 0.0)] {
        bench.click_at(on_rail(&bench, slider, end));
        let reached = value(&bench.session().arm(), slider);
        assert_eq!(reached, if end > 0.5 { 1200.0 } else { -1200.0 });
    }
}

/// True if a tooltip is on screen.
fn has_tooltip(bench: &Bench) -> bool {
    let layers = bench.harness.ctx.memory(|memory| memory.areas().visible_layer_ids());
    layers.iter().any(|layer| layer.order == egui::Order::Tooltip)
}

#[test]
fn after_a_slider_was_dragged_its_tooltip_stays_away_until_the_mouse_leaves_it() {
    for (role, name) in [(Role::Slider, "Hand x"), (Role::SpinButton, "Hand x value")] {
        let mut bench = Bench::new();
        let at = bench.rect(role, name).center();
        bench.drag_and_drop(PointerButton::Primary, at, at + egui::vec2(12.0, 0.0));
        bench.wait(1.5);
        assert!(!has_tooltip(&bench), "{name}: a tooltip covers the rows below");
        bench.move_to(at + egui::vec2(14.0, 1.0));
        bench.wait(1.5);
        assert!(!has_tooltip(&bench), "{name}: the mouse is still there");
        bench.move_to(bench.empty_point());
        bench.wait(0.5);
        bench.move_to(at);
        bench.wait(1.5);
        assert!(has_tooltip(&bench), "{name}: the mouse came back");
    }
}
