//! Particular poses and former bugs.

use crate::common::arm::{Arm, ArmEdit, ArmPosed, ArmSession, Cursor, LOWER, Step, UPPER};
use std::f64::consts::PI;

use glam::{DQuat, DVec3, Vec3};
use ik_arm::document::TwistReferenceKind;
use ik_arm::kinematics::skeleton::RotationAxis;
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::kinematics::two_bone::TwoBone;
use ik_arm::session::{
    DragInput, Grip, GripRing, JointEdit, PointHandle, PoseMode, Session, TransactionAction,
    ViewAction,
};

use crate::posing::*;

#[test]
fn the_root_of_a_leaning_body_keeps_a_pinned_hand_on_the_table() {
    // A hand on the edge of a table, and a body that leans.
    let mut session =
        session([ArmEdit::SetHand(Vec3::new(300.0, 0.0, 100.0)), ArmEdit::PinHand(true)]);
    session.edit_arm(ArmEdit::SetRoot(Vec3::new(50.0, 120.0, -30.0)));
    let (arm, pose) = (session.arm(), session.pose());
    assert_eq!(arm.cursor, Cursor::pinned(Vec3::new(300.0, 0.0, 100.0)));
    assert!((arm.root + pose.hand).distance(Vec3::new(300.0, 0.0, 100.0)) < 2e-4);
}

#[test]
fn a_transported_elbow_comes_back_turned_by_the_solid_angle_of_its_path() {
    // An octant of the sphere: a quarter turn.
    let mut session = session([
        Step::from(ArmEdit::SetTwistReference(TwistReferenceKind::Transport)),
        ArmEdit::SetHand(Vec3::X * 300.0).into(),
        ViewAction::ResetTransport.into(),
    ]);
    let before = session.pose().outward();
    let corners = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::X];
    for ends in corners.windows(2) {
        for step in 1..=90 {
            let angle = (step as f32).to_radians();
            let hand = ends[0] * angle.cos() + ends[1] * angle.sin();
            session.edit_arm(ArmEdit::SetHand(hand * 300.0));
        }
    }
    let holonomy = f64::from(session.evaluated().transport_path().expect("a limb").holonomy());
    assert!((holonomy - PI / 2.0).abs() < 1e-4, "{holonomy}");
    let turned =
        before.cross(session.pose().outward()).x.atan2(before.dot(session.pose().outward()));
    assert!((f64::from(turned) - PI / 2.0).abs() < 1e-4, "{turned}");
}

#[test]
fn a_forearm_rolls_beyond_half_a_turn() {
    let mut session = Session::default();
    for step in 1..=30 {
        let roll = step as f32 * 0.3;
        session.edit_arm(ArmEdit::SetHandOrientation(Vec3::X * roll));
        let found = session.posed().roll();
        assert!((found - roll).abs() < 1e-4, "{found} is not {roll}");
    }
    let opened = ik_arm::io::parse(
        "a",
        &ik_arm::io::to_json(session.document()).expect("json"),
        &ik_arm::io::OpenOptions::default(),
    );
    let roll = opened.expect("opened").document.at(0.0).roll();
    assert!((roll - 9.0).abs() < 1e-4, "its turns are kept in the file");
}

#[test]
fn a_soft_arm_keeps_its_pose_when_switched_to_fk() {
    let soft = SoftReach::new(0.3, 1.0, 0.0).expect("a softening");
    for hand in [Vec3::new(470.0, 100.0, 40.0), Vec3::new(90.0, 60.0, 10.0)] {
        let mut session = session([ArmEdit::SetSoftReach(soft), ArmEdit::SetHand(hand)]);
        let before = session.pose();
        assert!(before.hand.distance(hand) > 1.0, "it is softened");
        session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Angles));
        session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Hand));
        assert!(apart(&before, &session.pose()) < 1e-4);
        assert!(session.shell().message().is_none());
    }
}

#[test]
fn a_stretched_arm_keeps_its_length_in_fk() {
    let stretch = SoftReach::new(0.0, 2.0, 0.0).expect("a softening");
    let mut session = session([ArmEdit::SetSoftReach(stretch), ArmEdit::SetHand(Vec3::X * 750.0)]);
    assert_eq!(session.pose().stretch, 1.5);
    let before = session.pose();
    session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Angles));
    assert!(apart(&before, &session.pose()) < 1e-5);
    session.edit_arm(ArmEdit::SetInfluence(0.5));
    assert!((session.pose().hand.length() - 750.0).abs() < 1e-2);
}

#[test]
fn a_pole_is_dragged_and_the_elbow_follows() {
    let mut session =
        session([ArmEdit::SetTwistReference(TwistReferenceKind::Pole), ArmEdit::SetTwist(0.0)]);
    let projection = session.camera().projection(1.0);
    let ray = projection.ray(projection.project(session.arm().pole).expect("seen"));
    let forward = projection.forward;
    session.apply(TransactionAction::Grab {
        grip: Grip::LimbPole(LOWER, PointHandle::Free),
        ray,
        forward,
    });
    let to = projection.ray(glam::Vec2::new(0.2, -0.3));
    session.apply(TransactionAction::Drag(DragInput { ray: to, precise: false, snap: false }));
    session.apply(TransactionAction::Commit);
    assert_eq!(session.history().undo_label(), Some("Move pole"));
    let (arm, pose) = (session.arm(), session.pose());
    let aside =
        (arm.pole - pose.pointer.direction * arm.pole.dot(pose.pointer.direction)).normalize();
    assert!(aside.distance(pose.outward()) < 1e-5, "the elbow points at the pole");
}

#[test]
fn a_ring_turns_its_own_angle_in_fk() {
    let mut session = session([ArmEdit::SwitchPoseMode(PoseMode::Angles)]);
    let rings = RotationAxis::ALL.map(|axis| (UPPER, axis));
    for (joint, axis) in rings.into_iter().chain([(LOWER, RotationAxis::Z)]) {
        let ring = GripRing::of_joint(session.posed(), joint, axis).expect("a ring");
        let mut rotation = session.skeleton()[joint].rotation;
        let forearm = |session: &Session| (session.pose().hand - session.pose().elbow).as_dvec3();
        let limb = |session: &Session| session.pose().elbow.as_dvec3();
        let (before, was) = (limb(&session), forearm(&session));
        rotation[axis.index()] += 0.2;
        session.apply(JointEdit::SetRotation { joint, rotation });
        // The angle is a right-handed rotation about the ring's axis.
        let turn = DQuat::from_axis_angle(ring.axis.as_dvec3().normalize(), 0.2);
        assert!((turn * was).distance(forearm(&session)) < 1e-3, "{joint} {axis}");
        let upper = if joint == LOWER { before } else { turn * before };
        assert!(upper.distance(limb(&session)) < 1e-3, "{joint} {axis}");
    }
    session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Hand));
    assert!(GripRing::of_joint(session.posed(), LOWER, RotationAxis::Z).is_none());
}

#[test]
fn a_hand_pinned_where_numbers_overflow_stays_finite() {
    let far = Vec3::X * 3e38;
    let session = session([ArmEdit::SetRoot(far), ArmEdit::SetHand(far), ArmEdit::PinHand(true)]);
    let pose = session.skeleton_pose();
    assert!(pose.ids().all(|joint| pose.tip(joint).is_finite()));
    assert!(ik_arm::io::to_json(session.document()).is_ok());
}

#[test]
fn a_click_on_the_hand_leaves_the_document_unchanged() {
    for twist_reference in TwistReferenceKind::ALL {
        for hand in [Vec3::new(250.0, 120.0, 60.0), Vec3::new(-90.0, 210.0, 33.3)] {
            let mut session =
                session([ArmEdit::SetTwistReference(twist_reference), ArmEdit::SetHand(hand)]);
            let (before, undo) = (session.document().clone(), session.history().undo_label());
            let projection = session.camera().projection(1.0);
            let ray = projection.ray(projection.project(hand).expect("seen"));
            let forward = projection.forward;
            session.apply(TransactionAction::Grab {
                grip: Grip::Target(LOWER, PointHandle::Free),
                ray,
                forward,
            });
            session.apply(TransactionAction::Drag(DragInput { ray, precise: false, snap: false }));
            session.apply(TransactionAction::Commit);
            assert_eq!(session.document(), &before);
            assert_eq!(session.history().undo_label(), undo);
        }
    }
}

#[test]
fn limits_scale_with_the_arm_in_fk() {
    let bones = TwoBone::new(0.001, 0.002).expect("lengths");
    let arm = Arm { bones, cursor: Cursor::unpinned(Vec3::Y * 0.0025), ..Arm::default() };
    let mut session = Session::with_document(Default::default(), arm.document());
    session.edit_arm(ArmEdit::SwitchPoseMode(PoseMode::Angles));
    let pose = session.pose();
    assert!(
        (pose.hand.length() - 0.0025).abs() < 1e-8 && DVec3::Y.dot(pose.hand.as_dvec3()) > 0.0024
    );
}
