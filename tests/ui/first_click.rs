//! First use of skeletons: switching to them, and building one by mouse.

use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use glam::Vec3;
use ik_arm::session::{JointEdit, SelectAction, TransactionAction, ViewAction};

use crate::bench::Bench;
use ik_arm::kinematics::skeleton::JointId;

const CTRL: Modifiers = Modifiers::COMMAND;

fn names(bench: &Bench) -> Vec<String> {
    let joints = bench.session().skeleton().joints();
    joints.iter().map(|joint| joint.name.clone()).collect()
}

/// Every base and tip, on screen.
fn ends(bench: &Bench) -> Vec<egui::Pos2> {
    let pose = bench.session().skeleton_pose();
    let points = (0..pose.len())
        .flat_map(|joint| [pose.base(JointId::new(joint)), pose.tip(JointId::new(joint))]);
    points.map(|point| bench.on_screen(point)).collect()
}

fn new_skeleton() -> Bench {
    let mut bench = Bench::new();
    bench.choose(&["File", "New", "Empty"]);
    bench
}

#[test]
fn a_new_figure_is_shown_framed_and_large() {
    let mut bench = Bench::new();
    bench.choose(&["File", "New", "Figure"]);
    assert!(names(&bench).contains(&"head".to_owned()));
    let ends = ends(&bench);
    let box_of_human = egui::Rect::from_points(&ends);
    assert!(bench.viewport().contains_rect(box_of_human), "all of it is seen");
    assert!(box_of_human.height() > 0.4 * bench.viewport().height(), "and it is large");
}

#[test]
fn an_empty_skeleton_says_what_to_do_and_clicks_build_it() {
    let mut bench = new_skeleton();
    bench.apply([SelectAction::Joints(Vec::new())]);
    assert!(bench.says("Click to place the first joint"));
    let centre = bench.viewport().center();
    bench.click_at(centre + vec2(0.0, -120.0));
    bench.settle();
    assert_eq!(names(&bench).len(), 2, "a click places the first bone");
    assert!(!bench.says("Click to place the first joint"));
    let tip = bench.session().skeleton_pose().tip(JointId::new(1));
    assert!(bench.on_screen(tip).distance(centre + vec2(0.0, -120.0)) < 2.0, "where the mouse is");

    bench.apply([SelectAction::Joints(Vec::new())]);
    bench.hold(CTRL);
    bench.click_at(centre + vec2(90.0, -170.0));
    bench.hold(Modifiers::NONE);
    bench.settle();
    assert_eq!(names(&bench).len(), 3, "Ctrl+click with nothing selected continues the last one");
    assert_eq!(bench.session().skeleton().joints()[2].parent, Some(JointId::new(1)));

    bench.apply([SelectAction::Joints(Vec::new())]);
    bench.key(Key::A);
    bench.settle();
    assert_eq!(
        bench.session().skeleton().joints()[3].parent,
        Some(JointId::new(2)),
        "and so does A"
    );
}

#[test]
fn a_skeleton_without_any_joint_gets_a_root_and_a_joint_by_one_click() {
    for by_key in [false, true] {
        let mut bench = new_skeleton();
        bench.apply([JointEdit::DeleteJoints(vec![JointId::new(0)])]);
        assert!(names(&bench).is_empty());
        assert!(bench.says("Click to place the first joint"));
        if by_key {
            bench.key(Key::A);
        } else {
            bench.click_at(bench.viewport().center() + vec2(0.0, -100.0));
        }
        bench.settle();
        assert_eq!(names(&bench), ["root", "joint"]);
        bench.apply([TransactionAction::Undo]);
        assert!(names(&bench).is_empty(), "it is one step");
    }
}

#[test]
fn add_child_stays_under_the_mouse() {
    let mut bench = new_skeleton();
    let button = bench.rect(Role::Button, "Add child");
    for count in 2..14 {
        bench.click(Role::Button, "Add child");
        assert_eq!(names(&bench).len(), count);
        assert_eq!(bench.rect(Role::Button, "Add child"), button, "with {count} joints");
    }
}

#[test]
fn a_bone_that_leaves_the_view_makes_the_camera_zoom_out() {
    let mut bench = new_skeleton();
    for _ in 0..12 {
        bench.click(Role::Button, "Add child");
    }
    bench.wait(0.5);
    for end in ends(&bench) {
        assert!(bench.viewport().contains(end), "{end:?}");
    }
}

#[test]
fn a_view_that_shows_the_new_bone_stays() {
    let mut bench = new_skeleton();
    let view = bench.session().camera().zoomed(6.0, glam::Vec2::ZERO, 1.0);
    bench.apply([ViewAction::SetCamera(view)]);
    bench.click(Role::Button, "Add child");
    bench.wait(0.5);
    assert_eq!(*bench.session().camera(), view);
}

#[test]
fn bones_of_one_skeleton_are_about_as_thick_however_long_they_are() {
    let mut bench = new_skeleton();
    let tips = [Vec3::Y, Vec3::Y * 1.1, Vec3::new(3.0, 1.1, 0.0), Vec3::new(3.0, 1.3, 0.0)];
    bench.apply(tips.map(|tip| JointEdit::AddJoint { tip: Some(tip) }));
    let joints = &bench.session().skeleton().joints()[1..];
    for joint in joints {
        assert!((0.02..=0.15).contains(&joint.radius), "{} of {}", joint.radius, joint.axis);
        assert!(joint.radius <= 0.5 * joint.axis.length(), "no bone is thicker than long");
    }
}
