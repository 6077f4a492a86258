//! Keys and typed numbers with a skeleton: only the focused widget receives them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::accesskit::Role;
use egui::{DroppedFile, Event, Key, Modifiers};
use glam::Vec3;
use ik_arm::io::{Example, OpenOptions};
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::skeleton::{JointId, JointLimits, Limit, RotationAxis};
use ik_arm::session::{
    Action, Edit, Effect, FileAction, JointEdit, PanelTab, PlaybackAction, SelectAction,
    SolverAction, SolverEdit, TargetEdit,
};

use crate::bench::{Bench, SMALL};

const CTRL: Modifiers = Modifiers::COMMAND;

/// The Y-shaped tree with its last joint selected.
fn tree() -> Bench {
    let mut bench = Bench::example("two-targets");
    let joint = bench.joint("left_3");
    bench.apply([SelectAction::Joints(vec![joint])]);
    bench
}

fn enter_field(bench: &mut Bench, name: &str, text: &str, key: Key) {
    bench.node(Role::SpinButton, name).scroll_to_me();
    bench.settle();
    bench.click(Role::SpinButton, name);
    bench.key_with(CTRL, Key::A);
    bench.frame([Event::Text(text.to_owned())]);
    bench.key(key);
    bench.settle();
}

#[test]
fn escape_in_a_number_leaves_it_and_the_selection_alone() {
    for field in ["Length", "Bone x", "Weight", "Maximum iterations", "Rotation x value"] {
        let mut bench = tree();
        let before =
            (bench.session().document().clone(), bench.session().selection().joints().to_vec());
        enter_field(&mut bench, field, "7", Key::Escape);
        let after =
            (bench.session().document().clone(), bench.session().selection().joints().to_vec());
        assert_eq!(after, before, "{field}");
    }
}

#[test]
fn escape_in_a_number_lets_a_running_solver_run() {
    let mut bench = tree();
    let solver = bench.session().rig().solver;
    bench.apply([SolverEdit::SetSolver(solver.with_method(Method::TransposeFixed))]);
    bench.apply_moving([SolverAction::Run(true)]);
    bench.click_at(bench.rect(Role::SpinButton, "Iterations per frame").center());
    bench.frame([]);
    bench.frame([]);
    assert!(bench.session().solvers().is_running());
    bench.key(Key::Escape);
    assert!(bench.session().solvers().run().is_some(), "the key was the number's");
}

#[test]
fn escape_closes_a_list_and_leaves_the_selection() {
    for combo in ["Parent", "Motion", "Method"] {
        let mut bench = tree();
        let before = bench.session().selection().joints().to_vec();
        bench.node(Role::ComboBox, combo).scroll_to_me();
        bench.settle();
        bench.click(Role::ComboBox, combo);
        bench.key(Key::Escape);
        bench.settle();
        assert_eq!(bench.session().selection().joints(), before, "{combo}");
        bench.key(Key::Escape);
        bench.settle();
        assert!(
            bench.session().selection().joints().is_empty(),
            "{combo}: the next one is the skeleton's"
        );
    }
}

#[test]
fn escape_closes_a_menu_and_leaves_the_selection() {
    let mut bench = tree();
    bench.choose(&["File"]);
    bench.key(Key::Escape);
    bench.settle();
    assert!(!bench.says("Empty"));
    assert!(!bench.session().selection().joints().is_empty());
}

#[test]
fn focusing_a_number_field_changes_no_bit_of_its_value() {
    let mut bench = tree();
    let joint = bench.session().selection().active().expect("one");
    let target = bench.session().rig().targets[0];
    let solver = bench.session().rig().solver;
    bench.apply([
        Edit::from(JointEdit::SetAxis {
            joint,
            axis: Vec3::new(0.123_456_7, 1.000_000_1, -0.333_333_3),
        }),
        Edit::from(JointEdit::SetLimits {
            joint,
            limits: JointLimits::new([Some(Limit { min: -1.234_567, max: 0.7654 }), None, None]),
        }),
        Edit::from(TargetEdit::SetTarget(ik_arm::document::Target {
            weight: 0.123_456_7,
            ..target
        })),
        Edit::from(SolverEdit::SetSolver(
            solver
                .with_method(Method::DampedLeastSquares)
                .with_tolerance(1.234e-8)
                .with_damping(0.012_345_678),
        )),
    ]);
    let before = bench.session().document().clone();
    for field in [
        "Bone x",
        "Bone y",
        "Bone z",
        "Length",
        "x minimum",
        "x maximum",
        "Weight",
        "Tolerance",
        "Damping",
        "Iterations per frame",
    ] {
        bench.node(Role::SpinButton, field).scroll_to_me();
        bench.settle();
        bench.click(Role::SpinButton, field);
        bench.key(Key::Enter);
        bench.settle();
        assert_eq!(bench.session().document(), &before, "{field}");
    }
    assert_eq!(bench.session().shell().message(), None, "nothing was refused");
}

#[test]
fn a_number_can_be_typed_with_its_unit() {
    let mut bench = tree();
    bench.click(Role::CheckBox, "Limit x");
    enter_field(&mut bench, "x maximum", "30°", Key::Enter);
    let joint = bench.session().selection().active().expect("one");
    let limit = bench.session().skeleton()[joint].limits.range(RotationAxis::X).expect("limited");
    assert!((limit.max.to_degrees() - 30.0).abs() < 1e-4, "{limit:?}");
}

#[test]
fn text_that_is_not_a_number_changes_no_field() {
    for typed in ["nan", "inf", "", "x"] {
        let mut bench = tree();
        let before = bench.session().document().clone();
        for field in ["Length", "Bone y", "Iterations per frame", "Maximum iterations"] {
            enter_field(&mut bench, field, typed, Key::Enter);
            assert_eq!(bench.session().document(), &before, "{field} {typed:?}");
        }
    }
}

#[test]
fn a_click_in_the_tree_gives_it_the_arrow_keys_and_leaves_the_letters() {
    let mut bench = tree();
    let joints = bench.session().skeleton_pose().len();
    bench.click(Role::Button, "Joint left_2");
    let clicked = bench.session().selection().joints().to_vec();
    bench.key(Key::ArrowDown);
    bench.settle();
    let next = bench.session().selection().active().expect("one");
    assert_eq!(bench.session().skeleton().joints()[next.index()].name, "left_3");
    bench.key(Key::ArrowUp);
    bench.settle();
    assert_eq!(bench.session().selection().joints(), clicked);
    bench.key(Key::A);
    bench.settle();
    assert_eq!(bench.session().skeleton_pose().len(), joints + 1);
    bench.key(Key::Delete);
    bench.settle();
    assert_eq!(bench.session().skeleton_pose().len(), joints);
    bench.key(Key::T);
    bench.settle();
    assert_eq!(bench.session().rig().targets.len(), 3);
}

#[test]
fn keys_do_nothing_without_joints() {
    let mut bench = Bench::new();
    bench.choose(&["File", "New", "Empty"]);
    bench.apply([JointEdit::DeleteJoints(vec![JointId::new(0)])]);
    for key in [Key::T, Key::F2, Key::Delete, Key::R, Key::S, Key::Space, Key::Home, Key::F] {
        bench.key(key);
        bench.settle();
    }
    bench.key_with(CTRL, Key::A);
    bench.key(Key::Escape);
    bench.click(Role::Button, "Reset pose");
    bench.apply([SolverAction::Compare]);
    assert!(bench.session().skeleton().joints().is_empty());
    assert_eq!(bench.session().shell().dialog(), None);
}

/// A file as a window hands it over.
#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Err("nobody reads it here".to_owned())
    }
}

#[test]
fn a_file_that_is_dropped_on_the_window_is_opened() {
    let mut bench = Bench::new();
    let path = PathBuf::from("dropped scene.js3d");
    bench.harness.input_mut().dropped_files.push(Arc::new(Dropped(path.clone())));
    bench.frame([]);
    assert_eq!(bench.effects(), [Effect::Open { path, options: OpenOptions::default() }]);
}

#[test]
fn everything_beside_a_skeleton_that_can_be_acted_on_has_a_name() {
    for example in Example::ALL {
        let mut bench = Bench::of_size(SMALL);
        bench.apply_moving([FileAction::OpenExample(example)]);
        bench.apply([
            Action::from(PlaybackAction::Play(false)),
            SelectAction::Joints(vec![JointId::new(0)]).into(),
        ]);
        bench.harness.check_accessibility();
        let joint = bench.session().rig().targets.first().map(|target| target.joint);
        bench.apply([
            Action::from(SelectAction::Joints(joint.into_iter().collect())),
            SolverAction::Step.into(),
        ]);
        bench.harness.check_accessibility();
    }
}

#[test]
fn the_list_of_keys_fits_a_small_window_and_cuts_no_line() {
    let mut bench = Bench::of_size(SMALL);
    bench.key(Key::F1);
    bench.wait(0.5);
    let window = bench.rect(Role::Dialog, "Shortcuts");
    assert!(egui::Rect::from_min_size(egui::Pos2::ZERO, SMALL).contains_rect(window), "{window:?}");
    for text in [
        "left drag on empty space, middle drag",
        "F2, double-click in the list",
        "Perspective or orthographic",
        "left and right in the timeline",
        "Shift in the graph editor",
    ] {
        // The list scrolls down, but no line is cut off at its end.
        let rect = bench.rect(Role::Label, text);
        assert!(window.x_range().contains(rect.left()), "{text}: {rect:?}");
        assert!(rect.right() < window.right() - 8.0, "{text}: {rect:?} in {window:?}");
    }
}

#[test]
fn follow_path_can_be_switched_off_as_its_tooltip_says() {
    let mut bench = Bench::example("snake");
    bench.node(Role::ComboBox, "Follow path").scroll_to_me();
    bench.settle();
    bench.click(Role::ComboBox, "Follow path");
    bench.click(Role::Button, "None");
    assert_eq!(bench.session().rig().follow_paths, []);
    bench.apply([SelectAction::Joints(vec![JointId::new(1)])]);
    bench.node(Role::SpinButton, "Rotation x value").scroll_to_me();
    bench.settle();
    bench.enter("Rotation x", "10");
    let angle = bench.session().skeleton().joints()[1].rotation.x;
    assert!((angle.to_degrees() - 10.0).abs() < 1e-3);
}

#[test]
fn a_long_name_does_not_widen_the_panel() {
    let mut bench = Bench::of_size(SMALL);
    bench.choose(&["File", "New", "Empty"]);
    bench.click(Role::Button, "Add child");
    bench.choose(&["More", "Add target"]);
    let before = bench.viewport();
    let name = "a name of many letters ".repeat(3);
    bench.apply([JointEdit::RenameJoint { joint: JointId::new(1), name: name.clone() }]);
    bench.apply([
        Action::from(JointEdit::AddChild { parent: JointId::new(1), tip: None }),
        SelectAction::Joints(vec![JointId::new(1)]).into(),
    ]);
    assert_eq!(bench.viewport(), before);
    for field in ["Bone x", "Bone z", "Length"] {
        let rect = bench.rect(Role::SpinButton, field);
        assert!(rect.left() > 0.0 && rect.right() < before.left(), "{field}: {rect:?}");
    }
    assert!(bench.says(&format!("Joint: {}", name.trim())), "it is read out whole");
}

#[test]
fn a_race_shows_the_result_of_every_solver() {
    let mut bench = tree();
    bench.show_tab(PanelTab::Race);
    bench.apply_moving([SolverAction::Compare]);
    bench.wait(4.0);
    assert!(bench.says("FABRIK: converged after"));
    assert!(bench.says("Two-bone: stalled after"));
}
