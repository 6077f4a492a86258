//! View → Crowd: many arms instead of the rig, and their times.

use std::time::Duration;

use egui::PointerButton;
use egui::accesskit::Role;
use ik_arm::document::Document;
use ik_arm::rig::{Crowd, CrowdTimes, Processor};
use ik_arm::session::ViewAction;
use ik_arm::ui::FrameTime;

use crate::bench::Bench;

/// A crowd without movement.
fn shown() -> Bench {
    let mut bench = Bench::after([ViewAction::AnimateCrowd(false)]);
    bench.choose(&["View", "Crowd"]);
    bench
}

fn crowd(bench: &Bench) -> Crowd {
    bench.session().crowd().expect("a crowd")
}

#[test]
fn the_view_menu_shows_a_crowd_and_its_window_closes_it() {
    let mut bench = shown();
    assert_eq!(crowd(&bench).arms, 1_000);
    assert!(bench.says("Crowd of 1,000 arms"));
    assert!(bench.shows(Role::Window, "Crowd"));
    bench.click(Role::Button, "Close window");
    assert_eq!(bench.session().crowd(), None);
    assert!(!bench.shows(Role::Window, "Crowd"));
}

#[test]
fn the_slider_goes_from_one_arm_to_a_million_by_tens() {
    let mut bench = shown();
    let rail = bench.rect(Role::Slider, "Arms");
    for (part, least, most) in [(-0.1, 1, 1), (0.5, 300, 3_000), (1.1, 1_000_000, 1_000_000)] {
        let to = rail.left_center() + egui::vec2(rail.width() * part, 0.0);
        bench.drag(PointerButton::Primary, rail.center(), to);
        let arms = crowd(&bench).arms;
        assert!((least..=most).contains(&arms), "{arms} at {part}");
    }
    assert!(bench.says("Crowd of 1,000,000 arms"));
}

#[test]
fn solver_and_movement_can_be_chosen() {
    let mut bench = shown();
    bench.click(Role::RadioButton, "GPU");
    assert_eq!(crowd(&bench).processor, Processor::Gpu);
    bench.click(Role::RadioButton, "CPU");
    assert_eq!(crowd(&bench).processor, Processor::Cpu);
    assert!(!bench.asks_for_a_frame(), "a crowd without movement requests no frame");
    bench.apply_moving([ViewAction::AnimateCrowd(true)]);
    for _ in 0..3 {
        bench.wait(0.5);
    }
    assert!(crowd(&bench).time > 0.9);
    assert!(bench.asks_for_a_frame());
    bench.apply([ViewAction::AnimateCrowd(false)]);
    let before = crowd(&bench).time;
    bench.wait(1.0);
    assert_eq!(crowd(&bench).time, before);
}

#[test]
fn the_shown_times_are_the_measured_ones() {
    let mut bench = shown();
    assert!(bench.says("–"), "nothing is measured before the first frame");
    let machine = &mut bench.harness.state_mut().machine;
    machine.crowd = Some(CrowdTimes { arms: 1_000, solve: Duration::from_micros(1_250) });
    machine.times.push(FrameTime { encode: Duration::from_millis(10), ..FrameTime::default() });
    bench.frame([]);
    for time in ["1.25 ms", "1250.00 ns", "8.75 ms"] {
        assert!(bench.says(time), "{time}");
    }
    bench.apply([ViewAction::SetCrowdSize(2_000)]);
    assert!(!bench.says("1.25 ms"), "those were of another crowd");
}

#[test]
fn the_hand_cannot_be_grabbed_behind_a_crowd() {
    let mut bench = Bench::after([ViewAction::AnimateCrowd(false)]);
    let (hand, document) = (bench.cursor_on_screen(), bench.session().document().clone());
    bench.choose(&["View", "Crowd"]);
    bench.drag(PointerButton::Primary, hand, hand + egui::vec2(60.0, 10.0));
    let camera = bench.session().document().camera;
    assert_ne!(camera, document.camera, "the view turns");
    assert_eq!(*bench.session().document(), Document { camera, ..document });
}
