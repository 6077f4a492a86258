//! The view: orbit, pan and zoom by mouse and by the corner axes.

use crate::common::arm::ArmSession;
use core::f32::consts::{FRAC_PI_2, PI};

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Vec2, vec2};
use glam::Vec3;
use ik_arm::document::{AxisView, Camera, Channel, Document};
use ik_arm::io::OpenOptions;
use ik_arm::session::{
    CameraMotion, FileAction, FileContents, Navigation, PlaybackAction, ShellAction, ViewAction,
};

use crate::bench::Bench;
use crate::common::documents::example;

use PointerButton::{Middle, Primary, Secondary};

const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL: Modifiers = Modifiers::COMMAND;
const ALT: Modifiers = Modifiers::ALT;
const NONE: Modifiers = Modifiers::NONE;

/// Camera after dragging with a button.
fn motion(bench: &mut Bench, modifiers: Modifiers, button: PointerButton) -> Option<CameraMotion> {
    let before = *bench.session().camera();
    let arm = bench.session().arm();
    let at = bench.empty_point();
    bench.hold(modifiers);
    bench.drag(button, at, at + vec2(60.0, 45.0));
    let motion = bench.session().view().drag().map(|drag| drag.motion);
    let after = *bench.session().camera();
    match motion {
        Some(CameraMotion::Orbit) => {
            assert!(after.yaw != before.yaw && after.pitch != before.pitch);
            assert_eq!((after.target, after.distance), (before.target, before.distance));
        }
        Some(CameraMotion::Pan) => {
            assert_ne!(after.target, before.target);
            assert_eq!(Camera { target: before.target, ..after }, before);
        }
        Some(CameraMotion::Zoom) => {
            assert_ne!(after.distance, before.distance);
            assert_eq!((after.yaw, after.pitch), (before.yaw, before.pitch));
        }
        None => assert_eq!(after, before),
    }
    bench.release(button);
    bench.hold(NONE);
    assert!(bench.session().view().drag().is_none());
    assert_eq!(&bench.session().arm(), &arm);
    bench.apply([ViewAction::SetCamera(Camera::default())]);
    motion
}

#[test]
fn each_navigation_preset_orbits_pans_and_zooms_with_its_own_buttons() {
    use CameraMotion::{Orbit, Pan, Zoom};
    use Navigation::{Blender, Default, Maya, Trackpad};
    let table: [(Navigation, [Option<CameraMotion>; 5]); 4] = [
        (Default, [Some(Orbit), Some(Pan), Some(Orbit), Some(Pan), Some(Zoom)]),
        (Blender, [None, None, Some(Orbit), Some(Pan), Some(Zoom)]),
        (Maya, [None, None, None, None, None]),
        (Trackpad, [Some(Orbit), Some(Pan), Some(Orbit), Some(Pan), Some(Zoom)]),
    ];
    for (navigation, expected) in table {
        let mut bench = Bench::after([ShellAction::SetNavigation(navigation)]);
        let presses =
            [(NONE, Primary), (NONE, Secondary), (NONE, Middle), (SHIFT, Middle), (CTRL, Middle)];
        for ((modifiers, button), expected) in presses.into_iter().zip(expected) {
            let found = motion(&mut bench, modifiers, button);
            assert_eq!(found, expected, "{navigation:?}: {modifiers:?} {button:?}");
        }
        for (button, expected) in [(Primary, Orbit), (Middle, Pan), (Secondary, Zoom)] {
            assert_eq!(motion(&mut bench, ALT, button), Some(expected), "{navigation:?}: Alt");
        }
    }
}

#[test]
fn alt_orbits_the_view_even_over_a_handle() {
    let mut bench = Bench::new();
    let hand = bench.cursor_on_screen();
    bench.hold(ALT);
    bench.drag_and_drop(Primary, hand, hand + vec2(80.0, 10.0));
    assert_ne!(bench.session().camera().yaw, Camera::default().yaw);
    assert_eq!(bench.hand(), Vec3::new(250.0, 120.0, 60.0));
}

#[test]
fn orbiting_follows_the_mouse_keeps_the_horizon_and_returns_to_perspective() {
    let mut bench = Bench::after([ViewAction::SetCamera(Camera::default().along(AxisView::Front))]);
    let at = bench.empty_point();
    bench.drag(Primary, at, at + vec2(0.0, 4000.0));
    let camera = bench.session().camera();
    assert!(!camera.orthographic);
    assert!((camera.pitch - FRAC_PI_2).abs() < 1e-6, "not over the top: {}", camera.pitch);
    bench.move_to(at + vec2(10.0, 0.0));
    assert!(bench.session().camera().yaw > PI, "what is seen goes with the pointer");
    bench.move_to(at);
    assert_eq!(bench.session().camera(), &Camera::default().along(AxisView::Front));
}

#[test]
fn panning_keeps_the_grabbed_point_under_the_mouse() {
    let mut bench = Bench::new();
    let target = bench.session().camera().target;
    let at = bench.on_screen(target);
    let offset = vec2(-120.0, 75.0);
    // Off the handles, and the target follows by the same step.
    let beside = at - vec2(250.0, 150.0);
    bench.drag(Secondary, beside, beside + offset);
    assert!(bench.on_screen(target).distance(at + offset) < 0.05);
}

#[test]
fn the_wheel_zooms_to_the_mouse() {
    let mut bench = Bench::new();
    let (_, right, up) = bench.session().camera().basis();
    let point = bench.session().camera().target + right * 180.0 - up * 90.0;
    let at = bench.on_screen(point);
    bench.move_to(at);
    for lines in [1.0, 3.0, -2.0] {
        let before = bench.session().camera().distance;
        bench.wheel(lines);
        let factor = bench.session().camera().distance / before;
        assert_eq!(factor < 1.0, lines > 0.0);
        assert!(bench.on_screen(point).distance(at) < 0.05, "{}", bench.on_screen(point));
    }
    let before = bench.session().camera().distance;
    bench.frame([Event::Zoom(2.0)]);
    assert!((bench.session().camera().distance - before / 2.0).abs() < 0.1);
    assert!(bench.on_screen(point).distance(at) < 0.1);
}

#[test]
fn the_wheel_over_a_panel_does_not_zoom_the_view() {
    let mut bench = Bench::new();
    let over = bench.rect(Role::Slider, "Hand x").center();
    bench.move_to(over);
    bench.wheel(2.0);
    assert_eq!(bench.session().document(), &Document::default());
}

#[test]
fn on_a_trackpad_scrolling_orbits_pans_with_shift_and_zooms_with_ctrl() {
    let mut bench = Bench::after([ShellAction::SetNavigation(Navigation::Trackpad)]);
    let before = Camera::default();
    bench.move_to(bench.empty_point());
    bench.scroll(vec2(2.0, 1.0));
    let turned = *bench.session().camera();
    assert!(turned.yaw != before.yaw && turned.pitch != before.pitch);
    assert_eq!(turned.target, before.target);
    bench.hold(SHIFT);
    bench.scroll(vec2(2.0, 1.0));
    let moved = *bench.session().camera();
    assert_ne!(moved.target, turned.target);
    assert_eq!((moved.yaw, moved.distance), (turned.yaw, turned.distance));
    bench.hold(CTRL);
    bench.scroll(vec2(0.0, 1.0));
    assert!(bench.session().camera().distance < moved.distance);
}

#[test]
fn esc_cancels_an_orbit_of_the_view() {
    for button in [Primary, Secondary] {
        let mut bench = Bench::new();
        let at = bench.empty_point();
        bench.drag(button, at, at + vec2(150.0, 90.0));
        assert_ne!(bench.session().camera(), &Camera::default());
        bench.key(Key::Escape);
        assert_eq!(bench.session().camera(), &Camera::default());
        bench.move_to(at + vec2(10.0, 200.0));
        bench.release(button);
        assert_eq!(bench.session().camera(), &Camera::default());
    }
}

#[test]
fn a_double_click_on_the_background_resets_the_view_and_on_the_hand_frames_its_limb() {
    let elsewhere = Camera { yaw: 2.0, distance: 1500.0, ..Camera::default() };
    let mut bench = Bench::after([ViewAction::SetCamera(elsewhere)]);
    bench.double_click_at(bench.empty_point());
    assert_eq!(bench.session().camera(), &Camera::default());
    let arm = bench.session().arm();
    bench.wait(1.0);
    bench.double_click_at(bench.cursor_on_screen());
    let (pose, camera) = (bench.session().pose(), bench.session().camera());
    let (low, high) = (pose.elbow.min(pose.hand), pose.elbow.max(pose.hand));
    assert!(camera.target.cmpge(low - 1.0).all() && camera.target.cmple(high + 1.0).all());
    assert_eq!(&bench.session().arm(), &arm);
}

#[test]
fn the_corner_axes_look_along_their_axis_when_their_ends_are_clicked() {
    for (name, view) in [
        ("View from the right", AxisView::Right),
        ("View from the top", AxisView::Top),
        ("View from the front", AxisView::Front),
        ("View from the left", AxisView::Left),
        ("View from the bottom", AxisView::Bottom),
        ("View from the back", AxisView::Back),
    ] {
        let mut bench = Bench::new();
        bench.click(Role::Button, name);
        assert_eq!(bench.session().camera(), &Camera::default().along(view), "{name}");
        let mut bench = Bench::new();
        bench.node(Role::Button, name).click_accesskit();
        bench.settle();
        assert_eq!(bench.session().camera(), &Camera::default().along(view), "{name}");
    }
}

#[test]
fn dragging_the_corner_axes_orbits_the_view() {
    let mut bench = Bench::after([ShellAction::SetNavigation(Navigation::Blender)]);
    let at = bench.rect(Role::Button, "View from the top").center();
    bench.drag_and_drop(Primary, at, at + Vec2::new(70.0, -10.0));
    bench.settle();
    assert_ne!(bench.session().camera().yaw, Camera::default().yaw);
    assert!(!bench.session().camera().orthographic);
}

#[test]
fn the_camera_follows_the_selection_while_it_is_ticked_in_the_menu() {
    let mut bench = Bench::new();
    let walk = example("walk");
    bench.apply([FileAction::Opened { document: Box::new(walk), file: None, contents: None }]);
    bench.choose(&["View", "Follow selection"]);
    assert!(bench.session().view().follows_selection());
    bench.settle();
    let before = bench.session().camera().target;
    let end = bench.session().document().timeline.end;
    bench.apply([PlaybackAction::SetTime(0.6 * end)]);
    assert!(bench.session().camera().target.distance(before) > 1e-3);
    bench.choose(&["View", "Follow selection"]);
    assert!(!bench.session().view().follows_selection());
}

#[test]
fn the_camera_follows_a_figure_that_walks_far_away() {
    let mut far = example("human");
    for (time, place) in [(0.0, Vec3::ZERO), (4.0, Vec3::Z * 30.0)] {
        far.keys.insert(Channel::Translation, time, place);
    }
    far.timeline.end = 4.0;
    far.rig.targets.clear();
    let contents = FileContents {
        path: "far.glb".into(),
        options: OpenOptions::default(),
        skeletons: vec!["rig".into()],
        animations: Vec::new(),
        animation: None,
    };
    let mut bench = Bench::new();
    let opened = |document: Document, contents: Option<FileContents>| FileAction::Opened {
        document: Box::new(document),
        file: None,
        contents: contents.map(Box::new),
    };
    bench.apply([opened(far.clone(), Some(contents))]);
    assert!(bench.session().view().follows_selection());
    let height = |bench: &Bench| {
        let [head, foot] = ["head", "left_foot"].map(|name| bench.on_screen(bench.tip(name)));
        assert!(bench.viewport().contains(head) && bench.viewport().contains(foot));
        head.distance(foot)
    };
    let before = height(&bench);
    assert!(before > 0.3 * bench.viewport().height(), "{before}: it is large");
    bench.apply([PlaybackAction::SetTime(4.0)]);
    bench.settle();
    assert!((height(&bench) - before).abs() < 0.05 * before, "it stays large");

    let near = example("walk");
    bench.apply([opened(near, None)]);
    assert!(!bench.session().view().follows_selection(), "a walk of some steps is in view");
}
