//! The pin of the hand and its keys.

use crate::common::arm::{ArmSession, channels};
use egui::Key;
use egui::accesskit::{Role, Toggled};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::session::{KeysEdit, PlaybackAction, TransactionAction};

use crate::bench::{Bench, LARGE};
use crate::looks::has_tooltip;
use crate::timeline::times;

const PIN: &str = "Pinned to world";
const DIAMOND: &str = "Key Pinned to world";

fn go_to(bench: &mut Bench, time: f64) {
    bench.apply([PlaybackAction::SetTime(time)]);
}

/// True if the diamond shows a key at the playhead.
fn is_at_key(bench: &Bench) -> bool {
    bench.node(Role::Button, DIAMOND).accesskit_node().toggled() == Some(Toggled::True)
}

/// The hand in the world.
fn hand(bench: &Bench) -> Vec3 {
    bench.session().arm().root + bench.session().pose().hand
}

#[test]
fn the_diamond_adds_and_deletes_a_key_of_the_pin_at_the_playhead() {
    let mut bench = Bench::with_timeline(LARGE);
    assert!(!bench.shows(Role::Button, DIAMOND), "a pin that is off and has no keys has none");
    bench.click(Role::CheckBox, PIN);
    assert!(has_tooltip(&mut bench, Role::Button, DIAMOND));
    bench.apply([TransactionAction::Undo]);
    bench.apply([KeysEdit::Key(vec![channels::PINNED])]);
    go_to(&mut bench, 1.0);
    bench.click(Role::Button, DIAMOND);
    assert!(is_at_key(&bench) && bench.shows(Role::Button, "Channel hand · pinned to world"));
    assert!(bench.shows(Role::Button, "Key of hand · pinned to world at 1.00 s"));
    assert_eq!(times(&bench, channels::HAND), [1.0], "with the point that the Cursor has");
    assert!(times(&bench, channels::PIN).is_empty());
    bench.click(Role::Button, "Turn off");
    go_to(&mut bench, 2.0);
    assert!(!is_at_key(&bench));
    bench.click(Role::CheckBox, PIN);
    assert!(bench.session().history().is_overridden(channels::PINNED), "until the time changes");
    bench.click(Role::Button, DIAMOND);
    assert_eq!(times(&bench, channels::PINNED), [0.0, 1.0, 2.0]);
    assert_eq!(
        (times(&bench, channels::HAND), times(&bench, channels::PIN)),
        (vec![1.0], vec![2.0])
    );
    bench.click(Role::Button, DIAMOND);
    assert_eq!(times(&bench, channels::PINNED), [0.0, 1.0]);
    bench.apply([TransactionAction::Undo]);
    assert_eq!(times(&bench, channels::PINNED), [0.0, 1.0, 2.0]);
}

#[test]
fn a_hand_planted_by_the_check_box_and_k_stays_until_it_is_lifted() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([KeysEdit::Key(vec![channels::PINNED, channels::HAND])]);
    bench.apply([KeysEdit::Key(vec![channels::ROOT_OFFSET])]);
    go_to(&mut bench, 1.0);
    let place = hand(&bench);
    bench.click(Role::CheckBox, PIN);
    bench.key(Key::K);
    bench.apply([KeysEdit::Key(vec![channels::ROOT_OFFSET])]);
    go_to(&mut bench, 3.0);
    bench.enter("Root x", "120");
    bench.key(Key::K);
    bench.click(Role::CheckBox, PIN);
    bench.key(Key::K);
    assert_eq!(times(&bench, channels::PINNED), [0.0, 1.0, 3.0]);
    go_to(&mut bench, 4.0);
    bench.enter("Hand y", "-100");
    bench.key(Key::K);
    for (time, is_planted) in [(0.5, false), (1.0, true), (2.0, true), (2.9, true), (3.5, false)] {
        go_to(&mut bench, time);
        let arm = bench.session().arm();
        assert_eq!(arm.is_pinned(), is_planted, "at {time}");
        let from_root = hand(&bench) - if time < 1.0 { arm.root } else { Vec3::ZERO };
        let slid = from_root.distance(place);
        assert!(if time < 3.0 { slid < 5e-3 } else { slid > 1.0 }, "{slid} at {time}");
    }
}

#[test]
fn auto_key_keys_the_pin_from_the_check_box() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([PlaybackAction::SetAutoKey(true), PlaybackAction::SetTime(1.0)]);
    bench.click(Role::CheckBox, PIN);
    assert!(is_at_key(&bench));
    assert_eq!(times(&bench, channels::PINNED), [0.0, 1.0], "not pinned until then");
    assert!(times(&bench, channels::HAND).is_empty());
    bench.apply([TransactionAction::Undo]);
    assert!(times(&bench, channels::PINNED).is_empty() && !bench.session().arm().is_pinned());
}
