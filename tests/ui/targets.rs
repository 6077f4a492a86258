//! Targets that pose a figure: with the mouse, from the panel, and over time.

use egui::PointerButton::Primary as LEFT;
use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::Vec3;
use ik_arm::document::{Channel, Target};
use ik_arm::kinematics::chain_ik::{Method, SolverOptions};
use ik_arm::kinematics::skeleton::RotationAxis;
use ik_arm::rig::{TargetKind, TargetSpace};
use ik_arm::session::{
    Action, Grip, GripRing, JointEdit, PlaybackAction, SelectAction, SolverEdit, TargetEdit,
    TransactionAction,
};

use crate::bench::Bench;

/// The Human without targets.
fn figure() -> Bench {
    let mut bench = Bench::example("human");
    let targets = bench.session().rig().targets.clone();
    bench.apply([SolverEdit::SetBodyFollows(false)]);
    bench.apply(targets.into_iter().map(|target| TargetEdit::RemoveTarget(target.joint)));
    bench
}

/// The Human with targets that were added to its hands and feet by T.
fn with_targets() -> Bench {
    let mut bench = figure();
    for name in ["left_hand", "right_hand", "left_foot", "right_foot"] {
        select(&mut bench, name);
        bench.key(Key::T);
        bench.settle();
    }
    bench
}

/// The Human with a whole-body target that was added to its head by T; the head is selected.
fn with_head_target() -> Bench {
    let mut bench = human();
    let own = bench.joint("head");
    bench.apply([TargetEdit::RemoveTarget(own)]);
    select(&mut bench, "head");
    bench.key(Key::T);
    bench.settle();
    bench
}

#[test]
fn one_button_adds_targets_to_hands_feet_and_head() {
    let mut bench = figure();
    let before = tips(&bench);
    bench.click(Role::Button, "Add targets");
    bench.settle();
    let rig = bench.session().rig();
    let ends: Vec<&str> =
        rig.targets.iter().map(|it| rig.skeleton[rig.end_of(it)].name.as_str()).collect();
    assert_eq!(ends, ["left_hand", "right_hand", "left_foot", "right_foot", "head"]);
    assert!(rig.targets[4].aim.is_some() && rig.body_follows);
    assert!(bench.says("Added targets: left_hand, right_hand, left_foot, right_foot and head"));
    assert!(farthest(&before, &tips(&bench)) < 1e-3 * bench.session().rig().reach());
    assert!(!bench.shows(Role::Button, "Add targets"), "there are targets");
    bench.choose(&["Edit", "Add targets"]);
    assert!(bench.says("Hands, feet and head have targets already"));
    bench.key_with(Modifiers::COMMAND, Key::Z);
    assert!(bench.session().rig().targets.is_empty(), "one step adds them all");
}

#[test]
fn a_figure_that_is_no_person_gets_no_targets_and_is_told_why() {
    let mut bench = figure();
    let shin = bench.joint("left_shin");
    bench.apply([JointEdit::RenameJoint { joint: shin, name: "pipe".into() }]);
    bench.apply([JointEdit::DeleteJoints(vec![bench.joint("right_foot")])]);
    bench.settle();
    bench.reveal(Role::Button, "Add targets");
    bench.click(Role::Button, "Add targets");
    let found = "Found left arm, right arm and head, but no left leg or right leg";
    assert!(bench.says(&format!("{found}: add targets by hand, with a joint selected and T")));
    assert!(bench.session().rig().targets.is_empty());
    let small = Bench::example("two-targets");
    assert!(!small.shows(Role::Button, "Add targets"), "too few joints");
}

fn select(bench: &mut Bench, name: &str) {
    let joint = bench.joint(name);
    bench.apply([SelectAction::Joints(vec![joint])]);
}

fn tips(bench: &Bench) -> Vec<Vec3> {
    let pose = bench.session().skeleton_pose();
    pose.ids().map(|joint| pose.tip(joint)).collect()
}

fn farthest(before: &[Vec3], after: &[Vec3]) -> f32 {
    before.iter().zip(after).map(|(before, after)| before.distance(*after)).fold(0.0, f32::max)
}

fn target<'a>(bench: &'a Bench, name: &str) -> &'a Target {
    let rig = bench.session().rig();
    &rig.targets[rig.target(bench.joint(name)).expect("a target")]
}

fn choose(bench: &mut Bench, list: &str, item: &str) {
    bench.reveal(Role::ComboBox, list);
    bench.click(Role::ComboBox, list);
    bench.click(Role::Button, item);
}

fn enter(bench: &mut Bench, slider: &str, number: &str) {
    bench.reveal(Role::SpinButton, &format!("{slider} value"));
    bench.enter(slider, number);
}

fn is_disabled(bench: &Bench, role: Role, name: &str) -> bool {
    use egui_kittest::kittest::NodeT as _;
    bench.node(role, name).accesskit_node().is_disabled()
}

#[test]
fn a_target_added_to_a_hand_or_foot_poses_its_limb_and_moves_nothing() {
    let mut bench = figure();
    let before = tips(&bench);
    for (end, lower) in [
        ("left_hand", "left_forearm"),
        ("right_hand", "right_forearm"),
        ("left_foot", "left_shin"),
        ("right_foot", "right_shin"),
    ] {
        select(&mut bench, end);
        bench.key(Key::T);
        bench.settle();
        let added = target(&bench, lower);
        assert!(added.limb().is_some() && added.influence == 1.0, "{added:?}");
        assert!(bench.shows(Role::CheckBox, &format!("Target of {end}")));
        assert!(bench.says("Reached"));
    }
    assert!(farthest(&before, &tips(&bench)) <= 2e-6);
    select(&mut bench, "head");
    bench.key(Key::T);
    bench.settle();
    assert_eq!(target(&bench, "head").kind, TargetKind::WholeBody);
    assert!(farthest(&before, &tips(&bench)) <= 2e-6);
    select(&mut bench, "left_hand");
    bench.key(Key::T);
    bench.settle();
    assert_eq!(bench.session().rig().targets.len(), 4, "T on a hand removes its target");
}

#[test]
fn hands_and_feet_stay_while_the_pelvis_is_dragged_in_one_undo_step() {
    let mut bench = with_targets();
    let lowers = ["left_forearm", "right_forearm", "left_shin", "right_shin"];
    let before = lowers.map(|name| bench.tip(name));
    let (pelvis, all) = (bench.tip("pelvis"), tips(&bench));
    let reach = bench.session().rig().reach();
    bench.apply([SelectAction::Joints(Vec::new())]);
    let start = bench.on_screen(pelvis);
    bench.move_to(start);
    bench.press(LEFT);
    for step in 1..=10 {
        bench.move_to(start + vec2(1.0, 3.0) * step as f32);
        for (name, before) in lowers.into_iter().zip(before) {
            let moved = bench.tip(name).distance(before);
            assert!(moved <= 1e-5 * reach, "{name} moves by {moved} in step {step}");
        }
    }
    bench.release(LEFT);
    assert!(bench.tip("pelvis").distance(pelvis) > 0.02);
    bench.apply([TransactionAction::Undo]);
    assert_eq!(tips(&bench), all);
}

#[test]
fn influence_blends_from_the_joint_angles_to_the_target() {
    let mut bench = with_targets();
    select(&mut bench, "left_hand");
    let fk = bench.tip("left_forearm");
    enter(&mut bench, "Target y", "1.4");
    let solved = bench.tip("left_forearm");
    assert!(solved.distance(fk) > 0.1);
    enter(&mut bench, "IK influence", "0");
    assert!(bench.tip("left_forearm").distance(fk) <= 1e-6);
    assert!(bench.says("has no influence: the joint angles alone pose it"));
    bench.reveal(Role::Button, "FK to pose");
    assert!(is_disabled(&bench, Role::Button, "FK to pose"));
    enter(&mut bench, "IK influence", "0.5");
    let between = bench.tip("left_forearm");
    assert!(between.distance(fk) > 0.02 && between.distance(solved) > 0.02);
    enter(&mut bench, "IK influence", "1");
    assert!(bench.tip("left_forearm").distance(solved) <= 1e-6);
}

#[test]
fn diamonds_key_what_a_target_has_and_the_limb_follows_over_time() {
    let mut bench = with_targets();
    select(&mut bench, "left_foot");
    let shin = bench.joint("left_shin");
    let start = bench.tip("left_shin");
    bench.reveal(Role::Button, "Key Target y");
    bench.click(Role::Button, "Key Target y");
    bench.apply([PlaybackAction::SetTime(1.0)]);
    enter(&mut bench, "Target y", "0.4");
    let keys = |bench: &Bench, channel| {
        bench.session().document().keys.track(channel).map_or(0, |track| track.knots().len())
    };
    assert_eq!(keys(&bench, Channel::Target(shin)), 2, "the first key has turned auto-key on");
    assert!((bench.tip("left_shin").y - 0.4).abs() < 1e-4);
    bench.apply([PlaybackAction::SetTime(0.0)]);
    assert!(bench.tip("left_shin").distance(start) < 1e-5);
    bench.apply([PlaybackAction::SetTime(0.5)]);
    let middle = bench.tip("left_shin").y;
    assert!(middle > start.y + 0.05 && middle < 0.35, "{middle}");

    bench.reveal(Role::Button, "Key IK influence");
    bench.click(Role::Button, "Key IK influence");
    assert_eq!(keys(&bench, Channel::TargetInfluence(shin)), 1);
    bench.click(Role::Button, "Key IK influence");
    assert_eq!(keys(&bench, Channel::TargetInfluence(shin)), 0, "a second press deletes the key");
}

#[test]
fn a_target_moves_with_the_joint_that_is_chosen_and_not_with_its_own() {
    let mut bench = with_targets();
    select(&mut bench, "left_hand");
    let before = tips(&bench);
    choose(&mut bench, "Target space", "chest");
    let chest = bench.joint("chest");
    assert_eq!(target(&bench, "left_forearm").space, TargetSpace::Joint(chest));
    assert!(farthest(&before, &tips(&bench)) <= 1e-5);
    let on_chest = |bench: &Bench| {
        let pose = &bench.session().posed().evaluated_skeleton().solved;
        pose.full_transform(chest).inverse().transform_point3(bench.tip("left_forearm"))
    };
    let place = on_chest(&bench);
    let spine = bench.joint("spine");
    bench.apply([JointEdit::SetRotation { joint: spine, rotation: Vec3::new(0.3, 0.2, 0.0) }]);
    let moved = bench.tip("left_forearm").distance(before[7]);
    assert!(moved > 0.02, "it moves with the chest by {moved}");
    assert!(on_chest(&bench).distance(place) <= 1e-5);

    bench.reveal(Role::ComboBox, "Target space");
    bench.click(Role::ComboBox, "Target space");
    assert!(is_disabled(&bench, Role::Button, "left_forearm"), "the target moves it");
}

#[test]
fn dragging_an_elbow_turns_it_about_the_line_to_the_target() {
    let mut bench = with_targets();
    bench.apply([SelectAction::Joints(Vec::new())]);
    let (elbow, hand) = (bench.tip("right_upper_arm"), bench.tip("right_forearm"));
    let start = bench.on_screen(elbow);
    bench.drag_and_drop(LEFT, start, start + vec2(-25.0, 0.0));
    let twist = target(&bench, "right_forearm").limb().expect("a limb").twist;
    assert!(twist.abs() > 0.1, "{twist}");
    assert!(bench.tip("right_forearm").distance(hand) <= 1e-5, "the hand stays");
    assert!(bench.tip("right_upper_arm").distance(elbow) > 0.01);
}

#[test]
fn dragging_the_tip_of_a_limb_moves_its_target() {
    let mut bench = with_targets();
    bench.apply([SelectAction::Joints(Vec::new())]);
    let wrist = bench.tip("left_forearm");
    let start = bench.on_screen(wrist);
    let end = start + vec2(20.0, -15.0);
    bench.drag_and_drop(LEFT, start, end);
    assert!(bench.on_screen(bench.tip("left_forearm")).distance(end) < 1.0);
    assert!(target(&bench, "left_forearm").home.distance(wrist) > 0.02);
}

#[test]
fn the_pole_of_a_limb_is_dragged_and_the_elbow_points_at_it() {
    let mut bench = with_targets();
    select(&mut bench, "left_hand");
    let before = tips(&bench);
    choose(&mut bench, "Twist reference", "Pole");
    let forearm = bench.joint("left_forearm");
    let pole = bench.session().posed().target_report(forearm).and_then(|report| report.pole);
    let pole = pole.expect("a pole");
    assert!(farthest(&before, &tips(&bench)) <= 2e-2, "the new pole is in front of the elbow");
    let start = bench.on_screen(pole);
    bench.drag_and_drop(LEFT, start, start + vec2(-60.0, 20.0));
    let limb = *target(&bench, "left_forearm").limb().expect("a limb");
    let (_, moved) = limb.pole().expect("a pole");
    assert!(moved.distance(pole) > 0.05);
    assert!(farthest(&before, &tips(&bench)) > 1e-3, "the elbow turns");
}

#[test]
fn matches_move_nothing() {
    let mut bench = with_targets();
    select(&mut bench, "left_hand");
    let before = tips(&bench);
    enter(&mut bench, "Target y", "1.3");
    enter(&mut bench, "Socket twist", "40");
    assert!(farthest(&before, &tips(&bench)) > 0.1);
    let before = tips(&bench);
    bench.reveal(Role::Button, "FK to pose");
    bench.click(Role::Button, "FK to pose");
    assert!(farthest(&before, &tips(&bench)) <= 2e-6);
    enter(&mut bench, "IK influence", "0");
    assert!(farthest(&before, &tips(&bench)) <= 2e-6, "FK has the pose");
    enter(&mut bench, "Target y", "0.9");
    bench.reveal(Role::Button, "Target to FK");
    bench.click(Role::Button, "Target to FK");
    enter(&mut bench, "IK influence", "1");
    assert!(farthest(&before, &tips(&bench)) <= 2e-6, "the target is at the FK tip");
}

#[test]
fn a_hand_keeps_its_orientation_while_the_arm_moves() {
    let mut bench = with_targets();
    select(&mut bench, "left_hand");
    bench.toggle(&["Hand orientation"]);
    bench.reveal(Role::RadioButton, "Keep orientation");
    bench.click(Role::RadioButton, "Keep orientation");
    let hand = bench.joint("left_hand");
    let turned =
        |bench: &Bench| bench.session().posed().evaluated_skeleton().solved.rotation_in_world(hand);
    let before = turned(&bench);
    let place = bench.tip("left_forearm") + Vec3::new(0.02, 0.06, 0.05);
    let moved = Target { home: place, ..*target(&bench, "left_forearm") };
    bench.apply([Action::from(TargetEdit::SetTarget(moved))]);
    assert!(bench.tip("left_forearm").distance(place) <= 1e-5);
    assert!(turned(&bench).angle_between(before) <= 1e-4);
    bench.apply([Action::from(TargetEdit::SetTarget(Target { orientation: None, ..moved }))]);
    assert!(turned(&bench).angle_between(before) > 0.05, "without, it follows the forearm");
}

#[test]
fn a_target_that_is_not_reached_says_its_distance_and_one_that_is_disabled_that_it_is_off() {
    let mut bench = with_targets();
    // The note on a selected target says its distance, too.
    bench.apply([SelectAction::Joints(Vec::new())]);
    let says = |bench: &Bench, text: &str| {
        bench.harness.query_all_by_role_and_label(Role::Label, text).count()
    };
    let numbers = |bench: &Bench| {
        let labels = bench.harness.query_all_by_role(Role::Label);
        labels
            .filter(|it| it.accesskit_node().value().is_some_and(|it| it.parse::<f32>().is_ok()))
            .count()
    };
    let others = numbers(&bench);
    let moved = *target(&bench, "left_forearm");
    bench.apply([TargetEdit::SetTarget(Target { home: moved.home + Vec3::X * 3.0, ..moved })]);
    let report = bench.session().posed().target_report(moved.joint).expect("a report");
    assert!(report.error > 1.0);
    assert_eq!(says(&bench, &format!("{:.3}", report.error)), 1);
    assert_eq!((numbers(&bench), says(&bench, "off")), (others + 1, 0));
    let away = *target(&bench, "left_forearm");
    for disabled in [moved, away] {
        bench.apply([TargetEdit::SetTarget(Target { enabled: false, ..disabled })]);
        assert_eq!((numbers(&bench), says(&bench, "off")), (others, 1));
    }
}

#[test]
fn a_target_matched_to_fk_says_that_the_figure_follows_if_the_target_poses() {
    let mut bench = with_targets();
    for (influence, said) in
        [(1.0, "the figure follows into its FK pose"), (0.0, "nothing else moves")]
    {
        select(&mut bench, "left_hand");
        let posing = *target(&bench, "left_forearm");
        let home = posing.home + Vec3::Y * 0.1;
        bench.apply([TargetEdit::SetTarget(Target { influence, home, ..posing })]);
        bench.reveal(Role::Button, "Target to FK");
        assert!(crate::looks::has_tooltip(&mut bench, Role::Button, "Target to FK"));
        assert!(bench.says(said), "{influence}: {said}");
        let before = tips(&bench);
        bench.click(Role::Button, "Target to FK");
        let moved = farthest(&before, &tips(&bench));
        assert_eq!(moved > 1e-3, influence > 0.0, "{influence}: {moved}");
    }
}

#[test]
fn no_row_moves_when_a_slider_is_let_go_that_put_a_target_out_of_reach() {
    let mut bench = with_targets();
    select(&mut bench, "left_hand");
    bench.reveal(Role::Slider, "Target x");
    let rail = bench.rect(Role::Slider, "Target x");
    let end = rail.right_center() - vec2(3.0, 0.0);
    bench.drag_and_drop(LEFT, rail.center(), end);
    bench.settle();
    assert!(bench.says("left_hand not reached"), "the slider put the target out of reach");
    assert_eq!(bench.rect(Role::Slider, "Target x"), rail);
    let nodes = bench.harness.query_all_by_role(Role::Button);
    let under = nodes.filter(|node| node.rect().expand(4.0).contains(end)).count();
    assert_eq!(under, 0, "a button came under the mouse");
}

/// Radius in points of rings around a point with arrows.
const RING: f32 = 104.0;

fn human() -> Bench {
    let mut bench = Bench::example("human");
    bench.apply([SolverEdit::SetBodyFollows(false)]);
    bench
}

fn held(bench: &Bench, name: &str) -> Option<Vec3> {
    target(bench, name).orientation
}

#[test]
fn rings_turn_the_orientation_that_the_target_of_a_foot_holds() {
    for axis in RotationAxis::ALL {
        let mut bench = human();
        select(&mut bench, "left_foot");
        let (shin, foot) = (bench.joint("left_shin"), bench.joint("left_foot"));
        let grip = Grip::Orientation(shin, axis);
        let (before, home) =
            (held(&bench, "left_shin").expect("held"), target(&bench, "left_shin").home);
        let turned = |bench: &Bench| {
            bench.session().posed().evaluated_skeleton().solved.rotation_in_world(foot)
        };
        let was = turned(&bench);
        let ring = GripRing::of_orientation(bench.session().posed(), shin, axis).expect("a ring");
        let to = bench.take_ring(grip, ring, RING, 0.1);
        bench.move_to(to);
        assert!(bench.says("Rotate about"));
        let now = held(&bench, "left_shin").expect("held");
        assert!(
            (now[axis.index()] - before[axis.index()] - 0.1).abs() < 2e-3,
            "{now} was {before}"
        );
        for other in (0..3).filter(|other| *other != axis.index()) {
            assert_eq!(now[other].to_bits(), before[other].to_bits());
        }
        let expected = glam::DQuat::from_axis_angle(ring.axis.as_dvec3(), 0.1) * was;
        assert!(turned(&bench).angle_between(expected) < 3e-3, "about {axis}");
        bench.key(Key::Escape);
        bench.release(LEFT);
        assert_eq!(held(&bench, "left_shin"), Some(before), "Esc restores");

        let to = bench.take_ring(grip, ring, RING, 0.1);
        bench.move_to(to);
        bench.release(LEFT);
        assert_eq!(bench.session().history().undo_label(), Some("Turn target"));
        assert_eq!(target(&bench, "left_shin").home, home);
        bench.apply([TransactionAction::Undo]);
        assert_eq!(held(&bench, "left_shin"), Some(before));
        let label = bench.session().history().undo_label();
        assert_eq!(label, Some("Keep body"), "it was one step");
    }
}

#[test]
fn ctrl_snaps_a_held_orientation_and_auto_key_keys_it() {
    let mut bench = human();
    select(&mut bench, "right_foot");
    let shin = bench.joint("right_shin");
    let ring =
        GripRing::of_orientation(bench.session().posed(), shin, RotationAxis::Y).expect("a ring");
    bench.apply([PlaybackAction::SetAutoKey(true)]);
    let to = bench.take_ring(Grip::Orientation(shin, RotationAxis::Y), ring, RING, 0.2);
    bench.hold(Modifiers::COMMAND | Modifiers::CTRL);
    bench.move_to(to);
    bench.release(LEFT);
    bench.hold(Modifiers::NONE);
    let degrees = held(&bench, "right_shin").expect("held").y.to_degrees();
    assert!((degrees / 5.0 - (degrees / 5.0).round()).abs() < 1e-4, "{degrees}");
    let keys = &bench.session().document().keys;
    assert!(keys.has(Channel::TargetOrientation(shin)));
    assert!(!keys.has(Channel::Target(shin)), "nothing else is keyed");
}

#[test]
fn a_whole_body_target_can_turn_its_joint() {
    let mut bench = with_head_target();
    let turned = |bench: &Bench| {
        let head = bench.joint("head");
        bench.session().posed().evaluated_skeleton().solved.rotation_in_world(head)
    };
    let before = turned(&bench);
    choose(&mut bench, "Target turns", "To a rotation");
    assert!(turned(&bench).angle_between(before) < 1e-3, "it keeps the rotation that it has");
    let held = held(&bench, "head").expect("angles");
    bench.reveal(Role::Slider, "Target rotation y");
    bench.enter("Target rotation y", "30");
    let wanted = glam::DQuat::from_rotation_z(f64::from(held.z))
        * glam::DQuat::from_rotation_y(30.0_f64.to_radians())
        * glam::DQuat::from_rotation_x(f64::from(held.x));
    assert!(turned(&bench).angle_between(wanted) < 2e-3);
    let head = bench.joint("head");
    let ring = GripRing::of_orientation(bench.session().posed(), head, RotationAxis::Y);
    assert!(ring.is_some(), "a ring turns it, too");

    // A method that cannot do it says so.
    bench.apply([TransactionAction::Undo, TransactionAction::Undo]);
    assert_eq!(self::held(&bench, "head"), None);
    let options = SolverOptions::new(Method::Relaxation);
    bench.apply([SolverEdit::SetSolver(options)]);
    choose(&mut bench, "Target turns", "To a rotation");
    assert_eq!(self::held(&bench, "head"), None, "the choice is disabled");

    // FABRIK turns, but does not aim.
    bench.apply([SolverEdit::SetSolver(SolverOptions::new(Method::Fabrik))]);
    choose(&mut bench, "Target turns", "Aims at a point");
    assert!(target(&bench, "head").aim.is_none(), "the choice is disabled");
    choose(&mut bench, "Target turns", "To a rotation");
    assert!(self::held(&bench, "head").is_some());
}

#[test]
fn a_whole_body_target_can_aim_an_axis_of_its_joint() {
    let mut bench = with_head_target();
    let head = bench.joint("head");
    let solved = |bench: &Bench| bench.session().posed().evaluated_skeleton().solved.clone();
    let before = solved(&bench).rotation_in_world(head);
    choose(&mut bench, "Target turns", "Aims at a point");
    assert!(solved(&bench).rotation_in_world(head).angle_between(before) < 1e-3);
    bench.reveal(Role::Slider, "Aim x");
    bench.enter("Aim x", "0.4");
    let aim = target(&bench, "head").aim.expect("an aim");
    let off = |bench: &Bench, axis: Vec3| {
        let pose = solved(bench);
        let looks = pose.rotation_in_world(head).as_quat() * axis;
        looks.angle_between(aim.point - pose.base(head))
    };
    assert_eq!((aim.axis, aim.point.x), (Vec3::Z, 0.4));
    assert!(off(&bench, Vec3::Z) < 2e-3, "{}", off(&bench, Vec3::Z));

    choose(&mut bench, "Target turns", "Free");
    assert_eq!((target(&bench, "head").aim, held(&bench, "head")), (None, None));
}

#[test]
fn a_target_that_turns_a_joint_can_leave_its_place_free() {
    let mut bench = with_head_target();
    assert!(!bench.shows(Role::CheckBox, "Free place"), "a target that turns nothing has a place");
    choose(&mut bench, "Target turns", "Aims at a point");
    bench.reveal(Role::CheckBox, "Free place");
    bench.click(Role::CheckBox, "Free place");
    assert!(target(&bench, "head").has_free_place());
    assert!(!bench.shows(Role::Slider, "Target x"), "there is no place to set");
    let head = bench.joint("head");
    let report = bench.session().posed().target_report(head).expect("a report").clone();
    assert_eq!(report.error, 0.0);
    bench.reveal(Role::Slider, "Aim x");
    bench.enter("Aim x", "0.9");
    let aimed = bench.session().posed().target_report(head).expect("a report").clone();
    assert!(aimed.rotation_error.expect("an aim") < 2e-3);

    choose(&mut bench, "Target turns", "Free");
    assert_eq!(target(&bench, "head").weight, 1.0, "it has a place again");
}

#[test]
fn the_point_of_an_aim_is_dragged_in_the_view_and_keyed() {
    let mut bench = with_head_target();
    let head = bench.joint("head");
    choose(&mut bench, "Target turns", "Aims at a point");
    let point = |bench: &Bench| target(bench, "head").aim.expect("an aim").point;
    let before = point(&bench);
    let at = bench.on_screen(before);
    bench.move_to(at);
    assert!(bench.says("left drag: drag the aim of head"));
    bench.drag_and_drop(LEFT, at, at + vec2(60.0, -20.0));
    let after = point(&bench);
    assert!(bench.on_screen(after).distance(at + vec2(60.0, -20.0)) < 1.0, "under the mouse");
    let pose = bench.session().posed().skeleton().clone();
    let looks = pose.rotation_in_world(head).as_quat() * Vec3::Z;
    assert!(looks.angle_between(after - pose.base(head)) < 2e-3, "the head follows");
    assert_eq!(bench.session().history().undo_label(), Some("Move aim"));
    bench.reveal(Role::Button, "Key Aim x");
    bench.click(Role::Button, "Key Aim x");
    let keys = &bench.session().document().keys;
    assert!(keys.has(Channel::TargetAim(head)));

    // A match moves the point to where the joint looks by its angles.
    bench.reveal(Role::Button, "Target to FK");
    bench.click(Role::Button, "Target to FK");
    let pose = bench.session().posed().evaluated_skeleton().fk.clone();
    let looks = pose.rotation_in_world(head).as_quat() * Vec3::Z;
    assert!(looks.angle_between(point(&bench) - pose.base(head)) < 2e-3, "{}", point(&bench));
}

#[test]
fn the_target_of_the_head_turns_as_many_joints_as_its_chain_is_long() {
    let chain = |length: u32| TargetKind::Chain(length.try_into().expect("above 0"));
    let mut bench = human();
    select(&mut bench, "head");
    bench.settle();
    assert_eq!(target(&bench, "head").kind, chain(2));
    for (typed, length) in [("3", 3), ("0", 1), ("99", 5)] {
        bench.reveal(Role::SpinButton, "Chain length");
        bench.type_into("Chain length", typed);
        assert_eq!(target(&bench, "head").kind, chain(length), "{typed}");
    }
    let aim = target(&bench, "head").aim;
    choose(&mut bench, "Target kind", "Whole body");
    assert_eq!(target(&bench, "head").kind, TargetKind::WholeBody);
    choose(&mut bench, "Target kind", "Chain");
    assert_eq!((target(&bench, "head").kind, target(&bench, "head").aim), (chain(2), aim));
}

#[test]
fn a_hand_that_follows_its_bone_has_rings_of_its_own_angles() {
    let mut bench = human();
    select(&mut bench, "left_hand");
    let (forearm, hand) = (bench.joint("left_forearm"), bench.joint("left_hand"));
    assert_eq!(GripRing::of_orientation(bench.session().posed(), forearm, RotationAxis::X), None);
    let before = bench.session().skeleton()[hand].rotation;
    let ring = GripRing::of_joint(bench.session().posed(), hand, RotationAxis::Z).expect("a ring");
    let to = bench.take_ring(Grip::Ring(hand, RotationAxis::Z), ring, RING, 0.2);
    bench.drag(LEFT, to, to);
    bench.release(LEFT);
    let after = bench.session().skeleton()[hand].rotation;
    assert!((after.z - before.z).abs() > 0.05, "{after} was {before}");
    bench.apply([TransactionAction::Undo]);

    bench.toggle(&["Hand orientation"]);
    bench.reveal(Role::RadioButton, "Keep orientation");
    bench.click(Role::RadioButton, "Keep orientation");
    assert_eq!(
        GripRing::of_joint(bench.session().posed(), hand, RotationAxis::Z),
        None,
        "the target turns the hand"
    );
    assert!(GripRing::of_orientation(bench.session().posed(), forearm, RotationAxis::Z).is_some());
}
