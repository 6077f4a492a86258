//! Cone limits of a joint: chosen in the panel, drawn in the view, kept by targets.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use glam::Vec3;
use ik_arm::document::Overlay;
use ik_arm::kinematics::skeleton::{Cone, Joint};
use ik_arm::scene::SceneBuilder;
use ik_arm::session::{DisplayEdit, SelectAction, TargetEdit, TransactionAction};

use crate::bench::Bench;

/// The Human with its left upper arm selected.
fn upper_arm() -> Bench {
    let mut bench = Bench::example("human");
    let joint = bench.joint("left_upper_arm");
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
    bench.click(Role::SpinButton, name);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([Event::Text(text.to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
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
    let Cone { x, z, twist } = cone(&bench).expect("a cone");
    assert!((x.to_degrees() - 80.0).abs() < 1e-3, "{x}");
    assert_eq!(z, Cone::WIDEST, "the widest that there is");
    assert!((twist.max.to_degrees() + 40.0).abs() < 1e-3 && twist.min == twist.max, "{twist:?}");
    assert!(joint(&bench).limits.contains(joint(&bench).rotation), "the angles are within it");
    for _ in 0..5 {
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
fn the_limits_of_the_selected_joint_are_drawn_and_red_where_they_block() {
    let mut bench = upper_arm();
    choose_cone(&mut bench);
    let lines = |bench: &Bench| {
        let (session, mut builder) = (bench.session(), SceneBuilder::default());
        builder.build(session.posed(), &session.overlays(), session.preferences().theme).lines.len()
    };
    let before = lines(&bench);
    bench.apply([DisplayEdit::ShowOverlay(Overlay::JointLimits, true)]);
    let of_cone = lines(&bench) - before;
    assert!(of_cone > 100, "{of_cone} lines");
    let forearm = bench.joint("left_forearm");
    bench.apply([SelectAction::Joints(vec![forearm])]);
    let of_hinge = lines(&bench) - before;
    assert!((10..of_cone).contains(&of_hinge), "{of_hinge} lines of the elbow, {of_cone} before");
}
