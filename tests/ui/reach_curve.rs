//! Plot of the hand's distance over the Cursor's.

use crate::common::arm::ArmEdit;
use egui::accesskit::Role;
use egui::{Rect, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::Vec3;
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::session::{PanelTab, PoseMode, Preferences};

use crate::bench::Bench;

fn bench(softness: f32, stretch: f32, asked: f32) -> Bench {
    let preferences = Preferences { timeline_open: Some(false), ..Preferences::default() };
    let mut bench = Bench::liking(vec2(1280.0, 1500.0), preferences);
    bench.show_tab(PanelTab::Reach);
    let soft_reach = SoftReach::new(softness, stretch, 0.0).expect("a softening");
    bench.apply([ArmEdit::SetSoftReach(soft_reach), ArmEdit::SetHand(Vec3::X * asked)]);
    bench
}

/// Rectangle of the plot.
fn plot(bench: &Bench) -> Rect {
    let plots = bench.harness.query_all_by_label_contains("Reach curve: ");
    let mut images = plots.filter(|node| node.accesskit_node().role() == Role::Image);
    images.next().expect("a plot").rect()
}

#[test]
fn the_position_of_the_cursor_on_the_arms_curve_is_stated() {
    // The soft zone is 0.2·(500 − 100)/2 = 40 wide.
    let soft = 500.0 - 40.0 * (-1.0_f64).exp();
    for (softness, stretch, asked, actual, slope) in [
        (0.0, 1.0, 300.0, 300.0, 1.0),
        (0.0, 1.0, 560.0, 500.0, 0.0),
        (0.0, 1.0, 60.0, 100.0, 0.0),
        (0.2, 1.0, 300.0, 300.0, 1.0),
        (0.2, 1.0, 500.0, soft, (-1.0_f64).exp()),
        (0.0, 1.5, 560.0, 560.0, 1.0),
        (0.0, 1.5, 900.0, 750.0, 0.0),
    ] {
        let bench = bench(softness, stretch, asked);
        let said = format!("Cursor at {asked:.1}: hand at {actual:.1}, slope {slope:.2}");
        assert!(bench.shows(Role::Label, &said), "{said}");
        assert!(bench.shows(Role::Image, &format!("Reach curve: {said}")), "{said}");
    }
}

/// Distance that the elbow of an arm of 200 and 300 moves in its plane, between two distances of
/// the hand, by the law of cosines in f64.
fn elbow_moves(from: f64, to: f64) -> f64 {
    let [(x, y), (to_x, to_y)] = [from, to].map(|distance| {
        let along = (distance * distance + 200.0 * 200.0 - 300.0 * 300.0) / (2.0 * distance);
        (along, (200.0 * 200.0 - along * along).max(0.0).sqrt())
    });
    (to_x - x).hypot(to_y - y)
}

#[test]
fn the_same_step_moves_the_elbow_farther_where_the_arm_is_nearly_straight() {
    let (bent, straight) = (elbow_moves(360.0, 380.0), elbow_moves(480.0, 500.0));
    assert!(straight > 3.0 * bent, "{straight} and {bent}");
    for softness in [0.0, 0.2] {
        let bench = bench(softness, 1.0, 300.0);
        for (name, elbow) in [("Bent", bent), ("Nearly straight", straight)] {
            let said = format!("{name}: hand 20.0, elbow {elbow:.1}");
            assert!(bench.shows(Role::Image, &said), "{said}");
        }
    }
}

#[test]
fn status_bar_and_reach_meter_state_the_limits_of_the_hand() {
    for (stretch, degrees, mode, rounded, exact) in [
        (1.0, 0.0, PoseMode::Hand, "of 100–500", "from 100.0 to 500.0"),
        (1.5, 0.0, PoseMode::Hand, "of 100–750", "from 100.0 to 750.0"),
        (1.0, 90.0_f32, PoseMode::Hand, "of 361–500", "from 360.6 to 500.0"),
        (1.5, 90.0, PoseMode::Angles, "of 100–500", "from 100.0 to 500.0"),
    ] {
        let soft_reach = SoftReach::new(0.0, stretch, degrees.to_radians()).expect("soft limits");
        let mut bench = Bench::after([
            ArmEdit::SetHand(Vec3::X * 400.0),
            ArmEdit::SetSoftReach(soft_reach),
            ArmEdit::SwitchPoseMode(mode),
        ]);
        bench.show_tab(PanelTab::Reach);
        assert!(bench.says(rounded), "{rounded}");
        let meter = format!("the hand reaches {exact}");
        assert!(bench.harness.query_by_label_contains(&meter).is_some(), "{meter}");
    }
}

#[test]
fn a_hand_at_the_minimum_elbow_angle_says_so() {
    let soft_reach = SoftReach::new(0.0, 1.0, core::f32::consts::FRAC_PI_2).expect("soft limits");
    let bench =
        Bench::after([ArmEdit::SetHand(Vec3::X * 300.0), ArmEdit::SetSoftReach(soft_reach)]);
    let said =
        "The smallest elbow angle keeps the hand away from its target, 300 from the shoulder.";
    assert!(bench.says(said));
}

#[test]
fn lines_are_labelled_and_examples_are_marked_as_such() {
    for (softness, stretch, names, note) in [
        (
            0.0,
            1.0,
            ["off", "soft 0.50", "stretch 1.50"],
            "Soft limits are off; the dashed curves show what they would do",
        ),
        (
            0.3,
            1.0,
            ["off", "soft 0.30", "stretch 1.50"],
            "the dotted curve shows what stretch would do",
        ),
        (
            0.0,
            1.2,
            ["off", "soft 0.50", "stretch 1.20"],
            "the dashed curve shows what softness would do",
        ),
        (0.4, 1.3, ["off", "soft 0.40", "stretch 1.30"], "Softness and stretch are on"),
    ] {
        let bench = bench(softness, stretch, 300.0);
        for name in names {
            assert!(bench.shows(Role::Label, name), "{name}");
        }
        assert!(bench.says(note), "{note}");
    }
}

#[test]
fn a_note_appears_when_fk_has_influence() {
    let mut bench = bench(0.0, 1.0, 300.0);
    assert!(!bench.says("Shown for IK alone"));
    bench.apply([ArmEdit::SetInfluence(0.5)]);
    assert!(bench.says("Shown for IK alone"));
}

#[test]
fn hovering_reads_the_curve_at_the_mouse() {
    let mut bench = bench(0.0, 1.0, 300.0);
    let rect = plot(&bench);
    let mut asked = Vec::new();
    for part in [0.3, 0.5, 0.95] {
        bench.move_to(rect.left_center() + vec2(rect.width() * part, 0.0));
        bench.wait(0.7);
        let texts = bench.harness.query_all_by_label_contains("Cursor at ");
        let texts = texts.filter_map(|node| {
            let node = node.accesskit_node();
            node.label().or(node.value())
        });
        let mut others = texts.filter(|text| !text.contains("Cursor at 300.0"));
        let text = others.next_back().expect("a tooltip");
        let numbers: Vec<f32> = text
            .split(|letter: char| !letter.is_ascii_digit() && letter != '.')
            .filter_map(|number| number.parse().ok())
            .collect();
        let [cursor, actual, slope] = numbers[..] else { panic!("{text}") };
        assert!((actual - cursor.clamp(100.0, 500.0)).abs() < 0.11, "{text}");
        assert_eq!(slope, if (100.0..=500.0).contains(&cursor) { 1.0 } else { 0.0 }, "{text}");
        asked.push(cursor);
    }
    assert!(asked.is_sorted() && asked[2] > 700.0, "{asked:?}");
}

#[test]
fn extreme_hands_and_lengths_are_plotted() {
    let mut bench = bench(0.2, 1.5, 300.0);
    for hand in [Vec3::ZERO, Vec3::X * 1e30, Vec3::MAX, Vec3::splat(1e-30)] {
        bench.apply([ArmEdit::SetHand(hand)]);
        plot(&bench);
    }
    for length in [1e-20, 1e30] {
        bench.apply([ArmEdit::SetUpper(length), ArmEdit::SetLower(length)]);
        plot(&bench);
    }
}

#[test]
fn a_cursor_within_reach_is_softened_and_one_beyond_it_too_far() {
    for (x, softness, said) in [
        (480.0, 0.3, "Softened · hand"),
        (530.0, 0.3, "Too far · hand"),
        (105.0, 0.3, "Softened · hand"),
        (95.0, 0.3, "Too close · hand"),
        (530.0, 0.0, "Too far · hand"),
        (480.0, 0.0, "Reached · hand"),
    ] {
        let soft_reach = SoftReach::new(softness, 1.0, 0.0).expect("soft limits");
        let bench =
            Bench::after([ArmEdit::SetHand(Vec3::X * x), ArmEdit::SetSoftReach(soft_reach)]);
        assert!(bench.says(said), "{x}, {softness}: not {said}");
        let is_soft = bench.says("The soft limits slow the hand down");
        assert_eq!(is_soft, said.starts_with("Softened"), "{x}, {softness}");
    }
}
