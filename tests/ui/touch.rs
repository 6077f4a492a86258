//! Fingers on the view: one drags the hand or orbits, two pan and zoom.

use egui::{Event, PointerButton, Pos2, TouchDeviceId, TouchId, TouchPhase, vec2};
use glam::Vec3;
use ik_arm::document::Camera;

use crate::bench::Bench;

/// Fingers on the screen of a bench. As in a window, the first one also moves the pointer.
struct Fingers {
    bench: Bench,
    down: Vec<(u64, Pos2)>,
}

impl Fingers {
    fn new() -> Self {
        Self { bench: Bench::new(), down: Vec::new() }
    }

    fn put(&mut self, id: u64, at: Pos2) {
        self.down.push((id, at));
        let pointer = [Event::PointerMoved(at), button(at, true)];
        self.touch(id, TouchPhase::Start, at, &pointer);
    }

    fn slide(&mut self, id: u64, to: Pos2) {
        const STEPS: u8 = 6;
        let finger = self.down.iter_mut().find(|finger| finger.0 == id).expect("it is down");
        let from = std::mem::replace(&mut finger.1, to);
        for step in 1..=STEPS {
            let at = from.lerp(to, f32::from(step) / f32::from(STEPS));
            self.touch(id, TouchPhase::Move, at, &[Event::PointerMoved(at)]);
        }
    }

    fn lift(&mut self, id: u64) {
        let at = self.at(id);
        self.touch(id, TouchPhase::End, at, &[button(at, false), Event::PointerGone]);
        self.down.retain(|finger| finger.0 != id);
    }

    /// The system takes the finger's gesture for one of its own.
    fn cancel(&mut self, id: u64) {
        let at = self.at(id);
        self.touch(id, TouchPhase::Cancel, at, &[Event::PointerGone]);
        self.down.retain(|finger| finger.0 != id);
    }

    fn at(&self, id: u64) -> Pos2 {
        self.down.iter().find(|finger| finger.0 == id).expect("it is down").1
    }

    fn touch(&mut self, id: u64, phase: TouchPhase, pos: Pos2, pointer: &[Event]) {
        let device_id = TouchDeviceId(1);
        let touch = Event::Touch { device_id, id: TouchId(id), phase, pos, force: None };
        let pointer = if id == 1 { pointer } else { &[] };
        self.bench.frame([touch].into_iter().chain(pointer.iter().cloned()));
    }

    fn camera(&self) -> Camera {
        *self.bench.session().camera()
    }
}

fn button(pos: Pos2, pressed: bool) -> Event {
    let button = PointerButton::Primary;
    Event::PointerButton { pos, button, pressed, modifiers: egui::Modifiers::NONE }
}

#[test]
fn a_finger_drags_the_hand_and_leaves_it_where_it_is_lifted() {
    let mut fingers = Fingers::new();
    let hand = fingers.bench.cursor_on_screen();
    // A finger covers more than the pixel in its middle.
    let beside = hand + vec2(-14.0, 12.0);
    fingers.put(1, beside);
    fingers.slide(1, beside + vec2(-70.0, -50.0));
    fingers.lift(1);
    assert!(fingers.bench.session().history().drag().is_none());
    let there = hand + vec2(-70.0, -50.0);
    let found = fingers.bench.cursor_on_screen();
    assert!(found.distance(there) < 1.0, "it keeps its distance: {hand:?}, {found:?}, {there:?}");
    let undo = fingers.bench.session().history().undo_label().is_some();
    assert!(undo, "the drag is one step of the history");

    let left = fingers.bench.hand();
    fingers.put(1, fingers.bench.empty_point());
    fingers.slide(1, fingers.bench.empty_point() + vec2(40.0, 40.0));
    fingers.lift(1);
    assert_eq!(fingers.bench.hand(), left, "the next touch orbits");
    assert_ne!(fingers.camera(), Camera::default());
}

#[test]
fn a_drag_that_the_system_cancels_ends() {
    let mut fingers = Fingers::new();
    let hand = fingers.bench.cursor_on_screen();
    fingers.put(1, hand);
    fingers.slide(1, hand + vec2(-40.0, -30.0));
    fingers.cancel(1);
    assert!(fingers.bench.session().history().drag().is_none());
    let left = fingers.bench.hand();
    assert_ne!(left, Vec3::new(250.0, 120.0, 60.0));
    fingers.put(1, fingers.bench.empty_point());
    fingers.lift(1);
    assert_eq!(fingers.bench.hand(), left);
}

#[test]
fn two_fingers_keep_the_points_under_them() {
    let mut fingers = Fingers::new();
    let view = fingers.bench.viewport();
    let start = view.left_top() + vec2(60.0, 60.0);
    fingers.put(1, start);
    fingers.put(2, start + vec2(120.0, 0.0));
    let before = fingers.camera();

    // Both move by the same distance: the view is panned.
    for _ in 0..10 {
        for id in [1, 2] {
            fingers.slide(id, fingers.at(id) + vec2(6.0, 3.0));
        }
    }
    let panned = fingers.camera();
    assert_ne!(panned.target, before.target);
    assert_eq!((panned.yaw, panned.pitch), (before.yaw, before.pitch));
    assert!((panned.distance / before.distance - 1.0).abs() < 1e-3, "{}", panned.distance);

    // The second one moves to twice its distance: everything appears twice as large.
    fingers.slide(2, fingers.at(1) + vec2(240.0, 0.0));
    let zoomed = fingers.camera();
    assert!((panned.distance / zoomed.distance - 2.0).abs() < 1e-3, "{}", zoomed.distance);

    // After the first one is lifted, the other one does nothing.
    fingers.lift(1);
    fingers.slide(2, fingers.at(2) + vec2(50.0, 50.0));
    fingers.lift(2);
    assert_eq!(fingers.camera(), zoomed);
    assert!(fingers.bench.session().view().drag().is_none());
}

#[test]
fn a_second_finger_ends_an_orbit_but_no_drag_of_the_hand() {
    let mut fingers = Fingers::new();
    let start = fingers.bench.empty_point();
    fingers.put(1, start);
    fingers.slide(1, start + vec2(30.0, 20.0));
    let orbited = fingers.camera();
    assert_ne!(orbited.yaw, Camera::default().yaw);
    fingers.put(2, start + vec2(90.0, 90.0));
    fingers.slide(1, start + vec2(60.0, 20.0));
    assert_eq!(fingers.camera().yaw, orbited.yaw);
    fingers.lift(2);
    fingers.lift(1);

    let hand = fingers.bench.cursor_on_screen();
    let camera = fingers.camera();
    fingers.put(1, hand);
    fingers.put(2, hand + vec2(80.0, 80.0));
    fingers.slide(1, hand + vec2(-50.0, -20.0));
    fingers.lift(2);
    fingers.lift(1);
    assert_eq!(fingers.camera(), camera);
    let there = hand + vec2(-50.0, -20.0);
    assert!(fingers.bench.cursor_on_screen().distance(there) < 1.0);
}
