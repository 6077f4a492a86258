//! The head of a snake: dragged with the mouse, moved in the panel, and keyed.

use egui::PointerButton::Primary as LEFT;
use egui::accesskit::Role;
use egui::vec2;
use glam::Vec3;
use ik_arm::document::{Channel, PathKind};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::session::{Grip, KeysEdit, PlaybackAction, SelectAction};

use crate::bench::Bench;

const HEAD: JointId = JointId::new(0);

fn snake() -> Bench {
    Bench::example("snake")
}

fn head(bench: &Bench) -> Vec3 {
    bench.session().skeleton_pose().base(HEAD)
}

#[test]
fn the_mouse_drags_the_head_and_the_body_follows_in_one_undo_step() {
    let mut bench = snake();
    let before = bench.session().skeleton_pose().clone();
    let at = bench.on_screen(head(&bench));
    bench.drag(LEFT, at, at + vec2(60.0, -20.0));
    let grip = bench.session().history().drag().expect("a drag").grip();
    assert!(matches!(grip, Grip::Head(HEAD, _)));
    for step in 1..20 {
        bench.move_to(at + vec2(60.0 + 3.0 * step as f32, -20.0 - 4.0 * step as f32));
    }
    bench.release(LEFT);
    bench.settle();
    assert!(bench.on_screen(head(&bench)).distance(at + vec2(117.0, -96.0)) < 2.0);
    let after = bench.session().skeleton_pose().clone();
    for joint in before.ids().skip(1) {
        assert_ne!(before.base(joint), after.base(joint), "joint {joint} follows");
    }
    bench.choose(&["Edit", "Undo Move head"]);
    assert_eq!(bench.session().skeleton_pose(), &before);
}

#[test]
fn the_panel_chooses_what_the_body_follows() {
    let mut bench = snake();
    let follows = |bench: &Bench| bench.session().rig().path_kind(HEAD);
    assert_eq!(follows(&bench), Some(PathKind::Head));
    for (name, slider) in [("Wavy ring", "Radius"), ("Head", "Head x")] {
        bench.reveal(Role::ComboBox, "Follow path");
        bench.click(Role::ComboBox, "Follow path");
        bench.click(Role::Button, name);
        bench.settle();
        bench.reveal(Role::Slider, slider);
        assert_eq!(follows(&bench) == Some(PathKind::Head), name == "Head");
    }
}

#[test]
fn a_head_is_keyed_at_two_times_and_the_body_is_on_its_path() {
    let mut bench = snake();
    assert!(!bench.session().document().is_animated());
    bench.apply([SelectAction::Joints(vec![HEAD])]);
    bench.reveal(Role::Slider, "Head x");
    for (time, x) in [(0.0, "1.4"), (2.0, "3")] {
        bench.apply([PlaybackAction::SetTime(time)]);
        bench.enter("Head x", x);
        bench.apply([KeysEdit::Key(vec![Channel::Offset(HEAD)])]);
        bench.settle();
    }
    let keys = &bench.session().document().keys;
    assert_eq!(keys.track(Channel::Offset(HEAD)).expect("keys").knots().len(), 2);
    let y = head(&bench).y;
    for (time, x) in [(0.0, 1.4), (2.0, 3.0)] {
        bench.apply([PlaybackAction::SetTime(time)]);
        assert!(head(&bench).distance(Vec3::new(x, y, 0.0)) < 1e-3, "{}", head(&bench));
    }
    let pose = bench.session().skeleton_pose().clone();
    for joint in pose.ids().take(15) {
        let base = pose.base(joint);
        assert!(base.z.abs() < 1e-3, "joint {joint} is on the straight path at {base}");
    }
}
