//! Bodies in the viewport: what lights up under the mouse can be dragged, and nothing else.

use crate::common::arm::{ArmEdit, ArmPosed, ArmSession};
use egui::{CursorIcon, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use glam::Vec3;
use ik_arm::document::{Camera, Overlay, Target};
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::rig::LimbPart;
use ik_arm::session::{
    DisplayEdit, Drag, Grip, GripRing, PoseMode, SelectAction, SkinEdit, SolverEdit, TargetEdit,
    TransactionAction, ViewAction,
};

use crate::bench::Bench;

const LEFT: PointerButton = PointerButton::Primary;

/// The Human from its left, as a document without a camera is seen.
fn human() -> Bench {
    let mut bench = Bench::example("human");
    let (camera, Camera { yaw, pitch, .. }) = (*bench.session().camera(), Camera::default());
    bench.apply([ViewAction::SetCamera(Camera { yaw, pitch, ..camera })]);
    bench.apply([SolverEdit::SetBodyFollows(false)]);
    bench.apply([SelectAction::Joints(Vec::new())]);
    bench
}

fn show(bench: &mut Bench, skin: bool, bones: bool) {
    bench.apply([SkinEdit::ShowSkin { skin, bones }]);
}

fn name(bench: &Bench, joint: JointId) -> String {
    bench.session().skeleton()[joint].name.clone()
}

/// The middle of a bone, on screen.
fn middle(bench: &Bench, name: &str) -> Pos2 {
    let (pose, joint) = (bench.session().skeleton_pose(), bench.joint(name));
    bench.on_screen(pose.base(joint).midpoint(pose.tip(joint)))
}

fn home(bench: &Bench, joint_with_target: &str) -> Vec3 {
    let rig = bench.session().rig();
    rig.targets[rig.target(bench.joint(joint_with_target)).expect("a target")].home
}

fn icon(bench: &Bench) -> CursorIcon {
    bench.harness.output().platform_output.cursor_icon
}

/// Points of the viewport, clear of its edges, of the axes in one corner and of the switch in
/// another.
fn grid(bench: &Bench, step: f32) -> Vec<Pos2> {
    let room = bench.viewport().shrink(24.0);
    let corner = bench.viewport().right_bottom() - vec2(140.0, 140.0);
    let columns = (room.width() / step) as usize;
    let rows = (room.height() / step) as usize;
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let points = cells.map(|(x, y)| room.left_top() + vec2(x as f32, y as f32) * step);
    let switch = bench.viewport().left_top() + vec2(190.0, 50.0);
    let is_clear = |at: &Pos2| at.x > switch.x || at.y > switch.y;
    points.filter(|at| at.x < corner.x || at.y < corner.y).filter(is_clear).collect()
}

/// Presses at points of the viewport. At each, the cursor of a grip and the light are there exactly
/// if a drag of something starts there; elsewhere the view is dragged. Returns the number of points
/// at which something is dragged.
fn press_everywhere(bench: &mut Bench, step: f32) -> usize {
    let before = bench.session().document().clone();
    let mut count = 0;
    for at in grid(bench, step) {
        bench.move_to(at);
        let is_lit = bench.session().selection().hovered().is_some();
        let is_offered = icon(bench) == CursorIcon::Grab;
        bench.press(LEFT);
        let drag = bench.session().history().drag().map(Drag::grip);
        assert_eq!(is_offered, drag.is_some(), "{at}: {drag:?}");
        assert!(!is_lit || drag.is_some(), "{at} is lit and orbits");
        assert_ne!(drag.is_some(), bench.session().view().drag().is_some(), "{at}: {drag:?}");
        count += usize::from(drag.is_some());
        bench.key(Key::Escape);
        bench.release(LEFT);
    }
    assert_eq!(bench.session().document(), &before, "a press alone changes nothing");
    count
}

#[test]
fn what_lights_up_on_a_figure_can_be_dragged_and_nothing_else_lights_up() {
    for (skin, bones) in [(true, false), (false, true), (true, true)] {
        let mut bench = human();
        show(&mut bench, skin, bones);
        let count = press_everywhere(&mut bench, 31.0);
        assert!(count > 15, "{count} points of the figure with skin {skin}, bones {bones}");
    }
    let mut bench = Bench::example("two-targets");
    assert!(press_everywhere(&mut bench, 31.0) > 3, "a figure of bones alone");
}

#[test]
fn a_snake_on_its_path_lights_up_only_where_it_can_be_dragged() {
    let mut bench = Bench::example("snake");
    press_everywhere(&mut bench, 37.0);
}

#[test]
fn every_lit_part_of_a_figure_follows_its_drag() {
    let mut bench = human();
    for at in grid(&bench, 29.0) {
        bench.move_to(at);
        if bench.session().selection().hovered().is_none() {
            continue;
        }
        let lit = name(&bench, bench.session().selection().hovered().expect("lit"));
        let before = bench.session().skeleton_pose().clone();
        bench.drag(LEFT, at, at + vec2(24.0, -30.0));
        let pose = bench.session().skeleton_pose();
        let moved = before
            .ids()
            .map(|joint| pose.tip(joint).distance(before.tip(joint)))
            .fold(0.0, f32::max);
        assert!(moved > 5e-3, "{lit} at {at} moves by {moved}");
        bench.key(Key::Escape);
        bench.release(LEFT);
        assert_eq!(bench.session().skeleton_pose(), &before, "{lit}");
    }
}

#[test]
fn the_pelvis_is_called_pelvis_and_moves_by_its_skin_its_point_and_its_arrows() {
    for (skin, bones) in [(true, false), (false, true)] {
        let mut bench = human();
        show(&mut bench, skin, bones);
        let (pelvis, before) = (bench.joint("pelvis"), bench.tip("pelvis"));
        let at = bench.on_screen(before);
        bench.move_to(at);
        assert_eq!(bench.session().selection().hovered(), Some(pelvis), "skin {skin}");
        assert!(bench.says("left drag: drag pelvis"));
        let toes = bench.tip("left_foot");
        bench.drag(LEFT, at, at + vec2(6.0, 14.0));
        assert!(bench.says("Move pelvis freely"));
        bench.release(LEFT);
        let moved = bench.tip("pelvis");
        assert!(bench.on_screen(moved).distance(at + vec2(6.0, 14.0)) < 1.0);
        assert!(bench.tip("left_foot").distance(toes) < 1e-3, "the feet stay");
        bench.apply([TransactionAction::Undo]);

        bench.click_at(at);
        assert_eq!(bench.session().selection().joints(), [pelvis]);
        let up = at - vec2(0.0, 70.0);
        bench.drag_and_drop(LEFT, up, up + vec2(3.0, 25.0));
        let moved = bench.tip("pelvis");
        assert_eq!([moved.x, moved.z].map(f32::to_bits), [before.x, before.z].map(f32::to_bits));
        assert!(moved.y < before.y - 0.02, "{moved} was {before}");
    }
}

#[test]
fn hands_and_feet_drag_their_targets_by_the_skin() {
    for (end, lower) in [("left_hand", "left_forearm"), ("right_foot", "right_shin")] {
        let mut bench = human();
        let (at, before) = (middle(&bench, end), home(&bench, lower));
        bench.move_to(at);
        assert_eq!(bench.session().selection().hovered(), Some(bench.joint(end)));
        assert!(bench.says(&format!("left drag: drag the target of {end}")));
        let start = bench.on_screen(before);
        let by = vec2(-18.0, -26.0);
        bench.drag_and_drop(LEFT, at, at + by);
        let seen = bench.on_screen(home(&bench, lower));
        assert!(seen.distance(start + by) < 0.5, "the target of {end} is at {seen}");
        assert_eq!(bench.session().history().undo_label(), Some("Move target"));
    }
}

#[test]
fn a_point_of_a_limb_with_a_target_turns_about_the_pointer_under_the_mouse_and_the_hand_stays() {
    for (bone, end) in [
        ("right_upper_arm", "right_hand"),
        ("right_forearm", "right_hand"),
        ("left_thigh", "left_foot"),
        ("left_shin", "left_foot"),
    ] {
        let mut bench = human();
        // From a side where no ring is seen edge-on.
        let camera = *bench.session().camera();
        let yaw = camera.yaw + if end == "right_hand" { 0.6 } else { 0.0 };
        bench.apply([ViewAction::SetCamera(Camera { yaw, ..camera })]);
        let (joint, hand) = (bench.joint(bone), bench.joint(end));
        let rig = bench.session().rig();
        let target = rig.targets[rig.limb_target_of(hand).expect("a limb")].joint;
        let place = |bench: &Bench| {
            let pose = bench.session().skeleton_pose();
            (pose.base(joint).lerp(pose.tip(joint), 0.6), pose.tip(target))
        };
        let (from, wrist) = place(&bench);
        let frames = bench.session().posed().limb_frames(target).expect("a limb");
        let ring = GripRing::of_limb(&frames, from).expect("a ring");
        let to = ring.centre + glam::Quat::from_axis_angle(ring.axis, 0.3) * (from - ring.centre);
        let [at, to] = [from, to].map(|point| bench.on_screen(point));
        bench.move_to(at);
        assert_eq!(bench.session().selection().hovered(), Some(joint));
        assert!(bench.says(&format!("left drag: drag the limb of {end}")));
        assert!(at.distance(to) > 3.0, "{bone} is seen to turn");
        bench.drag_and_drop(LEFT, at, to);
        let (seen, after) = place(&bench);
        let seen = bench.on_screen(seen);
        assert!(seen.distance(to) < 1.0, "{bone}: {seen} is not at {to}");
        assert!(after.distance(wrist) < 1e-4, "{bone}: the end moves from {wrist} to {after}");
        bench.apply([TransactionAction::Undo]);
        assert_eq!(place(&bench), (from, wrist));
    }
}

#[test]
fn a_segment_without_a_target_poses_the_joints_above_it() {
    let mut bench = human();
    let (at, before) = (middle(&bench, "chest"), bench.tip("chest"));
    let wrist = bench.tip("right_forearm");
    bench.move_to(at);
    assert_eq!(bench.session().selection().hovered(), Some(bench.joint("chest")));
    bench.drag_and_drop(LEFT, at, at + vec2(30.0, 0.0));
    let by = bench.on_screen(bench.tip("chest")) - bench.on_screen(before);
    assert!(by.x > 15.0, "{by}");
    assert!(bench.tip("right_forearm").distance(wrist) < 1e-3, "its target holds the hand");
}

#[test]
fn a_bone_that_a_target_poses_is_dragged_and_the_target_stays() {
    let mut bench = Bench::example("two-targets");
    let target = bench.session().rig().targets[0];
    bench.apply([TargetEdit::SetTarget(Target { enabled: true, influence: 1.0, ..target })]);
    let rig = bench.session().rig();
    let bone = rig.skeleton[target.joint].parent.expect("a bone above it");
    let (target, bone) = (target.joint, name(&bench, bone));
    let at = middle(&bench, &bone);
    bench.move_to(at);
    bench.press(LEFT);
    let grip = bench.session().history().drag().map(Drag::grip);
    assert_eq!(grip, Some(Grip::Bone(bench.joint(&bone))));
    bench.release(LEFT);
    let (place, before) = (bench.session().posed().skeleton().tip(target), bench.tip(&bone));
    bench.drag_and_drop(LEFT, at, at + vec2(20.0, -12.0));
    assert!(
        bench.tip(&bone).distance(before) > 0.02,
        "{bone} moves from {before} to {}, {:?}",
        bench.tip(&bone),
        bench.session().shell().message()
    );
    let missed = bench.session().posed().skeleton().tip(target).distance(place);
    assert!(missed < 1e-3, "the tip is {missed} from where it was");
    bench.apply([TransactionAction::Undo]);
    assert_eq!(bench.tip(&bone), before, "one undo step");
}

#[test]
fn hidden_points_of_joints_take_no_press_from_the_skin() {
    let mut bench = human();
    let pose = bench.session().skeleton_pose().clone();
    let rig = bench.session().rig();
    let targets: Vec<Pos2> = rig.targets.iter().map(|it| bench.on_screen(it.home)).collect();
    let mut on_skin = 0;
    for joint in pose.ids() {
        for aside in [vec2(0.0, -8.0), vec2(7.0, 0.0), vec2(0.0, 8.0), vec2(-7.0, 0.0)] {
            let at = bench.on_screen(pose.tip(joint)) + aside;
            if targets.iter().any(|target| target.distance(at) < 16.0) {
                continue;
            }
            let seen =
                bench.session().evaluated().joint_on_skin(bench.session().posed(), bench.ray(at));
            bench.move_to(at);
            assert_eq!(bench.session().selection().hovered(), seen, "beside the tip of {joint}");
            bench.press(LEFT);
            assert_eq!(
                bench.session().history().drag().is_some(),
                seen.is_some(),
                "{joint} at {at}"
            );
            bench.release(LEFT);
            // The click has selected the joint, whose handles are shown. The next press is no
            // double click.
            bench.apply([SelectAction::Joints(Vec::new())]);
            bench.skip(1.0);
            on_skin += usize::from(seen.is_some());
        }
    }
    assert!(on_skin > 30, "{on_skin}");
}

#[test]
fn alt_and_the_other_buttons_move_the_view_over_bodies_too() {
    for is_arm in [true, false] {
        let mut bench = if is_arm { Bench::new() } else { human() };
        let at =
            if is_arm { limb_place(&bench, Limb::Lower, 0.5) } else { middle(&bench, "chest") };
        let before = bench.session().document().clone();
        for (button, modifiers) in [
            (LEFT, Modifiers::ALT),
            (PointerButton::Middle, Modifiers::NONE),
            (PointerButton::Secondary, Modifiers::NONE),
        ] {
            bench.move_to(at);
            bench.hold(modifiers);
            bench.press(button);
            assert!(bench.session().view().drag().is_some(), "{is_arm} {button:?}");
            assert!(bench.session().history().drag().is_none());
            bench.release(button);
            bench.hold(Modifiers::NONE);
        }
        assert_eq!(bench.session().document().rig, before.rig);
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Limb {
    Upper,
    Lower,
}

/// A point on the axis of a limb of the arm, a fraction of its length from its base, in the world.
fn limb_point(bench: &Bench, limb: Limb, part: f32) -> Vec3 {
    let (arm, pose) = (bench.session().arm(), bench.session().pose());
    let (base, tip) = match limb {
        Limb::Upper => (Vec3::ZERO, pose.elbow),
        Limb::Lower => (pose.elbow, pose.hand),
    };
    arm.root + base.lerp(tip, part)
}

fn limb_place(bench: &Bench, limb: Limb, part: f32) -> Pos2 {
    bench.on_screen(limb_point(bench, limb, part))
}

/// A point of the fingers, on screen.
fn fingers(bench: &Bench) -> Pos2 {
    let (arm, pose) = (bench.session().arm(), bench.session().pose());
    let forwards = bench.session().posed().hand_rotation().x_axis.as_vec3();
    bench.on_screen(arm.root + pose.hand + 60.0 * forwards)
}

#[test]
fn what_is_offered_on_the_arm_can_be_dragged_in_ik_and_in_fk() {
    for mode in [PoseMode::Hand, PoseMode::Angles] {
        let mut bench = Bench::after([ArmEdit::SwitchPoseMode(mode)]);
        let count = press_everywhere(&mut bench, 31.0);
        assert!(count > 15, "{mode:?}: {count}");
    }
}

#[test]
fn a_limb_of_the_arm_turns_the_elbow_about_the_pointer_under_the_mouse() {
    for (limb, part) in [(Limb::Upper, 0.6), (Limb::Lower, 0.3), (Limb::Lower, 0.6)] {
        for radians in [0.3_f32, -0.5] {
            let mut bench = Bench::new();
            let from = limb_point(&bench, limb, part);
            let hand = bench.session().pose().hand;
            let ring = GripRing::of_twist(&bench.session().posed().arm_frames()).expect("a ring");
            let turn = glam::Quat::from_axis_angle(ring.axis, radians);
            let to = bench.on_screen(turn * from);
            let from = bench.on_screen(from);
            bench.move_to(from);
            assert!(bench.says("left drag: drag the limb of hand"));
            bench.drag(LEFT, from, to);
            assert!(bench.says("Socket twist:"));
            bench.release(LEFT);
            let seen = limb_place(&bench, limb, part);
            assert!(seen.distance(to) < 0.5, "{limb:?} {part}: {seen} is not at {to}");
            assert!(bench.session().pose().hand.distance(hand) < 1e-3);
            assert_eq!(bench.session().history().undo_label(), Some("Pose joints"));
            bench.apply([TransactionAction::Undo]);
            assert_eq!(
                (bench.session().arm().twist, bench.session().history().undo_label()),
                (0.0, None)
            );
        }
    }
}

#[test]
fn the_fingers_drag_the_cursor() {
    let mut bench = Bench::new();
    let (at, cursor) = (fingers(&bench), bench.cursor_on_screen());
    bench.move_to(at);
    assert!(bench.says("left drag: drag the target of hand"));
    let by = vec2(22.0, -31.0);
    bench.drag_and_drop(LEFT, at, at + by);
    assert!(bench.cursor_on_screen().distance(cursor + by) < 0.5);
    assert_eq!(bench.session().history().undo_label(), Some("Move target"));
}

#[test]
fn a_straight_arm_is_dragged_by_its_cursor() {
    let mut bench = Bench::after([ArmEdit::SetHand(Vec3::new(499.9, 0.0, 0.0))]);
    let (at, twist) = (limb_place(&bench, Limb::Lower, 0.5), bench.session().arm().twist);
    let cursor = bench.hand();
    bench.drag_and_drop(LEFT, at, at + vec2(0.0, -60.0));
    assert!(bench.hand().distance(cursor) > 20.0);
    assert_eq!(bench.session().arm().twist, twist, "there is no elbow to turn");
}

#[test]
fn in_fk_the_upper_limb_turns_the_shoulder_and_the_lower_limb_takes_the_hand_along() {
    let mut bench = Bench::after([ArmEdit::SwitchPoseMode(PoseMode::Angles)]);
    let before = bench.session().arm();
    let at = limb_place(&bench, Limb::Upper, 0.7);
    let to = at + vec2(40.0, 15.0);
    bench.drag(LEFT, at, to);
    assert!(bench.says("Upper limb"));
    bench.release(LEFT);
    let (fk, was) = (bench.session().arm().fk, before.fk);
    assert!(fk.shoulder.distance(was.shoulder) > 0.05, "{}", fk.shoulder);
    assert_eq!((fk.bend, fk.stretch), (was.bend, was.stretch));
    let root = bench.on_screen(bench.session().arm().root);
    let seen = (limb_place(&bench, Limb::Upper, 0.7) - root).normalized();
    let asked = (to - root).normalized();
    assert!(seen.dot(asked) > 0.999, "the limb points at the mouse: {seen} and {asked}");
    assert_eq!(bench.session().history().undo_label(), Some("Pose joints"));
    bench.apply([TransactionAction::Undo]);
    assert_eq!(&bench.session().arm(), &before);

    for part in [0.3, 0.6, 0.8] {
        let (at, hand) = (limb_place(&bench, Limb::Lower, part), bench.hand());
        let to = at + vec2(10.0, -40.0);
        bench.drag_and_drop(LEFT, at, to);
        let seen = limb_place(&bench, Limb::Lower, part);
        assert!(seen.distance(to) < 0.5, "{part}: {seen} is not at {to}");
        assert!(bench.session().posed().arm_frames().origin(LimbPart::Hand).distance(hand) > 10.0);
        assert_eq!(bench.session().history().undo_label(), Some("Pose joints"));
        bench.apply([TransactionAction::Undo]);
    }
}

#[test]
fn the_light_goes_out_when_the_mouse_leaves_the_view() {
    let mut bench = human();
    let at = middle(&bench, "chest");
    bench.move_to(at);
    assert!(bench.session().selection().hovered().is_some());
    bench.move_to(pos2(6.0, 794.0));
    bench.settle();
    assert_eq!(bench.session().selection().hovered(), None);
}

#[test]
fn without_its_hand_the_arm_is_still_dragged_by_its_wrist() {
    let mut bench = Bench::after([DisplayEdit::ShowOverlay(Overlay::Hand, false)]);
    let at = fingers(&bench);
    bench.move_to(at);
    bench.press(LEFT);
    assert!(bench.session().history().drag().is_none(), "there are no fingers to take");
    bench.release(LEFT);
}
