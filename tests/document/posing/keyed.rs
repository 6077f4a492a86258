//! Keyed poses.

use crate::common::arm::{ArmEdit, ArmPosed, ArmSession, HandSpace, Step, channels};
use std::f64::consts::PI;

use glam::Vec3;
use ik_arm::document::TwistReferenceKind;
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::session::{KeysEdit, PlaybackAction, PoseMode, Session};

use crate::posing::*;

#[test]
fn hand_keys_have_no_effect_while_the_hand_is_pinned() {
    let mut session = Session::default();
    for (time, hand) in [(0.0, Vec3::X * 200.0), (1.0, Vec3::Y * 200.0)] {
        session.apply(PlaybackAction::SetTime(time));
        session.edit_arm(ArmEdit::SetHand(hand));
        session.apply(KeysEdit::Key(vec![channels::HAND]));
    }
    session.apply(PlaybackAction::SetAutoKey(false));
    session.edit_arm(ArmEdit::PinHand(true));
    session.apply(PlaybackAction::SetTime(0.5));
    assert_eq!(session.arm().cursor_in_root(), Vec3::Y * 200.0);
    session.edit_arm(ArmEdit::PinHand(false));
    assert_eq!(session.arm().cursor_in_root(), Vec3::Y * 200.0, "it stays until the time changes");
    session.apply(PlaybackAction::SetTime(0.0));
    assert_eq!(session.arm().cursor_in_root(), Vec3::X * 200.0);
}

#[test]
fn k_keys_an_edit_that_would_be_lost_when_the_time_changes() {
    let mut session = session([
        Step::from(ArmEdit::SetInfluence(0.0)),
        KeysEdit::Key(vec![channels::INFLUENCE]).into(),
    ]);
    session.apply(PlaybackAction::SetAutoKey(false));
    session.apply(PlaybackAction::SetTime(1.0));
    session.edit_arm(ArmEdit::SetInfluence(1.0));
    assert!(session.shell().message().is_some_and(|message| message.contains("press K")));
    session.apply(KeysEdit::Key(KeysEdit::channels_to_key(&session)));
    session.apply(PlaybackAction::SetTime(0.0));
    session.apply(PlaybackAction::SetTime(1.0));
    assert_eq!(session.arm().influence, 1.0);
}

#[test]
fn a_keyed_switch_keeps_the_stretch_of_its_limbs() {
    let stretch = SoftReach::new(0.0, 2.0, 0.0).expect("a softening");
    let mut session = session([
        Step::from(ArmEdit::SetSoftReach(stretch)),
        PlaybackAction::SetAutoKey(true).into(),
    ]);
    session.edit_arm(ArmEdit::SetHand(Vec3::X * 750.0));
    session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Angles));
    session.apply(PlaybackAction::SetTime(1.0));
    session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Hand));
    session.edit_arm(ArmEdit::SetHand(Vec3::new(300.0, 50.0, 0.0)));
    session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Angles));
    session.apply(PlaybackAction::SetTime(0.0));
    assert!(session.pose().hand.distance(Vec3::X * 750.0) < 1e-2, "{}", session.pose().hand);
}

#[test]
fn a_keyed_hand_keeps_its_orientation_at_every_key_in_another_space() {
    let mut session = Session::default();
    for (time, hand, angles) in [
        (0.0, Vec3::new(250.0, 120.0, 60.0), Vec3::new(0.3, 0.2, 0.1)),
        (2.0, Vec3::new(-150.0, 220.0, 160.0), Vec3::new(0.9, -0.2, 0.4)),
    ] {
        session.apply(PlaybackAction::SetTime(time));
        session.edit_arm(ArmEdit::SetHand(hand));
        session.edit_arm(ArmEdit::SetHandOrientation(angles));
        session.apply(KeysEdit::Key(vec![channels::HAND, channels::WRIST_ANGLES]));
    }
    let turned = |session: &Session, time: f64| session.document().at(time).hand_rotation();
    let before = [0.0, 2.0].map(|time| turned(&session, time));
    session.edit_arm(ArmEdit::SetHandSpace(HandSpace::World));
    for (before, time) in before.into_iter().zip([0.0, 2.0]) {
        let now = turned(&session, time);
        assert!(
            before.x_axis.distance(now.x_axis) < 1e-5 && before.y_axis.distance(now.y_axis) < 1e-5
        );
    }
}

/// A time between two keys of a hand whose transported elbow has no keys.
fn transported_between_keys() -> Session {
    let mut session = session([ArmEdit::SetTwistReference(TwistReferenceKind::Transport)]);
    for (time, hand) in [(0.0, Vec3::X * 300.0), (2.0, Vec3::new(150.0, 200.0, 0.0))] {
        session.apply(PlaybackAction::SetTime(time));
        session.edit_arm(ArmEdit::SetHand(hand));
        session.apply(KeysEdit::Key(vec![channels::HAND]));
    }
    session.apply(PlaybackAction::SetAutoKey(false));
    session.apply(PlaybackAction::SetTime(1.0));
    session
}

/// Moves the hand away from its keys and back.
fn move_off_the_keys_and_back(mut session: Session) -> Session {
    for hand in [Vec3::Y, Vec3::Z, Vec3::X] {
        session.edit_arm(ArmEdit::SetHand(hand * 300.0));
    }
    session
}

#[test]
fn the_twist_of_a_transported_elbow_can_be_set_between_keys_of_the_hand() {
    let mut session = move_off_the_keys_and_back(transported_between_keys());
    session.edit_arm(ArmEdit::SetTwist(2.0));
    assert_eq!(session.arm().twist, 2.0);
    session.edit_arm(ArmEdit::SetUpper(210.0));
    session.apply(PlaybackAction::SetTime(0.5));
    assert_eq!(session.arm().twist, 2.0, "it has no keys to come back to");
}

#[test]
fn a_transported_elbow_between_keys_stays_with_another_twist_reference() {
    for twist_reference in
        [TwistReferenceKind::Up, TwistReferenceKind::Pole, TwistReferenceKind::Stereographic]
    {
        let mut session = move_off_the_keys_and_back(transported_between_keys());
        let before = session.pose();
        session.edit_arm(ArmEdit::SetTwistReference(twist_reference));
        assert!(apart(&before, &session.pose()) < 1e-5, "{twist_reference:?}");
    }
}

#[test]
fn another_edit_leaves_a_keyed_transported_twist_at_its_keys() {
    let mut session = session([ArmEdit::SetTwistReference(TwistReferenceKind::Transport)]);
    for (time, hand) in [(0.0, Vec3::X * 300.0), (2.0, Vec3::new(150.0, 200.0, 90.0))] {
        session.apply(PlaybackAction::SetTime(time));
        session.edit_arm(ArmEdit::SetHand(hand));
        session.apply(KeysEdit::Key(vec![channels::HAND, channels::TWIST]));
    }
    session.apply(PlaybackAction::SetTime(0.7));
    session.edit_arm(ArmEdit::SetUpper(210.0));
    assert!(
        !session.history().is_overridden(channels::TWIST) && session.shell().message().is_none()
    );
}

#[test]
fn the_unkeyed_twist_is_converted_to_the_new_reference_too() {
    let mut session = session([ArmEdit::SetTwist(1.0)]);
    let pose = session.pose();
    session.apply(KeysEdit::Key(vec![channels::TWIST, channels::WRIST_ANGLES]));
    session.edit_arm(ArmEdit::SetTwistReference(TwistReferenceKind::Stereographic));
    session.edit_arm(ArmEdit::SetHandSpace(HandSpace::World));
    let hand = session.posed().hand_rotation();
    session.apply(KeysEdit::ClearChannels(vec![channels::TWIST, channels::WRIST_ANGLES]));
    assert!(apart(&pose, &session.pose()) < 1e-5);
    let now = session.posed().hand_rotation();
    assert!(now.x_axis.distance(hand.x_axis) < 1e-5 && now.y_axis.distance(hand.y_axis) < 1e-5);
}

#[test]
fn moving_off_the_keys_and_back_leaves_a_transported_elbow_unchanged() {
    let session = transported_between_keys();
    let (document, pose) = (session.document().clone(), session.pose());
    let mut session = move_off_the_keys_and_back(session);
    assert_eq!(session.document(), &document);
    session.apply(PlaybackAction::SetTime(0.5));
    session.apply(PlaybackAction::SetTime(1.0));
    assert_eq!(session.pose(), pose);
}

#[test]
fn a_forearm_keyed_to_roll_around_does_not_snap_between_keys() {
    let mut session = Session::default();
    for (time, roll) in [(0.0, 0.0), (2.0, 2.0 * PI as f32)] {
        session.apply(PlaybackAction::SetTime(time));
        session.edit_arm(ArmEdit::SetHandOrientation(Vec3::X * roll));
        session.apply(KeysEdit::Key(vec![channels::WRIST_ANGLES]));
    }
    let roll = |frame: i32| session.document().at(f64::from(frame) / 50.0).roll();
    for frame in 0..100 {
        assert!((0.0..0.2).contains(&(roll(frame + 1) - roll(frame) + 0.02)), "at {frame}");
    }
}

#[test]
fn changing_the_reference_at_a_key_makes_no_unkeyed_edit() {
    let mut session = session([ArmEdit::SetTwist(1.0)]);
    session.apply(KeysEdit::Key(vec![channels::HAND, channels::TWIST]));
    session.edit_arm(ArmEdit::SetTwistReference(TwistReferenceKind::Pole));
    assert!(
        !session.history().is_overridden(channels::TWIST) && session.shell().message().is_none()
    );
}
