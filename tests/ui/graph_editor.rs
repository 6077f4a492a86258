//! The graph editor: keys and tangents dragged, interpolation chosen.

use crate::common::arm::{ArmEdit, ArmSession, Step, channels};
use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::kittest::NodeT as _;
use ik_arm::document::Channel;
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::kinematics::spline::{Interpolation, Knot};
use ik_arm::session::{
    Action, FileAction, KeysEdit, PlaybackAction, SelectAction, TransactionAction, ViewAction,
};

use crate::bench::{Bench, LARGE};
use crate::common::documents::open_example;
use glam::Vec3;

const LEFT: PointerButton = PointerButton::Primary;
const RIGHT: PointerButton = PointerButton::Secondary;
/// Times and values of the keys, in seconds and degrees.
const KEYS: [(f64, f32); 3] = [(1.0, 0.0), (3.0, 60.0), (5.0, 0.0)];

/// The curve of the Socket twist with three keys.
fn graph() -> Bench {
    let mut bench = Bench::with_timeline(LARGE);
    for (time, degrees) in KEYS {
        bench.apply([
            Step::from(PlaybackAction::SetTime(time)),
            ArmEdit::SetTwist(degrees.to_radians()).into(),
            KeysEdit::Key(vec![channels::TWIST]).into(),
        ]);
    }
    bench.apply([ViewAction::ShowGraphEditor(true)]);
    bench.apply([PlaybackAction::SetTime(0.0)]);
    bench
}

/// Screen position of a time and a value in degrees, with the room that the plot leaves above and
/// below its curves.
fn place(bench: &Bench, time: f64, degrees: f32) -> Pos2 {
    let area = bench.rect(Role::Image, "Curves of hand · Socket twist");
    let seconds = bench.session().document().timeline.duration();
    let (low, high) = (-0.12 * 60.0, 1.12 * 60.0);
    // The dope sheet's scale: the timeline with a margin at both sides.
    let x = scale(bench, time).unwrap_or(area.left() + area.width() * (time / seconds) as f32);
    pos2(x, area.bottom() - area.height() * (degrees - low) / (high - low))
}

/// Screen x of a time, from the keys in the dope sheet.
fn scale(bench: &Bench, time: f64) -> Option<f32> {
    let mut sheet = Bench::with_timeline(LARGE);
    for (time, _) in KEYS {
        let key = KeysEdit::Key(vec![channels::HAND]);
        sheet.apply([Action::from(PlaybackAction::SetTime(time)), key.into()]);
    }
    let x = |time: f64| {
        sheet.rect(Role::Button, &format!("Key of hand · target at {time:.2} s")).center().x
    };
    let (a, b) = (x(1.0), x(5.0));
    assert_eq!(sheet.session().document().timeline, bench.session().document().timeline);
    Some(a + (b - a) * ((time - 1.0) / 4.0) as f32)
}

fn keys(bench: &Bench) -> Vec<Knot<Vec3>> {
    let track = bench.session().document().keys.track(channels::TWIST).expect("keys");
    track.knots().to_vec()
}

#[test]
fn a_key_is_dragged_in_time_and_value_in_one_undo_step() {
    let mut bench = graph();
    let before = keys(&bench);
    let from = place(&bench, 3.0, 60.0);
    let to = place(&bench, 4.0, 30.0);
    bench.drag_and_drop(LEFT, from, to);
    bench.settle();
    let moved = keys(&bench)[1];
    assert!((moved.time - 4.0).abs() < 1e-9, "on a frame: {}", moved.time);
    assert!((moved.value.x.to_degrees() - 30.0).abs() < 1.5, "{}", moved.value.x.to_degrees());
    assert_eq!([keys(&bench)[0], keys(&bench)[2]], [before[0], before[2]]);
    assert_eq!(bench.session().history().undo_label(), Some("Move keys"));
    bench.apply([TransactionAction::Undo]);
    assert_eq!(keys(&bench), before);
}

#[test]
fn shift_keeps_a_drag_to_one_direction_and_esc_cancels_it() {
    let mut bench = graph();
    let before = keys(&bench);
    let from = place(&bench, 3.0, 60.0);
    bench.hold(Modifiers::SHIFT);
    bench.drag(LEFT, from, from + vec2(8.0, 40.0));
    assert_eq!(keys(&bench)[1].time, 3.0);
    assert!(keys(&bench)[1].value.x < before[1].value.x);
    bench.key(Key::Escape);
    bench.release(LEFT);
    bench.hold(Modifiers::NONE);
    bench.settle();
    assert_eq!(keys(&bench), before);
}

#[test]
fn a_click_selects_and_shift_adds_and_removes() {
    let mut bench = graph();
    bench.click_at(place(&bench, 3.0, 60.0));
    assert_eq!(bench.session().selection().keys(), [(channels::TWIST, 3.0)]);
    bench.hold(Modifiers::SHIFT);
    bench.click_at(place(&bench, 5.0, 0.0));
    assert_eq!(
        bench.session().selection().keys(),
        [(channels::TWIST, 3.0), (channels::TWIST, 5.0)]
    );
    bench.click_at(place(&bench, 5.0, 0.0));
    assert_eq!(bench.session().selection().keys(), [(channels::TWIST, 3.0)]);
}

#[test]
fn a_drag_of_a_handle_turns_the_tangent_and_alt_turns_one_side_of_it() {
    let mut bench = graph();
    bench.click_at(place(&bench, 3.0, 60.0));
    bench.settle();
    // The tangent of the highest key is level.
    let handle = place(&bench, 3.0, 60.0) + vec2(40.0, 0.0);
    bench.drag_and_drop(LEFT, handle, handle + vec2(0.0, 20.0));
    bench.settle();
    let slopes = keys(&bench)[1].slopes.expect("its own slopes");
    assert!(slopes.leaving.x < -0.01 && slopes.arriving == slopes.leaving, "{slopes:?}");
    assert_eq!(bench.session().history().undo_label(), Some("Set tangents"));
    assert_eq!(keys(&bench)[1].value, keys(&graph())[1].value, "the key stays");

    let mut bench = graph();
    bench.click_at(place(&bench, 3.0, 60.0));
    bench.settle();
    bench.hold(Modifiers::ALT);
    bench.drag_and_drop(LEFT, handle, handle + vec2(0.0, 20.0));
    bench.hold(Modifiers::NONE);
    bench.settle();
    let slopes = keys(&bench)[1].slopes.expect("its own slopes");
    assert!(slopes.leaving.x < -0.01 && slopes.arriving.x.abs() < 1e-6, "{slopes:?}");

    bench.move_to(place(&bench, 3.0, 60.0));
    bench.press(RIGHT);
    bench.release(RIGHT);
    bench.settle();
    bench.click(Role::Button, "Automatic tangents");
    assert_eq!(keys(&bench)[1].slopes, None);
}

#[test]
fn the_context_menu_chooses_the_interpolation_of_the_selected_keys() {
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        let mut bench = graph();
        bench.move_to(place(&bench, 3.0, 60.0));
        bench.press(RIGHT);
        bench.release(RIGHT);
        bench.settle();
        assert_eq!(bench.session().selection().keys(), [(channels::TWIST, 3.0)], "selects it");
        bench.click(Role::Button, interpolation.title());
        assert_eq!(keys(&bench)[1].interpolation, interpolation);
        bench.apply([PlaybackAction::SetTime(4.0)]);
        let degrees = bench.session().arm().twist.to_degrees();
        let expected = if interpolation == Interpolation::Linear { 30.0 } else { 60.0 };
        assert!((degrees - expected).abs() < 1e-3, "{interpolation:?}: {degrees}");
        bench.apply([TransactionAction::Undo]);
        assert_eq!(keys(&bench)[1].interpolation, Interpolation::Auto);
    }
}

#[test]
fn slerp_is_offered_for_joints_alone() {
    let is_disabled = |bench: &Bench| {
        bench.node(Role::Button, Interpolation::Slerp.title()).accesskit_node().is_disabled()
    };
    let mut bench = graph();
    bench.move_to(place(&bench, 3.0, 60.0));
    bench.press(RIGHT);
    bench.release(RIGHT);
    bench.settle();
    assert!(is_disabled(&bench), "the twist is no rotation of a joint");
    let key = (Channel::Rotation(JointId::new(0)), 1.0);
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([
        Step::from(FileAction::NewFigure),
        PlaybackAction::SetTime(1.0).into(),
        KeysEdit::Key(vec![key.0]).into(),
        SelectAction::Keys(vec![key]).into(),
        ViewAction::ShowGraphEditor(true).into(),
    ]);
    bench.apply([KeysEdit::SetInterpolation(vec![key], Interpolation::Slerp)]);
    let set = bench.session().document().keys.key(key.0, key.1).expect("a key");
    assert_eq!(set.interpolation, Interpolation::Slerp);
}

#[test]
fn copied_and_moved_keys_keep_their_shape() {
    let mut bench = graph();
    let key = (channels::TWIST, 3.0);
    bench.apply([KeysEdit::SetInterpolation(vec![key], Interpolation::Step)]);
    bench.apply([Action::from(SelectAction::Keys(vec![key])), SelectAction::CopyKeys.into()]);
    bench.apply([Action::from(PlaybackAction::SetTime(7.0)), KeysEdit::PasteKeys.into()]);
    bench.apply([KeysEdit::MoveKeys { keys: vec![key], by: 0.5, raise: Vec3::ZERO }]);
    let shapes: Vec<_> = keys(&bench).iter().map(|key| (key.time, key.interpolation)).collect();
    let (auto, step) = (Interpolation::Auto, Interpolation::Step);
    assert_eq!(shapes, [(1.0, auto), (3.5, step), (5.0, auto), (7.0, step)]);
}

#[test]
fn a_hold_between_two_equal_keys_holds_and_catmull_rom_is_one_choice_away() {
    let mut bench = graph();
    for (time, degrees) in [(1.0, 90.0_f32), (3.0, 177.0), (5.0, 177.0), (7.0, 90.0)] {
        bench.apply([
            Step::from(PlaybackAction::SetTime(time)),
            ArmEdit::SetTwist(degrees.to_radians()).into(),
            KeysEdit::Key(vec![channels::TWIST]).into(),
        ]);
    }
    let between = |bench: &mut Bench| {
        bench.apply([PlaybackAction::SetTime(4.0)]);
        bench.session().arm().twist.to_degrees()
    };
    assert!((between(&mut bench) - 177.0).abs() < 1e-3);
    bench.apply([SelectAction::Keys(
        keys(&bench).iter().map(|it| (channels::TWIST, it.time)).collect(),
    )]);
    let area = bench.rect(Role::Image, "Curves of hand · Socket twist");
    bench.move_to(area.center());
    bench.press(RIGHT);
    bench.release(RIGHT);
    bench.settle();
    bench.click(Role::Button, "Catmull–Rom");
    assert!(keys(&bench).iter().all(|key| key.interpolation == Interpolation::Smooth));
    assert!(between(&mut bench) > 187.0, "the seed's spline swings beyond its keys");
}

#[test]
fn switches_have_no_curve_to_choose() {
    let mut bench = graph();
    let key = (channels::PINNED, 1.0);
    bench.apply([
        Action::from(PlaybackAction::SetTime(1.0)),
        KeysEdit::Key(vec![key.0]).into(),
        SelectAction::Keys(vec![key]).into(),
    ]);
    let set = bench.session().document().keys.key(key.0, key.1).expect("a key");
    assert_eq!(set.interpolation, Interpolation::default());
    let area = bench.rect(Role::Image, "Curves of hand · pinned to world, hand · Socket twist");
    bench.move_to(area.center());
    bench.press(RIGHT);
    bench.release(RIGHT);
    bench.settle();
    assert!(bench.node(Role::Button, "Auto").accesskit_node().is_disabled());
}

/// A figure with keys of two joints' angles and of one offset, in the graph editor. Returns the
/// names of the two joints.
fn figure() -> (Bench, [String; 2]) {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([Step::from(FileAction::NewFigure)]);
    let [one, other] = [0, 1].map(JointId::new);
    for time in [1.0, 3.0] {
        bench.apply([
            Action::from(PlaybackAction::SetTime(time)),
            KeysEdit::Key(vec![
                Channel::Rotation(one),
                Channel::Rotation(other),
                Channel::Offset(other),
            ])
            .into(),
        ]);
    }
    bench.apply([
        Action::from(ViewAction::ShowGraphEditor(true)),
        SelectAction::Joints(Vec::new()).into(),
        SelectAction::Channels(Vec::new()).into(),
    ]);
    let skeleton = &bench.session().rig().skeleton;
    let names = [one, other].map(|joint| skeleton[joint].name.clone());
    (bench, names)
}

#[test]
fn a_figure_shows_the_curves_of_the_selected_joints_and_of_all_without_a_selection() {
    let (mut bench, [one, other]) = figure();
    let all = format!("Curves of {one} · rotation, {other} · rotation, {other} · offset");
    assert!(bench.shows(Role::Image, &all));
    bench.apply([SelectAction::Joints(vec![JointId::new(1)])]);
    let own = format!("Curves of {other} · rotation, {other} · offset");
    assert!(bench.shows(Role::Image, &own));
    assert!(!bench.shows(Role::Button, &format!("Curve of {one} · rotation")));
    bench.apply([SelectAction::Joints(vec![JointId::new(2)])]);
    assert!(bench.says(
        "No curves of the selected joints. Press K to key them, or select no joint to see all"
    ));
}

#[test]
fn names_of_joints_and_channels_are_clicked_and_clicked_again() {
    let (mut bench, [one, other]) = figure();
    bench.click(Role::Button, &format!("Curves of joint {one}"));
    assert_eq!(bench.session().selection().joints(), [JointId::new(0)]);
    assert!(bench.shows(Role::Image, &format!("Curves of {one} · rotation")));
    bench.click(Role::Button, &format!("Curves of joint {one}"));
    assert_eq!(bench.session().selection().joints(), []);
    bench.click(Role::Button, &format!("Curve of {other} · offset"));
    assert!(bench.shows(Role::Image, &format!("Curves of {other} · offset")));
    assert!(bench.shows(Role::Button, &format!("Curve of {one} · rotation")), "it stays listed");
    bench.hold(Modifiers::SHIFT);
    bench.click(Role::Button, &format!("Curve of {one} · rotation"));
    bench.hold(Modifiers::NONE);
    assert!(bench.shows(Role::Image, &format!("Curves of {one} · rotation, {other} · offset")));
    for name in [format!("{one} · rotation"), format!("{other} · offset")] {
        bench.hold(Modifiers::SHIFT);
        bench.click(Role::Button, &format!("Curve of {name}"));
        bench.hold(Modifiers::NONE);
    }
    assert!(bench.session().selection().channels().is_empty());
}

#[test]
fn degrees_and_lengths_have_lanes_below_each_other_each_with_its_unit_at_the_left() {
    let (mut bench, [_, other]) = figure();
    bench.apply([SelectAction::Joints(vec![JointId::new(1)])]);
    let plot = bench.rect(Role::Image, &format!("Curves of {other} · rotation, {other} · offset"));
    let [degrees, metres] =
        ["Axis in degrees (deg)", "Axis in metres (m)"].map(|name| bench.rect(Role::Label, name));
    for axis in [degrees, metres] {
        assert!(axis.right() <= plot.left() + 0.5);
        assert!((axis.height() - 0.5 * (plot.height() - 8.0)).abs() < 1.0);
    }
    assert!((degrees.height() - metres.height()).abs() < 1.0);
    assert!(degrees.bottom() < metres.top(), "they are apart");
    bench.apply([SelectAction::Channels(vec![Channel::Rotation(JointId::new(1))])]);
    assert!(bench.shows(Role::Label, "Axis in degrees (deg)"));
    assert!(!bench.shows(Role::Label, "Axis in metres (m)"));
    let mut arm = graph();
    arm.apply([Action::from(KeysEdit::Key(vec![channels::HAND]))]);
    assert!(
        arm.shows(Role::Label, "Axis in millimetres (mm)"),
        "a unit of the arm is a millimetre"
    );
}

#[test]
fn a_lane_with_three_curves_is_higher_than_one_with_one() {
    let mut arm = graph();
    arm.apply([Action::from(KeysEdit::Key(vec![channels::HAND, channels::TWIST]))]);
    let [degrees, millimetres] = ["Axis in degrees (deg)", "Axis in millimetres (mm)"]
        .map(|name| arm.rect(Role::Label, name).height());
    assert!((6.0 * millimetres - 8.0 * degrees).abs() < 1.0, "{millimetres} and {degrees}");
}

#[test]
fn of_many_curves_those_of_the_first_joint_are_drawn_until_others_are_selected() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([open_example("walk")]);
    bench.apply([ViewAction::ShowGraphEditor(true)]);
    assert!(bench.shows(Role::Image, "Curves of pelvis · rotation, pelvis · offset"));
    assert!(bench.shows(Role::Button, "Curve of spine · rotation"), "all are listed");
    bench.click(Role::Button, "Curve of spine · rotation");
    assert!(bench.shows(Role::Image, "Curves of spine · rotation"));
}

#[test]
fn ctrl_and_the_wheel_zoom_only_the_lane_under_the_mouse() {
    let (mut bench, [_, other]) = figure();
    bench.apply([SelectAction::Joints(vec![JointId::new(1)])]);
    let plot = bench.rect(Role::Image, &format!("Curves of {other} · rotation, {other} · offset"));
    let lanes = |bench: &mut Bench| {
        let picture = bench.harness.render().expect("a picture");
        let half = picture.height().min(plot.bottom() as u32);
        let (top, middle) = (plot.top() as u32 + 1, plot.center().y as u32);
        let part = |from: u32, to: u32| -> Vec<_> {
            (from..to)
                .flat_map(|y| [plot.left() + 90.0, plot.right() - 90.0].map(|x| (x, y)))
                .map(|(x, y)| *picture.get_pixel(x as u32, y))
                .collect()
        };
        [part(top, middle - 2), part(middle + 2, half - 1)]
    };
    let before = lanes(&mut bench);
    bench.move_to(pos2(plot.center().x, plot.top() + 0.3 * plot.height()));
    bench.hold(Modifiers::COMMAND);
    bench.wheel(6.0);
    bench.hold(Modifiers::NONE);
    bench.settle();
    let after = lanes(&mut bench);
    assert_ne!(after[0], before[0], "angles");
    assert_eq!(after[1], before[1], "lengths");
}

/// Degrees by which the key at 3 s moves when it is dragged up by 20 points.
fn raised(bench: &mut Bench) -> f32 {
    let at = place(bench, 3.0, 60.0);
    bench.drag_and_drop(LEFT, at, at - vec2(0.0, 20.0));
    bench.settle();
    let degrees = keys(bench)[1].value.x.to_degrees() - 60.0;
    bench.apply([TransactionAction::Undo]);
    degrees
}

#[test]
fn ctrl_and_the_wheel_zoom_values_about_the_mouse_and_a_double_click_on_the_axis_shows_all() {
    let mut bench = graph();
    let before = raised(&mut bench);
    let at = place(&bench, 3.0, 60.0);
    bench.move_to(at);
    bench.hold(Modifiers::COMMAND);
    bench.wheel(2.0);
    bench.hold(Modifiers::NONE);
    bench.settle();
    // The key under the mouse stays there.
    let zoomed = raised(&mut bench);
    assert!((zoomed - before / 1.44).abs() < 0.05 * before, "{zoomed}, {before} before");
    let axis = bench.rect(Role::Label, "Axis in degrees (deg)").center();
    bench.double_click_at(axis);
    bench.settle();
    assert!((raised(&mut bench) - before).abs() < 0.01 * before);
}

#[test]
fn the_wheel_alone_zooms_the_time_and_keeps_the_values() {
    let mut bench = graph();
    let before = raised(&mut bench);
    bench.move_to(place(&bench, 3.0, 60.0));
    bench.wheel(2.0);
    bench.settle();
    assert!((raised(&mut bench) - before).abs() < 0.02 * before);
    // The key at 5 s is farther away from the one under the mouse.
    let far =
        place(&bench, 3.0, 60.0) + 1.44 * (place(&bench, 5.0, 60.0) - place(&bench, 3.0, 60.0));
    let plot = bench.rect(Role::Image, "Curves of hand · Socket twist");
    let low = place(&bench, 5.0, 0.0).y;
    assert!(plot.contains(pos2(far.x, low)), "on screen");
    bench.click_at(pos2(far.x, low));
    assert_eq!(bench.session().selection().keys(), [(channels::TWIST, 5.0)]);
}
