//! Looking inside an iteration: the slider of parts, keys, buttons, switches and numbers.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use glam::Vec3;
use ik_arm::document::Target;
use ik_arm::kinematics::chain_ik::{Method, SubStepKind};
use ik_arm::session::{InsideLayer, SelectAction, SolverAction, SolverEdit, SolverRun, TargetEdit};

use crate::bench::Bench;

/// The ten-joint chain, solved by a method, after one iteration.
fn after_a_step(method: Method) -> Bench {
    let mut bench = example("ten-joints");
    let options = bench.session().rig().solver;
    bench.apply([SolverEdit::SetSolver(options.with_method(method))]);
    bench.apply([SolverAction::Step]);
    bench.settle();
    bench
}

fn example(name: &str) -> Bench {
    let mut bench = Bench::example(name);
    bench.settle();
    bench
}

fn run(bench: &Bench) -> &SolverRun {
    bench.session().solvers().run().expect("a run")
}

/// Number of the shown iteration and index of the shown part.
fn shown(bench: &Bench) -> (u32, Option<usize>) {
    (run(bench).shown().iteration, run(bench).shown_part())
}

fn look_inside(bench: &mut Bench) {
    bench.reveal(Role::CheckBox, "Look inside");
    bench.click(Role::CheckBox, "Look inside");
    bench.settle();
}

#[test]
fn the_check_box_shows_the_first_part_and_then_the_whole_iteration_again() {
    let mut bench = after_a_step(Method::Ccd);
    let whole = run(&bench).skeleton().clone();
    look_inside(&mut bench);
    assert_eq!(shown(&bench), (1, Some(0)));
    assert_ne!(run(&bench).skeleton(), &whole);
    look_inside(&mut bench);
    assert_eq!(shown(&bench), (1, None));
    assert_eq!(run(&bench).skeleton(), &whole);
}

#[test]
fn shift_period_and_shift_comma_go_through_parts_and_iterations_and_back() {
    let mut bench = after_a_step(Method::Fabrik);
    let mut seen = Vec::new();
    for _ in 0..4 {
        bench.key_with(Modifiers::SHIFT, Key::Period);
        bench.settle();
        seen.push(shown(&bench));
    }
    assert_eq!(seen, [(1, Some(0)), (1, Some(1)), (2, Some(0)), (2, Some(1))]);
    for expected in [(2, Some(0)), (1, Some(1)), (1, Some(0)), (1, Some(0))] {
        bench.key_with(Modifiers::SHIFT, Key::Comma);
        bench.settle();
        assert_eq!(shown(&bench), expected);
    }
}

#[test]
fn shift_period_without_a_run_begins_one() {
    let mut bench = example("ten-joints");
    bench.key_with(Modifiers::SHIFT, Key::Period);
    bench.settle();
    assert_eq!(shown(&bench), (1, Some(0)));
}

#[test]
fn the_last_part_has_the_pose_of_the_iteration() {
    for method in [
        Method::DampedLeastSquares,
        Method::Ccd,
        Method::Fabrik,
        Method::Relaxation,
        Method::Transpose,
    ] {
        let mut bench = after_a_step(method);
        let whole = run(&bench).skeleton().clone();
        let last = run(&bench).parts().len() - 1;
        bench.apply([SolverAction::ShowPart { iteration: 1, part: Some(last) }]);
        assert_eq!(run(&bench).skeleton(), &whole, "{method:?}");
    }
}

#[test]
fn relaxation_shows_its_pass_and_then_the_bones_laid_out() {
    let mut bench = after_a_step(Method::Relaxation);
    look_inside(&mut bench);
    assert!(bench.says("Restore each bone's length") && bench.says("Points of the joints"));
    let lines = |bench: &Bench| bench.session().overlays().inside.expect("a part").part.clone();
    assert!(matches!(lines(&bench).kind, SubStepKind::Relaxed(_)));
    bench.key_with(Modifiers::SHIFT, Key::Period);
    bench.settle();
    assert_eq!(shown(&bench), (1, Some(1)));
    assert!(bench.says("Lay the bones out") && bench.says("Bones laid out"));
    assert!(matches!(lines(&bench).kind, SubStepKind::LaidOut(_)));
}

#[test]
fn the_slider_and_the_buttons_choose_the_part() {
    let mut bench = after_a_step(Method::Ccd);
    look_inside(&mut bench);
    bench.reveal(Role::Button, "Next");
    bench.click(Role::Button, "Next");
    bench.settle();
    assert_eq!(shown(&bench), (1, Some(1)));
    bench.click(Role::Button, "Back");
    bench.settle();
    assert_eq!(shown(&bench), (1, Some(0)));
    bench.focus(Role::Slider, "Part");
    bench.key(Key::ArrowRight);
    bench.key(Key::ArrowRight);
    bench.settle();
    assert_eq!(shown(&bench), (1, Some(2)));
}

#[test]
fn walking_shows_every_part_of_every_iteration_and_ends_with_the_run() {
    let mut bench = example("inside-fabrik");
    assert!(bench.shows(Role::Button, "Walk"));
    bench.apply_moving([SolverAction::Walk(true)]);
    assert!(bench.shows(Role::Button, "Stand"));
    let mut seen = vec![shown(&bench)];
    for _ in 0..4_000 {
        bench.skip(0.1);
        if shown(&bench) != seen[seen.len() - 1] {
            seen.push(shown(&bench));
        }
        if !run(&bench).is_walking() {
            break;
        }
    }
    assert!(!run(&bench).is_walking() && run(&bench).is_over(), "{:?}", shown(&bench));
    let iterations = run(&bench).report().iterations;
    let parts: Vec<_> = (1..=iterations).flat_map(|it| [(it, Some(0)), (it, Some(1))]).collect();
    assert_eq!(seen, parts);
}

#[test]
fn the_numbers_of_a_step_are_those_of_the_solver() {
    let mut bench = after_a_step(Method::DampedLeastSquares);
    look_inside(&mut bench);
    assert!(bench.says("Columns of the Jacobian") && bench.says("Manipulability ellipsoid"));
    let SubStepKind::Gradient(gradient) = &run(&bench).parts()[0].kind else { panic!("gradient") };
    let strongest = gradient.ellipsoids[0].values[0];
    assert!(bench.says(&format!("{strongest:.3}")), "{strongest}");

    bench.key_with(Modifiers::SHIFT, Key::Period);
    bench.settle();
    let SubStepKind::Step(step) = &run(&bench).parts()[1].kind else { panic!("step") };
    let most = step.changes.iter().max_by(|one, other| one.by.abs().total_cmp(&other.by.abs()));
    let most = most.expect("an angle").by.to_degrees();
    assert!(bench.says(&format!("{most:+.2}°")), "{most}");
}

#[test]
fn turns_that_joints_miss_are_told_in_the_parts_of_every_method_that_can() {
    for method in [Method::DampedLeastSquares, Method::Transpose, Method::Ccd, Method::Fabrik] {
        let mut bench = example("ten-joints");
        let tip = bench.session().rig().targets[0];
        let options = bench.session().rig().solver;
        bench.apply([SolverEdit::SetSolver(options.with_method(method))]);
        let turned = Target { orientation: Some(Vec3::new(0.3, 1.0, 0.0)), ..tip };
        bench.apply([TargetEdit::SetTarget(turned)]);
        bench.apply([SolverAction::Step]);
        bench.settle();
        look_inside(&mut bench);
        let last = run(&bench).parts().len() - 1;
        for part in [0, last] {
            bench.apply([SolverAction::ShowPart { iteration: 1, part: Some(part) }]);
            bench.settle();
            let [missed] = run(&bench).parts()[part].turns[..] else { panic!("one turn") };
            let shown = format!("{:.2}°", missed.turn.length().to_degrees());
            assert!(bench.says("Missing turn") && bench.says(&shown), "{method}: {shown}");
        }
    }
    let mut bench = after_a_step(Method::DampedLeastSquares);
    look_inside(&mut bench);
    assert!(!bench.says("Missing turn"), "no target turns its joint");
}

#[test]
fn switches_hide_what_the_view_shows_and_keep_it_hidden() {
    let mut bench = after_a_step(Method::DampedLeastSquares);
    look_inside(&mut bench);
    let lines = |bench: &Bench| {
        let overlays = bench.session().overlays();
        overlays.inside.expect("a part").layers
    };
    assert!(lines(&bench).shows(InsideLayer::Ellipsoid));
    bench.reveal(Role::CheckBox, "Manipulability ellipsoid");
    bench.click(Role::CheckBox, "Manipulability ellipsoid");
    bench.settle();
    assert!(!lines(&bench).shows(InsideLayer::Ellipsoid));
    assert!(lines(&bench).shows(InsideLayer::Columns));
    bench.apply([SolverAction::Step]);
    assert!(!lines(&bench).shows(InsideLayer::Ellipsoid));
}

#[test]
fn damping_changes_the_shown_iteration_at_once() {
    let mut bench = example("inside-dls");
    let kept = |bench: &Bench| {
        let SubStepKind::Gradient(gradient) = &run(bench).parts()[0].kind else {
            panic!("gradient")
        };
        gradient.ellipsoids[0].gains(gradient.damping.expect("damping"))[2]
    };
    let before = kept(&bench);
    let options = bench.session().rig().solver;
    bench.apply([SolverEdit::SetSolver(options.with_damping(2.0 * options.damping))]);
    bench.settle();
    assert_eq!(shown(&bench), (1, Some(0)));
    assert!(kept(&bench) < before, "{} {before}", kept(&bench));
}

#[test]
fn the_examples_open_inside_their_first_iteration() {
    for (name, method) in [
        ("inside-dls", Method::DampedLeastSquares),
        ("inside-ccd", Method::Ccd),
        ("inside-fabrik", Method::Fabrik),
    ] {
        let bench = example(name);
        assert_eq!((run(&bench).method(), shown(&bench)), (method, (1, Some(0))), "{name}");
        assert!(bench.says("Look inside"));
    }
}

#[test]
fn selecting_a_joint_lists_its_columns_alone() {
    let mut bench = after_a_step(Method::Transpose);
    look_inside(&mut bench);
    assert!(bench.count("joint_3 ") >= 3);
    let joint = bench.joint("joint_1");
    bench.apply([SelectAction::Joints(vec![joint])]);
    bench.settle();
    assert_eq!(bench.count("joint_3 x"), 0);
    assert_eq!(bench.count("joint_1 x"), 1);
}

#[test]
fn the_report_and_the_thin_lines_are_those_of_the_part_that_is_looked_at() {
    let mut bench = after_a_step(Method::Ccd);
    look_inside(&mut bench);
    let parts = run(&bench).parts().len();
    let mut before = bench.session().skeleton().pose();
    for part in 0..parts {
        bench.apply([SolverAction::ShowPart { iteration: 1, part: Some(part) }]);
        let shown = &run(&bench).parts()[part];
        let status = bench.session().solvers().status(bench.session().posed()).expect("a report");
        assert_eq!(status.error, shown.error, "part {part}");
        let view = bench.session().overlays().inside.expect("a part");
        assert_eq!(*view.before, before, "part {part}");
        before = shown.pose.pose();
    }
    bench.apply([SolverAction::ShowPart { iteration: 1, part: None }]);
    let status = bench.session().solvers().status(bench.session().posed()).expect("a report");
    assert_eq!(status.error, run(&bench).shown().error);
}
