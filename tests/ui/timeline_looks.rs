//! Appearance of the timeline in both themes and in windows of all sizes.

use crate::common::arm::{ArmEdit, Step, channels};
use egui::accesskit::Role;
use egui::{Rect, Vec2};
use egui_kittest::SnapshotResults;
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::document::Theme;
use ik_arm::session::{
    Action, Actions, KeysEdit, PlaybackAction, SelectAction, ShellAction, ViewAction,
};

use crate::bench::{Bench, LARGE, SMALL};
use crate::looks::has_tooltip;

/// An arm with keys at three times, between them.
pub fn animated() -> Vec<Step> {
    let keyed = |time, hand, twist: f32| {
        [
            Step::from(PlaybackAction::SetTime(time)),
            ArmEdit::SetHand(hand).into(),
            ArmEdit::SetTwist(twist.to_radians()).into(),
            KeysEdit::Key(vec![channels::HAND, channels::TWIST]).into(),
        ]
    };
    let mut actions = vec![Step::from(PlaybackAction::SetAutoKey(false))];
    actions.extend(keyed(1.0, Vec3::new(250.0, 120.0, 60.0), 0.0));
    actions.extend(keyed(3.5, Vec3::new(-100.0, 300.0, 160.0), 90.0));
    actions.extend(keyed(6.0, Vec3::new(200.0, -50.0, -60.0), 30.0));
    actions.extend([
        Step::from(PlaybackAction::SetTime(2.0)),
        ArmEdit::SetUpper(220.0).into(),
        KeysEdit::Key(vec![channels::UPPER_LENGTH]).into(),
        PlaybackAction::SetTime(5.0).into(),
        ArmEdit::SetUpper(180.0).into(),
        KeysEdit::Key(vec![channels::UPPER_LENGTH]).into(),
        SelectAction::Keys(vec![(channels::HAND, 3.5), (channels::TWIST, 3.5)]).into(),
        SelectAction::Channels(vec![channels::HAND]).into(),
        PlaybackAction::SetTime(4.5).into(),
        ArmEdit::SetHand(Vec3::new(100.0, 100.0, 100.0)).into(),
    ]);
    actions
}

fn bench(size: Vec2, more: impl IntoIterator<Item = impl Into<Step>>) -> Bench {
    let mut bench = Bench::with_timeline(size);
    bench.apply(animated());
    bench.apply(more);
    bench
}

#[test]
fn the_timeline_looks_as_it_did() {
    let mut results = SnapshotResults::new();
    for theme in [Theme::Dark, Theme::Light] {
        for (name, size, curves) in
            [("timeline", LARGE, false), ("timeline_small", SMALL, false), ("curves", LARGE, true)]
        {
            let looks = [
                Action::from(ShellAction::SetTheme(theme)),
                ViewAction::ShowGraphEditor(curves).into(),
            ];
            let mut bench = bench(size, looks);
            if curves {
                bench.apply([SelectAction::Channels(Vec::new())]);
            } else if size == SMALL {
                bench.apply([PlaybackAction::SetAutoKey(true)]);
            }
            bench.snapshot(name, theme, &mut results);
        }
    }
}

const CONTROLS: [(Role, &str); 14] = [
    (Role::Button, "To start"),
    (Role::Button, "Previous key"),
    (Role::Button, "Play"),
    (Role::Button, "Next key"),
    (Role::Button, "To end"),
    (Role::Button, "Loop"),
    (Role::SpinButton, "Time"),
    (Role::SpinButton, "Frame"),
    (Role::Button, "Key"),
    (Role::Button, "Auto-key"),
    (Role::Button, "Playback"),
    (Role::Button, "Graph editor"),
    (Role::Button, "Hide timeline"),
    (Role::Slider, "Timeline ruler"),
];

#[test]
fn no_control_is_cut_and_none_overlaps_another_in_any_window() {
    for size in [SMALL, LARGE, egui::vec2(2560.0, 1600.0)] {
        for curves in [false, true] {
            let bench = bench(size, [ViewAction::ShowGraphEditor(curves)]);
            let window = Rect::from_min_size(egui::Pos2::ZERO, size);
            let rects = CONTROLS.map(|(role, name)| (name, bench.rect(role, name)));
            for (index, (name, rect)) in rects.iter().enumerate() {
                assert!(window.contains_rect(*rect), "{size:?} {name}: {rect:?}");
                assert!(rect.top() >= bench.viewport().bottom(), "{size:?} {name}: {rect:?}");
                for (other, beside) in &rects[index + 1..] {
                    let shared = rect.intersect(*beside);
                    let apart = !shared.is_positive() || shared.area() < 1.0;
                    assert!(apart, "{size:?}: {name} lies over {other}");
                }
            }
            assert!(bench.viewport().height() > 280.0, "{size:?}: {:?}", bench.viewport());
        }
    }
}

#[test]
fn no_control_of_the_timeline_moves_when_the_time_changes() {
    let mut bench = bench(LARGE, Actions::new());
    let places = |bench: &Bench| CONTROLS.map(|(role, name)| bench.rect(role, name));
    let before = places(&bench);
    for time in [0.0, 7.96, 123.456, -9999.5] {
        bench.apply([PlaybackAction::SetTime(time), PlaybackAction::SetAutoKey(time > 5.0)]);
        assert_eq!(places(&bench), before, "{time}");
    }
}

#[test]
fn everything_in_the_timeline_that_can_be_acted_on_has_a_name() {
    for size in [SMALL, LARGE] {
        for curves in [false, true] {
            let bench = bench(size, [ViewAction::ShowGraphEditor(curves)]);
            bench.harness.check_accessibility();
        }
    }
}

#[test]
fn a_timeline_without_keys_says_how_to_set_the_first_one() {
    let mut bench = Bench::with_timeline(SMALL);
    assert!(bench.says("press K to add keys"));
    bench.apply([ViewAction::ShowGraphEditor(true)]);
    assert!(bench.says("No curves"));
    bench.apply([
        Action::from(ViewAction::ShowGraphEditor(false)),
        KeysEdit::Key(vec![channels::HAND]).into(),
    ]);
    assert!(!bench.says("press K to add keys"));
}

#[test]
fn every_control_of_the_timeline_has_a_tooltip() {
    let mut bench = bench(LARGE, Actions::new());
    let more = [
        (Role::Button, "Channel hand · target"),
        (Role::Button, "Key of hand · target at 1.00 s"),
        (Role::Button, "Keys at 2.00 s"),
        (Role::Image, "hand · target: unkeyed change, press K or it is lost when the time changes"),
    ];
    for (role, name) in CONTROLS.into_iter().chain(more) {
        assert!(has_tooltip(&mut bench, role, name), "{name}");
    }
    let mut bench = Bench::with_timeline(LARGE);
    for name in ["Play", "Previous key", "Next key"] {
        assert!(has_tooltip(&mut bench, Role::Button, name), "{name} says why it is disabled");
    }
}

#[test]
fn controls_that_cannot_act_are_disabled() {
    let disabled =
        |bench: &Bench, name: &str| bench.node(Role::Button, name).accesskit_node().is_disabled();
    let mut bench = Bench::with_timeline(LARGE);
    for name in ["Play", "Previous key", "Next key"] {
        assert!(disabled(&bench, name), "{name}");
    }
    bench.apply(animated());
    for name in ["Play", "Previous key", "Next key"] {
        assert!(!disabled(&bench, name), "{name}");
    }
}

#[test]
fn the_curves_are_those_of_the_selected_channels_or_of_the_whole_rig() {
    let mut bench = bench(LARGE, [ViewAction::ShowGraphEditor(true)]);
    bench.apply([SelectAction::Channels(Vec::new())]);
    assert!(
        bench.shows(Role::Image, "Curves of upper · length, hand · target, hand · Socket twist")
    );
    bench.apply([SelectAction::Channels(vec![channels::UPPER_LENGTH])]);
    assert!(bench.shows(Role::Image, "Curves of upper · length"));
    assert!(bench.shows(Role::Button, "Curve of hand · target"), "its name stays, to be clicked");
}
