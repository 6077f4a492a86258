//! The skeleton's panels: building, rotating, targets and solving.

use core::f32::consts::FRAC_PI_2;

use egui::accesskit::Role;
use egui::epaint::text::MissingGlyphPolicy;
use egui::{Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::document::{Target, TargetPath};
use ik_arm::io::{Example, ExampleGroup, FileAnimation, OpenOptions, Upwards};
use ik_arm::kinematics::chain_ik::{Method, Root};
use ik_arm::session::{
    Action, Dialog, Effect, FileAction, FileContents, Iterate, JointEdit, PanelTab, PathDialog,
    PlaybackAction, SelectAction, ShellAction, SolverAction, SolverEdit, TargetEdit, ViewAction,
};

use crate::bench::{Bench, LARGE, SMALL};
use crate::common::documents::{example, open_example};
use ik_arm::kinematics::skeleton::{Joint, JointId, JointLimits};

/// A root with three joints in a chain, built by pressing buttons.
fn built() -> Bench {
    built_in(Bench::new())
}

fn built_in(mut bench: Bench) -> Bench {
    bench.choose(&["File", "New", "Empty"]);
    for _ in 0..3 {
        bench.click(Role::Button, "Add child");
    }
    bench
}

fn names(bench: &Bench) -> Vec<&str> {
    let joints = bench.session().skeleton().joints();
    joints.iter().map(|joint| joint.name.as_str()).collect()
}

fn select(bench: &mut Bench, name: &str) {
    let name = format!("Joint {name}");
    bench.click(Role::Button, &name);
}

fn choose_item(bench: &mut Bench, combo: &str, item: &str) {
    bench.click(Role::ComboBox, combo);
    bench.click(Role::Button, item);
}

fn is_enabled(bench: &Bench, role: Role, name: &str) -> bool {
    use egui_kittest::kittest::NodeT as _;
    !bench.node(role, name).accesskit_node().is_disabled()
}

#[test]
fn a_new_skeleton_is_a_locked_root_and_a_chain_can_be_added_to_it() {
    let bench = built();
    assert_eq!(names(&bench), ["root", "joint", "joint_1", "joint_2"]);
    let skeleton = &bench.session().skeleton();
    let joints = skeleton.joints();
    assert!(joints[0].locked && joints[0].axis == Vec3::ZERO);
    for (joint, it) in skeleton.iter().skip(1) {
        let above = JointId::new(joint.index() - 1);
        assert_eq!(it.parent, Some(above));
        assert!(skeleton.base(joint).distance(skeleton.tip(above)) < 1e-6);
    }
    assert_eq!(
        bench.session().selection().joints(),
        [3].map(JointId::new),
        "the new one can be gone on from"
    );
}

#[test]
fn a_joint_can_be_renamed_but_not_to_a_name_in_use() {
    let mut bench = built();
    bench.choose(&["More", "Rename…"]);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([egui::Event::Text("hand".to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(names(&bench), ["root", "joint", "joint_1", "hand"]);
    bench.apply([JointEdit::RenameJoint { joint: JointId::new(1), name: "hand".to_owned() }]);
    assert_eq!(names(&bench)[1], "joint");
    assert!(bench.says("Names of joints must be unique, got \"hand\" twice"));
}

#[test]
fn a_name_may_have_letters_of_any_script_and_letters_that_no_font_has() {
    let mut bench = built();
    // Letters that no font has are boxes.
    bench.harness.ctx.set_missing_glyph_policy(MissingGlyphPolicy::Tofu);
    for name in ["Hüfte", "左手", "\u{10fffd}"] {
        bench.choose(&["More", "Rename…"]);
        bench.key_with(Modifiers::COMMAND, Key::A);
        bench.frame([egui::Event::Text(name.to_owned())]);
        bench.key(Key::Enter);
        bench.settle();
        assert_eq!(names(&bench)[3], name);
        assert!(bench.shows(Role::Button, &format!("Joint {name}")));
    }
}

#[test]
fn a_joint_is_deleted_with_its_subtree_and_its_parent_is_selected() {
    let mut bench = built();
    select(&mut bench, "joint_1");
    bench.choose(&["More", "Delete"]);
    bench.click(Role::Button, "Delete children too");
    assert_eq!(names(&bench), ["root", "joint"]);
    assert_eq!(bench.session().selection().joints(), [1].map(JointId::new));
    select(&mut bench, "root");
    bench.choose(&["More", "Delete"]);
    bench.click(Role::Button, "Delete children too");
    assert!(names(&bench).is_empty());
    assert!(bench.says("No joints"));
    bench.click(Role::Button, "Add root");
    assert_eq!(names(&bench), ["root"]);
}

#[test]
fn a_right_click_on_a_joint_selects_it_and_opens_its_menu() {
    let mut bench = built();
    select(&mut bench, "root");
    bench.move_to(bench.rect(Role::Button, "Joint joint_2").center());
    bench.press(PointerButton::Secondary);
    bench.release(PointerButton::Secondary);
    bench.settle();
    assert_eq!(bench.session().selection().joints(), [3].map(JointId::new));
    bench.choose(&["Delete"]);
    assert_eq!(names(&bench), ["root", "joint", "joint_1"]);
}

#[test]
fn controls_that_need_a_selection_are_disabled_without_one() {
    let mut bench = built();
    bench.apply([SelectAction::Joints(Vec::new())]);
    bench.choose(&["More"]);
    for name in ["Delete Delete", "Rename… F2", "Add target T"] {
        assert!(!is_enabled(&bench, Role::Button, name), "{name}");
    }
    bench.key(Key::Escape);
    for name in ["Run", "Step", "Reset"] {
        assert!(!is_enabled(&bench, Role::Button, name), "{name} without a target");
    }
    bench.show_tab(PanelTab::Race);
    assert!(!is_enabled(&bench, Role::Button, "Race all solvers"), "a race without a target");
}

#[test]
fn a_reparented_joint_stays_where_it_is() {
    let mut bench = built();
    let (base, tip) = {
        let pose = bench.session().skeleton_pose();
        (pose.base(JointId::new(3)), pose.tip(JointId::new(3)))
    };
    choose_item(&mut bench, "Parent", "root");
    let rig = bench.session().rig();
    let moved = rig.skeleton.find("joint_2").expect("there");
    assert_eq!(rig.skeleton.joints()[moved.index()].parent, Some(JointId::new(0)));
    let pose = bench.session().skeleton_pose();
    assert!(pose.base(moved).distance(base) < 1e-5 && pose.tip(moved).distance(tip) < 1e-5);
    assert_eq!(bench.session().selection().active(), Some(moved));
}

#[test]
fn a_slider_turns_a_joint_with_its_subtree_and_nothing_else() {
    let mut bench = built();
    select(&mut bench, "joint_1");
    let before = bench.session().skeleton_pose().clone();
    bench.enter("Rotation z", "90");
    let skeleton = &bench.session().skeleton();
    assert!((skeleton.joints()[2].rotation.z - FRAC_PI_2).abs() < 1e-6);
    let pose = bench.session().skeleton_pose();
    assert_eq!(pose.tip(JointId::new(1)), before.tip(JointId::new(1)));
    for joint in [2, 3] {
        assert!(pose.tip(JointId::new(joint)).distance(before.tip(JointId::new(joint))) > 0.5);
    }
}

#[test]
fn a_limit_holds_the_angle_and_can_be_set_by_its_ends() {
    let mut bench = built();
    bench.click(Role::CheckBox, "Limit z");
    bench.enter("Rotation z", "170");
    let rotation = |bench: &Bench| bench.session().skeleton().joints()[3].rotation.z.to_degrees();
    assert!((rotation(&bench) - 90.0).abs() < 1e-4, "the limit begins at 90° either way");
    bench.click(Role::SpinButton, "z maximum");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([egui::Event::Text("30".to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
    assert!((rotation(&bench) - 30.0).abs() < 1e-4);
    bench.click(Role::CheckBox, "Limit z");
    assert_eq!(bench.session().skeleton().joints()[3].limits, JointLimits::NONE);
}

#[test]
fn two_targets_are_added_and_the_chosen_solver_runs_to_convergence() {
    for (method, name) in [
        (Method::Fabrik, "FABRIK"),
        (Method::Relaxation, "Constraint relaxation"),
        (Method::DampedLeastSquares, "Damped least squares"),
        (Method::Ccd, "Cyclic coordinate descent"),
    ] {
        // High enough to show the whole panel.
        let mut bench = built_in(Bench::of_size(vec2(1280.0, 1200.0)));
        select(&mut bench, "joint");
        bench.click(Role::Button, "Add child");
        bench.click(Role::Button, "Add child");
        bench.choose(&["More", "Add target"]);
        bench.enter("Target x", "0.9");
        bench.enter("Target y", "1.6");
        select(&mut bench, "joint_2");
        bench.choose(&["More", "Add target"]);
        bench.enter("Target x", "-0.8");
        bench.enter("Target y", "1.9");
        assert_eq!(bench.session().rig().targets.len(), 2);
        bench.show_tab(PanelTab::Solver);

        choose_item(&mut bench, "Method", name);
        assert_eq!(bench.session().rig().solver.method, method);
        bench.click_at(bench.rect(Role::Button, "Run").center());
        assert!(bench.session().solvers().is_running());
        bench.wait(4.0);
        let solver_run = bench.session().solvers().run().expect("it ran");
        assert!(!solver_run.is_running(), "it stops by itself");
        let report = solver_run.report();
        assert!(report.converged(), "{name}: {report:?}");
        assert!(bench.says("converged"));
        assert_eq!(solver_run.iterates().iter().len(), report.iterations as usize + 1);
        assert_eq!(solver_run.shown().error, report.error);
        bench.click(Role::Button, "Apply pose");
        let (rig, pose) = (bench.session().rig(), bench.session().skeleton_pose());
        for target in &rig.targets {
            assert!(pose.tip(target.joint).distance(target.home) < 1e-3);
        }
    }
}

#[test]
fn a_step_is_one_iteration_of_a_ghost_and_reset_removes_it() {
    let mut bench = Bench::example("two-targets");
    let before = bench.session().document().clone();
    let ghosts = |bench: &Bench| bench.session().overlays().ghosts;
    let mut poses = Vec::new();
    for iterations in 1..=3 {
        bench.click(Role::Button, "Step");
        let run = bench.session().solvers().run().expect("it stepped");
        assert_eq!(run.report().iterations, iterations);
        poses.extend(ghosts(&bench).into_iter().map(|ghost| ghost.pose));
    }
    assert!(poses.len() == 3 && poses[0] != poses[1] && poses[1] != poses[2]);
    assert_eq!(bench.session().document(), &before);
    bench.click(Role::Button, "Reset");
    assert!(ghosts(&bench).is_empty() && bench.session().solvers().run().is_none());
    assert!(!is_enabled(&bench, Role::Button, "Reset"));
}

#[test]
fn the_iteration_slider_moves_the_ghost_the_plot_and_the_error_together() {
    let mut bench = Bench::example("two-targets");
    assert!(!bench.shows(Role::Slider, "Iteration"), "there is no run yet");
    (0..5).for_each(|_| bench.click(Role::Button, "Step"));
    let run = bench.session().solvers().run().expect("it stepped").clone();
    let iterates: Vec<Iterate> = run.iterates().iter().cloned().collect();
    bench.reveal(Role::Slider, "Iteration");
    bench.focus(Role::Slider, "Iteration");
    for number in (0..5_usize).rev() {
        bench.key(Key::ArrowLeft);
        bench.settle();
        let session = bench.session();
        assert_eq!(session.solvers().run().expect("a run").shown(), &iterates[number]);
        let ghost = &session.overlays().ghosts[0];
        assert_eq!(ghost.iteration as usize, number);
        assert_eq!(ghost.pose, session.solvers().run().expect("a run").skeleton().pose());
        assert!(bench.says(&format!("at iteration {number} of 5")), "the plot's cursor");
        assert!(bench.shows(Role::Label, &format!("iteration {number} of 5")));
    }
    assert_eq!(bench.session().overlays().ghosts[0].pose, bench.session().skeleton().pose());
}

#[test]
fn comma_and_full_stop_go_through_the_iterations() {
    let mut bench = Bench::example("two-targets");
    let shown =
        |bench: &Bench| bench.session().solvers().shown_iteration().map(|shown| shown.number);
    bench.key(Key::Comma);
    assert_eq!(shown(&bench), None);
    (0..3).for_each(|_| bench.key(Key::S));
    for (key, expected) in [
        (Key::Period, 3),
        (Key::Comma, 2),
        (Key::Comma, 1),
        (Key::Comma, 0),
        (Key::Comma, 0),
        (Key::Period, 1),
        (Key::S, 4),
        (Key::Comma, 3),
    ] {
        bench.key(key);
        assert_eq!(shown(&bench), Some(expected), "{key:?}");
    }
    bench.key(Key::F1);
    bench.wait(0.5);
    assert!(bench.shows(Role::Label, "Previous iteration"));
}

#[test]
fn apply_pose_writes_the_shown_iterate_as_one_step() {
    let mut bench = Bench::example("two-targets");
    let before = bench.session().document().clone();
    let is_disabled_because = |bench: &mut Bench, reason: &str| {
        bench.reveal(Role::Button, "Apply pose");
        assert!(!is_enabled(bench, Role::Button, "Apply pose"));
        bench.move_to(bench.rect(Role::Button, "Apply pose").center());
        bench.wait(1.0);
        assert!(bench.says(reason), "{reason}");
    };
    assert!(!bench.shows(Role::Button, "Apply pose"), "there is no run yet");
    (0..4).for_each(|_| bench.click(Role::Button, "Step"));
    bench.apply([SolverAction::Show(0)]);
    is_disabled_because(&mut bench, "Iteration 0 is the start already");
    bench.apply([SolverAction::Show(2)]);
    let posed = bench.session().solvers().run().expect("a run").skeleton().clone();
    bench.click(Role::Button, "Apply pose");
    assert_eq!(bench.session().skeleton(), &posed);
    assert_eq!(bench.session().history().undo_label(), Some("Apply pose"));
    assert!(bench.session().solvers().run().is_none());
    bench.key_with(Modifiers::COMMAND, Key::Z);
    assert_eq!(bench.session().document(), &before);
    bench.apply([SolverAction::Compare]);
    is_disabled_because(&mut bench, "End the race");
}

#[test]
fn escape_ends_a_solver_run_and_a_race() {
    let mut bench = Bench::example("ten-joints");
    bench.apply([SolverEdit::SetSolver({
        let solver = bench.session().rig().solver;
        solver.with_method(Method::TransposeFixed)
    })]);
    bench.click_at(bench.rect(Role::Button, "Run").center());
    bench.wait(0.2);
    assert!(bench.session().solvers().is_running());
    bench.key(Key::Escape);
    bench.settle();
    assert!(bench.session().solvers().run().is_none());
    bench.apply_moving([SolverAction::Compare]);
    bench.key(Key::Escape);
    bench.settle();
    assert!(bench.session().solvers().comparison().is_none());
}

#[test]
fn a_disabled_target_is_ignored() {
    let mut bench = Bench::example("two-targets");
    bench.click(Role::CheckBox, "Target of left_3");
    assert!(!bench.session().rig().targets[0].enabled);
    assert_eq!(bench.session().rig().targets_at(0.0).len(), 1);
    bench.click(Role::CheckBox, "Target of right_3");
    assert!(!is_enabled(&bench, Role::Button, "Run"));
}

#[test]
fn a_race_runs_every_solver_from_the_same_start_and_leaves_the_skeleton() {
    let mut bench = Bench::example("two-targets");
    let before = bench.session().rig().clone();
    bench.show_tab(PanelTab::Race);
    bench.click_at(bench.rect(Role::Button, "Race all solvers").center());
    bench.wait(4.0);
    let comparison = bench.session().solvers().comparison().expect("it goes on");
    assert!(!comparison.is_running(), "it ends");
    assert_eq!(comparison.solvers().len(), Method::ALL.len());
    for solver in comparison.solvers() {
        let run = solver.run.as_ref().expect("all can run here");
        let report = run.report();
        assert!(report.iterations > 0 && run.elapsed().as_nanos() > 0);
        let converges = !matches!(solver.method, Method::TwoBone | Method::TransposeFixed);
        assert!(report.converged() || !converges, "{:?}: {report:?}", solver.method);
    }
    assert_eq!(bench.session().overlays().ghosts.len(), Method::ALL.len());
    assert_eq!(bench.session().rig(), &before);
    assert!(bench.says("CCD") && bench.says("FABRIK"));
    bench.click(Role::Button, "End race");
    assert!(bench.session().solvers().comparison().is_none());
}

#[test]
fn a_solver_that_cannot_run_says_so_in_the_race() {
    let mut bench = built();
    select(&mut bench, "joint");
    bench.choose(&["More", "Add target"]);
    bench.show_tab(PanelTab::Race);
    bench.click_at(bench.rect(Role::Button, "Race all solvers").center());
    bench.wait(1.0);
    let comparison = bench.session().solvers().comparison().expect("it goes on");
    let two_bone = comparison.solvers().iter().find(|solver| solver.method == Method::TwoBone);
    let error = two_bone.expect("it is there").run.as_ref().expect_err("its parent is locked");
    assert!(error.to_string().contains("locked"), "{error}");
}

#[test]
fn a_moving_target_moves_during_playback_and_the_skeleton_follows() {
    let mut bench = built();
    bench.choose(&["More", "Add target"]);
    bench.reveal(Role::ComboBox, "Motion");
    bench.click_at(bench.rect(Role::ComboBox, "Motion").center());
    bench.wait(0.1);
    let at = bench.rect(Role::Button, "Circle").center();
    bench.click_at(at);
    bench.wait(0.1);
    let target = bench.session().rig().targets[0];
    assert_eq!(target.motion.path, TargetPath::Circle);
    assert!(bench.session().playback().is_playing(), "it goes at once");
    bench.wait(1.0);
    let time = bench.session().playback().time();
    assert!(time > 0.8, "{time} s");
    let at = bench.session().rig().targets[0].at(time);
    assert!(at.distance(target.home) > 0.1 * target.motion.radius);
    let tip = bench.session().skeleton_pose().tip(JointId::new(3));
    assert!(tip.distance(at) < 1e-3, "{tip} follows {at}");
    bench.key(Key::Space);
    bench.wait(1.0);
    assert!(!bench.session().playback().is_playing());
    bench.settle();
}

#[test]
fn a_snake_moves_when_it_is_played_and_its_joints_can_be_turned_only_at_its_first_key() {
    let document = Box::new(crate::common::documents::keyed_snake());
    let mut bench = Bench::after([FileAction::Opened { document, file: None, contents: None }]);
    bench.apply([ViewAction::ShowTimeline(true)]);
    let before = bench.session().skeleton_pose().clone();
    bench.click_at(bench.rect(Role::Button, "Play").center());
    bench.wait(1.0);
    assert!(
        bench
            .session()
            .skeleton_pose()
            .base(JointId::new(0))
            .distance(before.base(JointId::new(0)))
            > 0.05
    );
    let document = bench.session().document().clone();
    bench.wait(0.5);
    assert_eq!(bench.session().document(), &document, "playing writes nothing");
    bench.click_at(bench.rect(Role::Button, "Pause").center());
    bench.settle();
    select(&mut bench, "head");
    assert!(!is_enabled(&bench, Role::Slider, "Rotation x"));
    assert!(!is_enabled(&bench, Role::Button, "Run"));
    bench.click(Role::Button, "To start");
    assert_eq!(bench.session().skeleton_pose(), &before);
    assert!(is_enabled(&bench, Role::Slider, "Rotation x"), "at the first key");
}

#[test]
fn the_tree_selects_one_more_or_none_and_follows_the_arrow_keys() {
    let mut bench = built();
    select(&mut bench, "joint");
    assert_eq!(bench.session().selection().joints(), [1].map(JointId::new));
    bench.hold(Modifiers::SHIFT);
    select(&mut bench, "joint_2");
    assert_eq!(bench.session().selection().joints(), [1, 3].map(JointId::new));
    select(&mut bench, "joint");
    assert_eq!(bench.session().selection().joints(), [3].map(JointId::new));
    bench.hold(Modifiers::NONE);
    select(&mut bench, "joint");
    bench.focus(Role::Button, "Joint joint");
    bench.key(Key::ArrowDown);
    assert_eq!(bench.session().selection().joints(), [2].map(JointId::new));
    bench.key(Key::ArrowUp);
    bench.key(Key::ArrowUp);
    assert_eq!(bench.session().selection().joints(), [0].map(JointId::new));
}

#[test]
fn single_keys_build_and_solve_while_no_widget_has_the_keyboard() {
    let mut bench = Bench::new();
    bench.choose(&["File", "New", "Empty"]);
    let empty = bench.empty_point();
    bench.move_to(empty);
    bench.apply([SelectAction::Joints(vec![JointId::new(0)])]);
    bench.key(Key::A);
    bench.key(Key::A);
    assert_eq!(names(&bench).len(), 3);
    bench.key(Key::T);
    assert_eq!(bench.session().rig().targets.len(), 1);
    bench.key(Key::S);
    assert!(bench.session().solvers().run().is_some());
    bench.key(Key::T);
    assert!(bench.session().rig().targets.is_empty());
    bench.key(Key::F2);
    assert!(
        matches!(bench.session().shell().dialog(), Some(Dialog::Rename { joint, .. }) if joint.index() == 2)
    );
    bench.frame([]);
    bench.type_text("a");
    assert_eq!(names(&bench).len(), 3, "a letter in a text box is a letter");
    bench.key(Key::Escape);
    bench.settle();
    bench.apply([ShellAction::CloseDialog]);
    bench.key_with(Modifiers::COMMAND, Key::A);
    assert_eq!(bench.session().selection().joints(), [0, 1, 2].map(JointId::new));
    bench.key(Key::Escape);
    assert!(bench.session().selection().joints().is_empty());
    bench.apply([SelectAction::Joints(vec![JointId::new(1)])]);
    bench.key(Key::Delete);
    bench.settle();
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(names(&bench), ["root", "joint_1"], "its child is kept");
}

#[test]
fn lengthening_a_bone_moves_the_children_on_its_tip() {
    let mut bench = built();
    select(&mut bench, "joint_1");
    bench.click(Role::SpinButton, "Length");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([egui::Event::Text("2.5".to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
    let skeleton = &bench.session().skeleton();
    assert!((skeleton.joints()[2].axis.length() - 2.5).abs() < 1e-6);
    assert!(skeleton.base(JointId::new(3)).distance(skeleton.tip(JointId::new(2))) < 1e-6);
}

#[test]
fn a_joint_is_made_stiff_as_a_whole_or_about_one_axis() {
    let mut bench = built();
    select(&mut bench, "joint_1");
    let stiffness = |bench: &Bench| bench.session().skeleton().joints()[2].stiffness;
    bench.reveal(Role::Slider, "Stiffness");
    bench.enter("Stiffness", "0.5");
    assert_eq!(stiffness(&bench), Vec3::splat(0.5));
    bench.click(Role::DisclosureTriangle, "Stiffness by angle");
    bench.reveal(Role::Slider, "Stiffness y");
    bench.enter("Stiffness y", "7");
    assert_eq!(stiffness(&bench), Vec3::new(0.5, Joint::MAX_STIFFNESS, 0.5));
    bench.key_with(Modifiers::COMMAND, Key::Z);
    bench.key_with(Modifiers::COMMAND, Key::Z);
    assert_eq!(stiffness(&bench), Vec3::ZERO);
}

#[test]
fn the_stiffness_of_free_roots_is_set_on_the_solver_page() {
    let mut bench = Bench::example("human");
    assert_eq!(bench.session().rig().solver.root, Root::Free);
    bench.show_tab(PanelTab::Solver);
    bench.toggle(&["Settings"]);
    bench.reveal(Role::SpinButton, "Root stiffness");
    bench.click(Role::SpinButton, "Root stiffness");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([egui::Event::Text("7".to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bench.session().rig().solver.root_stiffness, Joint::MAX_STIFFNESS);
    let turns = bench.session().rig().solver.with_root(Root::Turns);
    bench.apply([SolverEdit::SetSolver(turns)]);
    bench.settle();
    assert!(!bench.shows(Role::SpinButton, "Root stiffness"), "roots that stay have none");
}

#[test]
fn the_posture_rate_is_set_on_the_solver_page() {
    let mut bench = built();
    bench.choose(&["More", "Add target"]);
    bench.reveal(Role::SpinButton, "Posture rate");
    bench.click(Role::SpinButton, "Posture rate");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([egui::Event::Text("0".to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bench.session().rig().solver.posture_rate, 0.0);
}

#[test]
fn the_mobility_of_roots_is_one_choice_of_three() {
    let mut bench = built();
    bench.choose(&["More", "Add target"]);
    for (name, root) in [("Locked", Root::Locked), ("Free", Root::Free), ("Turns", Root::Turns)] {
        bench.click(Role::Button, name);
        assert_eq!(bench.session().rig().solver.root, root);
    }
}

#[test]
fn a_root_that_is_free_is_moved_by_the_solver() {
    let mut bench = built();
    bench.choose(&["More", "Add target"]);
    bench.click(Role::Button, "Free");
    assert_eq!(bench.session().rig().solver.root, Root::Free);
    bench.reveal(Role::Slider, "Target x");
    bench.enter("Target x", "25");
    bench.click_at(bench.rect(Role::Button, "Run").center());
    bench.wait(4.0);
    let report = bench.session().solvers().run().expect("it ran").report();
    assert!(report.converged(), "{report:?}");
    bench.reveal(Role::Button, "Apply pose");
    bench.click(Role::Button, "Apply pose");
    assert!(bench.session().skeleton().joints()[0].offset.x > 15.0);
}

#[test]
fn files_are_asked_for_opened_and_saved() {
    let mut bench = Bench::new();
    bench.key_with(Modifiers::COMMAND, Key::O);
    assert_eq!(bench.session().shell().dialog(), Some(&Dialog::Path(PathDialog::open())));
    bench.frame([]);
    bench.frame([egui::Event::Text("scene.js3d".to_owned())]);
    bench.key(Key::Enter);
    let open = Effect::Open { path: "scene.js3d".into(), options: OpenOptions::default() };
    assert_eq!(bench.effects(), [open]);
    let document = Box::new(bench.session().document().clone());
    bench.apply([FileAction::Opened { document, file: None, contents: None }]);
    bench.key_with(Modifiers::COMMAND, Key::S);
    assert!(
        matches!(bench.session().shell().dialog(), Some(Dialog::Path(PathDialog::SaveAs { .. }))),
        "it has no file yet"
    );
    bench.settle();
    bench.key(Key::Enter);
    assert_eq!(bench.effects(), [Effect::Save("ik-arm.json".into())]);
    bench.apply([FileAction::Saved("ik-arm.json".into())]);
    bench.key_with(Modifiers::COMMAND, Key::S);
    assert_eq!(bench.effects(), [Effect::Save("ik-arm.json".into())]);
}

fn contents(skeletons: &[&str], animations: &[&str]) -> Box<FileContents> {
    let animation = |name: &&str| FileAnimation {
        name: (*name).to_owned(),
        start: 0.0,
        end: 2.0,
        moving_joints: 3,
        has_morphs: false,
    };
    Box::new(FileContents {
        path: "two.glb".into(),
        options: OpenOptions::default(),
        skeletons: skeletons.iter().map(|name| (*name).to_owned()).collect(),
        animations: animations.iter().map(animation).collect(),
        animation: Some(0),
    })
}

#[test]
fn of_several_skeletons_one_is_chosen() {
    let dialog = Dialog::ChooseContents(contents(&["left", "right"], &[]));
    let mut bench = Bench::after([ShellAction::OpenDialog(dialog)]);
    bench.click(Role::Button, "left");
    assert_eq!(bench.effects(), [], "it is open");
    bench.click(Role::Button, "right");
    let options = OpenOptions::of_skeleton("right");
    assert_eq!(bench.effects(), [Effect::Open { path: "two.glb".into(), options }]);
}

#[test]
fn of_several_animations_another_is_chosen_from_the_menu() {
    let mut bench = Bench::new();
    bench.choose(&["File", "Skeletons and animations…"]);
    assert!(bench.session().shell().dialog().is_none(), "there is nothing to choose");
    bench.key(Key::Escape);
    let opened = |contents| FileAction::Opened {
        document: Box::new(example("human")),
        file: None,
        contents: Some(contents),
    };
    bench.apply([opened(contents(&["rig"], &["Idle", "Run"]))]);
    assert!(bench.says("2 animations"), "asked once it is open");
    bench.click(Role::Button, "Keep what is open");
    bench.choose(&["File", "Skeletons and animations…"]);
    assert!(bench.says("2 animations"));
    bench.click(Role::Button, "Run · 2.00 s · 3 joints");
    let options = OpenOptions::of_animation("Run");
    assert_eq!(bench.effects(), [Effect::Open { path: "two.glb".into(), options }]);
}

#[test]
fn a_figure_that_stands_along_z_can_be_turned_or_left() {
    let human = example("human");
    let mut standing_along_z = human.clone();
    (0..3).for_each(|_| standing_along_z.turn_y_up());
    let mut bench = Bench::new();
    for answer in ["Turn to y up", "Leave"] {
        let mut contents = contents(&["rig"], &["Idle", "Run"]);
        contents.options = OpenOptions::of_skeleton("rig");
        let document = Box::new(standing_along_z.clone());
        bench.apply([FileAction::Opened { document, file: None, contents: Some(contents) }]);
        assert!(bench.says("z seems to point up"));
        bench.click(Role::Button, answer);
        assert!(!bench.says("z seems to point up"));
        let is_turned = answer == "Turn to y up";
        let transform = bench.session().skeleton().transform();
        assert_eq!(transform == human.skeleton().transform(), is_turned);
        let up = bench.session().files().contents().expect("it has contents").options.up;
        assert_eq!(up, is_turned.then_some(Upwards::Z), "other animations are turned, too");
        if is_turned {
            bench.key_with(Modifiers::COMMAND, Key::Z);
            assert_eq!(bench.session().document().skeleton(), standing_along_z.skeleton());
        }
    }
    bench.choose(&["Edit", "Turn to y up"]);
    assert_eq!(bench.session().skeleton().transform(), human.skeleton().transform());
}

#[test]
fn every_example_of_the_tour_opens_from_its_menu() {
    let mut bench = Bench::new();
    for example in Example::of(ExampleGroup::Basics) {
        bench.choose(&["Examples", example.title]);
        let opened = example.open().expect("it opens").document;
        assert_eq!(bench.session().document(), &opened, "{}", example.title);
        assert!(bench.says(example.sentence));
        bench.apply_moving([PlaybackAction::Play(false)]);
    }
}

#[test]
fn hundreds_of_joints_long_names_and_small_windows_are_shown_too() {
    let mut bench = Bench::of_size(SMALL);
    bench.choose(&["File", "New", "Empty"]);
    let name = "a name of many letters ".repeat(4);
    bench.apply([JointEdit::RenameJoint { joint: JointId::new(0), name }]);
    bench.apply(
        (0..200).map(|parent| JointEdit::AddChild { parent: JointId::new(parent), tip: None }),
    );
    assert_eq!(names(&bench).len(), 201);
    assert_eq!(bench.session().selection().active(), Some(JointId::new(200)));
    bench.apply([
        Action::from(TargetEdit::AddTarget(JointId::new(200))),
        SelectAction::Joints((0..201).map(JointId::new).collect()).into(),
    ]);
    bench.settle();
}

#[test]
fn where_no_solver_can_run_the_empty_plots_say_why() {
    let mut bench = built();
    for tab in [PanelTab::Solver, PanelTab::Race] {
        bench.show_tab(tab);
        assert!(bench.says("Add a target to a joint first."), "{tab:?}");
        assert!(!bench.says("Press Run"), "{tab:?}");
    }
}

#[test]
fn a_race_of_many_iterations_stays_inside_the_window() {
    for size in [LARGE, SMALL] {
        let mut bench = Bench::of_size(size);
        bench.apply([open_example("ten-joints")]);
        let far = |target: &Target| Target { home: Vec3::new(3.0, 3.0, 3.0), ..*target };
        let targets: Vec<_> = bench.session().rig().targets.iter().map(far).collect();
        bench.apply(targets.into_iter().map(TargetEdit::SetTarget));
        bench.apply([SolverEdit::SetIterationsPerFrame(1000)]);
        bench.show_tab(PanelTab::Race);
        bench.click_at(bench.rect(Role::Button, "Race all solvers").center());
        bench.settle();
        let latest = bench.session().solvers().shown_iteration().expect("a race").latest;
        assert!(latest >= 1000, "too few iterations for the test: {latest}");
        // The margin of the panel.
        let edge = size.x - 8.0 + 0.5;
        for node in bench.harness.root().children_recursive() {
            let widget = node.accesskit_node();
            let is_widget = matches!(
                widget.role(),
                Role::Label | Role::Button | Role::Slider | Role::SpinButton | Role::Image
            );
            if !is_widget || widget.bounding_box().is_none() {
                continue;
            }
            let rect = node.rect();
            let is_on_page = rect.left() > bench.viewport().right();
            let name = widget.label();
            assert!(!is_on_page || rect.right() <= edge, "{name:?} ends at {}", rect.right());
        }
    }
}

// The outliner

/// Whether the tree shows a joint.
fn lists(bench: &Bench, name: &str) -> bool {
    bench.shows(Role::Button, &format!("Joint {name}"))
}

#[test]
fn a_figure_is_unfolded_at_first_to_the_end_of_its_first_limb() {
    let bench = Bench::example("human");
    for name in ["right_upper_arm", "right_forearm", "right_hand", "left_thigh", "neck"] {
        assert!(lists(&bench, name), "{name}");
    }
    for name in ["right_thumb_1", "left_upper_arm", "left_shin", "head"] {
        assert!(!lists(&bench, name), "{name}");
    }
}

#[test]
fn hands_are_folded_until_a_finger_is_selected() {
    let mut bench = Bench::example("human");
    assert!(lists(&bench, "neck") && !lists(&bench, "left_upper_arm"), "twelve rows at most");
    bench.apply([SelectAction::Joints(vec![bench.joint("left_hand")])]);
    bench.settle();
    assert!(lists(&bench, "left_hand") && !lists(&bench, "left_index_1"));
    let finger = bench.joint("left_index_2");
    bench.apply([SelectAction::Joints(vec![finger])]);
    bench.settle();
    assert!(lists(&bench, "left_index_2") && !lists(&bench, "right_index_1"));
}

#[test]
fn rows_fold_at_their_triangles_and_by_the_arrow_keys() {
    let mut bench = built();
    let row = bench.rect(Role::Button, "Joint joint");
    let dot = |depth: f32| egui::pos2(row.left() + 13.0 * depth + 7.0, row.center().y);
    bench.click_at(dot(1.0));
    bench.settle();
    assert!(lists(&bench, "joint") && !lists(&bench, "joint_1"));
    bench.click_at(dot(1.0));
    bench.settle();
    assert!(lists(&bench, "joint_2"));
    select(&mut bench, "joint_1");
    bench.key(Key::ArrowLeft);
    bench.settle();
    assert!(!lists(&bench, "joint_2"));
    bench.key(Key::ArrowRight);
    bench.settle();
    assert!(lists(&bench, "joint_2"));
}

#[test]
fn the_filter_shows_joints_by_parts_of_their_names_with_those_above_them() {
    let mut bench = Bench::example("human");
    bench.click(Role::TextInput, "Filter joints");
    bench.type_text("thumb");
    bench.settle();
    for name in ["left_thumb_3", "right_thumb_1", "left_hand", "pelvis"] {
        assert!(lists(&bench, name), "{name}");
    }
    assert!(!lists(&bench, "head") && !lists(&bench, "left_index_1"));
    bench.type_text("s");
    bench.settle();
    assert!(bench.says("No joint has such a name"));
}

#[test]
fn the_outliner_keeps_its_height_and_folds_as_a_whole() {
    let mut bench = Bench::example("human");
    let end = bench.bottom_of_outliner();
    bench.wait(1.0);
    assert_eq!(bench.bottom_of_outliner(), end, "it does not grow by itself");
    bench.click(Role::Button, "Joints");
    assert!(!lists(&bench, "pelvis") && bench.bottom_of_outliner() < end - 100.0);
    bench.click(Role::Button, "Joints");
    assert!(lists(&bench, "pelvis"));
}

#[test]
fn the_outliner_of_a_small_figure_ends_below_its_joints() {
    let mut bench = built();
    let joints = bench.session().skeleton().joints().len();
    let first = bench.bottom_of_outliner();
    bench.apply([JointEdit::AddJoint { tip: None }]);
    assert_eq!(bench.session().skeleton().joints().len(), joints + 1);
    assert_eq!(bench.bottom_of_outliner(), first + 20.0, "a row more");
    let large = Bench::example("human");
    let rows = 20.0 * large.session().skeleton().joints().len() as f32;
    assert!(large.bottom_of_outliner() < rows, "that of a large one scrolls");
}
