//! Wiggling: a joint swings while the mouse is over one of its rings and Alt is held.

use core::f32::consts::PI;

use egui::{Event, Modifiers, Pos2};
use ik_arm::io::Example;
use ik_arm::kinematics::skeleton::{JointId, RotationAxis};
use ik_arm::session::{FileAction, GripRing, Preferences, SelectAction, Session, WiggleView};

use crate::bench::Bench;
use crate::common::documents::open_example;

/// The ten-joint chain with one of its joints selected.
fn bench(joint: &str) -> (Bench, JointId) {
    let example = Example::find("ten-joints").expect("an example");
    let mut bench = Bench::after([FileAction::OpenExample(example)]);
    let joint = bench.joint(joint);
    bench.apply([SelectAction::Joints(vec![joint])]);
    bench.settle();
    (bench, joint)
}

/// Moves the mouse over a ring of the joint and holds Alt.
fn hover(bench: &mut Bench, joint: JointId, axis: RotationAxis) -> Pos2 {
    let ring = GripRing::of_joint(bench.session().posed(), joint, axis).expect("a ring");
    let (u, v) = ring.axis.any_orthonormal_pair();
    let centre = bench.on_screen(ring.centre);
    let places = (0..64).map(|step| {
        let (sin, cos) = (step as f32 / 64.0 * 2.0 * PI).sin_cos();
        let at = bench.on_screen(ring.centre + 0.01 * (u * cos + v * sin));
        centre + 56.0 * (at - centre).normalized()
    });
    let places: Vec<Pos2> = places.collect();
    bench.hold(Modifiers::ALT);
    for at in places {
        bench.frame([Event::PointerMoved(at)]);
        bench.frame([]);
        if bench.session().view().wiggled() == Some((joint, axis)) {
            return at;
        }
    }
    panic!("no ring at the mouse");
}

fn view(bench: &Bench) -> WiggleView {
    bench.session().overlays().wiggle.expect("a wiggle")
}

#[test]
fn alt_over_a_ring_lets_the_joint_swing_by_5_degrees_and_changes_nothing_else() {
    let (mut bench, joint) = bench("joint_4");
    let before = bench.session().document().clone();
    hover(&mut bench, joint, RotationAxis::Z);
    let mut least = 0.0_f32;
    let mut most = 0.0_f32;
    for _ in 0..240 {
        bench.frame([]);
        let WiggleView { by, swing, .. } = view(&bench);
        assert_eq!(swing.joint, joint);
        (least, most) = (least.min(by.to_degrees()), most.max(by.to_degrees()));
    }
    assert!((-5.01..-4.8).contains(&least) && (4.8..5.01).contains(&most), "{least} {most}");
    assert_eq!(bench.session().document(), &before);
    assert!(!bench.session().history().is_editing());
}

#[test]
fn the_residual_is_that_of_the_tip_to_its_target_and_of_the_line() {
    let (mut bench, joint) = bench("joint_4");
    hover(&mut bench, joint, RotationAxis::X);
    for _ in 0..40 {
        bench.frame([]);
        let view = view(&bench);
        let target = view.target.expect("a target");
        let tip = view.pose.tip(view.swing.tip);
        assert!((tip.distance(target.position) - target.now).abs() < 1e-5);
        let skeleton = &bench.session().posed().evaluated_skeleton().solved;
        let line = view.swing.predicted_at(skeleton, view.by);
        assert!((line.distance(target.position) - target.predicted).abs() < 1e-5);
        assert!((target.now - target.predicted).abs() < 0.02);
    }
}

#[test]
fn it_stops_when_alt_is_released_or_the_mouse_leaves_the_ring() {
    let (mut bench, joint) = bench("joint_4");
    let at = hover(&mut bench, joint, RotationAxis::Y);
    bench.hold(Modifiers::NONE);
    bench.frame([]);
    bench.frame([]);
    assert_eq!(bench.session().view().wiggled(), None);
    bench.hold(Modifiers::ALT);
    bench.frame([Event::PointerMoved(at)]);
    bench.frame([]);
    assert!(bench.session().view().wiggled().is_some());
    let beside = bench.empty_point();
    bench.frame([Event::PointerMoved(beside)]);
    bench.frame([]);
    assert_eq!(bench.session().view().wiggled(), None);
    assert_eq!(bench.session().overlays().wiggle, None);
}

#[test]
fn a_joint_without_targets_below_swings_its_farthest_tip() {
    let mut session = Session::new(Preferences::default());
    session.apply(open_example("human"));
    let joint = |session: &Session, name| session.skeleton().find(name).expect("a joint");
    let (neck, head) = (joint(&session, "neck"), joint(&session, "head"));
    session.apply(SelectAction::Wiggle(Some((neck, RotationAxis::X))));
    let view = session.view().wiggle_view(session.posed()).expect("a wiggle");
    assert_eq!((view.swing.tip, view.target), (head, None));
}
