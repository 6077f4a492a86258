//! The skeleton in the viewport: selecting, posing, rotating and solving by mouse.

use core::f32::consts::PI;

use egui::{CursorIcon, Key, Modifiers, PointerButton, Pos2, vec2};
use glam::Vec3;
use ik_arm::document::{Document, SkeletonRig, TargetMotion, TargetPath};
use ik_arm::kinematics::skeleton::{Joint, JointId, RotationAxis, Skeleton};
use ik_arm::session::{
    Action, Drag, FileAction, Grip, GripRing, JointEdit, PlaybackAction, SelectAction, TargetEdit,
    TransactionAction, ViewAction,
};

use crate::bench::{Bench, bits};

const LEFT: PointerButton = PointerButton::Primary;

/// A root that is a point with a bent chain of three on it, and a short bone aside.
fn skeleton() -> Skeleton {
    let mut skeleton = Skeleton::with_root("root");
    let add = |skeleton: &mut Skeleton, name: &str, parent: JointId, axis: Vec3| {
        let offset = skeleton.joints()[parent.index()].axis;
        let joint = Joint { offset, ..Joint::new(name, Some(parent), axis) };
        skeleton.add(joint).expect("a joint")
    };
    let a = add(&mut skeleton, "a", JointId::new(0), Vec3::new(0.2, 1.0, 0.0));
    let b = add(&mut skeleton, "b", a, Vec3::new(0.8, 0.3, 0.1));
    add(&mut skeleton, "c", b, Vec3::new(0.7, -0.4, 0.2));
    add(&mut skeleton, "d", a, Vec3::new(-0.6, 0.2, 0.0));
    skeleton
}

fn bench() -> Bench {
    let rig = SkeletonRig::new(skeleton());
    let document = Document::new(rig);
    let mut bench = Bench::after([FileAction::Opened {
        document: Box::new(document),
        file: None,
        contents: None,
    }]);
    let camera = bench.session().framing_all();
    bench.apply([ViewAction::SetCamera(camera)]);
    bench
}

fn tip_place(bench: &Bench, name: &str) -> Pos2 {
    bench.on_screen(bench.tip(name))
}

/// The middle of a bone, on screen.
fn bone_place(bench: &Bench, name: &str) -> Pos2 {
    let pose = bench.session().skeleton_pose();
    let joint = bench.joint(name);
    bench.on_screen(
        pose.base(JointId::new(joint.index())).midpoint(pose.tip(JointId::new(joint.index()))),
    )
}

/// A point of a ring around the selected joint, so many radians along from where it starts.
fn ring_place(bench: &Bench, axis: RotationAxis, radius: f32, angle: f32) -> Pos2 {
    let selected = bench.session().selection().active().expect("one");
    let ring = GripRing::of_joint(bench.session().posed(), selected, axis).expect("a ring");
    let (u, v) = ring.axis.any_orthonormal_pair();
    let v = v * u.cross(v).dot(ring.axis).signum();
    let rect = bench.viewport();
    let projection = bench.session().camera().projection(rect.aspect_ratio());
    let unit = projection.half_height_at(ring.centre) / (rect.height() / 2.0);
    bench.on_screen(ring.centre + (u * angle.cos() + v * angle.sin()) * radius * unit)
}

#[test]
fn a_click_on_a_bone_selects_it_and_a_click_beside_all_selects_none() {
    let mut bench = bench();
    for name in ["b", "d", "a", "c"] {
        let at = bone_place(&bench, name);
        bench.click_at(at);
        assert_eq!(bench.session().selection().joints(), [bench.joint(name)]);
    }
    let empty = bench.empty_point();
    bench.click_at(empty);
    assert!(bench.session().selection().joints().is_empty());
}

#[test]
fn shift_click_adds_a_bone_to_the_selection_or_removes_it() {
    let mut bench = bench();
    let places = ["a", "b", "c"].map(|name| bone_place(&bench, name));
    bench.click_at(places[0]);
    bench.hold(Modifiers::SHIFT);
    bench.click_at(places[1]);
    bench.click_at(places[2]);
    assert_eq!(bench.session().selection().joints(), [1, 2, 3].map(JointId::new));
    bench.click_at(places[1]);
    assert_eq!(bench.session().selection().joints(), [1, 3].map(JointId::new));
}

#[test]
fn orbiting_the_view_keeps_the_selection() {
    let mut bench = bench();
    let at = bone_place(&bench, "b");
    bench.click_at(at);
    let empty = bench.empty_point();
    bench.drag_and_drop(LEFT, empty, empty + vec2(120.0, 40.0));
    assert_eq!(bench.session().selection().joints(), [bench.joint("b")]);
}

#[test]
fn the_bone_under_the_mouse_is_highlighted() {
    let mut bench = bench();
    let at = bone_place(&bench, "c");
    bench.move_to(at);
    assert_eq!(bench.session().selection().hovered(), Some(bench.joint("c")));
    let empty = bench.empty_point();
    bench.move_to(empty);
    assert_eq!(bench.session().selection().hovered(), None);
}

#[test]
fn a_tip_that_is_dragged_stays_under_the_mouse_and_bones_keep_their_lengths() {
    let mut bench = bench();
    let start = tip_place(&bench, "c");
    bench.move_to(start);
    assert_eq!(bench.harness.output().platform_output.cursor_icon, CursorIcon::Grab);
    bench.press(LEFT);
    let root = bench.session().skeleton_pose().base(JointId::new(0));
    for step in 1..=20 {
        let pointer = start + vec2(-4.0, -5.0) * step as f32;
        bench.move_to(pointer);
        let seen = tip_place(&bench, "c");
        assert!(seen.distance(pointer) < 1.0, "{seen} is not under {pointer}");
    }
    bench.release(LEFT);
    let (before, pose) = (skeleton(), bench.session().skeleton_pose().clone());
    assert_eq!(bits(pose.base(JointId::new(0))), bits(root));
    for (index, joint) in before.joints().iter().enumerate() {
        let length = pose.base(JointId::new(index)).distance(pose.tip(JointId::new(index)));
        assert!((length - joint.axis.length()).abs() < 1e-4);
    }
    assert!(bench.session().selection().joints().is_empty(), "a drag selects nothing");
    assert_eq!(bench.session().rig().targets, [], "the target was only for the drag");
}

#[test]
fn escape_restores_the_pose_bit_for_bit() {
    let mut bench = bench();
    let before = bench.session().rig().clone();
    let start = tip_place(&bench, "c");
    bench.drag(LEFT, start, start + vec2(-70.0, 90.0));
    assert_ne!(bench.session().rig(), &before);
    bench.key(Key::Escape);
    bench.release(LEFT);
    assert_eq!(bench.session().rig(), &before);
}

#[test]
fn a_tip_comes_back_to_where_it_was_when_the_mouse_does() {
    let mut bench = bench();
    let before = bench.session().rig().clone();
    let start = tip_place(&bench, "c");
    bench.drag(LEFT, start, start + vec2(-70.0, 90.0));
    bench.move_to(start + vec2(1.0, 0.0));
    bench.release(LEFT);
    for (now, then) in bench.session().skeleton().joints().iter().zip(before.skeleton.joints()) {
        assert!(now.rotation.distance(then.rotation) < 0.1, "{} at {}", now.name, now.rotation);
    }
}

#[test]
fn a_root_that_is_a_point_moves_with_its_subtree() {
    let mut bench = bench();
    let (root, before) = (tip_place(&bench, "root"), bench.tip("c"));
    bench.drag_and_drop(LEFT, root, root + vec2(60.0, 25.0));
    let moved = bench.tip("c") - before;
    assert!(moved.length() > 0.1);
    assert!(tip_place(&bench, "root").distance(root + vec2(60.0, 25.0)) < 1.0);
    for joint in bench.session().skeleton().joints() {
        assert_eq!(joint.rotation, Vec3::ZERO, "{} is not turned", joint.name);
    }
}

#[test]
fn a_ring_turns_its_angle_alone_by_as_much_as_the_mouse_goes_around() {
    for axis in RotationAxis::ALL {
        let mut bench = bench();
        let b = bench.joint("b");
        bench.apply([SelectAction::Joints(vec![b])]);
        // At a point without other handles.
        let grip = |bench: &mut Bench, from: f32| {
            let at = ring_place(bench, axis, 56.0, from);
            bench.move_to(at);
            bench.press(LEFT);
            let drag = bench.session().history().drag().map(Drag::grip);
            if drag != Some(Grip::Ring(JointId::new(b.index()), axis)) {
                bench.key(Key::Escape);
                bench.release(LEFT);
                bench.apply([SelectAction::Joints(vec![b])]);
            }
            drag == Some(Grip::Ring(JointId::new(b.index()), axis))
        };
        let from = (0..16)
            .map(|part| part as f32 * PI / 8.0)
            .find(|from| grip(&mut bench, *from))
            .expect("the ring can be taken");
        for step in 1..=12 {
            let angle = step as f32 * 0.1;
            // The ring itself turns with other angles, not with its own.
            let at = ring_place(&bench, axis, 56.0, from + angle);
            bench.move_to(at);
            let rotation = bench.session().skeleton().joints()[b.index()].rotation;
            assert!(
                (rotation[axis.index()] - angle).abs() < 0.02,
                "{rotation} for {angle} about {axis}"
            );
            for other in (0..3).filter(|other| *other != axis.index()) {
                assert_eq!(rotation[other], 0.0);
            }
        }
        bench.release(LEFT);
    }
}

/// The skeleton with a bone whose tip is `aside` points outside the selected joint's ring about y,
/// at a free place of its near half. Returns also the tip and the point of the ring beside it, on
/// screen.
fn beside_a_ring(aside: f32) -> (Bench, JointId, [Pos2; 2]) {
    const RADIUS: f32 = 56.0;
    let mut bench = bench();
    let b = bench.joint("b");
    bench.apply([SelectAction::Joints(vec![b])]);
    let tips: Vec<Pos2> = ["root", "a", "b", "c", "d"].map(|name| tip_place(&bench, name)).into();
    let free = (0..64).map(|part| part as f32 * PI / 32.0).find(|angle| {
        let at = ring_place(&bench, RotationAxis::Y, RADIUS, *angle);
        bench.move_to(at);
        bench.press(LEFT);
        let grip = bench.session().history().drag().map(Drag::grip);
        bench.key(Key::Escape);
        bench.release(LEFT);
        bench.apply([SelectAction::Joints(vec![b])]);
        // So that the next press is no double click.
        bench.skip(1.0);
        grip == Some(Grip::Ring(b, RotationAxis::Y))
            && tips.iter().all(|tip| tip.distance(at) > 24.0)
    });
    let angle = free.expect("a free place of the ring");
    let on_ring = ring_place(&bench, RotationAxis::Y, RADIUS, angle);
    let rect = bench.viewport();
    let projection = bench.session().camera().projection(rect.aspect_ratio());
    let centre =
        GripRing::of_joint(bench.session().posed(), b, RotationAxis::Y).expect("a ring").centre;
    // Outwards from the ring's curve, on screen.
    let along = ring_place(&bench, RotationAxis::Y, RADIUS, angle + 0.02) - on_ring;
    let outwards = along.rot90().normalized();
    let outwards = outwards * outwards.dot(on_ring - bench.on_screen(centre)).signum();
    let at = on_ring + outwards * aside;
    let tip = bench.ray(at).meets_plane(centre, projection.forward);
    let parent = bench.joint("root");
    bench.apply([JointEdit::AddChild { parent, tip }]);
    let added = bench.session().selection().active().expect("the new joint");
    bench.apply([Action::from(SelectAction::Joints(vec![b]))]);
    (bench, added, [at, on_ring])
}

fn grip_at(bench: &mut Bench, at: Pos2) -> Option<Grip> {
    bench.move_to(at);
    bench.press(LEFT);
    let grip = bench.session().history().drag().map(Drag::grip);
    bench.key(Key::Escape);
    bench.release(LEFT);
    grip
}

#[test]
fn the_ring_of_the_selected_joint_wins_over_the_tip_of_another_bone_on_it() {
    let (mut bench, _, [_, on_ring]) = beside_a_ring(0.0);
    let b = bench.joint("b");
    assert_eq!(grip_at(&mut bench, on_ring), Some(Grip::Ring(b, RotationAxis::Y)));
    let (mut bench, _, [_, on_ring]) = beside_a_ring(6.0);
    assert_eq!(grip_at(&mut bench, on_ring), Some(Grip::Ring(b, RotationAxis::Y)));
}

#[test]
fn a_tip_wins_over_a_ring_if_its_centre_is_clearly_nearer() {
    let (mut bench, added, [at, _]) = beside_a_ring(6.0);
    let grip = grip_at(&mut bench, at);
    assert!(matches!(grip, Some(Grip::Tip(joint, _)) if joint == added), "{grip:?}");
}

#[test]
fn digits_type_the_degrees_that_a_ring_turns() {
    let mut bench = bench();
    let b = bench.joint("b");
    let forward = bench.session().camera().projection(1.0).forward;
    let ray = bench.session().camera().projection(1.0).ray(glam::Vec2::new(0.3, 0.3));
    bench.apply([TransactionAction::Grab { grip: Grip::Ring(b, RotationAxis::Z), ray, forward }]);
    bench.apply([TransactionAction::TypeOffset("37.5".to_owned())]);
    let rotation = bench.session().skeleton().joints()[b.index()].rotation;
    assert!((rotation.z.to_degrees() - 37.5).abs() < 1e-4);
    bench.apply([TransactionAction::Cancel]);
    assert_eq!(bench.session().skeleton().joints()[b.index()].rotation, Vec3::ZERO);
}

#[test]
fn a_target_is_dragged_and_the_skeleton_follows() {
    let mut bench = bench();
    let c = bench.joint("c");
    bench.apply([TargetEdit::AddTarget(c)]);
    let start = tip_place(&bench, "c");
    for step in 1..=15 {
        let pointer = start + vec2(-5.0, 4.0) * step as f32;
        if step == 1 {
            bench.move_to(start);
            bench.press(LEFT);
            assert!(matches!(
                bench.session().history().drag().map(Drag::grip),
                Some(Grip::Target(joint, _)) if joint == JointId::new(c.index())
            ));
        }
        bench.move_to(pointer);
        let target = bench.session().rig().targets[0].home;
        assert!(bench.on_screen(target).distance(pointer) < 0.1);
        assert!(bench.tip("c").distance(target) < 0.01, "the tip follows");
    }
    bench.release(LEFT);
}

#[test]
fn the_selected_joints_target_has_arrows_that_move_one_coordinate() {
    let mut bench = bench();
    let c = bench.joint("c");
    bench.apply([Action::from(TargetEdit::AddTarget(c)), SelectAction::Joints(vec![c]).into()]);
    let home = bench.session().rig().targets[0].home;
    let start = bench.on_screen(home);
    let camera = bench.session().camera();
    let projection = camera.projection(bench.viewport().aspect_ratio());
    let up = vec2(0.0, -Vec3::Y.dot(projection.up.normalize()));
    bench.drag_and_drop(LEFT, start + up * 70.0, start + up * 30.0);
    let moved = bench.session().rig().targets[0].home;
    assert_eq!([moved.x.to_bits(), moved.z.to_bits()], [home.x.to_bits(), home.z.to_bits()]);
    assert!(moved.y < home.y);
}

#[test]
fn dragging_a_moving_target_moves_its_path() {
    let mut bench = bench();
    let c = bench.joint("c");
    bench.apply([TargetEdit::AddTarget(c)]);
    let mut target = bench.session().rig().targets[0];
    target.motion = TargetMotion { path: TargetPath::Circle, ..target.motion };
    bench.apply([Action::from(TargetEdit::SetTarget(target)), PlaybackAction::SetTime(1.0).into()]);
    let start = bench.on_screen(target.at(1.0));
    bench.drag_and_drop(LEFT, start, start + vec2(30.0, 0.0));
    let dragged = bench.session().rig().targets[0];
    assert!(bench.on_screen(dragged.at(1.0)).distance(start + vec2(30.0, 0.0)) < 0.1);
    assert_eq!(dragged.motion, target.motion);
}

#[test]
fn ctrl_click_adds_a_bone_from_the_selected_tip_to_the_mouse() {
    let mut bench = bench();
    let c = bench.joint("c");
    bench.apply([SelectAction::Joints(vec![c])]);
    let (from, at) = (bench.tip("c"), tip_place(&bench, "c") + vec2(-20.0, 90.0));
    bench.hold(Modifiers::COMMAND);
    bench.click_at(at);
    let added = bench.session().selection().active().expect("the new joint");
    let (pose, rig) = (bench.session().skeleton_pose(), bench.session().rig());
    assert_eq!(rig.skeleton.joints()[added.index()].parent, Some(c));
    assert!(pose.base(added).distance(from) < 1e-5);
    assert!(bench.on_screen(pose.tip(added)).distance(at) < 0.1);
}
