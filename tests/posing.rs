//! An arm in a session: pinned, measured from elsewhere, led by its angles, its hand turned, in time.
#![cfg(feature = "document")]

use std::f64::consts::PI;

use glam::{DQuat, DVec3, Vec3};
use ik_arm::document::{Arm, Channel, Document, Goal, Space, Swivel};
use ik_arm::kinematics::reach::Softening;
use ik_arm::kinematics::two_bone::{Pose, TwoBone};
use ik_arm::session::{Action, DragInput, Grip, Handle, Lead, Session};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(0x0b0d_01e5),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn points(size: f32) -> impl Strategy<Value = Vec3> {
    [-size..size, -size..size, -size..size].prop_map(Vec3::from_array)
}

fn swivels() -> impl Strategy<Value = Swivel> {
    (0..Swivel::ALL.len()).prop_map(|index| Swivel::ALL[index])
}

fn session(actions: impl IntoIterator<Item = Action>) -> Session {
    let mut session = Session::default();
    for action in actions {
        session.apply(action);
    }
    session
}

fn bits(point: Vec3) -> [u32; 3] {
    point.to_array().map(f32::to_bits)
}

/// In f64, and exact for small angles, which the arc cosine is not.
fn angle(a: Vec3, b: Vec3) -> f64 {
    let [a, b] = [a, b].map(Vec3::as_dvec3);
    a.cross(b).length().atan2(a.dot(b))
}

/// How far elbow and hand of two poses are apart, in parts of the seed's arm.
fn apart(a: &Pose, b: &Pose) -> f32 {
    a.elbow.distance(b.elbow).max(a.hand.distance(b.hand)) / 500.0
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn a_pinned_hand_stays_where_it_is_to_the_last_bit_however_the_root_moves(
        hand in points(300.0), roots in vec(points(400.0), 1..8), swivel in swivels()
    ) {
        let mut session = session([
            Action::SetSwivel(swivel), Action::SetHand(hand), Action::SetRoot(roots[0]),
        ]);
        let before = session.arm().cursor_world();
        session.apply(Action::PinHand(true));
        prop_assert_eq!(bits(session.arm().cursor_world()), bits(before));
        for root in roots {
            session.apply(Action::SetRoot(root));
            let (arm, pose) = (session.arm(), session.pose());
            prop_assert_eq!(bits(arm.cursor_world()), bits(before));
            let asked = before.as_dvec3() - root.as_dvec3();
            if (100.1..499.9).contains(&asked.length()) {
                let missed = asked.distance(pose.hand.as_dvec3());
                let ulps = 2.0 * f64::from(f32::EPSILON) * f64::from(before.abs().max(root.abs()).max_element());
                prop_assert!(missed <= 3e-7 * 500.0 + ulps, "off by {}", missed);
            }
        }
        let (world, pose) = (session.arm().cursor_world(), *session.pose());
        session.apply(Action::PinHand(false));
        prop_assert!(world.distance(session.arm().cursor_world()) < 1e-3);
        prop_assert!(apart(&pose, session.pose()) < 1e-3);
    }

    #[test]
    fn measured_from_elsewhere_the_elbow_stays(
        hand in points(300.0), spin in 0.0..6.0_f32, swivels in vec(swivels(), 1..6), pole in points(300.0)
    ) {
        let mut session =
            session([Action::SetHand(hand), Action::SetElbowSpin(spin), Action::SetPole(pole)]);
        let pose = *session.pose();
        for swivel in swivels {
            session.apply(Action::SetSwivel(swivel));
            prop_assert_eq!(session.arm().swivel, swivel);
            prop_assert!(apart(&pose, session.pose()) < 1e-5, "{:?}", apart(&pose, session.pose()));
        }
    }

    #[test]
    fn measured_from_elsewhere_the_elbow_stays_at_every_key(
        hands in vec(points(300.0), 2..5), spins in vec(0.0..6.0_f32, 5), to in vec(swivels(), 1..4)
    ) {
        let mut session = Session::default();
        for (index, hand) in hands.iter().enumerate() {
            session.apply(Action::SetTime(index as f64));
            session.apply(Action::SetHand(*hand));
            session.apply(Action::SetElbowSpin(spins[index]));
            session.apply(Action::Key(vec![Channel::Hand, Channel::ElbowSpin]));
        }
        let poses: Vec<_> =
            (0..hands.len()).map(|time| session.document().at(time as f64).arm.pose()).collect();
        for swivel in to {
            session.apply(Action::SetSwivel(swivel));
            for (time, pose) in poses.iter().enumerate() {
                let now = session.document().at(time as f64).arm.pose();
                prop_assert!(apart(pose, &now) < 2e-5, "{} at {} with {:?}", apart(pose, &now), time, swivel);
            }
        }
    }

    #[test]
    fn what_is_carried_along_does_not_pop_and_is_taken_back_with_the_drag(
        hands in vec(points(300.0), 2..40)
    ) {
        let mut session = session([Action::SetSwivel(Swivel::Transport), Action::SetHand(hands[0])]);
        let before = session.document().clone();
        session.apply(Action::BeginEdit);
        for ends in hands.windows(2) {
            for step in 1..=20 {
                let was = *session.pose();
                session.apply(Action::SetHand(ends[0].lerp(ends[1], step as f32 / 20.0)));
                let now = *session.pose();
                let [from, to] = [was, now].map(|pose| pose.outward().as_dvec3());
                let [w0, w1] = [was, now].map(|pose| pose.facing.direction.as_dvec3());
                // Carried by the least turn, in f64.
                let turn = DQuat::from_rotation_arc(w0.normalize(), w1.normalize());
                prop_assert!(w0.dot(w1) < -0.999 || (turn * from).distance(to) < 2e-5);
            }
        }
        session.apply(Action::CancelEdit);
        prop_assert_eq!(session.document(), &before);
    }

    #[test]
    fn playing_never_transports(hands in vec(points(300.0), 2..5), times in vec(0.0..4.0_f64, 1..12)) {
        let mut session = session([Action::SetSwivel(Swivel::Transport), Action::SetElbowSpin(0.7)]);
        for (time, hand) in hands.iter().enumerate() {
            session.apply(Action::SetTime(time as f64));
            session.apply(Action::SetHand(*hand));
            session.apply(Action::Key(vec![Channel::Hand]));
        }
        let last = *times.last().expect("one");
        let alone = session.document().at(last).arm.pose();
        for time in times {
            session.apply(Action::SetTime(time));
        }
        prop_assert_eq!(*session.pose(), alone);
        let again = ik_arm::io::parse("a", &ik_arm::io::to_json(session.document()).expect("json"), None);
        prop_assert_eq!(again.expect("opened").document.at(last).arm.pose(), alone);
    }

    #[test]
    fn a_hand_dragged_against_its_keys_does_not_pop(to in points(300.0)) {
        let mut session = session([Action::SetSwivel(Swivel::Transport)]);
        for (time, hand) in [(0.0, Vec3::new(200.0, 50.0, 10.0)), (2.0, Vec3::new(-20.0, 250.0, 90.0))] {
            session.apply(Action::SetTime(time));
            session.apply(Action::SetHand(hand));
            session.apply(Action::Key(vec![Channel::Hand, Channel::ElbowSpin]));
        }
        session.apply(Action::SetTime(1.0));
        let from = session.arm().cursor();
        for step in 0..=200 {
            let was = *session.pose();
            session.apply(Action::SetHand(from.lerp(to, step as f32 / 200.0)));
            let now = *session.pose();
            let turned = angle(was.facing.direction, now.facing.direction);
            let swung = angle(was.outward(), now.outward());
            prop_assert!(swung <= turned * 1.01 + 1e-5, "swung {} for {}", swung, turned);
        }
    }

    #[test]
    fn switching_between_hand_and_angles_keeps_the_pose_in_one_step(
        hand in points(400.0), spin in 0.0..6.0_f32, swivel in swivels(), pinned in any::<bool>(),
        shoulder in points(3.0), bend in -3.0..3.0_f32
    ) {
        let mut session = session([
            Action::SetHand(hand), Action::SetElbowSpin(spin), Action::SetSwivel(swivel), Action::PinHand(pinned),
        ]);
        let before = (session.document().clone(), *session.pose());
        let bound = |pose: &Pose| {
            let angle = pose.elbow_angle().to_degrees();
            if (1.0..=179.0).contains(&angle) { 1.2e-5 } else { 5e-4 }
        };
        session.apply(Action::SwitchTo(Lead::Angles));
        prop_assert_eq!(session.arm().weight, 0.0);
        prop_assert!(apart(&before.1, session.pose()) <= bound(&before.1));
        session.apply(Action::Undo);
        prop_assert_eq!(session.document(), &before.0);
        session.apply(Action::Redo);
        session.apply(Action::SetShoulder(shoulder));
        session.apply(Action::SetBend(bend));
        let posed = *session.pose();
        session.apply(Action::SwitchTo(Lead::Hand));
        prop_assert_eq!((session.arm().weight, session.arm().is_pinned()), (1.0, pinned));
        prop_assert!(apart(&posed, session.pose()) <= bound(&posed), "{}", apart(&posed, session.pose()));
    }

    #[test]
    fn a_keyed_switch_blends_without_changing_lengths(
        hand in points(400.0), shoulder in points(3.0), bend in -3.0..3.0_f32
    ) {
        let mut session = session([Action::SetHand(hand)]);
        session.apply(Action::Key(vec![Channel::Weight]));
        session.apply(Action::SetTime(2.0));
        session.apply(Action::SwitchTo(Lead::Angles));
        session.apply(Action::SetShoulder(shoulder));
        session.apply(Action::SetBend(bend));
        session.apply(Action::Key(vec![Channel::Weight]));
        let bones = session.arm().bones;
        for frame in 0..=60 {
            let posed = session.document().at(f64::from(frame) / 30.0).arm;
            let pose = posed.pose();
            prop_assert!((0.0..=1.0).contains(&posed.weight));
            let [elbow, hand] = [pose.elbow, pose.hand].map(Vec3::as_dvec3);
            prop_assert!((elbow.length() - f64::from(bones.upper())).abs() < 1.5e-4);
            prop_assert!(((hand - elbow).length() - f64::from(bones.lower())).abs() < 2e-4);
        }
        prop_assert_eq!(session.document().at(0.0).arm.weight, 1.0);
        prop_assert_eq!(session.document().at(2.0).arm.weight, 0.0);
    }

    #[test]
    fn a_hand_that_keeps_its_orientation_has_it_wherever_it_goes(
        angles in points(3.0), hands in vec(points(400.0), 1..8)
    ) {
        let mut session = session([Action::SetWrist(angles)]);
        let before = session.arm().hand_rotation(session.pose());
        session.apply(Action::SetWristSpace(Space::World));
        let same = |a: glam::DMat3, b: glam::DMat3| (a.x_axis.distance(b.x_axis)).max(a.y_axis.distance(b.y_axis)) < 1e-5;
        prop_assert!(same(session.arm().hand_rotation(session.pose()), before));
        for hand in hands {
            session.apply(Action::SetHand(hand));
            prop_assert!(same(session.arm().hand_rotation(session.pose()), before));
        }
        let turned = session.arm().hand_rotation(session.pose());
        session.apply(Action::SetWristSpace(Space::Lower));
        prop_assert!(same(session.arm().hand_rotation(session.pose()), turned));
    }
}

#[test]
fn a_root_is_where_the_hand_reaches_on_a_table_from() {
    // The case of the seed's analysis: a hand on the edge of a table, and a body that leans.
    let mut session =
        session([Action::SetHand(Vec3::new(300.0, 0.0, 100.0)), Action::PinHand(true)]);
    session.apply(Action::SetRoot(Vec3::new(50.0, 120.0, -30.0)));
    let (arm, pose) = (session.arm(), session.pose());
    assert_eq!(arm.goal, Goal::World(Vec3::new(300.0, 0.0, 100.0)));
    assert!((arm.root + pose.hand).distance(Vec3::new(300.0, 0.0, 100.0)) < 2e-4);
}

#[test]
fn a_carried_elbow_comes_back_turned_by_the_solid_angle_of_its_way() {
    // An octant of the sphere: a quarter turn.
    let mut session = session([
        Action::SetSwivel(Swivel::Transport),
        Action::SetHand(Vec3::X * 300.0),
        Action::StartJourney,
    ]);
    let before = session.pose().outward();
    let corners = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::X];
    for ends in corners.windows(2) {
        for step in 1..=90 {
            let angle = (step as f32).to_radians();
            let hand = ends[0] * angle.cos() + ends[1] * angle.sin();
            session.apply(Action::SetHand(hand * 300.0));
        }
    }
    let holonomy = f64::from(session.journey().holonomy());
    assert!((holonomy - PI / 2.0).abs() < 1e-4, "{holonomy}");
    let turned =
        before.cross(session.pose().outward()).x.atan2(before.dot(session.pose().outward()));
    assert!((f64::from(turned) - PI / 2.0).abs() < 1e-4, "{turned}");
}

#[test]
fn a_forearm_rolls_on_past_half_a_turn() {
    let mut session = Session::default();
    for step in 1..=30 {
        let roll = step as f32 * 0.3;
        session.apply(Action::SetWrist(Vec3::X * roll));
        let found = session.arm().roll(session.pose());
        assert!((found - roll).abs() < 1e-4, "{found} is not {roll}");
    }
    let opened =
        ik_arm::io::parse("a", &ik_arm::io::to_json(session.document()).expect("json"), None);
    let arm = opened.expect("opened").document.arm;
    assert!((arm.roll(&arm.pose()) - 9.0).abs() < 1e-4, "its turns are kept in the file");
}

#[test]
fn a_soft_arm_that_is_led_by_its_angles_keeps_its_pose_too() {
    let soft = Softening::new(0.3, 1.0, 0.0).expect("a softening");
    for hand in [Vec3::new(470.0, 100.0, 40.0), Vec3::new(90.0, 60.0, 10.0)] {
        let mut session = session([Action::SetSoftening(soft), Action::SetHand(hand)]);
        let before = *session.pose();
        assert!(before.hand.distance(hand) > 1.0, "it is softened");
        session.apply(Action::SwitchTo(Lead::Angles));
        session.apply(Action::SwitchTo(Lead::Hand));
        assert!(apart(&before, session.pose()) < 1e-4);
        assert!(session.message().is_none());
    }
}

#[test]
fn a_stretched_arm_keeps_its_length_when_its_angles_lead() {
    let stretch = Softening::new(0.0, 2.0, 0.0).expect("a softening");
    let mut session = session([Action::SetSoftening(stretch), Action::SetHand(Vec3::X * 750.0)]);
    assert_eq!(session.pose().stretch, 1.5);
    let before = *session.pose();
    session.apply(Action::SwitchTo(Lead::Angles));
    assert!(apart(&before, session.pose()) < 1e-5);
    session.apply(Action::SetWeight(0.5));
    assert!((session.pose().hand.length() - 750.0).abs() < 1e-2);
}

#[test]
fn a_pole_is_dragged_and_the_elbow_follows() {
    let mut session = session([Action::SetSwivel(Swivel::Pole), Action::SetElbowSpin(0.0)]);
    let projection = session.camera().projection(1.0);
    let ray = projection.ray(projection.project(session.arm().pole).expect("seen"));
    let forward = projection.forward;
    session.apply(Action::Grab { grip: Grip::Pole(Handle::Free), ray, forward });
    let to = projection.ray(glam::Vec2::new(0.2, -0.3));
    session.apply(Action::Drag(DragInput { ray: to, precise: false, snap: false }));
    session.apply(Action::CommitEdit);
    assert_eq!(session.undo_name(), Some("move pole"));
    let (arm, pose) = (session.arm(), session.pose());
    let aside =
        (arm.pole - pose.facing.direction * arm.pole.dot(pose.facing.direction)).normalize();
    assert!(aside.distance(pose.outward()) < 1e-5, "the elbow points at the pole");
}

#[test]
fn a_ring_turns_the_angle_that_it_is_of_while_the_angles_lead() {
    let mut session = session([Action::SwitchTo(Lead::Angles)]);
    for grip in [Grip::Shoulder(0), Grip::Shoulder(1), Grip::Shoulder(2), Grip::Bend] {
        let ring = session.arm_ring(grip).expect("a ring");
        let fk = session.arm().fk;
        let forearm = |session: &Session| (session.pose().hand - session.pose().elbow).as_dvec3();
        let limb = |session: &Session| session.pose().elbow.as_dvec3();
        let (before, was) = (limb(&session), forearm(&session));
        match grip {
            Grip::Shoulder(axis) => {
                let mut angles = fk.shoulder;
                angles[axis] += 0.2;
                session.apply(Action::SetShoulder(angles));
            }
            _ => {
                session.apply(Action::SetBend(fk.bend + 0.2));
            }
        }
        // What the angle does is a right-handed turn about the ring.
        let turn = DQuat::from_axis_angle(ring.axis.as_dvec3().normalize(), 0.2);
        assert!((turn * was).distance(forearm(&session)) < 1e-3, "{grip:?}");
        let upper = if grip == Grip::Bend { before } else { turn * before };
        assert!(upper.distance(limb(&session)) < 1e-3, "{grip:?}");
    }
    session.apply(Action::SwitchTo(Lead::Hand));
    assert!(session.arm_ring(Grip::Bend).is_none());
}

#[test]
fn hand_keys_rest_while_the_hand_is_pinned() {
    let mut session = Session::default();
    for (time, hand) in [(0.0, Vec3::X * 200.0), (1.0, Vec3::Y * 200.0)] {
        session.apply(Action::SetTime(time));
        session.apply(Action::SetHand(hand));
        session.apply(Action::Key(vec![Channel::Hand]));
    }
    session.apply(Action::PinHand(true));
    session.apply(Action::SetTime(0.5));
    assert_eq!(session.arm().cursor(), Vec3::Y * 200.0);
    session.apply(Action::PinHand(false));
    assert_eq!(session.arm().cursor(), Vec3::Y * 200.0, "it stays until the time changes");
    session.apply(Action::SetTime(0.0));
    assert_eq!(session.arm().cursor(), Vec3::X * 200.0);
}

#[test]
fn an_arm_of_any_size_has_its_own_limits_when_it_is_led() {
    let bones = TwoBone::new(0.001, 0.002).expect("lengths");
    let arm = Arm { bones, goal: Goal::Root(Vec3::Y * 0.0025), ..Arm::default() };
    let document = Document { arm: arm.settled().led_by_angles(), ..Document::default() };
    let pose = document.arm.pose();
    assert!(
        (pose.hand.length() - 0.0025).abs() < 1e-8 && DVec3::Y.dot(pose.hand.as_dvec3()) > 0.0024
    );
}
