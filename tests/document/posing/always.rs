//! Properties of every arm in a session.

use crate::common::arm::{ArmDocument, ArmEdit, ArmPosed, ArmSession, HandSpace, channels};
use glam::{DQuat, Vec3};
use ik_arm::document::TwistReferenceKind;
use ik_arm::kinematics::two_bone::TwoBonePose;
use ik_arm::session::{KeysEdit, PlaybackAction, PoseMode, Session, TransactionAction};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::common::strategies::{config, points};
use crate::posing::*;

proptest! {
    #![proptest_config(config(300, 0x0b0d_01e5))]

    #[test]
    fn a_pinned_hand_stays_bit_identical_while_the_root_moves(
        hand in points(300.0), roots in vec(points(400.0), 1..8), twist_reference in references()
    ) {
        let mut session = session([
            ArmEdit::SetTwistReference(twist_reference), ArmEdit::SetHand(hand), ArmEdit::SetRoot(roots[0]),
        ]);
        let before = session.arm().cursor_in_world();
        session.edit_arm(ArmEdit::PinHand(true));
        prop_assert_eq!(bits(session.arm().cursor_in_world()), bits(before));
        for root in roots {
            session.edit_arm(ArmEdit::SetRoot(root));
            let (arm, pose) = (session.arm(), session.pose());
            prop_assert_eq!(bits(arm.cursor_in_world()), bits(before));
            let cursor = before.as_dvec3() - root.as_dvec3();
            if (100.1..499.9).contains(&cursor.length()) {
                let missed = cursor.distance(pose.hand.as_dvec3());
                let ulps = 2.0 * f64::from(f32::EPSILON) * f64::from(before.abs().max(root.abs()).max_element());
                prop_assert!(missed <= 3e-7 * 500.0 + ulps, "off by {}", missed);
            }
        }
        let (world, pose) = (session.arm().cursor_in_world(), session.pose());
        session.edit_arm(ArmEdit::PinHand(false));
        prop_assert!(world.distance(session.arm().cursor_in_world()) < 1e-3);
        prop_assert!(apart(&pose, &session.pose()) < 1e-3);
    }

    #[test]
    fn another_twist_reference_keeps_the_elbow(
        hand in points(300.0), twist in 0.0..6.0_f32, references in vec(references(), 1..6), pole in points(300.0)
    ) {
        let mut session =
            session([ArmEdit::SetHand(hand), ArmEdit::SetTwist(twist), ArmEdit::SetPole(pole)]);
        let pose = session.pose();
        for twist_reference in references {
            session.edit_arm(ArmEdit::SetTwistReference(twist_reference));
            prop_assert_eq!(session.arm().twist_reference, twist_reference);
            prop_assert!(apart(&pose, &session.pose()) < 1e-5, "{:?}", apart(&pose, &session.pose()));
        }
    }

    #[test]
    fn another_twist_reference_keeps_the_elbow_at_every_key(
        hands in vec(points(300.0), 2..5), twists in vec(0.0..6.0_f32, 5), to in vec(references(), 1..4)
    ) {
        let mut session = Session::default();
        for (index, hand) in hands.iter().enumerate() {
            session.apply(PlaybackAction::SetTime(index as f64));
            session.edit_arm(ArmEdit::SetHand(*hand));
            session.edit_arm(ArmEdit::SetTwist(twists[index]));
            session.apply(KeysEdit::Key(vec![channels::HAND, channels::TWIST]));
        }
        let poses: Vec<_> =
            (0..hands.len()).map(|time| session.document().at(time as f64).arm_pose().to_owned()).collect();
        for twist_reference in to {
            session.edit_arm(ArmEdit::SetTwistReference(twist_reference));
            for (time, pose) in poses.iter().enumerate() {
                let now = session.document().at(time as f64).arm_pose().to_owned();
                prop_assert!(apart(pose, &now) < 2e-5, "{} at {} with {:?}", apart(pose, &now), time, twist_reference);
            }
        }
    }

    #[test]
    fn a_transported_elbow_does_not_pop_and_is_restored_when_the_drag_is_cancelled(
        hands in vec(points(300.0), 2..40)
    ) {
        let mut session = session([ArmEdit::SetTwistReference(TwistReferenceKind::Transport), ArmEdit::SetHand(hands[0])]);
        let before = session.document().clone();
        session.apply(TransactionAction::Begin);
        for ends in hands.windows(2) {
            for step in 1..=20 {
                let was = session.pose();
                session.edit_arm(ArmEdit::SetHand(ends[0].lerp(ends[1], step as f32 / 20.0)));
                let now = session.pose();
                let [from, to] = [was, now].map(|pose| pose.outward().as_dvec3());
                let [w0, w1] = [was, now].map(|pose| pose.pointer.direction.as_dvec3());
                // Parallel transport in f64.
                let turn = DQuat::from_rotation_arc(w0.normalize(), w1.normalize());
                prop_assert!(w0.dot(w1) < -0.999 || (turn * from).distance(to) < 2e-5);
            }
        }
        session.apply(TransactionAction::Cancel);
        prop_assert_eq!(session.document(), &before);
    }

    #[test]
    fn playing_never_transports(hands in vec(points(300.0), 2..5), times in vec(0.0..4.0_f64, 1..12)) {
        let mut session = session([ArmEdit::SetTwistReference(TwistReferenceKind::Transport), ArmEdit::SetTwist(0.7)]);
        for (time, hand) in hands.iter().enumerate() {
            session.apply(PlaybackAction::SetTime(time as f64));
            session.edit_arm(ArmEdit::SetHand(*hand));
            session.apply(KeysEdit::Key(vec![channels::HAND]));
        }
        let last = *times.last().expect("one");
        let alone = session.document().at(last).arm_pose().to_owned();
        for time in times {
            session.apply(PlaybackAction::SetTime(time));
        }
        prop_assert_eq!(session.pose(), alone);
        let again = ik_arm::io::parse("a", &ik_arm::io::to_json(session.document()).expect("json"), &ik_arm::io::OpenOptions::default());
        prop_assert_eq!(again.expect("opened").document.at(last).arm_pose().to_owned(), alone);
    }

    #[test]
    fn a_hand_dragged_against_its_keys_is_posed_as_if_it_were_keyed(to in points(300.0)) {
        let mut session = session([ArmEdit::SetTwistReference(TwistReferenceKind::Transport)]);
        for (time, hand) in [(0.0, Vec3::new(200.0, 50.0, 10.0)), (2.0, Vec3::new(-20.0, 250.0, 90.0))] {
            session.apply(PlaybackAction::SetTime(time));
            session.edit_arm(ArmEdit::SetHand(hand));
            session.apply(KeysEdit::Key(vec![channels::HAND, channels::TWIST]));
        }
        session.apply(PlaybackAction::SetTime(1.0));
        let from = session.arm().cursor_in_root();
        for step in 0..=20 {
            session.edit_arm(ArmEdit::SetHand(from.lerp(to, step as f32 / 20.0)));
        }
        let dragged = session.pose();
        session.apply(KeysEdit::Key(vec![channels::HAND]));
        prop_assert_eq!(session.pose(), dragged);
        prop_assert_eq!(session.document().at(1.0).arm_pose(), dragged);
    }

    #[test]
    fn switching_between_hand_and_angles_keeps_the_pose_in_one_step(
        hand in points(400.0), twist in 0.0..6.0_f32, twist_reference in references(), pinned in any::<bool>(),
        shoulder in points(3.0), bend in -3.0..3.0_f32
    ) {
        let mut session = session([
            ArmEdit::SetHand(hand), ArmEdit::SetTwist(twist), ArmEdit::SetTwistReference(twist_reference), ArmEdit::PinHand(pinned),
        ]);
        let before = (session.document().clone(), session.pose());
        let bound = |pose: &TwoBonePose| {
            let angle = pose.elbow_angle().to_degrees();
            if (1.0..=179.0).contains(&angle) { 1e-5 } else { 5e-4 }
        };
        session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Angles));
        prop_assert_eq!(session.arm().influence, 0.0);
        prop_assert!(apart(&before.1, &session.pose()) <= bound(&before.1));
        session.apply(TransactionAction::Undo);
        prop_assert_eq!(session.document(), &before.0);
        session.apply(TransactionAction::Redo);
        session.edit_arm(ArmEdit::SetShoulder(shoulder));
        session.edit_arm(ArmEdit::SetBend(bend));
        let posed = session.pose();
        session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Hand));
        prop_assert_eq!((session.arm().influence, session.arm().is_pinned()), (1.0, pinned));
        prop_assert!(apart(&posed, &session.pose()) <= bound(&posed), "{}", apart(&posed, &session.pose()));
    }

    #[test]
    fn a_keyed_switch_blends_without_changing_lengths(
        hand in points(400.0), shoulder in points(3.0), bend in -3.0..3.0_f32
    ) {
        let mut session = session([ArmEdit::SetHand(hand)]);
        session.apply(KeysEdit::Key(vec![channels::INFLUENCE]));
        session.apply(PlaybackAction::SetTime(2.0));
        session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Angles));
        session.edit_arm(ArmEdit::SetShoulder(shoulder));
        session.edit_arm(ArmEdit::SetBend(bend));
        session.apply(KeysEdit::Key(vec![channels::INFLUENCE]));
        let bones = session.arm().bones;
        for frame in 0..=60 {
            let posed = session.document().at(f64::from(frame) / 30.0).into_document().arm();
            let pose = posed.pose();
            prop_assert!((0.0..=1.0).contains(&posed.influence));
            let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
            prop_assert!((elbow.length() - f64::from(bones.upper())).abs() < 1.5e-4);
            prop_assert!(((hand - elbow).length() - f64::from(bones.lower())).abs() < 2e-4);
        }
        prop_assert_eq!(session.document().at(0.0).into_document().arm().influence, 1.0);
        prop_assert_eq!(session.document().at(2.0).into_document().arm().influence, 0.0);
    }

    #[test]
    fn a_hand_in_world_orientation_keeps_it_at_every_position(
        angles in points(3.0), hands in vec(points(400.0), 1..8)
    ) {
        let mut session = session([ArmEdit::SetHandOrientation(angles)]);
        let before = session.posed().hand_rotation();
        session.edit_arm(ArmEdit::SetHandSpace(HandSpace::World));
        let same = |a: glam::DMat3, b: glam::DMat3| (a.x_axis.distance(b.x_axis)).max(a.y_axis.distance(b.y_axis)) < 1e-5;
        prop_assert!(same(session.posed().hand_rotation(), before));
        for hand in hands {
            session.edit_arm(ArmEdit::SetHand(hand));
            prop_assert!(same(session.posed().hand_rotation(), before));
        }
        let turned = session.posed().hand_rotation();
        session.edit_arm(ArmEdit::SetHandSpace(HandSpace::LowerLimb));
        prop_assert!(same(session.posed().hand_rotation(), turned));
    }
}
