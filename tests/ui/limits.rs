//! Cone limits of a joint: chosen in the panel, drawn in the view, kept by targets.

use core::f32::consts::PI;

use egui::PointerButton;
use egui::accesskit::Role;
use glam::{Quat, Vec2, Vec3};
use ik_arm::document::{Camera, Overlay};
use ik_arm::kinematics::skeleton::{
    Cone, Extreme, Joint, JointLimits, Limit, LimitEnd, RotationAxis, SwingAxis,
};
use ik_arm::rig::TargetOutcome;
use ik_arm::scene::{Colour, SceneBuilder};
use ik_arm::session::{
    DisplayEdit, Grip, JointEdit, LimitFan, SelectAction, SolverEdit, TargetEdit,
    TransactionAction, ViewAction,
};

use crate::bench::Bench;

/// The Human with its left upper arm selected.
fn upper_arm() -> Bench {
    let mut bench = Bench::example("human");
    let (camera, Camera { yaw, pitch, .. }) = (*bench.session().camera(), Camera::default());
    bench.apply([ViewAction::SetCamera(Camera { yaw, pitch, ..camera })]);
    let joint = bench.joint("left_upper_arm");
    bench.apply([JointEdit::SetLimits { joint, limits: JointLimits::NONE }]);
    bench.apply([SelectAction::Joints(vec![joint])]);
    bench.settle();
    bench
}

fn joint(bench: &Bench) -> Joint {
    bench.session().skeleton()[bench.joint("left_upper_arm")].clone()
}

fn cone(bench: &Bench) -> Option<Cone> {
    joint(bench).limits.as_cone()
}

fn choose_cone(bench: &mut Bench) {
    bench.reveal(Role::ComboBox, "Limits");
    bench.click(Role::ComboBox, "Limits");
    bench.settle();
    bench.click(Role::Button, "Cone");
    bench.settle();
}

fn type_into(bench: &mut Bench, name: &str, text: &str) {
    bench.reveal(Role::SpinButton, name);
    bench.type_into(name, text);
}

#[test]
fn a_cone_is_chosen_and_its_angles_are_typed_in_degrees() {
    let mut bench = upper_arm();
    choose_cone(&mut bench);
    assert!(cone(&bench).is_some());
    type_into(&mut bench, "Swing x", "80");
    type_into(&mut bench, "Swing z", "200");
    type_into(&mut bench, "Twist minimum", "-30");
    type_into(&mut bench, "Twist maximum", "-40");
    type_into(&mut bench, "Middle x", "-45");
    type_into(&mut bench, "Middle z", "20");
    let Cone { x, z, twist, middle } = cone(&bench).expect("a cone");
    assert!((x.to_degrees() - 80.0).abs() < 1e-3, "{x}");
    assert_eq!(z, Cone::WIDEST, "the widest that there is");
    assert!((twist.max.to_degrees() + 40.0).abs() < 1e-3 && twist.min == twist.max, "{twist:?}");
    let wanted = Vec2::new(-45.0, 20.0);
    assert!((middle * 180.0 / PI).distance(wanted) < 1e-3, "{middle}");
    assert!(joint(&bench).limits.contains(joint(&bench).rotation), "the angles are within it");
    for _ in 0..7 {
        bench.apply([TransactionAction::Undo]);
    }
    assert_eq!(cone(&bench), None);
}

#[test]
fn a_hand_that_its_target_pulls_behind_the_body_stays_in_the_cone_of_the_shoulder() {
    let mut bench = upper_arm();
    choose_cone(&mut bench);
    let hand = bench.joint("left_hand");
    let index = bench.session().rig().target_of_end(hand).expect("a target");
    let target = bench.session().rig().targets[index];
    for by in [Vec3::new(-0.6, 0.2, -0.4), Vec3::new(0.2, 0.8, -0.5), Vec3::NEG_Z] {
        bench.apply([TargetEdit::SetTarget(target.with_home(target.home + by))]);
        let posed = bench.session().posed().skeleton();
        let upper = &posed[bench.joint("left_upper_arm")];
        assert!(upper.limits.contains(upper.rotation), "{by}: {}", upper.rotation);
    }
}

#[test]
fn an_elbow_that_the_cone_turns_aside_is_told_and_the_hand_gets_there() {
    let mut bench = upper_arm();
    let limits = JointLimits::cone(Cone {
        x: 1.3,
        z: 1.5,
        twist: Limit { min: -1.2, max: 1.2 },
        middle: Vec2::ZERO,
    });
    let joint_id = bench.joint("left_upper_arm");
    let hand = bench.joint("left_hand");
    bench.apply([JointEdit::SetLimits { joint: joint_id, limits }]);
    bench.apply([SelectAction::Joints(vec![hand])]);
    let index = bench.session().rig().target_of_end(hand).expect("a target");
    let target = bench.session().rig().targets[index];
    for way in [Vec3::new(0.1, 0.5, 0.1), Vec3::new(-0.1, 0.45, 0.25), Vec3::new(0.15, 0.6, -0.1)] {
        bench.apply([TargetEdit::SetTarget(target.with_home(target.home + way))]);
        bench.settle();
        let report = bench.session().posed().target_report(target.joint).expect("a report").clone();
        let TargetOutcome::Limb(limb) = &report.outcome else { panic!("{report:?}") };
        if limb.turned_aside.abs() > 0.05 && report.error < 1e-5 {
            assert!(bench.says("turn the elbow aside by"));
            assert!(bench.says("left_upper_arm"));
            return;
        }
    }
    panic!("no place turns the elbow aside");
}

#[test]
fn the_limits_of_the_selected_joint_are_drawn_and_red_where_they_block() {
    let mut bench = upper_arm();
    choose_cone(&mut bench);
    // The number of shapes, and of those in the colour of danger.
    let drawn = |bench: &Bench| {
        let (session, mut builder) = (bench.session(), SceneBuilder::default());
        let theme = session.preferences().theme;
        let scene = builder.build(session.posed(), &session.overlays(), theme);
        let colours = scene.guide_solids.iter().map(|it| it.colour);
        let colours: Vec<_> = colours.chain(scene.lines.iter().map(|it| it.colour)).collect();
        let is_red = |colour: &&Colour| colour.with_opacity(1.0) == scene.palette.danger();
        (colours.len(), colours.iter().filter(is_red).count())
    };
    let before = drawn(&bench).0;
    bench.apply([DisplayEdit::ShowOverlay(Overlay::JointLimits, true)]);
    let of_cone = drawn(&bench).0 - before;
    assert!(of_cone > 100, "{of_cone} shapes");
    let forearm = bench.joint("left_forearm");
    bench.apply([SelectAction::Joints(vec![forearm])]);
    let (of_hinge, red) = drawn(&bench);
    let of_hinge = of_hinge - before;
    assert!((10..of_cone).contains(&of_hinge), "{of_hinge} shapes of the elbow, {of_cone} before");
    assert_eq!(red, 0, "the elbow is bent");
    let rig = bench.session().rig();
    let hand = rig.targets[rig.target(forearm).expect("a target")];
    let far = hand.home + Vec3::new(2.0, 0.0, 0.0);
    bench.apply([SolverEdit::SetBodyFollows(false)]);
    bench.apply([TargetEdit::SetTarget(hand.with_home(far))]);
    assert!(drawn(&bench).1 > 10, "the elbow is straight, at an end of its range");
}

/// Presses the handle at an end of the limits of the left upper arm, moves the mouse to where it has
/// turned by an angle, and releases the button.
fn drag_end(bench: &mut Bench, end: LimitEnd, by: f32) {
    let joint_id = bench.joint("left_upper_arm");
    let fan = LimitFan::shown(bench.session().posed(), joint_id).expect("limits are shown");
    let at = fan.ends().find(|(it, _)| *it == end).expect("an end").1;
    let ring = fan.ring(end).expect("a ring");
    let to = ring.centre + Quat::from_axis_angle(ring.axis, by) * (at - ring.centre);
    let [from, to] = [at, to].map(|point| bench.on_screen(point));
    bench.move_to(from);
    bench.press(PointerButton::Primary);
    let taken = bench.session().history().drag().map(ik_arm::session::Drag::grip);
    assert_eq!(taken, Some(Grip::Limit(joint_id, end)));
    bench.move_to(to);
    bench.settle();
    bench.release(PointerButton::Primary);
    bench.settle();
}

#[test]
fn ends_of_ranges_are_dragged_in_the_view() {
    let mut bench = upper_arm();
    bench.apply([DisplayEdit::ShowOverlay(Overlay::JointLimits, true)]);
    let joint_id = bench.joint("left_upper_arm");
    let ranges = [(-1.0, 1.2), (-0.8, 0.9), (-1.4, 0.6)];
    let ranges = ranges.map(|(min, max)| Some(Limit { min, max }));
    let limits = JointLimits::new(ranges);
    bench.apply([JointEdit::SetLimits { joint: joint_id, limits }]);
    bench.settle();
    for (axis, extreme, by) in [
        (RotationAxis::X, Extreme::Greatest, -0.3),
        (RotationAxis::Y, Extreme::Least, 0.2),
        (RotationAxis::Z, Extreme::Greatest, 0.25),
    ] {
        let end = LimitEnd::Range(axis, extreme);
        let before = joint(&bench).angle_of_end(end).expect("an end");
        drag_end(&mut bench, end, by);
        let after = joint(&bench).angle_of_end(end).expect("an end");
        assert!((after - before - by).abs() < 0.02, "{end:?}: {before} to {after}, by {by}");
        assert_eq!(bench.session().history().undo_label(), Some("Move limit"));
        bench.apply([TransactionAction::Undo]);
        assert_eq!(joint(&bench).limits, limits, "it was one step");
    }
}

#[test]
fn ends_of_a_cone_are_dragged_in_the_view_and_the_joint_is_pushed_by_them() {
    let mut bench = upper_arm();
    choose_cone(&mut bench);
    bench.apply([DisplayEdit::ShowOverlay(Overlay::JointLimits, true)]);
    let joint_id = bench.joint("left_upper_arm");
    let twist = Limit { min: -1.0, max: 1.0 };
    let limits = JointLimits::cone(Cone { x: 1.2, z: 1.3, twist, middle: Vec2::ZERO });
    bench.apply([JointEdit::SetLimits { joint: joint_id, limits }]);
    bench.settle();
    drag_end(&mut bench, LimitEnd::Swing(SwingAxis::Z, Extreme::Least), 0.3);
    assert!((cone(&bench).expect("a cone").z - 1.0).abs() < 0.02);
    drag_end(&mut bench, LimitEnd::Twist(Extreme::Greatest), -0.4);
    assert!((cone(&bench).expect("a cone").twist.max - 0.6).abs() < 0.03, "{:?}", cone(&bench));
    let own = joint(&bench);
    assert!(own.limits.contains(own.rotation), "{}", own.rotation);
    // Without the guide there is nothing to take.
    bench.apply([DisplayEdit::ShowOverlay(Overlay::JointLimits, false)]);
    assert!(LimitFan::shown(bench.session().posed(), joint_id).is_none());
}
