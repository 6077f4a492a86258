//! The handles of the arm that are hidden until they are needed: those of the Root and the ring of
//! the Socket twist.

use crate::common::arm::{ArmEdit, ArmPosed, ArmSession, HandSpace, LOWER, ROOT, WRIST};
use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2, vec2};
use glam::Vec3;
use ik_arm::kinematics::skeleton::RotationAxis;
use ik_arm::session::{Drag, Grip, GripRing, PoseMode, SelectAction, TransactionAction};

use crate::bench::{Bench, bits};

const LEFT: PointerButton = PointerButton::Primary;

fn root(bench: &Bench) -> Vec3 {
    bench.session().arm().root
}

fn twist(bench: &Bench) -> f32 {
    bench.session().arm().twist
}

fn hand_in_world(bench: &Bench) -> Vec3 {
    root(bench) + bench.session().pose().hand
}

fn elbow_in_world(bench: &Bench) -> Vec3 {
    root(bench) + bench.session().pose().elbow
}

/// The point of the elbow's circle around the Pointer after a turn of the twist.
fn elbow_turned_by(bench: &Bench, radians: f32) -> Pos2 {
    let ring = GripRing::of_twist(&bench.session().posed().arm_frames()).expect("a ring");
    let turn = glam::Quat::from_axis_angle(ring.axis, radians);
    bench.on_screen(ring.centre + turn * (elbow_in_world(bench) - ring.centre))
}

/// The middle of the Root's x arrow.
fn x_arrow(bench: &Bench) -> Pos2 {
    const HALF: f32 = 40.0;
    let projection = bench.session().camera().projection(bench.viewport().aspect_ratio());
    let [right, up] = [projection.right, projection.up].map(Vec3::normalize);
    bench.on_screen(root(bench)) + HALF * vec2(Vec3::X.dot(right), -Vec3::X.dot(up))
}

#[test]
fn the_root_can_be_dragged_before_it_is_selected() {
    let mut bench = Bench::new();
    let (before, hand) = (root(&bench), bench.hand());
    let at = bench.on_screen(before);
    let to = at + vec2(35.0, -20.0);
    bench.drag(LEFT, at, to);
    assert_eq!(bench.session().history().drag().map(Drag::grip).map(is_root), Some(true));
    assert!(bench.says("Move root freely"));
    bench.release(LEFT);
    assert!(bench.on_screen(root(&bench)).distance(to) < 0.5);
    assert_eq!(bits(bench.hand()), bits(hand), "the hand comes along");
    assert_eq!(bench.session().history().undo_label(), Some("Pose joints"));
    bench.apply([TransactionAction::Undo]);
    assert_eq!(bits(root(&bench)), bits(before));
    assert_eq!(bench.session().history().undo_label(), None, "it is one step");
}

fn is_root(grip: Grip) -> bool {
    matches!(grip, Grip::Tip(ROOT, _))
}

#[test]
fn the_arrows_of_the_root_are_there_while_it_is_selected() {
    let mut bench = Bench::new();
    let arrow = x_arrow(&bench);
    bench.move_to(arrow);
    bench.press(LEFT);
    assert!(bench.session().history().drag().is_none(), "the view is dragged instead");
    bench.release(LEFT);
    let at = bench.on_screen(root(&bench));
    bench.click_at(at);
    assert_eq!(bench.session().selection().active(), Some(ROOT));
    assert_eq!(bench.session().history().undo_label(), None, "a click changes nothing");
    bench.drag_and_drop(LEFT, arrow, arrow + vec2(40.0, 10.0));
    let moved = root(&bench);
    assert!(moved.x > 5.0 && (moved.y, moved.z) == (0.0, 0.0), "{moved}");
    bench.click_at(bench.empty_point());
    assert_eq!(bench.session().selection().active(), None);
    bench.move_to(x_arrow(&bench));
    bench.press(LEFT);
    assert!(bench.session().history().drag().is_none());
}

#[test]
fn a_pinned_hand_stays_when_the_root_is_dragged() {
    let mut bench = Bench::after([ArmEdit::PinHand(true)]);
    let cursor = bench.session().arm().cursor_in_world();
    let at = bench.on_screen(root(&bench));
    bench.move_to(at);
    bench.press(LEFT);
    for step in 1..=8 {
        bench.move_to(at + vec2(6.0, -4.0) * step as f32);
        assert_eq!(bits(bench.session().arm().cursor_in_world()), bits(cursor));
        assert!(hand_in_world(&bench).distance(cursor) < 1e-3, "step {step}");
    }
    bench.release(LEFT);
    assert!(root(&bench).length() > 20.0);
}

#[test]
fn the_elbow_turns_about_the_pointer_under_the_mouse() {
    for radians in [0.3_f32, -0.6] {
        let mut bench = Bench::new();
        let (hand, pointer) = (hand_in_world(&bench), bench.session().pose().pointer.direction);
        let to = elbow_turned_by(&bench, radians);
        bench.drag(LEFT, bench.on_screen(elbow_in_world(&bench)), to);
        assert!(bench.says("Socket twist:"));
        bench.release(LEFT);
        assert!(bench.on_screen(elbow_in_world(&bench)).distance(to) < 0.5, "{radians}");
        let turned = (twist(&bench) - radians).rem_euclid(core::f32::consts::TAU);
        assert!(turned.min(core::f32::consts::TAU - turned) < 1e-2, "{turned} apart");
        assert_eq!(bits(hand_in_world(&bench)), bits(hand));
        assert_eq!(bench.session().pose().pointer.direction, pointer);
        assert_eq!(bench.session().history().undo_label(), Some("Set Socket twist"));
        bench.apply([TransactionAction::Undo]);
        assert_eq!((twist(&bench), bench.session().history().undo_label()), (0.0, None));
    }
}

#[test]
fn the_ring_of_the_selected_elbow_can_be_dragged_anywhere_on_its_near_half() {
    let mut bench = Bench::new();
    let elbow = bench.on_screen(elbow_in_world(&bench));
    let side = if is_near(&bench, 1.2) { 1.0 } else { -1.0 };
    let [from, to] = [1.2, 1.5].map(|radians| elbow_turned_by(&bench, side * radians));
    bench.drag_and_drop(LEFT, from, to);
    assert_eq!(twist(&bench), 0.0, "the ring is hidden");
    bench.apply([ik_arm::session::ViewAction::SetCamera(Default::default())]);
    bench.click_at(elbow);
    assert_eq!(bench.session().selection().active(), Some(LOWER));
    bench.drag_and_drop(LEFT, from, to);
    let turned = twist(&bench).to_degrees();
    let turned = turned.min(360.0 - turned);
    assert!((turned - 0.3_f32.to_degrees()).abs() < 1.0, "{turned}");
}

fn is_near(bench: &Bench, radians: f32) -> bool {
    let ring = GripRing::of_twist(&bench.session().posed().arm_frames()).expect("a ring");
    let forward = bench.session().camera().projection(1.0).forward;
    let turn = glam::Quat::from_axis_angle(ring.axis, radians);
    (turn * (elbow_in_world(bench) - ring.centre)).dot(forward) < 0.0
}

#[test]
fn ctrl_snaps_the_twist_shift_is_precise_and_escape_cancels() {
    let mut bench = Bench::new();
    let elbow = bench.on_screen(elbow_in_world(&bench));
    let to = elbow_turned_by(&bench, 0.41);
    bench.drag(LEFT, elbow, elbow);
    bench.hold(Modifiers::COMMAND | Modifiers::CTRL);
    bench.move_to(to);
    bench.release(LEFT);
    assert!((twist(&bench).to_degrees() - 25.0).abs() < 1e-3, "{}", twist(&bench).to_degrees());
    bench.hold(Modifiers::NONE);
    bench.apply([TransactionAction::Undo]);
    bench.drag(LEFT, elbow, elbow);
    bench.hold(Modifiers::SHIFT);
    bench.move_to(to);
    bench.release(LEFT);
    assert!((twist(&bench) - 0.041).abs() < 5e-3, "{}", twist(&bench));
    bench.hold(Modifiers::NONE);
    bench.apply([TransactionAction::Undo]);
    bench.drag(LEFT, elbow, to);
    assert_ne!(twist(&bench), 0.0);
    bench.key(Key::Escape);
    bench.release(LEFT);
    assert_eq!((twist(&bench), bench.session().history().undo_label()), (0.0, None));
}

#[test]
fn there_is_no_ring_in_fk_nor_around_a_straight_arm() {
    for actions in [
        vec![ArmEdit::SwitchPoseMode(PoseMode::Angles)],
        vec![ArmEdit::SetHand(Vec3::new(499.9, 0.0, 0.0))],
    ] {
        let mut bench = Bench::after(actions);
        let before = bench.session().arm();
        let elbow = bench.on_screen(elbow_in_world(&bench));
        bench.move_to(elbow);
        bench.press(LEFT);
        assert_ne!(bench.session().history().drag().map(Drag::grip), Some(Grip::LimbTwist(LOWER)));
        bench.release(LEFT);
        assert_eq!(bench.session().arm().twist, before.twist);
    }
}

#[test]
fn hidden_handles_say_what_they_do() {
    let mut bench = Bench::new();
    for (at, hint) in [
        (root(&bench), "Move the Root; click to show its arrows"),
        (elbow_in_world(&bench), "Turn the elbow about the Pointer (Socket twist)"),
    ] {
        assert!(!bench.says(hint));
        bench.move_to(bench.on_screen(at));
        bench.wait(1.0);
        assert!(bench.says(hint), "{hint}");
        bench.click_at(bench.on_screen(at));
        bench.wait(1.0);
        assert!(!bench.says(hint), "its handles are shown: {hint}");
    }
    assert!(bench.shows(Role::CheckBox, "Pinned to world"));
}

#[test]
fn a_click_on_the_hand_shows_rings_that_turn_it() {
    const RING: f32 = 104.0;
    for space in [HandSpace::LowerLimb, HandSpace::World] {
        for axis in RotationAxis::ALL {
            let mut bench = Bench::after([
                ArmEdit::SetHandOrientation(Vec3::new(0.3, 0.2, -0.25)),
                ArmEdit::SetHandSpace(space),
            ]);
            let (grip, ring) = match space {
                HandSpace::LowerLimb => (
                    Grip::Ring(WRIST, axis),
                    GripRing::of_joint(bench.session().posed(), WRIST, axis),
                ),
                HandSpace::World => (
                    Grip::Orientation(LOWER, axis),
                    GripRing::of_orientation(bench.session().posed(), LOWER, axis),
                ),
            };
            let ring = ring.expect("a ring");
            let angles = |bench: &Bench| {
                let rig = bench.session().rig();
                let kept = rig.targets[0].orientation;
                kept.unwrap_or(rig.skeleton[WRIST].rotation)
            };
            let old = angles(&bench);
            let on_ring = bench.around(ring, RING);
            for at in on_ring.into_iter().step_by(7) {
                bench.move_to(at);
                bench.press(LEFT);
                assert_ne!(
                    bench.session().history().drag().map(Drag::grip),
                    Some(grip),
                    "it is hidden"
                );
                bench.key(Key::Escape);
                bench.release(LEFT);
                bench.apply([SelectAction::Joints(Vec::new())]);
            }
            bench.apply([ik_arm::session::ViewAction::SetCamera(Default::default())]);
            bench.click_at(bench.cursor_on_screen());
            assert_eq!(bench.session().selection().active(), Some(WRIST));
            let turned = |bench: &Bench| bench.session().posed().hand_rotation();
            let was = turned(&bench);
            let to = bench.take_ring(grip, ring, RING, 0.3);
            bench.move_to(to);
            let now = angles(&bench);
            assert!((now[axis.index()] - old[axis.index()] - 0.3).abs() < 5e-3, "{now} was {old}");
            for other in (0..3).filter(|other| *other != axis.index()) {
                assert_eq!(now[other].to_bits(), old[other].to_bits());
            }
            let turn = glam::DMat3::from_axis_angle(ring.axis.as_dvec3(), 0.3);
            let apart = (turn * was - turned(&bench)).to_cols_array();
            assert!(apart.iter().all(|apart| apart.abs() < 5e-3), "{space:?} {axis}");
            bench.release(LEFT);
            bench.apply([TransactionAction::Undo]);
            assert_eq!(angles(&bench), old);
            assert_eq!(bench.session().selection().active(), Some(WRIST));
            bench.click_at(bench.empty_point());
            assert_eq!(bench.session().selection().active(), None);
        }
    }
}
