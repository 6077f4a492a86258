//! The timeline by keyboard.

use crate::common::arm::channels;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton};
use ik_arm::document::Channel;
use ik_arm::io::Example;
use ik_arm::session::{
    Action, Effect, FileAction, KeysEdit, PlaybackAction, SelectAction, TransactionAction,
};

use crate::bench::{Bench, LARGE};
use crate::timeline::{HAND, key_of_hand, keyed, times};
use ik_arm::kinematics::skeleton::JointId;

fn is_keyed(bench: &Bench, channel: Channel) -> bool {
    !times(bench, channel).is_empty()
}

#[test]
fn k_keys_the_active_channels_and_shift_k_all() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.key(Key::K);
    assert!(is_keyed(&bench, channels::HAND) && is_keyed(&bench, channels::TWIST));
    assert!(!is_keyed(&bench, channels::ROOT_OFFSET));
    bench.key_with(Modifiers::SHIFT, Key::K);
    for channel in channels::ALL {
        let expected = match channel.target() {
            Some(_) => channel.shapes(&bench.session().rig().targets[0]),
            None => !matches!(channel, Channel::Length(_)),
        };
        assert_eq!(is_keyed(&bench, channel), expected, "{channel:?}");
    }
    let mut hidden = Bench::new();
    hidden.key(Key::K);
    assert!(is_keyed(&hidden, channels::HAND), "without the panel too");
}

#[test]
fn k_keys_after_a_slider_was_dragged_but_is_a_letter_in_a_text() {
    let mut bench = Bench::with_timeline(LARGE);
    let at = bench.rect(Role::Slider, "Hand x").center();
    bench.drag_and_drop(PointerButton::Primary, at, at + egui::vec2(20.0, 0.0));
    assert_eq!(bench.focused().map(|it| it.0), Some(Role::Slider));
    bench.key(Key::K);
    assert_eq!(times(&bench, channels::HAND), [0.0]);
    bench.apply([PlaybackAction::SetTime(1.0)]);
    bench.click(Role::SpinButton, "Hand x value");
    bench.type_text("k");
    bench.key(Key::Escape);
    bench.settle();
    assert_eq!(times(&bench, channels::HAND), [0.0]);
}

#[test]
fn k_keys_the_selected_joints() {
    let mut bench = Bench::with_timeline(LARGE);
    let human = Example::find("human").expect("an example");
    bench.apply([
        Action::from(FileAction::OpenExample(human)),
        SelectAction::Joints(vec![JointId::new(8)]).into(),
    ]);
    bench.key(Key::K);
    let keyed: Vec<_> = bench.session().document().keys.tracks().map(|it| it.0).collect();
    // The target of the hand is for the tip of the forearm, joint 7.
    assert_eq!(keyed, [Channel::Rotation(JointId::new(8)), Channel::Target(JointId::new(7))]);
}

#[test]
fn space_plays_and_pauses_the_arm_too() {
    let mut bench = keyed();
    bench.key(Key::Space);
    assert!(bench.session().playback().is_playing());
    bench.key(Key::Space);
    assert!(!bench.session().playback().is_playing());
    bench.click_at(bench.viewport().left_top() + egui::vec2(30.0, 30.0));
    bench.key(Key::Space);
    assert!(bench.session().playback().is_playing(), "from the viewport");
    bench.key(Key::Space);
    bench.focus(Role::Slider, "Hand x");
    bench.key(Key::Space);
    assert!(bench.session().playback().is_playing(), "from a slider");
    bench.key(Key::Space);
    bench.focus(Role::CheckBox, "Pointer");
    bench.key(Key::Space);
    assert!(!bench.session().playback().is_playing(), "a checkbox has a use for it");
    let mut bench = Bench::with_timeline(LARGE);
    bench.key(Key::Space);
    assert!(!bench.session().playback().is_playing() && bench.says("Nothing to play"));
}

#[test]
fn arrows_go_from_frame_to_frame_and_from_key_to_key_once_the_timeline_was_clicked() {
    let mut bench = keyed();
    let camera = *bench.session().camera();
    let ruler = bench.rect(Role::Slider, "Timeline ruler");
    bench.click_at(ruler.center());
    for (key, time) in [
        (Key::Home, 0.0),
        (Key::ArrowRight, 1.0 / 30.0),
        (Key::ArrowRight, 2.0 / 30.0),
        (Key::ArrowLeft, 1.0 / 30.0),
        (Key::ArrowDown, 1.0),
        (Key::ArrowDown, 2.0),
        (Key::ArrowUp, 1.0),
        (Key::End, 8.0),
        (Key::ArrowUp, 5.0),
        (Key::Home, 0.0),
        (Key::ArrowLeft, 0.0),
    ] {
        bench.key(key);
        bench.settle();
        assert!((bench.session().playback().time() - time).abs() < 1e-12, "{key:?} {time}");
    }
    assert_eq!(bench.session().camera(), &camera);
    bench.click_at(bench.viewport().left_top() + egui::vec2(30.0, 30.0));
    bench.key(Key::ArrowRight);
    assert_eq!(bench.session().playback().time(), 0.0);
    assert_ne!(bench.session().camera(), &camera, "in the viewport they turn the view");
}

#[test]
fn between_frames_the_arrows_go_to_the_next_frame() {
    let mut bench = keyed();
    bench.focus(Role::Slider, "Timeline ruler");
    bench.apply([PlaybackAction::SetTime(1.01)]);
    bench.key(Key::ArrowRight);
    assert_eq!(bench.session().playback().time(), 31.0 / 30.0);
    bench.apply([PlaybackAction::SetTime(1.01)]);
    bench.key(Key::ArrowLeft);
    assert_eq!(bench.session().playback().time(), 1.0);
}

#[test]
fn delete_removes_the_selected_keys() {
    for key in [Key::Delete, Key::Backspace] {
        let mut bench = keyed();
        bench.click_at(key_of_hand(&bench, 2.0));
        bench.key(key);
        bench.settle();
        assert_eq!(times(&bench, channels::HAND), [1.0, 5.0], "{key:?}");
        assert!(bench.session().selection().keys().is_empty());
        bench.apply([TransactionAction::Undo]);
        assert_eq!(times(&bench, channels::HAND), HAND.map(|it| it.0), "{key:?}");
    }
}

#[test]
fn delete_means_keys_or_joints_whatever_was_clicked_last() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.choose(&["File", "New", "Empty"]);
    bench.click(Role::Button, "Add child");
    bench.click(Role::Button, "Add child");
    bench.apply([KeysEdit::Key(vec![Channel::Rotation(JointId::new(1))])]);
    let joints = |bench: &Bench| bench.session().skeleton_pose().len();
    let key = |bench: &Bench| bench.rect(Role::Button, "Keys at 0.00 s").center();
    bench.click_at(key(&bench));
    bench.key(Key::Delete);
    bench.settle();
    assert_eq!(joints(&bench), 3, "the key went");
    assert!(!is_keyed(&bench, Channel::Rotation(JointId::new(1))));
    bench.key(Key::Delete);
    bench.settle();
    assert_eq!(joints(&bench), 3, "in the timeline it never means joints");
    bench.apply([KeysEdit::Key(vec![Channel::Rotation(JointId::new(1))])]);
    bench.click_at(key(&bench));
    bench.click(Role::Button, "Joint joint_1");
    bench.key(Key::Delete);
    bench.settle();
    assert_eq!(joints(&bench), 2, "the joint was clicked last");
    assert!(is_keyed(&bench, Channel::Rotation(JointId::new(1))));
}

#[test]
fn copied_keys_are_pasted_at_the_playhead() {
    let mut bench = keyed();
    bench.click_at(key_of_hand(&bench, 1.0));
    bench.hold(Modifiers::SHIFT);
    bench.click_at(key_of_hand(&bench, 2.0));
    bench.hold(Modifiers::NONE);
    bench.frame([Event::Copy]);
    let effects = bench.effects();
    assert!(
        matches!(&effects[..], [Effect::CopyText(text)] if text.contains("Target")),
        "{effects:?}"
    );
    bench.apply([PlaybackAction::SetTime(6.0)]);
    bench.frame([Event::Paste("whatever".to_owned())]);
    bench.settle();
    assert_eq!(times(&bench, channels::HAND), [1.0, 2.0, 5.0, 6.0, 7.0]);
    let track = bench.session().document().keys.track(channels::HAND).expect("keys");
    assert_eq!((track.get(6.0), track.get(7.0)), (Some(HAND[0].1), Some(HAND[1].1)));
    assert_eq!(bench.session().selection().keys().len(), 2, "they are selected");
    bench.apply([TransactionAction::Undo]);
    assert_eq!(times(&bench, channels::HAND), [1.0, 2.0, 5.0]);
}

#[test]
fn without_selected_keys_the_pose_is_copied() {
    let mut bench = keyed();
    bench.frame([Event::Copy]);
    let effects = bench.effects();
    assert!(matches!(&effects[..], [Effect::CopyText(text)] if text.contains("twist_deg")));
}

#[test]
fn ctrl_a_selects_all_keys_and_esc_none() {
    let mut bench = keyed();
    bench.focus(Role::Slider, "Timeline ruler");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.settle();
    assert_eq!(bench.session().selection().keys().len(), 5);
    bench.key(Key::Escape);
    bench.settle();
    assert!(bench.session().selection().keys().is_empty());
}

#[test]
fn after_the_first_key_a_pose_at_another_time_is_kept_and_a_note_says_why() {
    const NOTE: &str = "Auto-key is on: every edit sets keys at the playhead";
    let mut bench = Bench::new();
    bench.key(Key::K);
    bench.settle();
    assert!(bench.says(NOTE));
    let note = bench.rect(Role::Button, "Turn off");
    let ruler = bench.rect(Role::Slider, "Timeline ruler");
    assert!(note.bottom() < ruler.top() && note.bottom() > ruler.top() - 30.0, "above the ruler");

    bench.apply([PlaybackAction::SetTime(2.0)]);
    let at = bench.cursor_on_screen();
    bench.drag_and_drop(PointerButton::Primary, at, at + egui::vec2(-60.0, 20.0));
    bench.settle();
    assert_eq!(times(&bench, channels::HAND), [0.0, 2.0]);
    assert!(!bench.says(NOTE), "said once");

    let mut bench = Bench::new();
    bench.key(Key::K);
    bench.settle();
    bench.click(Role::Button, "Turn off");
    assert!(!bench.session().playback().is_auto_key() && !bench.says(NOTE));
}

#[test]
fn once_dragged_keys_are_dropped_the_status_line_says_what_was_done() {
    let mut bench = keyed();
    let at = key_of_hand(&bench, 1.0);
    bench.drag(PointerButton::Primary, at, at + egui::vec2(60.0, 0.0));
    assert!(bench.session().shell().message().is_some_and(|it| it.starts_with("Move 1 key: ")));
    bench.release(PointerButton::Primary);
    let said = bench.session().shell().message().unwrap_or_default();
    assert!(said.starts_with("Moved 1 key by +"), "{said}");
    assert!(!said.contains("cancel"), "{said}");
}
