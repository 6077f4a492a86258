//! The timeline by mouse: dragging times and keys.

use crate::common::arm::{ArmEdit, Step, channels};
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::document::{Channel, Document, SkeletonRig, Timeline};
use ik_arm::kinematics::skeleton::{Joint, JointId};
use ik_arm::kinematics::spline::{Interpolation, Knot, Spline};
use ik_arm::session::{
    Action, FileAction, KeysEdit, PlaybackAction, SelectAction, ShellAction, TransactionAction,
    ViewAction,
};

use crate::bench::{Bench, LARGE, SECONDS_PER_FRAME, SMALL};
use crate::common::documents::open_example;

pub const HAND: [(f64, Vec3); 3] = [
    (1.0, Vec3::new(250.0, 120.0, 60.0)),
    (2.0, Vec3::new(-100.0, 300.0, 160.0)),
    (5.0, Vec3::new(200.0, -50.0, -60.0)),
];

/// A timeline in which the hand goes through three keys and the elbow has two.
pub fn keyed() -> Bench {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([PlaybackAction::SetAutoKey(false)]);
    for (time, hand) in HAND {
        let key = KeysEdit::Key(vec![channels::HAND]).into();
        bench.apply([
            Step::from(PlaybackAction::SetTime(time)),
            ArmEdit::SetHand(hand).into(),
            key,
        ]);
    }
    for time in [1.0, 4.0] {
        bench.apply([
            Action::from(PlaybackAction::SetTime(time)),
            KeysEdit::Key(vec![channels::TWIST]).into(),
        ]);
    }
    bench.apply([PlaybackAction::SetTime(0.0)]);
    bench
}

pub fn times(bench: &Bench, channel: Channel) -> Vec<f64> {
    let track = bench.session().document().keys.track(channel);
    track.map_or_else(Vec::new, |track| track.knots().iter().map(|knot| knot.time).collect())
}

pub fn key_of_hand(bench: &Bench, time: f64) -> Pos2 {
    bench.rect(Role::Button, &format!("Key of hand · target at {time:.2} s")).center()
}

/// Screen position of a time on the ruler, from two keys of the hand.
fn ruler_position(bench: &Bench, time: f64) -> Pos2 {
    let (a, b) = (key_of_hand(bench, 1.0).x, key_of_hand(bench, 2.0).x);
    pos2(a + (time - 1.0) as f32 * (b - a), bench.rect(Role::Slider, "Timeline ruler").center().y)
}

#[test]
fn the_key_button_keys_hand_and_twist_of_an_arm() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([PlaybackAction::SetTime(1.5)]);
    bench.click(Role::Button, "Key");
    assert_eq!(times(&bench, channels::HAND), [1.5]);
    assert_eq!(times(&bench, channels::TWIST), [1.5]);
    assert!(times(&bench, channels::UPPER_LENGTH).is_empty());
    assert!(bench.shows(Role::Button, "Key of hand · target at 1.50 s"));
    assert!(bench.shows(Role::Button, "Channel hand · Socket twist"));
    bench.choose(&["Edit", "Key", "All"]);
    for channel in channels::ALL {
        let is_keyed = match channel.target() {
            Some(_) => channel.shapes(&bench.session().rig().targets[0]),
            None => !matches!(channel, Channel::Length(_)),
        };
        let expected = if is_keyed { &[1.5][..] } else { &[] };
        assert_eq!(times(&bench, channel), expected, "{channel:?}");
    }
}

#[test]
fn the_playhead_follows_the_mouse_on_the_ruler_from_frame_to_frame() {
    let mut bench = keyed();
    let document = bench.session().document().clone();
    let (from, to) = (ruler_position(&bench, 1.01), ruler_position(&bench, 3.495));
    bench.drag(PointerButton::Primary, from, to);
    assert_eq!(bench.session().playback().time(), Timeline::default().snapped(3.495));
    bench.hold(Modifiers::COMMAND);
    bench.move_to(to);
    assert!(
        (bench.session().playback().time() - 3.495).abs() < 2e-3,
        "{}",
        bench.session().playback().time()
    );
    bench.hold(Modifiers::NONE);
    bench.move_to(pos2(5000.0, to.y));
    assert_eq!(bench.session().playback().time(), 8.0, "not past the end");
    bench.move_to(pos2(-5000.0, to.y));
    assert_eq!(bench.session().playback().time(), 0.0);
    bench.release(PointerButton::Primary);
    bench.move_to(ruler_position(&bench, 3.0));
    assert_eq!(bench.session().playback().time(), 0.0, "it is let go");
    assert_eq!(bench.session().document(), &document);
    assert_eq!(bench.session().history().undo_label(), Some("Key Socket twist"), "it is no step");
}

#[test]
fn esc_restores_the_time() {
    let mut bench = keyed();
    bench.apply([PlaybackAction::SetTime(0.5)]);
    bench.drag(PointerButton::Primary, ruler_position(&bench, 1.0), ruler_position(&bench, 4.0));
    assert_eq!(bench.session().playback().time(), 4.0);
    bench.key(Key::Escape);
    assert_eq!(bench.session().playback().time(), 0.5);
    bench.move_to(ruler_position(&bench, 2.0));
    bench.release(PointerButton::Primary);
    assert_eq!(bench.session().playback().time(), 0.5);
}

#[test]
fn a_key_is_dragged_to_a_frame_and_the_whole_drag_is_one_step() {
    let mut bench = keyed();
    let before = bench.session().document().clone();
    let (from, to) = (key_of_hand(&bench, 2.0), key_of_hand(&bench, 2.0) + vec2(149.0, 3.0));
    bench.drag(PointerButton::Primary, from, to);
    assert!(bench.says("Move 1 key: +"));
    let moved = times(&bench, channels::HAND)[1];
    assert!(moved > 2.5, "{moved}");
    assert_eq!(moved, Timeline::default().snapped(moved), "on a frame");
    assert_eq!(times(&bench, channels::TWIST), [1.0, 4.0], "others stay");
    bench.release(PointerButton::Primary);
    bench.settle();
    assert_eq!(bench.session().selection().keys(), [(channels::HAND, moved)]);
    assert_eq!(bench.session().history().undo_label(), Some("Move keys"));
    bench.apply([TransactionAction::Undo]);
    assert_eq!(bench.session().document(), &before);
    bench.apply([TransactionAction::Redo]);
    assert_eq!(times(&bench, channels::HAND)[1], moved);
}

#[test]
fn ctrl_moves_a_key_between_frames() {
    let mut bench = keyed();
    let (from, to) = (key_of_hand(&bench, 2.0), key_of_hand(&bench, 2.0) + vec2(7.0, 0.0));
    bench.drag(PointerButton::Primary, from, to);
    bench.hold(Modifiers::COMMAND);
    bench.release(PointerButton::Primary);
    bench.hold(Modifiers::NONE);
    let moved = times(&bench, channels::HAND)[1];
    assert!(moved > 2.0 && moved != Timeline::default().snapped(moved), "{moved}");
}

#[test]
fn esc_cancels_a_drag_of_keys_and_they_stay_selected() {
    let mut bench = keyed();
    let before = bench.session().document().clone();
    let from = key_of_hand(&bench, 2.0);
    bench.drag(PointerButton::Primary, from, from + vec2(80.0, 0.0));
    assert_ne!(bench.session().document(), &before);
    bench.key(Key::Escape);
    assert_eq!(bench.session().document(), &before);
    bench.move_to(from + vec2(-60.0, 0.0));
    bench.release(PointerButton::Primary);
    assert_eq!(bench.session().document(), &before);
    assert_eq!(bench.session().selection().keys(), [(channels::HAND, 2.0)]);
    assert!(!bench.session().history().is_editing());
}

#[test]
fn a_click_selects_a_key_and_shift_adds_another_or_removes_it() {
    let mut bench = keyed();
    bench.click_at(key_of_hand(&bench, 1.0));
    assert_eq!(bench.session().selection().keys(), [(channels::HAND, 1.0)]);
    bench.hold(Modifiers::SHIFT);
    bench.click_at(key_of_hand(&bench, 5.0));
    assert_eq!(bench.session().selection().keys(), [(channels::HAND, 1.0), (channels::HAND, 5.0)]);
    bench.click_at(key_of_hand(&bench, 1.0));
    assert_eq!(bench.session().selection().keys(), [(channels::HAND, 5.0)]);
    bench.hold(Modifiers::NONE);
    bench.click_at(key_of_hand(&bench, 1.0) + vec2(60.0, 0.0));
    assert!(bench.session().selection().keys().is_empty(), "a click beside all selects none");
    assert!(!bench.session().history().is_editing());
}

#[test]
fn the_diamonds_on_top_select_and_move_all_keys_at_their_time() {
    let mut bench = keyed();
    let at = bench.rect(Role::Button, "Keys at 1.00 s").center();
    bench.click_at(at);
    let both = [(channels::HAND, 1.0), (channels::TWIST, 1.0)];
    assert_eq!(bench.session().selection().keys(), both);
    bench.drag_and_drop(PointerButton::Primary, at, at - vec2(70.0, 0.0));
    bench.settle();
    let (hand, twist) = (times(&bench, channels::HAND), times(&bench, channels::TWIST));
    assert!(hand[0] < 0.8 && hand[0] == twist[0], "{hand:?} {twist:?}");
    assert_eq!((hand[1], twist[1]), (2.0, 4.0));
}

#[test]
fn a_box_selects_what_is_in_it() {
    let mut bench = keyed();
    let (first, last) = (key_of_hand(&bench, 1.0), key_of_hand(&bench, 2.0));
    let (from, to) = (first - vec2(20.0, 8.0), last + vec2(20.0, 30.0));
    bench.drag_and_drop(PointerButton::Primary, from, to);
    let inside = [(channels::HAND, 1.0), (channels::HAND, 2.0), (channels::TWIST, 1.0)];
    assert_eq!(bench.session().selection().keys(), inside);
    bench.hold(Modifiers::SHIFT);
    let at = key_of_hand(&bench, 5.0);
    bench.drag_and_drop(PointerButton::Primary, at + vec2(20.0, 8.0), at - vec2(20.0, 8.0));
    bench.hold(Modifiers::NONE);
    assert_eq!(bench.session().selection().keys().len(), 4);
    bench.drag(PointerButton::Primary, from, to);
    bench.key(Key::Escape);
    bench.release(PointerButton::Primary);
    assert!(bench.session().selection().keys().is_empty());
}

#[test]
fn a_double_click_on_a_row_adds_a_key_on_the_curve() {
    let mut bench = keyed();
    let at = pos2(ruler_position(&bench, 3.0).x, key_of_hand(&bench, 1.0).y);
    bench.double_click_at(at);
    assert_eq!(times(&bench, channels::HAND), [1.0, 2.0, 3.0, 5.0]);
    assert_eq!(bench.session().playback().time(), 3.0);
    let spline = spline();
    let key = bench.session().document().keys.track(channels::HAND).and_then(|it| it.get(3.0));
    assert!(key.expect("there").distance(spline.at(3.0).expect("there")) < 1e-3);
}

fn spline() -> Spline<Vec3> {
    let interpolation = Interpolation::Auto;
    HAND.into_iter().map(|(time, value)| Knot { interpolation, ..Knot::new(time, value) }).collect()
}

#[test]
fn the_hand_follows_the_spline_during_playback() {
    let mut bench = keyed();
    bench.apply([PlaybackAction::SetTime(1.2)]);
    bench.click_at(bench.rect(Role::Button, "Play").center());
    assert!(bench.session().playback().is_playing());
    bench.frame([]);
    let begun = bench.session().playback().time();
    for frame in 1..=60 {
        bench.frame([]);
        let time = bench.session().playback().time();
        assert!((time - begun - f64::from(frame) * SECONDS_PER_FRAME).abs() < 1e-6, "{time}");
        let expected = spline().at(time).expect("keys");
        assert!(bench.hand().distance(expected) < 1e-3, "{time}: {} {expected}", bench.hand());
    }
    bench.click_at(bench.rect(Role::Button, "Pause").center());
    bench.settle();
    let time = bench.session().playback().time();
    assert_eq!(time, Timeline::default().snapped(time), "it is on a frame");
}

#[test]
fn at_half_speed_playback_goes_half_as_far() {
    let mut bench = keyed();
    bench.click(Role::Button, "Playback");
    type_into(&mut bench, "Speed", "0.5");
    assert_eq!(bench.session().playback().speed(), 0.5);
    bench.apply_moving([PlaybackAction::Play(true)]);
    let begun = bench.session().playback().time();
    bench.wait(1.0);
    assert!((bench.session().playback().time() - begun - 0.5).abs() < 0.02);
}

#[test]
fn at_its_end_playback_loops_or_stops() {
    let mut bench = keyed();
    bench.apply_moving([PlaybackAction::SetTime(7.9), PlaybackAction::Play(true)]);
    bench.wait(0.5);
    assert!(bench.session().playback().is_playing() && bench.session().playback().time() < 1.0);
    bench.apply([PlaybackAction::Play(false)]);
    bench.click(Role::Button, "Loop");
    assert!(!bench.session().playback().is_looping());
    bench.apply_moving([PlaybackAction::SetTime(7.9), PlaybackAction::Play(true)]);
    bench.wait(0.5);
    assert_eq!(
        (bench.session().playback().is_playing(), bench.session().playback().time()),
        (false, 8.0)
    );
    bench.click_at(bench.rect(Role::Button, "Play").center());
    bench.wait(0.2);
    assert!(
        bench.session().playback().is_playing() && bench.session().playback().time() < 1.0,
        "from the start again"
    );
}

#[test]
fn buttons_go_to_the_ends_and_from_key_to_key() {
    let mut bench = keyed();
    for (name, time) in [
        ("Next key", 1.0),
        ("Next key", 2.0),
        ("Next key", 4.0),
        ("To end", 8.0),
        ("Previous key", 5.0),
        ("Previous key", 4.0),
        ("To start", 0.0),
    ] {
        bench.click(Role::Button, name);
        assert_eq!(bench.session().playback().time(), time, "{name}");
    }
}

#[test]
fn with_auto_key_an_edit_makes_a_key_and_without_it_is_gone_when_the_time_changes() {
    let mut bench = keyed();
    bench.apply([PlaybackAction::SetTime(3.0)]);
    bench.enter("Hand x", "77");
    assert_eq!(bench.hand().x, 77.0);
    assert_eq!(times(&bench, channels::HAND), [1.0, 2.0, 5.0]);
    assert!(
        bench.says("hand · target: unkeyed change, press K or it is lost when the time changes")
    );
    bench.click(Role::Button, "Next key");
    bench.click(Role::Button, "Previous key");
    bench.apply([PlaybackAction::SetTime(3.0)]);
    assert!(bench.hand().distance(spline().at(3.0).expect("keys")) < 1e-3);
    assert!(!bench.says("changed here"));

    bench.click(Role::Button, "Auto-key");
    assert!(bench.session().playback().is_auto_key());
    bench.enter("Hand x", "77");
    assert_eq!(times(&bench, channels::HAND), [1.0, 2.0, 3.0, 5.0]);
    bench.apply([PlaybackAction::SetTime(0.0), PlaybackAction::SetTime(3.0)]);
    assert!((bench.hand().x - 77.0).abs() < 1e-4);
}

#[test]
fn the_frame_rate_can_be_chosen_and_an_unlisted_one_of_a_file_is_shown() {
    let mut bench = keyed();
    bench.click(Role::Button, "Playback");
    bench.click(Role::Button, "24 fps");
    assert_eq!(bench.session().document().timeline.frame_rate, 24.0);
    bench.key(Key::Escape);
    bench.settle();
    assert!(!bench.shows(Role::Button, "24 fps"), "Esc closes the menu");
    bench.drag_and_drop(
        PointerButton::Primary,
        ruler_position(&bench, 1.0),
        ruler_position(&bench, 1.5),
    );
    let frames = bench.session().playback().time() * 24.0;
    assert!((frames - frames.round()).abs() < 1e-9);
    let timeline = Timeline { frame_rate: 33.33, ..Timeline::default() };
    bench.apply([KeysEdit::SetTimeline(timeline)]);
    bench.click(Role::Button, "Playback");
    assert!(bench.shows(Role::Button, "33.33 fps"));
    bench.click(Role::Button, "29.97 fps");
    assert_eq!(bench.session().document().timeline.frame_rate, 30e3 / 1001.0);
}

fn type_into(bench: &mut Bench, field: &str, text: &str) {
    bench.click(Role::SpinButton, field);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([egui::Event::Text(text.to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
}

#[test]
fn start_and_end_can_be_typed_and_invalid_values_are_refused() {
    let mut bench = keyed();
    bench.click(Role::Button, "Playback");
    type_into(&mut bench, "End", "5.1");
    type_into(&mut bench, "Start", "-0.7 s");
    let timeline = bench.session().document().timeline;
    assert_eq!((timeline.start, timeline.end), (-0.7, 5.1), "exactly");
    for (field, text) in [("Start", "5.1"), ("End", "-3"), ("End", "1e9")] {
        type_into(&mut bench, field, text);
        assert_eq!(bench.session().document().timeline, timeline, "{field} {text}");
        assert!(bench.says("A timeline must start before it ends"), "{field} {text}");
    }
    bench.key(Key::Escape);
    bench.settle();
    type_into(&mut bench, "Time", "0.1");
    assert_eq!(bench.session().playback().time(), 0.1);
    type_into(&mut bench, "Frame", "45");
    assert_eq!(bench.session().playback().time(), 1.5);
}

#[test]
fn the_time_is_dragged_in_its_number_from_frame_to_frame() {
    let mut bench = keyed();
    let undo = bench.session().history().undo_label();
    let at = bench.rect(Role::SpinButton, "Time").center();
    bench.drag_and_drop(PointerButton::Primary, at, at + vec2(40.0, 0.0));
    bench.settle();
    let time = bench.session().playback().time();
    assert!(time > 0.1 && time == Timeline::default().snapped(time), "{time}");
    assert!(
        !bench.session().history().is_editing() && bench.session().history().undo_label() == undo
    );
}

#[test]
fn the_wheel_zooms_about_the_mouse_and_a_double_click_shows_all_again() {
    let mut bench = keyed();
    let before = key_of_hand(&bench, 2.0);
    let gap = |bench: &Bench| key_of_hand(bench, 2.0).x - key_of_hand(bench, 1.0).x;
    let was = gap(&bench);
    bench.move_to(before + vec2(0.0, 12.0));
    bench.wheel(3.0);
    bench.settle();
    assert!((key_of_hand(&bench, 2.0).x - before.x).abs() < 0.6, "what is pointed at stays");
    assert!(gap(&bench) > 1.5 * was);
    bench.wheel(-3.0);
    bench.settle();
    assert!((gap(&bench) - was).abs() < 0.6);
    let wide = before + vec2(0.0, 12.0);
    bench.drag_and_drop(PointerButton::Middle, wide, wide + vec2(90.0, 0.0));
    bench.settle();
    assert!((key_of_hand(&bench, 2.0).x - before.x - 90.0).abs() < 1.0, "moved with the pointer");
    let ruler = bench.rect(Role::Slider, "Timeline ruler").center();
    bench.double_click_at(ruler);
    assert!((key_of_hand(&bench, 2.0).x - before.x).abs() < 0.6);
}

#[test]
fn a_click_on_a_name_selects_the_channel_and_shift_adds_one() {
    let mut bench = keyed();
    bench.click(Role::Button, "Channel hand · target");
    let selected =
        |bench: &Bench| bench.session().selection().channels().iter().copied().collect::<Vec<_>>();
    assert_eq!(selected(&bench), [channels::HAND]);
    bench.hold(Modifiers::SHIFT);
    bench.click(Role::Button, "Channel hand · Socket twist");
    bench.hold(Modifiers::NONE);
    assert_eq!(selected(&bench), [channels::HAND, channels::TWIST]);
    bench.click(Role::Button, "Channel hand · Socket twist");
    assert_eq!(selected(&bench), [channels::TWIST]);
    bench.apply([PlaybackAction::SetTime(7.0)]);
    bench.click(Role::Button, "Key");
    assert_eq!(times(&bench, channels::TWIST), [1.0, 4.0, 7.0]);
    assert_eq!(times(&bench, channels::HAND), [1.0, 2.0, 5.0]);
}

fn right_click(bench: &mut Bench, at: Pos2) {
    bench.move_to(at);
    bench.press(PointerButton::Secondary);
    bench.release(PointerButton::Secondary);
    bench.settle();
}

#[test]
fn the_right_button_offers_what_can_be_done_with_keys_and_channels() {
    let mut bench = keyed();
    let key = key_of_hand(&bench, 2.0);
    right_click(&mut bench, key);
    bench.click(Role::Button, "Copy keys");
    let empty = pos2(ruler_position(&bench, 3.0).x, key.y);
    right_click(&mut bench, empty);
    bench.click(Role::Button, "Paste here");
    assert_eq!(times(&bench, channels::HAND), [1.0, 2.0, 3.0, 5.0]);
    let key = key_of_hand(&bench, 1.0);
    right_click(&mut bench, key);
    bench.click(Role::Button, "Delete keys");
    assert_eq!(times(&bench, channels::HAND), [2.0, 3.0, 5.0]);
    let name = bench.rect(Role::Button, "Channel hand · target").center();
    right_click(&mut bench, name);
    bench.click(Role::Button, "Delete all keys of channel");
    assert!(times(&bench, channels::HAND).is_empty());
    assert_eq!(times(&bench, channels::TWIST), [1.0, 4.0]);
}

#[test]
fn a_screen_reader_selects_keys_and_scrubs() {
    let mut bench = keyed();
    bench.node(Role::Button, "Key of hand · target at 5.00 s").click_accesskit();
    bench.settle();
    assert_eq!(bench.session().selection().keys(), [(channels::HAND, 5.0)]);
    bench.node(Role::Slider, "Timeline ruler").increment_accesskit();
    bench.frame([]);
    assert_eq!(bench.session().playback().time(), 1.0 / 30.0);
    bench.node(Role::Slider, "Timeline ruler").set_value_accesskit(2.5);
    bench.frame([]);
    let value = bench.node(Role::Slider, "Timeline ruler").accesskit_node().numeric_value();
    assert_eq!((bench.session().playback().time(), value), (2.5, Some(2.5)));
}

#[test]
fn dragging_in_the_graph_editor_scrubs() {
    let mut bench = keyed();
    let (from, to) = (ruler_position(&bench, 1.5), ruler_position(&bench, 4.0));
    bench.click(Role::Button, "Graph editor");
    // With one axis of values the times are where the dope sheet has them.
    bench.apply([SelectAction::Channels(vec![channels::HAND])]);
    assert!(bench.session().preferences().curves);
    let middle = bench.rect(Role::Image, "Curves of hand · target").center().y;
    bench.drag_and_drop(PointerButton::Primary, pos2(from.x, middle), pos2(to.x, middle));
    assert_eq!(bench.session().playback().time(), 4.0);
    bench.click(Role::Button, "Graph editor");
    assert!(bench.shows(Role::Button, "Channel hand · target"));
}

#[test]
fn the_view_menu_hides_the_timeline_and_shows_it() {
    let mut bench = Bench::with_timeline(SMALL);
    let low = bench.viewport().bottom();
    bench.choose(&["View", "Timeline"]);
    assert!(!bench.shows(Role::Button, "Auto-key"));
    assert!(bench.viewport().bottom() > low + 80.0);
    bench.key(Key::Escape);
    bench.settle();
    bench.choose(&["View", "Timeline"]);
    assert_eq!(bench.viewport().bottom(), low);
}

#[test]
fn channels_of_a_skeleton_have_the_names_of_its_joints() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([open_example("human")]);
    let names = |joint: JointId| bench.session().skeleton()[joint].name.clone();
    let (turned, reached) = (names(JointId::new(1)), names(JointId::new(8)));
    bench.apply([KeysEdit::Key(vec![
        Channel::Rotation(JointId::new(1)),
        // For the tip of the forearm, which the hand is at.
        Channel::Target(JointId::new(7)),
    ])]);
    let [turned, reached] = [format!("{turned} · rotation"), format!("{reached} · target")];
    let top = |name: &str| bench.rect(Role::Button, &format!("Channel {name}")).top();
    assert!(top(&turned) < top(&reached));
}

/// Only the rows in sight are laid out.
#[test]
fn ten_thousand_channels_scroll_quickly() {
    let mut document = Document::new(SkeletonRig::default());
    for joint in document.skeleton().joints().len()..5_000 {
        let joint = Joint::new(&format!("j{joint}"), Some(JointId::new(0)), Vec3::ONE);
        document.skeleton_mut().add(joint).expect("room");
    }
    for joint in 0..5_000 {
        for frame in 0..3 {
            let time = f64::from(frame) * 0.5 + joint as f64 * 1e-4;
            document.keys.insert(Channel::Rotation(JointId::new(joint)), time, Vec3::ZERO);
            document.keys.insert(Channel::Offset(JointId::new(joint)), time, Vec3::ONE);
        }
    }
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([FileAction::Opened { document: Box::new(document), file: None, contents: None }]);
    let frame = |bench: &mut Bench| {
        let begun = Instant::now();
        bench.frame([]);
        begun.elapsed()
    };
    let with = (0..5).map(|_| frame(&mut bench)).min().expect("some");
    bench.apply([ViewAction::ShowTimeline(false)]);
    let without = (0..5).map(|_| frame(&mut bench)).min().expect("some");
    // In a build without optimisation.
    assert!(with < without + Duration::from_millis(400), "{with:?}, without it {without:?}");
    println!("{with:?}, without the timeline {without:?}");
}

#[test]
fn zooming_out_ends_at_four_times_the_timeline() {
    let mut bench = keyed();
    let second = |bench: &Bench| key_of_hand(bench, 2.0).x - key_of_hand(bench, 1.0).x;
    let before = second(&bench);
    bench.move_to(ruler_position(&bench, 1.0));
    for _ in 0..40 {
        bench.wheel(-3.0);
    }
    bench.settle();
    assert!((second(&bench) - 0.25 * before).abs() < 0.02 * before, "{}", second(&bench));
}

#[test]
fn the_zoom_of_the_timeline_is_that_of_one_document() {
    let opened = || open_example("keyframes");
    let keys = |bench: &Bench| key_of_hand(bench, 2.0).x - key_of_hand(bench, 1.0).x;
    let mut bench = keyed();
    let was = keys(&bench);
    bench.move_to(key_of_hand(&bench, 2.0) + vec2(0.0, 12.0));
    bench.wheel(3.0);
    bench.settle();
    assert!(keys(&bench) > 1.5 * was);
    bench.apply_moving([FileAction::Discard(Box::new(opened()))]);
    bench.apply([PlaybackAction::Play(false)]);
    let ruler = |bench: &Bench| bench.rect(Role::Slider, "Timeline ruler");
    let first = |bench: &Bench| key_of_hand(bench, 0.0).x - ruler(bench).left();
    let mut fresh = Bench::with_timeline(LARGE);
    fresh.apply([opened()]);
    assert!((first(&bench) - first(&fresh)).abs() < 0.6, "the whole timeline is shown");
}

#[test]
fn the_status_line_says_how_many_keys_and_joints_are_selected() {
    let mut bench = keyed();
    bench.apply([SelectAction::Keys(vec![(channels::HAND, 1.0), (channels::HAND, 2.0)])]);
    bench.apply([ShellAction::ClearMessage]);
    assert!(bench.says("2 keys selected"));
    let mut bench = Bench::example("human");
    bench.apply([
        Action::from(SelectAction::Joints([1, 2, 3].map(JointId::new).to_vec())),
        ShellAction::ClearMessage.into(),
    ]);
    assert!(bench.says("and 2 more selected"));
}

#[test]
fn while_all_joints_are_folded_those_that_are_selected_are_shown() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([open_example("walk")]);
    let headings = |bench: &Bench| {
        ["pelvis · rotation", "spine · rotation", "chest · rotation"]
            .map(|name| bench.shows(Role::Button, &format!("Channel {name}")))
    };
    assert_eq!(headings(&bench), [false; 3]);
    assert!(bench.shows(Role::Button, "Keys of left_foot"), "a joint with a target");
    bench.apply([SelectAction::Joints(vec![bench.joint("spine")])]);
    bench.settle();
    assert_eq!(headings(&bench), [false, true, false]);
    bench.click(Role::Button, "Keys of all joints");
    assert_eq!(headings(&bench), [true; 3]);
    bench.click(Role::Button, "Keys of all joints");
    assert_eq!(headings(&bench), [false, true, false]);
}

#[test]
fn a_box_over_the_folded_row_of_all_keys_selects_the_keys_of_all_joints_in_it() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([open_example("walk")]);
    let [first, last] =
        ["Keys at 0.50 s", "Keys at 0.75 s"].map(|name| bench.rect(Role::Button, name).center());
    let from = first + vec2(-10.0, 30.0);
    bench.drag(PointerButton::Primary, from, last + vec2(10.0, 0.0));
    bench.release(PointerButton::Primary);
    bench.settle();
    let tracks = bench.session().document().keys.tracks();
    let inside = |time: f64| (0.5 - 1e-6..0.76).contains(&time);
    let expected: usize = tracks
        .map(|(_, track)| track.knots().iter().filter(|knot| inside(knot.time)).count())
        .sum();
    assert!(expected > 40, "{expected}");
    assert_eq!(bench.session().selection().keys().len(), expected);
}

#[test]
fn channels_stand_below_their_joint_which_folds_them_and_has_all_their_keys() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([open_example("walk")]);
    let channels = |bench: &Bench| {
        ["pelvis · rotation", "pelvis · offset"]
            .map(|name| bench.shows(Role::Button, &format!("Channel {name}")))
    };
    assert_eq!(channels(&bench), [false; 2], "many joints are folded at first");
    bench.click(Role::Button, "Keys of all joints");
    assert_eq!(channels(&bench), [true; 2]);
    bench.click(Role::Button, "Keys of pelvis");
    assert_eq!(channels(&bench), [false; 2], "folded");
    let keys = bench.rect(Role::Button, "Keys of pelvis at 0.50 s");
    bench.click_at(keys.center());
    bench.settle();
    let pelvis = bench.joint("pelvis");
    let mut picked = bench.session().selection().keys().to_vec();
    picked.sort_unstable_by_key(|(channel, _)| format!("{channel:?}"));
    let expected = [Channel::Offset(pelvis), Channel::Rotation(pelvis)].map(|it| (it, 0.5));
    assert_eq!(picked, expected);
    bench.click(Role::Button, "Keys of pelvis");
    assert_eq!(channels(&bench), [true; 2]);
}
