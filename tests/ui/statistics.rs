//! Help → Statistics: times of frames; showing them requests no frame.

use crate::common::arm::{ArmEdit, Step};
use std::time::Duration;

use egui::accesskit::Role;
use egui::{Key, PointerButton, Vec2, vec2};
use egui_kittest::SnapshotResults;
use glam::Vec3;
use ik_arm::document::Theme;
use ik_arm::render::Counts;
use ik_arm::session::{Dialog, KeysEdit, PlaybackAction, ShellAction};
use ik_arm::ui::{FrameTime, FrameTimes, Machine};

use crate::bench::{Bench, LARGE, SMALL};

/// A frame in which everything takes a part of a unit; every tenth takes three times as long.
fn frame(index: u64) -> FrameTime {
    let unit = if index.is_multiple_of(10) { 3_000 } else { 1_000 + 40 * (index % 7) };
    let part = |hundredths: u64| Duration::from_micros(unit * hundredths / 100);
    FrameTime {
        solve: part(30),
        panels: part(200),
        scene: part(20),
        encode: part(120),
        wait: part(400),
        gpu: Some(part(250)),
        interval: Some(Duration::from_micros(16_667)),
        resolution_scale: 0.7,
        draws_scene: true,
    }
}

fn machine(frames: u64, has_clock: bool) -> Machine {
    let mut times = FrameTimes::default();
    for index in 1..=frames {
        let gpu = frame(index).gpu.filter(|_| has_clock);
        times.push(FrameTime { gpu, ..frame(index) });
    }
    Machine {
        adapter: "Test adapter (of tests) (vulkan)".to_owned(),
        has_clock,
        times,
        counts: Some(Counts {
            solids: 57,
            lines: 12,
            labels: 3,
            triangles: 10_871,
            uploaded: 1_234_567,
        }),
        ..Machine::default()
    }
}

fn opened(size: Vec2, machine: Machine) -> Bench {
    let mut bench = Bench::of_size(size);
    bench.harness.state_mut().machine = machine;
    bench.choose(&["Help", "Statistics"]);
    bench
}

#[test]
fn the_help_menu_opens_the_statistics_and_esc_closes_them() {
    let mut bench = opened(LARGE, machine(3, true));
    assert_eq!(bench.session().shell().dialog(), Some(&Dialog::Statistics));
    assert!(bench.says("Frame times: the last took 8.6 ms"));
    bench.key(Key::Escape);
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None);
    assert!(!bench.says("Frame times"));
}

#[test]
fn every_part_shows_its_median_and_its_slowest_time() {
    let bench = opened(LARGE, machine(240, true));
    // The median frame has a unit of 1.12 ms, the slowest of 3.
    for (part, median, slowest) in [
        ("Solve", "0.336", "0.900"),
        ("Panels", "2.240", "6.000"),
        ("Scene", "0.224", "0.600"),
        ("Encode", "1.344", "3.600"),
        ("Wait", "4.480", "12.000"),
        ("Total", "8.624", "23.100"),
        ("GPU", "2.800", "7.500"),
    ] {
        let row = bench.rect(Role::Label, part);
        for number in [median, slowest] {
            let number = bench.rect(Role::Label, number);
            assert!((number.center().y - row.center().y).abs() < 3.0, "{part}: {number:?}");
        }
    }
    for number in ["60", "70 %", "57", "12", "3", "10,871", "1,234,567"] {
        assert!(bench.shows(Role::Label, number), "{number}");
    }
    assert!(bench.shows(Role::Label, "Test adapter (of tests)"));
    assert!(bench.shows(Role::Label, "Backend: vulkan"));
}

#[test]
fn an_adapter_without_timestamps_is_reported() {
    let bench = opened(LARGE, machine(10, false));
    assert!(bench.shows(Role::Label, "not measured by this adapter"));
}

#[test]
fn before_the_first_frame_there_is_nothing_to_show() {
    let bench = opened(LARGE, Machine::default());
    assert!(bench.says("Frame times: no frame drawn yet"));
    assert!(bench.shows(Role::Label, "–"));
}

#[test]
fn nothing_moves_when_the_numbers_change_their_widths() {
    let places = |bench: &Bench| {
        let names = ["Solve", "Total", "GPU", "Frames per second", "Bytes uploaded"];
        names.map(|name| bench.rect(Role::Label, name))
    };
    let mut bench = opened(LARGE, machine(240, true));
    let before = places(&bench);
    for frames in [0, 1, 17] {
        bench.harness.state_mut().machine = machine(frames, true);
        bench.settle();
        assert_eq!(places(&bench), before, "{frames} frames");
    }
    let slow = FrameTime { panels: Duration::from_millis(9_876), ..FrameTime::default() };
    bench.harness.state_mut().machine.times.push(slow);
    bench.harness.state_mut().machine.counts =
        Some(Counts { uploaded: 9_999_999, ..Counts::default() });
    bench.settle();
    assert_eq!(places(&bench), before);
}

#[test]
fn the_statistics_request_no_frame_and_do_not_block_the_window() {
    let mut bench = opened(LARGE, machine(240, true));
    assert!(!bench.asks_for_a_frame());
    bench.wait(1.0);
    assert!(!bench.asks_for_a_frame());
    let before = bench.hand();
    let at = bench.cursor_on_screen();
    assert!(at.x < bench.rect(Role::Label, "Solve").left(), "the hand is not hidden");
    bench.drag_and_drop(PointerButton::Primary, at, at + vec2(-60.0, 20.0));
    assert_ne!(bench.hand(), before, "the hand is dragged");
    bench.apply([
        Step::from(KeysEdit::Key(KeysEdit::all_channels(bench.session().shown()))),
        PlaybackAction::SetTime(1.0).into(),
        ArmEdit::SetHand(Vec3::new(100.0, 200.0, 0.0)).into(),
        KeysEdit::Key(KeysEdit::all_channels(bench.session().shown())).into(),
    ]);
    bench.key(Key::Space);
    assert!(bench.session().playback().is_playing(), "Space plays");
    assert_eq!(bench.session().shell().dialog(), Some(&Dialog::Statistics));
}

#[test]
fn the_statistics_fit_the_smallest_window() {
    let bench = opened(SMALL, machine(240, true));
    let screen = bench.harness.ctx.content_rect();
    for name in ["Solve", "Total", "Bytes uploaded", "Backend: vulkan"] {
        let rect = bench.rect(Role::Label, name);
        assert!(screen.contains_rect(rect), "{name}: {rect:?}");
    }
}

#[test]
fn the_statistics_look_as_they_did() {
    let mut results = SnapshotResults::new();
    for theme in [Theme::Dark, Theme::Light] {
        let mut bench = opened(LARGE, machine(240, true));
        bench.apply([ShellAction::SetTheme(theme)]);
        bench.move_to(bench.empty_point());
        bench.settle();
        bench.snapshot("statistics", theme, &mut results);
    }
}
