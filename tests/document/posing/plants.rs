//! A hand that is planted, lifted and planted again by keys of the pin.

use crate::common::arm::{Arm, ArmDocument, ArmEdit, ArmSession, Step, channels};
use glam::Vec3;
use ik_arm::document::{Channel, Document};
use ik_arm::session::{KeysEdit, PlaybackAction, Session, TransactionAction};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::common::strategies::{config, points};

/// The way in which the user keys the edits: by auto-key, or by pressing K after them.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Keying {
    Auto,
    K,
}

const KEYINGS: [Keying; 2] = [Keying::Auto, Keying::K];

/// A user who animates the arm of a session.
struct Animator {
    session: Session,
    keying: Keying,
    /// The documents after all edits, the first before them.
    documents: Vec<Document>,
}

impl Animator {
    fn new(keying: Keying) -> Self {
        let mut session = Session::default();
        session.apply(PlaybackAction::SetAutoKey(keying == Keying::Auto));
        let documents = vec![session.document().clone()];
        Self { session, keying, documents }
    }

    fn go_to(&mut self, time: f64) {
        self.session.apply(PlaybackAction::SetTime(time));
    }

    /// Applies edits. Without auto-key, K and the keys of `others` follow.
    fn edit(&mut self, edits: &[ArmEdit], others: &[Channel]) {
        edits.iter().for_each(|edit| self.apply(edit.clone()));
        if self.keying == Keying::K {
            let channels = [KeysEdit::channels_to_key(&self.session), others.to_vec()].concat();
            self.apply(KeysEdit::Key(channels));
        }
    }

    fn apply(&mut self, edit: impl Into<Step>) {
        edit.into().apply(&mut self.session);
        self.documents.push(self.session.document().clone());
    }

    fn arm(&self, time: f64) -> Arm {
        self.session.document().at(time).into_document().arm()
    }

    fn track(&self, channel: Channel) -> Vec<(f64, Vec3)> {
        let track = self.session.document().keys.track(channel);
        track.map_or_else(Vec::new, |it| it.knots().iter().map(|k| (k.time, k.value)).collect())
    }

    /// Distance between the hand's places in the world just before a time and at it.
    fn jump(&self, time: f64) -> f32 {
        hand(self.arm(time - 1e-6)).distance(hand(self.arm(time)))
    }
}

/// The hand in the world.
fn hand(arm: Arm) -> Vec3 {
    arm.root + arm.pose().hand
}

/// A plant from `2 n` to `2 n + 1` seconds: where the shoulder is at its start, how far it moves
/// during the plant, and where the hand is from the shoulder.
#[derive(Clone, Copy, Debug)]
struct Plant {
    root: Vec3,
    lean: Vec3,
    hand: Vec3,
}

impl Plant {
    fn start(index: usize) -> f64 {
        2.0 * index as f64
    }

    /// The shoulder, the hand and the pin at the start, the shoulder at the end, and the lift.
    fn animate(self, index: usize, animator: &mut Animator) {
        animator.go_to(Self::start(index));
        let start =
            [ArmEdit::SetRoot(self.root), ArmEdit::SetHand(self.hand), ArmEdit::PinHand(true)];
        animator.edit(&start, &[channels::ROOT_OFFSET]);
        animator.go_to(Self::start(index) + 1.0);
        animator.edit(&[ArmEdit::SetRoot(self.root + self.lean)], &[channels::ROOT_OFFSET]);
        animator.edit(&[ArmEdit::PinHand(false)], &[]);
    }
}

/// Plants of a shoulder that goes along x. All of the motion is within reach of the hand.
fn plants() -> impl Strategy<Value = Vec<Plant>> {
    let plant = (points(20.0), points(20.0), points(40.0));
    vec(plant, 2..5).prop_map(|plants| {
        let plant = |(index, (root, lean, hand))| Plant {
            root: Vec3::X * 150.0 * index as f32 + root,
            lean: Vec3::X * 75.0 + lean,
            hand: Vec3::new(60.0, -250.0, 0.0) + hand,
        };
        plants.into_iter().enumerate().map(plant).collect()
    })
}

fn animated(plants: &[Plant], keying: Keying) -> Animator {
    let mut animator = Animator::new(keying);
    plants.iter().enumerate().for_each(|(index, plant)| plant.animate(index, &mut animator));
    animator
}

proptest! {
    #![proptest_config(config(20, 0x91a_47ed))]

    #[test]
    fn a_planted_hand_stays_still_while_the_root_moves(plants in plants()) {
        for keying in KEYINGS {
            let animator = animated(&plants, keying);
            for (index, plant) in plants.iter().enumerate() {
                let place = plant.root + plant.hand;
                for frame in 0..60 {
                    let arm = animator.arm(Plant::start(index) + f64::from(frame) / 60.0);
                    prop_assert!(arm.is_pinned(), "{keying:?} {index} {frame}");
                    let slid = hand(arm).distance(place) / 500.0;
                    prop_assert!(slid < 1e-5, "{keying:?}: slid by {slid} in {index} at {frame}");
                }
                let lifted = animator.arm(Plant::start(index) + 1.5);
                prop_assert!(!lifted.is_pinned());
            }
        }
    }

    #[test]
    fn the_hand_does_not_jump_where_it_is_planted_and_lifted(plants in plants()) {
        for keying in KEYINGS {
            let animator = animated(&plants, keying);
            for index in 0..plants.len() {
                for time in [Plant::start(index), Plant::start(index) + 1.0] {
                    prop_assert!(animator.jump(time) < 1e-2, "{keying:?}: {} at {time}", animator.jump(time));
                }
            }
        }
    }

    #[test]
    fn a_later_plant_leaves_the_earlier_ones_where_they_are(plants in plants()) {
        for keying in KEYINGS {
            let mut animator = Animator::new(keying);
            let mut places = Vec::new();
            for (index, plant) in plants.iter().enumerate() {
                plant.animate(index, &mut animator);
                places.push(animator.arm(Plant::start(index)).cursor_in_world());
                for (earlier, place) in places.iter().enumerate() {
                    for part in [0.0, 0.3, 0.99] {
                        let arm = animator.arm(Plant::start(earlier) + part);
                        prop_assert!(arm.cursor_in_world().distance(*place) < 1e-4);
                    }
                }
            }
        }
    }

    #[test]
    fn undoing_restores_every_document_in_turn(plants in plants()) {
        for keying in KEYINGS {
            let mut animator = animated(&plants[..2], keying);
            let mut undone = vec![animator.session.document().clone()];
            while animator.session.history().undo_label().is_some() {
                animator.session.apply(TransactionAction::Undo);
                undone.push(animator.session.document().clone());
            }
            undone.dedup();
            undone.reverse();
            animator.documents.dedup();
            prop_assert_eq!(&undone, &animator.documents);
        }
    }

    #[test]
    fn pinning_leaves_the_keys_of_the_hand_as_they_are(
        hands in vec(points(300.0), 2..5), time in 0.0..4.0_f64
    ) {
        for keying in KEYINGS {
            let mut animator = Animator::new(keying);
            for (index, hand) in hands.iter().enumerate() {
                animator.go_to(index as f64);
                animator.edit(&[ArmEdit::SetHand(*hand)], &[]);
            }
            let keys = animator.track(channels::HAND);
            animator.go_to(time);
            let before = animator.session.arm().cursor_in_world();
            animator.edit(&[ArmEdit::PinHand(true)], &[]);
            prop_assert_eq!(animator.session.arm().cursor_in_world(), before);
            prop_assert_eq!(animator.track(channels::HAND), keys.clone());
            // Without K or auto-key, neither does unpinning.
            animator.session.apply(PlaybackAction::SetAutoKey(false));
            animator.session.edit_arm(ArmEdit::PinHand(false));
            prop_assert!(animator.session.arm().cursor_in_world().distance(before) < 1e-3);
            prop_assert_eq!(animator.track(channels::HAND), keys);
        }
    }

    /// The user pins the hand between two of its keys, where it has none.
    #[test]
    fn a_hand_that_is_pinned_and_lifted_on_its_way_arrives_where_it_was(
        hands in vec(points(60.0), 3), root in points(60.0)
    ) {
        for keying in KEYINGS {
            let mut animator = Animator::new(keying);
            for (time, hand) in [(0.0, hands[0]), (4.0, hands[1])] {
                animator.go_to(time);
                animator.edit(&[ArmEdit::SetHand(Vec3::Y * 250.0 + hand)], &[]);
            }
            for time in [0.0, 1.0] {
                animator.go_to(time);
                animator.edit(&[ArmEdit::SetRoot(Vec3::ZERO)], &[channels::ROOT_OFFSET, channels::PINNED]);
                animator.session.apply(KeysEdit::Key(vec![channels::ROOT_OFFSET]));
            }
            animator.go_to(1.0);
            let arrived = hand(animator.arm(1.0));
            animator.edit(&[ArmEdit::PinHand(true)], &[]);
            animator.go_to(2.0);
            animator.edit(&[ArmEdit::SetRoot(root)], &[channels::ROOT_OFFSET]);
            animator.edit(&[ArmEdit::PinHand(false)], &[]);
            animator.go_to(3.0);
            animator.edit(&[ArmEdit::SetHand(Vec3::Y * 250.0 + hands[2])], &[]);
            for time in [1.0, 1.5, 1.99] {
                let slid = hand(animator.arm(time)).distance(arrived);
                prop_assert!(slid < 5e-3, "{keying:?}: slid by {slid} at {time}");
            }
            for time in [1.0, 2.0] {
                prop_assert!(animator.jump(time) < 1e-2, "{keying:?}: {} at {time}", animator.jump(time));
            }
        }
    }
}

#[test]
fn auto_key_keys_a_first_pin_only_from_the_playhead_on() {
    let mut animator = Animator::new(Keying::Auto);
    let still = hand(animator.arm(0.0));
    animator.go_to(1.0);
    animator.edit(&[ArmEdit::PinHand(true)], &[]);
    animator.go_to(2.0);
    animator.edit(&[ArmEdit::SetRoot(Vec3::X * 50.0), ArmEdit::PinHand(false)], &[]);
    animator.edit(&[ArmEdit::SetHand(Vec3::X * 200.0)], &[]);
    let switched = [(0.0, Vec3::ZERO), (1.0, Vec3::X), (2.0, Vec3::ZERO)];
    assert_eq!(animator.track(channels::PINNED), switched);
    for time in [0.0, 0.7, 0.99] {
        let arm = animator.arm(time);
        let place = arm.cursor_in_root();
        assert!(!arm.is_pinned() && place.distance(still) < 1e-3, "{place} at {time}");
    }
    for time in [1.0, 1.3, 1.99] {
        assert!(hand(animator.arm(time)).distance(still) < 1e-3, "at {time}");
    }
}

#[test]
fn pinning_without_auto_key_is_undone_when_the_time_changes() {
    let mut animator = animated(
        &[Plant { root: Vec3::ZERO, lean: Vec3::X * 50.0, hand: Vec3::Y * 250.0 }],
        Keying::K,
    );
    let document = animator.session.document().clone();
    animator.go_to(1.5);
    animator.session.edit_arm(ArmEdit::PinHand(true));
    assert!(
        animator.session.history().is_overridden(channels::PINNED)
            && animator.session.arm().is_pinned()
    );
    assert_eq!(animator.session.document(), &document);
    animator.go_to(1.6);
    assert!(!animator.session.arm().is_pinned());
}

#[test]
fn a_planted_hand_can_be_moved_by_keys_within_its_plant() {
    let mut animator = Animator::new(Keying::Auto);
    animator.edit(&[ArmEdit::PinHand(true)], &[]);
    for (time, place) in [(0.0, Vec3::X), (1.0, Vec3::Y), (3.0, Vec3::Z)] {
        animator.go_to(time);
        animator.edit(&[ArmEdit::SetPin(place * 300.0)], &[]);
        if time == 1.0 {
            animator.edit(&[ArmEdit::PinHand(false)], &[]);
        }
    }
    // A straight line, as two keys alone give.
    let place = animator.arm(0.25).cursor_in_world();
    assert!(place.distance(Vec3::new(225.0, 75.0, 0.0)) < 1e-3, "{place}");
    assert_eq!(animator.arm(3.0).cursor_in_world(), Vec3::Z * 300.0);
}
