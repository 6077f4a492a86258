//! Posing the arm: FK, pinned hand, twist references.

use crate::common::arm::{ArmEdit, ArmSession, HandSpace, LOWER, Step, UPPER, channels};
use egui::accesskit::Role;
use egui::{PointerButton, Pos2, vec2};
use egui_kittest::SnapshotResults;
use glam::Vec3;
use ik_arm::document::{Channel, Overlay, Theme, TwistReferenceKind};
use ik_arm::kinematics::skeleton::RotationAxis;
use ik_arm::kinematics::two_bone::TwoBonePose;
use ik_arm::session::{
    Grip, GripRing, PanelTab, PoseMode, ShellAction, TransactionAction, ViewAction,
};

use crate::bench::{Bench, LARGE, bits, snapshot_options};
use crate::looks::has_tooltip;

const LEFT: PointerButton = PointerButton::Primary;

fn apart(a: &TwoBonePose, b: &TwoBonePose) -> f32 {
    a.elbow.distance(b.elbow).max(a.hand.distance(b.hand))
}

/// Chooses from the list beside a name.
fn pick(bench: &mut Bench, list: &str, item: &str) {
    bench.click(Role::ComboBox, list);
    bench.click(Role::Button, item);
}

/// With the sections of the angles unfolded.
fn posing(actions: impl IntoIterator<Item = impl Into<Step>>) -> Bench {
    let mut bench = Bench::after(actions);
    bench.toggle(&["FK and IK", "Lengths", "Root"]);
    bench
}

fn pole_place(bench: &Bench) -> Pos2 {
    let arm = bench.session().arm();
    bench.on_screen(arm.root + arm.pole)
}

#[test]
fn switching_between_fk_and_ik_keeps_the_pose() {
    let mut bench = posing([ArmEdit::SetHand(Vec3::new(200.0, 180.0, -90.0))]);
    let pose = bench.session().pose();
    assert!(!bench.shows(Role::Slider, "Elbow bend"));
    bench.click(Role::Button, "FK");
    assert_eq!(bench.session().arm().influence, 0.0);
    assert!(apart(&pose, &bench.session().pose()) < 5e-3);
    assert!(
        bench.says("Limb · FK (joint angles → hand)")
            && bench.says("FK (joint angles → hand): the angles place the hand.")
    );
    bench.enter("Elbow bend", "60");
    assert!((bench.session().pose().elbow_angle().to_degrees() - 120.0).abs() < 0.01);
    bench.enter("Shoulder yaw", "0");
    bench.enter("Shoulder pitch", "0");
    bench.enter("Shoulder roll", "0");
    let elbow = bench.session().pose().elbow;
    assert!(elbow.distance(Vec3::X * 200.0) < 1e-3, "{elbow}");
    let pose = bench.session().pose();
    bench.click(Role::Button, "IK");
    assert!(apart(&pose, &bench.session().pose()) < 5e-3);
    assert_eq!(bench.session().history().undo_label(), Some("Switch to IK"));
    assert!(!bench.shows(Role::Slider, "Elbow bend"));
}

#[test]
fn ik_settings_are_disabled_in_fk() {
    let mut bench = posing([ArmEdit::SwitchPoseMode(PoseMode::Angles)]);
    let before = bench.hand();
    let rail = bench.rect(Role::Slider, "Hand x");
    bench.drag_and_drop(LEFT, rail.center(), rail.right_center());
    assert_eq!(bits(bench.hand()), bits(before));
    let cursor = bench.cursor_on_screen();
    bench.drag_and_drop(LEFT, cursor, cursor + vec2(40.0, 0.0));
    assert_eq!(bits(bench.hand()), bits(before));
}

#[test]
fn between_fk_and_ik_the_arm_is_between_its_poses() {
    let mut bench = posing([ArmEdit::SwitchPoseMode(PoseMode::Angles), ArmEdit::SetBend(0.5)]);
    let angles = bench.session().pose().elbow_angle();
    bench.enter("IK influence", "1");
    let hand = bench.session().pose().elbow_angle();
    bench.enter("IK influence", "0.5");
    let between = bench.session().pose().elbow_angle();
    assert!((between - 0.5 * (angles + hand)).abs() < 1e-4);
    assert!(bench.says("Limb · 50 % IK") && bench.says("Between FK and IK"));
    bench.enter("IK influence", "3");
    assert!(bench.says("The influence of a target must be from 0 to 1, got 3"));
    assert_eq!(bench.session().arm().influence, 0.5);
}

#[test]
fn rings_turn_the_shoulder_and_bend_the_elbow() {
    let mut bench =
        Bench::after([ArmEdit::SwitchPoseMode(PoseMode::Angles), ArmEdit::SetShoulder(Vec3::ZERO)]);
    bench.apply([ArmEdit::SetBend(0.8)]);
    for (joint, axis) in
        [(UPPER, RotationAxis::Y), (UPPER, RotationAxis::Z), (LOWER, RotationAxis::Z)]
    {
        let grip = Grip::Ring(joint, axis);
        let ring = GripRing::of_joint(bench.session().posed(), joint, axis).expect("a ring");
        let centre = bench.on_screen(ring.centre);
        let before = bench.session().arm();
        // The ring has a constant size on screen, so this distance from its centre is on it.
        let around = (0..360).map(|step| {
            let angle = (step as f32).to_radians();
            centre + vec2(angle.cos(), angle.sin()) * 1.0
        });
        let held = around
            .clone()
            .flat_map(|at| (20..60).map(move |radius| centre + (at - centre) * radius as f32));
        let mut taken = false;
        for at in held.step_by(53) {
            bench.move_to(at);
            bench.press(LEFT);
            taken = bench.session().history().drag().is_some_and(|drag| drag.grip() == grip);
            if taken {
                bench.move_to(at + vec2(9.0, 7.0));
                bench.move_to(at + vec2(18.0, 14.0));
                bench.release(LEFT);
                break;
            }
            bench.release(LEFT);
        }
        assert!(taken, "{grip:?} is nowhere");
        let (now, was) = (bench.session().arm().fk, before.fk);
        let changed = [
            now.shoulder.x != was.shoulder.x,
            now.shoulder.y != was.shoulder.y,
            now.shoulder.z != was.shoulder.z,
            now.bend != was.bend,
        ];
        let expected = [
            false,
            grip == Grip::Ring(UPPER, RotationAxis::Z),
            grip == Grip::Ring(UPPER, RotationAxis::Y),
            grip == Grip::Ring(LOWER, RotationAxis::Z),
        ];
        assert_eq!(changed, expected, "{grip:?}");
        bench.apply([TransactionAction::Undo]);
        assert_eq!(bench.session().arm().fk, was);
    }
}

#[test]
fn a_pinned_hand_stays_when_the_root_moves() {
    let mut bench = Bench::new();
    let before = bench.session().arm().cursor_in_world();
    bench.click(Role::CheckBox, "Pinned to world");
    bench.enter("Root x", "80");
    bench.enter("Root y", "-30.5");
    assert_eq!(bits(bench.session().arm().cursor_in_world()), bits(before));
    let (arm, pose) = (bench.session().arm(), bench.session().pose());
    assert!((arm.root + pose.hand).distance(before) < 2e-4);
    bench.enter("Hand z", "10");
    assert_eq!(bench.session().arm().cursor_in_world().z, 10.0, "it is set in the world");
    let pose = bench.session().pose();
    bench.click(Role::CheckBox, "Pinned to world");
    assert!(apart(&pose, &bench.session().pose()) < 1e-3);
    let cursor = bench.cursor_on_screen();
    bench.apply([ArmEdit::PinHand(true)]);
    bench.drag_and_drop(LEFT, cursor, cursor + vec2(-30.0, 20.0));
    assert!(
        bench.cursor_on_screen().distance(cursor + vec2(-30.0, 20.0)) < 0.5,
        "it can be dragged"
    );
}

#[test]
fn changing_the_twist_reference_keeps_the_elbow() {
    let mut bench = Bench::after([ArmEdit::SetTwist(0.4)]);
    let pose = bench.session().pose();
    for (name, twist_reference) in [
        ("Pole", TwistReferenceKind::Pole),
        ("Stereographic", TwistReferenceKind::Stereographic),
        ("Transport", TwistReferenceKind::Transport),
        ("Up", TwistReferenceKind::Up),
    ] {
        pick(&mut bench, "Twist reference", name);
        assert_eq!(bench.session().arm().twist_reference, twist_reference);
        assert!(apart(&pose, &bench.session().pose()) < 5e-3, "{name}");
        assert_eq!(
            bench.shows(Role::Slider, "Pole x"),
            twist_reference == TwistReferenceKind::Pole
        );
        assert_eq!(bench.session().history().undo_label(), Some("Change twist reference"));
    }
}

#[test]
fn the_pole_is_dragged_in_the_view_and_cancelled() {
    let mut bench = Bench::after([ArmEdit::SetTwistReference(TwistReferenceKind::Pole)]);
    let (before, elbow) = (bench.session().arm().pole, bench.session().pose().elbow);
    let at = pole_place(&bench);
    bench.drag(LEFT, at, at + vec2(60.0, 90.0));
    assert!(bench.says("Pole freely"));
    assert!(pole_place(&bench).distance(at + vec2(60.0, 90.0)) < 0.5, "it is under the pointer");
    assert!(bench.session().pose().elbow.distance(elbow) > 5.0, "the elbow follows");
    bench.key(egui::Key::Escape);
    assert_eq!(bits(bench.session().arm().pole), bits(before));
    bench.release(LEFT);
    bench.drag_and_drop(LEFT, at, at + vec2(-40.0, 20.0));
    assert_eq!(bench.session().history().undo_label(), Some("Move pole"));
    bench.apply([TransactionAction::Undo]);
    assert_eq!(bits(bench.session().arm().pole), bits(before));
    bench.enter("Pole y", "123.5");
    assert_eq!(bench.session().arm().pole.y, 123.5);
}

#[test]
fn the_four_twist_references_are_compared() {
    let mut bench = Bench::after([ArmEdit::SetHand(Vec3::new(0.0, 300.0, 1.0))]);
    bench.show_tab(PanelTab::Twist);
    for name in ["Stereographic", "Transport", "Holonomy"] {
        assert!(bench.says(name), "{name}");
    }
    assert!(bench.says("300.00"), "the gain of the limb's, straight above");
    for (name, layer) in
        [("Ghosts", Overlay::TwistReferences), ("Singularity globe", Overlay::SingularityGlobe)]
    {
        bench.reveal(Role::CheckBox, name);
        bench.click(Role::CheckBox, name);
        assert!(bench.session().shown().display.shows(layer));
    }
    bench.apply([Step::from(ArmEdit::SetHand(Vec3::X * 300.0)), ViewAction::ResetTransport.into()]);
    for hand in [Vec3::Y, Vec3::Z, Vec3::X] {
        bench.apply([ArmEdit::SetHand(hand * 300.0)]);
    }
    assert!(bench.says("+90.0°"), "an octant's solid angle");
    bench.reveal(Role::Button, "Reset");
    bench.click(Role::Button, "Reset");
    assert!(!bench.says("+90.0°"));
}

#[test]
fn soft_limits_and_the_hands_orientation_are_folded_and_can_be_set() {
    let mut bench = Bench::new();
    assert!(!bench.shows(Role::Slider, "Softness"));
    bench.click(Role::DisclosureTriangle, "Soft limits");
    bench.enter("Softness", "0.25");
    bench.enter("Stretch", "1.5");
    bench.enter("Minimum elbow angle", "20");
    let soft_reach = bench.session().arm().soft_reach;
    assert_eq!((soft_reach.softness(), soft_reach.max_stretch()), (0.25, 1.5));
    assert!((soft_reach.min_elbow_angle().to_degrees() - 20.0).abs() < 1e-4);
    bench.enter("Softness", "7");
    assert!(bench.session().arm().soft_reach.softness() < 1.0, "it is brought within");
    bench.click(Role::DisclosureTriangle, "Soft limits");
    bench.click(Role::DisclosureTriangle, "Hand orientation");
    for degrees in ["100", "200", "270"] {
        bench.enter("Hand rotation x", degrees);
    }
    assert!(bench.says("270.0°"), "the forearm rolls on past half a turn");
    bench.click(Role::RadioButton, "Keep orientation");
    assert_eq!(bench.session().arm().hand_orientation.space, HandSpace::World);
}

#[test]
fn every_control_of_the_posing_has_a_tooltip() {
    let mut bench = posing([ArmEdit::SetTwistReference(TwistReferenceKind::Pole)]);
    for (role, name) in [
        (Role::Button, "IK"),
        (Role::Button, "FK"),
        (Role::Slider, "IK influence"),
        (Role::CheckBox, "Pinned to world"),
        (Role::ComboBox, "Twist reference"),
        (Role::Slider, "Pole y"),
    ] {
        assert!(has_tooltip(&mut bench, role, name), "{name}");
    }
}

#[test]
fn k_keys_the_channels_of_the_pose_mode() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([ArmEdit::PinHand(true)]);
    bench.key(egui::Key::K);
    let keyed = |bench: &Bench| -> Vec<Channel> {
        bench.session().document().keys.tracks().map(|(channel, _)| channel).collect()
    };
    assert_eq!(keyed(&bench), [channels::PIN, channels::PINNED, channels::TWIST]);
    bench.apply([
        Step::from(TransactionAction::Undo),
        ArmEdit::SwitchPoseMode(PoseMode::Angles).into(),
    ]);
    bench.key(egui::Key::K);
    assert_eq!(keyed(&bench), [channels::SHOULDER, channels::BEND, channels::INFLUENCE]);
}

#[test]
fn the_panels_in_pole_and_fk_mode_look_as_they_did() {
    let mut results = SnapshotResults::new();
    for (theme, name) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
        let mut bench = posing([
            Step::from(ShellAction::SetTheme(theme)),
            ArmEdit::SetTwistReference(TwistReferenceKind::Pole).into(),
        ]);
        let options = snapshot_options(600);
        results.add(bench.harness.try_snapshot_options(format!("pole_{name}"), &options));
        bench.apply([ArmEdit::SwitchPoseMode(PoseMode::Angles)]);
        results.add(bench.harness.try_snapshot_options(format!("fk_{name}"), &options));
    }
}
