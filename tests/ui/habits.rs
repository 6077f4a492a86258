//! First attempts of users of other 3D programs.

use crate::common::arm::{Arm, ArmEdit, ArmSession};
use std::path::PathBuf;

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Vec2, vec2};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;

use ik_arm::kinematics::skeleton::JointId;
use ik_arm::session::{
    Dialog, FileAction, JointEdit, Preferences, SelectAction, ShellAction, TransactionAction,
};

use crate::bench::{Bench, LARGE, SMALL};
use crate::common::documents::open_example;

const LEFT: PointerButton = PointerButton::Primary;

fn first(size: Vec2) -> Bench {
    Bench::first(size, Preferences { offers_tour: false, ..Preferences::default() })
}

fn human(size: Vec2) -> Bench {
    let mut bench = first(size);
    bench.apply([FileAction::NewFigure]);
    bench
}

/// Clicks a value and types another, without Enter.
fn type_into(bench: &mut Bench, name: &str, text: &str) {
    bench.click(Role::SpinButton, name);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.type_text(text);
}

fn focused_name(bench: &Bench) -> String {
    bench.focused().map(|(_, name)| name).unwrap_or_default()
}

#[test]
fn tab_goes_from_a_typed_value_to_the_next_value() {
    let mut bench = first(LARGE);
    type_into(&mut bench, "Hand x value", "300");
    bench.key(Key::Tab);
    bench.settle();
    bench.type_text("100");
    bench.key(Key::Tab);
    bench.settle();
    assert_eq!(focused_name(&bench), "Hand z value");
    bench.type_text("-40");
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bench.hand(), Vec3::new(300.0, 100.0, -40.0));
}

#[test]
fn shift_tab_goes_from_a_typed_value_to_the_value_before() {
    let mut bench = first(LARGE);
    type_into(&mut bench, "Hand z value", "7");
    bench.key_with(Modifiers::SHIFT, Key::Tab);
    bench.settle();
    assert_eq!(focused_name(&bench), "Hand y value");
    bench.type_text("8");
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bench.hand(), Vec3::new(250.0, 8.0, 7.0));
}

#[test]
fn tab_without_typing_goes_to_the_next_control_of_any_kind() {
    let mut bench = first(LARGE);
    bench.focus(Role::SpinButton, "Hand x value");
    bench.key(Key::Tab);
    bench.settle();
    assert_eq!(bench.focused(), Some((Role::Slider, "Hand y".to_owned())));
}

#[test]
fn values_take_expressions() {
    for (typed, value) in [
        ("2*50", 100.0),
        ("100+23", 123.0),
        ("(100+23)/2", 61.5),
        ("-2^3", -8.0),
        ("1e2", 100.0),
        ("3 - 10", -7.0),
        ("\u{2212}12", -12.0),
        ("sqrt(16)", 4.0),
    ] {
        let mut bench = first(LARGE);
        bench.enter("Hand x", typed);
        assert_eq!(bench.hand().x, value, "{typed}");
    }
    let mut bench = first(LARGE);
    bench.enter("Socket twist", "45+45°");
    assert!((bench.session().arm().twist.to_degrees() - 90.0).abs() < 1e-4);
}

#[test]
fn a_value_that_is_not_understood_is_refused_with_a_reason() {
    for typed in ["2*", "1/0", "abc", "3 4", "(1", "nan", "1e99"] {
        let mut bench = first(LARGE);
        bench.enter("Hand x", typed);
        assert_eq!(&bench.session().arm(), &Arm::default(), "{typed}");
        assert!(bench.session().shell().has_failed(), "{typed}");
        assert!(bench.says("The value must be a number or an expression such as 2*50"), "{typed}");
    }
    let mut bench = first(LARGE);
    type_into(&mut bench, "Hand x value", "2*");
    bench.key(Key::Escape);
    bench.settle();
    assert!(!bench.session().shell().has_failed(), "Esc gives up without an error");
}

#[test]
fn a_double_click_in_the_tree_renames() {
    let mut bench = human(LARGE);
    bench.double_click_at(bench.rect(Role::Button, "Joint chest").center());
    assert!(matches!(bench.session().shell().dialog(), Some(Dialog::Rename { .. })));
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.type_text("torso");
    bench.key(Key::Enter);
    bench.settle();
    assert!(bench.shows(Role::Button, "Joint torso"));
}

/// Number of pixels of the view that differ between two pictures of it.
fn changed_pixels(bench: &mut Bench, before: &image::RgbaImage) -> usize {
    let after = bench.harness.render().expect("a picture");
    before.pixels().zip(after.pixels()).filter(|(one, other)| one != other).count()
}

#[test]
fn a_coloured_line_shows_the_axis_to_which_a_drag_is_locked() {
    let mut bench = first(LARGE);
    let hand = bench.cursor_on_screen();
    bench.drag(LEFT, hand, hand + vec2(30.0, -10.0));
    for (key, axis) in [(Key::X, Vec3::X), (Key::Y, Vec3::Y), (Key::Z, Vec3::Z)] {
        let free = bench.harness.render().expect("a picture");
        bench.key(key);
        let at = bench.session().arm().cursor_in_world();
        let far = bench.on_screen(at + axis * 150.0);
        let picture = bench.harness.render().expect("a picture");
        let pixel = |image: &image::RgbaImage| *image.get_pixel(far.x as u32, far.y as u32);
        assert_ne!(pixel(&picture), pixel(&free), "{key:?}");
        assert!(changed_pixels(&mut bench, &free) > 300, "a line across the view for {key:?}");
        bench.key(key);
    }
    bench.release(LEFT);
}

#[test]
fn new_opens_the_arm_and_asks_before_changes_are_lost() {
    let mut bench = first(LARGE);
    bench.apply([ArmEdit::SetTwist(1.0)]);
    bench.key_with(Modifiers::COMMAND, Key::N);
    bench.settle();
    assert!(matches!(bench.session().shell().dialog(), Some(Dialog::Unsaved { .. })));
    bench.click(Role::Button, "Don't save");
    assert_eq!(&bench.session().arm(), &Arm::default());
    assert!(!bench.session().history().is_unsaved());

    bench.apply([open_example("snake")]);
    bench.choose(&["File", "New", "Arm"]);
    assert!(bench.session().rig().sole_limb().is_some());
    bench.key_with(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::N);
    bench.settle();
    assert_eq!(bench.session().skeleton().joints().len(), 1);
    bench.choose(&["File", "New", "Figure"]);
    assert_eq!(bench.session().skeleton().joints().len(), 49);
}

#[test]
fn the_window_names_the_document_and_marks_unsaved_changes() {
    for size in [LARGE, SMALL] {
        let mut bench = first(size);
        assert!(bench.shows(Role::Label, "untitled"));
        bench.apply([ArmEdit::SetTwist(1.0)]);
        assert!(bench.shows(Role::Label, "untitled*"));
        bench.tell(FileAction::Saved(PathBuf::from("/tmp/a drawer.json")));
        bench.settle();
        assert!(bench.shows(Role::Label, "a drawer.json"));
        bench.apply([ArmEdit::SetTwist(2.0)]);
        assert!(bench.shows(Role::Label, "a drawer.json*"));
        bench.apply([TransactionAction::Undo]);
        assert!(bench.shows(Role::Label, "a drawer.json"));
    }
}

#[test]
fn ten_points_on_a_rail_move_a_figure_by_less_than_an_eighth_of_its_size() {
    let mut bench = human(LARGE);
    bench.toggle(&["Skeleton", "Translation"]);
    bench.reveal(Role::Slider, "Skeleton y");
    let rail = bench.rect(Role::Slider, "Skeleton y").center();
    bench.drag_and_drop(LEFT, rail, rail + vec2(10.0, 0.0));
    let moved = Vec3::from(bench.session().skeleton().transform().translation).y;
    let size = bench.session().rig().reach();
    assert!(moved > 0.0 && moved < size / 8.0, "{moved} of {size}");
}

#[test]
fn the_edge_of_a_panel_is_grabbed_three_points_to_each_side() {
    for beside in [-3.0, 3.0] {
        let mut bench = first(LARGE);
        let before = bench.viewport();
        let edge = before.left_center() + vec2(beside, 0.0);
        bench.drag_and_drop(LEFT, edge, edge + vec2(40.0, 0.0));
        bench.settle();
        let moved = bench.viewport().left() - before.left();
        assert!((moved - 40.0).abs() < 6.0, "from {beside} beside the edge: {moved}");
    }
}

#[test]
fn in_a_low_window_the_timeline_gives_way_to_the_view() {
    let open = Preferences { timeline_open: Some(true), offers_tour: false, ..Default::default() };
    let mut bench = Bench::first(SMALL, open);
    assert!(bench.viewport().height() >= 330.0, "{:?}", bench.viewport());
    let edge = bench.viewport().center_bottom();
    bench.drag_and_drop(LEFT, edge, edge - vec2(0.0, 250.0));
    bench.settle();
    assert!(bench.viewport().height() >= 300.0, "also if its edge is dragged up");
}

#[test]
fn at_scale_two_in_a_small_window_the_view_has_room_and_nothing_leaves_the_window() {
    // A window of 1280×800 pixels at scale 2.
    let size = vec2(640.0, 400.0);
    for skeleton in [false, true] {
        let mut bench = if skeleton { human(size) } else { first(size) };
        assert!(bench.viewport().width() >= 300.0, "{:?}", bench.viewport());
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, size);
        for (role, name) in [
            (Role::Button, "Help"),
            (Role::Button, "Timeline"),
            (Role::Button, "Play"),
            (Role::Label, "untitled"),
        ] {
            assert!(window.contains_rect(bench.rect(role, name)), "{name}");
        }
        bench.choose(&["View"]);
        assert!(bench.node(Role::CheckBox, "Explain panel").accesskit_node().is_disabled());
    }
}

#[test]
fn undoing_an_added_joint_selects_its_parent_again() {
    let mut bench = human(LARGE);
    let chest = bench.joint("chest");
    bench.apply([SelectAction::Joints(vec![chest])]);
    bench.apply([JointEdit::AddJoint { tip: None }]);
    assert_ne!(bench.session().selection().joints(), [chest]);
    bench.apply([TransactionAction::Undo]);
    assert_eq!(bench.session().selection().joints(), [chest]);

    bench.apply([JointEdit::AddJoint { tip: None }]);
    let head = bench.joint("head");
    bench.apply([SelectAction::Joints(vec![head])]);
    bench.apply([TransactionAction::Undo]);
    assert_eq!(bench.session().selection().joints(), [head], "another selection stays");
}

#[test]
fn undoing_a_deletion_in_the_middle_forgets_a_selection_whose_indices_have_changed() {
    let mut bench = human(LARGE);
    let (spine, head) = (JointId::new(1), JointId::new(4));
    bench.apply([JointEdit::DissolveJoints(vec![spine])]);
    bench.apply([SelectAction::Joints(vec![JointId::new(3)])]);
    bench.apply([TransactionAction::Undo]);
    assert!(!bench.session().selection().joints().contains(&head));
}

#[test]
fn export_shows_only_the_fields_of_its_format() {
    let mut bench = first(LARGE);
    bench.apply([open_example("walk")]);
    bench.key_with(Modifiers::COMMAND, Key::E);
    bench.settle();
    for (format, has_frames, has_size, has_scale) in [
        ("GLB", true, false, true),
        ("BVH", true, false, true),
        ("CSV", true, false, false),
        ("OBJ", false, false, false),
        ("Animated PNG", true, true, false),
        ("PNG sequence", true, true, false),
        ("PNG", false, true, false),
    ] {
        bench.click(Role::Button, format);
        assert_eq!(bench.shows(Role::Label, "Frames per second"), has_frames, "{format}");
        assert_eq!(bench.shows(Role::Label, "Length"), has_frames, "{format}");
        assert_eq!(bench.shows(Role::Label, "Size in pixels"), has_size, "{format}");
        assert_eq!(bench.shows(Role::Label, "Metres per unit"), has_scale, "{format}");
    }
}

#[test]
fn a_message_goes_when_its_time_is_over_and_an_error_stays_longer() {
    let mut bench = first(LARGE);
    bench.apply([ShellAction::Report("A message".to_owned())]);
    bench.skip(6.0);
    assert!(bench.says("A message"));
    bench.apply([ShellAction::Report("Another message".to_owned())]);
    bench.skip(9.0);
    assert!(bench.says("Another message"), "each has its own time");
    bench.skip(5.0);
    assert_eq!(bench.session().shell().message(), None);
    bench.apply([ShellAction::Fail("an error".to_owned())]);
    bench.skip(20.0);
    assert!(bench.says("An error"));
    bench.skip(12.0);
    assert_eq!(bench.session().shell().message(), None);
}
