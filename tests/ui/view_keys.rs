//! Axis views by key and by name, and the glide of the camera.

use crate::common::arm::ArmSession;
use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, pos2};
use glam::Vec3;
use ik_arm::document::{AxisView, Camera};

use crate::bench::{Bench, SECONDS_PER_FRAME};

const NONE: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;

#[test]
fn view_keys_look_along_the_axes() {
    for (modifiers, key, view) in [
        (NONE, Key::Num1, AxisView::Front),
        (NONE, Key::Num3, AxisView::Right),
        (NONE, Key::Num7, AxisView::Top),
        (CTRL, Key::Num1, AxisView::Back),
        (CTRL, Key::Num3, AxisView::Left),
        (CTRL, Key::Num7, AxisView::Bottom),
    ] {
        let mut bench = Bench::new();
        bench.key_with(modifiers, key);
        bench.settle();
        assert_eq!(bench.session().camera(), &Camera::default().along(view), "{view:?}");
    }
}

#[test]
fn five_toggles_f_frames_the_arm_home_frames_all() {
    let mut bench = Bench::new();
    for orthographic in [true, false] {
        bench.key(Key::Num5);
        assert_eq!(bench.session().camera(), &Camera { orthographic, ..Camera::default() });
    }
    for key in [Key::F, Key::Home] {
        bench.key(key);
        bench.settle();
        let (centre, radius) = match key {
            Key::F => bench.session().posed().bounds(),
            _ => (Vec3::ZERO, bench.session().arm().reach_limits().outer),
        };
        assert_eq!(bench.session().camera().target, centre, "{key:?}");
        let (_, right, up) = bench.session().camera().basis();
        for side in [right, -right, up, -up] {
            assert!(bench.viewport().contains(bench.on_screen(centre + side * radius)), "{key:?}");
        }
    }
}

#[test]
fn view_keys_do_nothing_while_a_field_has_the_keyboard() {
    for (role, name, typed) in [
        (Role::SpinButton, "Hand x value", "1375"),
        // A slider makes use of Home, and digits alone choose a view.
        (Role::Slider, "Socket twist", ""),
    ] {
        let mut bench = Bench::new();
        bench.focus(role, name);
        bench.type_text(typed);
        bench.key(Key::F);
        assert!(!bench.session().view().is_gliding());
        assert_eq!(bench.session().camera(), &Camera::default(), "{name}");
    }
    let mut bench = Bench::new();
    bench.choose(&["File", "Save picture…"]);
    bench.type_text("f137");
    bench.key(Key::Home);
    assert_eq!(bench.session().camera(), &Camera::default());
    assert!(!bench.session().view().is_gliding());
}

#[test]
fn a_click_into_the_viewport_gives_it_the_keyboard() {
    let mut bench = Bench::new();
    bench.focus(Role::Slider, "Hand x");
    bench.click_at(bench.empty_point());
    bench.key(Key::Num7);
    bench.settle();
    assert_eq!(bench.session().camera(), &Camera::default().along(AxisView::Top));
    assert_eq!(bench.focused().map(|(role, _)| role), Some(Role::Image));
}

#[test]
fn a_glide_takes_two_tenths_of_a_second_and_then_the_window_sleeps() {
    let mut bench = Bench::new();
    let end = Camera::default().along(AxisView::Right);
    bench.key(Key::Num3);
    let mut frames = 0;
    let mut last = bench.session().camera().yaw;
    while bench.session().view().is_gliding() {
        assert!(bench.asks_for_a_frame());
        bench.frame([]);
        let yaw = bench.session().camera().yaw;
        assert!(yaw >= last, "{yaw} after {last}");
        last = yaw;
        frames += 1;
        assert!(frames < 30);
    }
    let seconds = f64::from(frames) * SECONDS_PER_FRAME;
    assert!((0.17..=0.25).contains(&seconds), "{seconds}");
    assert_eq!(bench.session().camera(), &end);
    bench.frame([]);
    assert!(!bench.asks_for_a_frame(), "{:?}", bench.harness.ctx.repaint_causes());
}

#[test]
fn any_input_ends_a_glide() {
    let end = Camera::default().along(AxisView::Top);
    let gliding = || {
        let mut bench = Bench::new();
        bench.move_to(bench.empty_point());
        bench.key(Key::Num7);
        bench.wait(0.05);
        assert!(bench.session().view().is_gliding());
        bench
    };
    let mut bench = gliding();
    bench.key(Key::K);
    assert!(!bench.session().view().is_gliding());
    assert_eq!(bench.session().camera(), &end, "a key brings it to its end");

    let mut bench = gliding();
    bench.wheel(1.0);
    assert!(!bench.session().view().is_gliding());
    assert!(bench.session().camera().distance < end.distance);
    assert_eq!(bench.session().camera().pitch, end.pitch);

    let mut bench = gliding();
    bench.click_at(pos2(200.0, 780.0));
    assert_eq!(bench.session().camera(), &end);

    let mut bench = gliding();
    let here = *bench.session().camera();
    bench.press(PointerButton::Primary);
    assert!(!bench.session().view().is_gliding());
    let taken = *bench.session().camera();
    assert!(taken.pitch < end.pitch && taken.pitch >= here.pitch, "a press stops it");
    bench.frame([]);
    assert_eq!(bench.session().camera(), &taken);
}

#[test]
fn the_view_menu_does_what_the_keys_do() {
    for (name, view) in [("Front", AxisView::Front), ("Bottom", AxisView::Bottom)] {
        let mut bench = Bench::new();
        bench.choose(&["View", name]);
        assert_eq!(bench.session().camera(), &Camera::default().along(view));
    }
    let mut bench = Bench::new();
    bench.choose(&["View", "Toggle orthographic"]);
    assert!(bench.session().camera().orthographic);
    bench.choose(&["View", "Frame all"]);
    assert_eq!(bench.session().camera().target, Vec3::ZERO);
    bench.choose(&["View", "Frame selection"]);
    assert_ne!(bench.session().camera().target, Vec3::ZERO);
}

#[test]
fn arrow_keys_orbit_and_pan_the_focused_view_and_plus_and_minus_zoom() {
    let mut bench = Bench::new();
    bench.key(Key::ArrowRight);
    assert_eq!(bench.session().camera(), &Camera::default(), "without the keyboard it stays");

    let mut bench = Bench::new();
    bench.click_at(bench.empty_point());
    let before = *bench.session().camera();
    bench.key(Key::ArrowRight);
    let turned = *bench.session().camera();
    assert!((turned.yaw - before.yaw - 5_f32.to_radians()).abs() < 1e-6);
    bench.key(Key::ArrowUp);
    assert!((bench.session().camera().pitch - before.pitch - 5_f32.to_radians()).abs() < 1e-6);
    bench.key_with(Modifiers::SHIFT, Key::ArrowRight);
    let moved = *bench.session().camera();
    assert!((moved.target - before.target).dot(moved.basis().1) > 0.0);
    for (key, nearer) in [(Key::Plus, true), (Key::Minus, false)] {
        let before = bench.session().camera().distance;
        bench.key(key);
        assert_eq!(bench.session().camera().distance < before, nearer);
    }
}

#[test]
fn view_keys_look_along_the_axes_while_a_slider_has_the_focus() {
    for (modifiers, key, view) in [
        (NONE, Key::Num1, AxisView::Front),
        (NONE, Key::Num3, AxisView::Right),
        (NONE, Key::Num7, AxisView::Top),
        (CTRL, Key::Num7, AxisView::Bottom),
    ] {
        let mut bench = Bench::new();
        bench.focus(Role::Slider, "Hand x");
        bench.key_with(modifiers, key);
        bench.settle();
        assert_eq!(bench.session().camera(), &Camera::default().along(view), "{view:?}");
        assert_eq!(bench.focused().map(|it| it.0), Some(Role::Slider));
    }
}

#[test]
fn a_digit_typed_into_a_number_leaves_the_view() {
    let mut bench = Bench::new();
    bench.click(Role::SpinButton, "Hand x value");
    bench.type_text("7");
    bench.settle();
    assert_eq!(bench.session().camera(), &Camera::default());
}
