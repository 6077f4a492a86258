//! Why targets are not reached: the note beside the target, the panel and the status bar.

use egui::accesskit::Role;
use egui::{PointerButton, vec2};
use glam::Vec3;
use ik_arm::document::Target;
use ik_arm::kinematics::diagnosis::Remedy;
use ik_arm::session::{
    PanelTab, PlaybackAction, SelectAction, SolverAction, SolverEdit, TargetEdit, TransactionAction,
};
use ik_arm::words;

use crate::bench::Bench;

const TOO_FAR: &str = "left_hand cannot reach that far: the target is";
const MOVE: &str = "Move the target of left_hand within reach";
const STRETCH: &str = "Let the limb stretch by up to";

/// The Human with the target of its left hand too far away.
fn bench() -> Bench {
    let mut bench = Bench::example("human");
    let target = Target { home: Vec3::new(0.8, 1.5, 0.5), ..target(&bench) };
    bench.show_tab(PanelTab::Solver);
    bench.apply([SolverEdit::SetBodyFollows(false)]);
    bench.apply([TargetEdit::SetTarget(target)]);
    bench.settle();
    bench
}

fn target(bench: &Bench) -> Target {
    let rig = bench.session().rig();
    rig.targets[rig.target_of_end(bench.joint("left_hand")).expect("a target")]
}

fn error(bench: &Bench) -> f32 {
    let target = target(bench);
    bench.session().posed().target_report(target.joint).expect("a report").error
}

/// Number of labels that begin with this text.
fn labels(bench: &Bench, text: &str) -> usize {
    bench.count(text)
}

#[test]
fn a_note_beside_the_target_and_the_status_bar_say_why() {
    let mut bench = bench();
    assert_eq!(labels(&bench, TOO_FAR), 3);
    let at = bench.on_screen(target(&bench).home);
    let button = bench.rect(Role::Button, MOVE);
    assert!(bench.viewport().contains_rect(button), "{button:?}");
    assert!(button.distance_to_pos(at) < 260.0 && !button.contains(at), "{button:?} {at:?}");

    // The panel adds one, with all remedies.
    let hand = bench.joint("left_hand");
    bench.apply([SelectAction::Joints(vec![hand])]);
    bench.settle();
    assert_eq!(labels(&bench, TOO_FAR), 4);
    assert_eq!(labels(&bench, STRETCH), 1);
}

#[test]
fn the_button_of_the_note_applies_the_remedy_as_one_undo_step_and_says_what_it_did() {
    let mut bench = bench();
    let before = bench.session().document().clone();
    bench.click(Role::Button, MOVE);
    bench.settle();
    assert!(error(&bench) <= bench.session().rig().tolerance());
    assert_eq!(labels(&bench, TOO_FAR), 0);
    let done = "Moved the target of left_hand within reach: left_hand is at its target now";
    assert!(bench.says(done), "{:?}", bench.session().shell().message());
    bench.apply([TransactionAction::Undo]);
    assert_eq!(bench.session().document(), &before);
}

#[test]
fn each_remedy_in_the_panel_leaves_what_its_tooltip_tells() {
    let mut bench = bench();
    let hand = bench.joint("left_hand");
    bench.apply([SelectAction::Joints(vec![hand])]);
    bench.settle();
    let tried: Vec<_> =
        bench.session().why(true).iter().flat_map(|it| it.remedies.clone()).collect();
    assert!(matches!(tried[..], [_, _, _]), "{tried:?}");
    for tried in tried {
        let name = words::remedy(bench.session().rig(), &tried.remedy);
        if matches!(tried.remedy, Remedy::Stretch { .. }) {
            // It may be below the edge of the note.
            bench.node(Role::Button, &name).click_accesskit();
            bench.settle();
        } else {
            let target = target(&bench).joint;
            bench.apply([TargetEdit::ApplyRemedy { target, remedy: tried.remedy.clone() }]);
        }
        assert!((error(&bench) - tried.residual).abs() < 1e-4, "{name}");
        bench.apply([TransactionAction::Undo]);
        bench.settle();
    }
}

#[test]
fn nothing_is_said_during_a_drag_while_time_passes_or_while_a_solver_run_is_watched() {
    let mut bench = bench();
    let at = bench.on_screen(target(&bench).home);
    bench.move_to(at);
    bench.press(PointerButton::Primary);
    bench.move_to(at + vec2(20.0, 0.0));
    assert_eq!(labels(&bench, TOO_FAR), 0);
    bench.release(PointerButton::Primary);
    bench.settle();
    assert_eq!(labels(&bench, TOO_FAR), 3);

    bench.apply_moving([PlaybackAction::Play(true)]);
    bench.frame([]);
    assert_eq!(labels(&bench, TOO_FAR), 0);
    bench.apply([PlaybackAction::Play(false)]);
    bench.apply([SolverAction::Step]);
    bench.settle();
    assert!(!bench.shows(Role::Button, MOVE));
    bench.apply([SolverAction::Reset]);
    bench.settle();
    assert!(bench.shows(Role::Button, MOVE));
}

#[test]
fn a_cancelled_drag_says_why_again() {
    let mut bench = bench();
    let at = bench.on_screen(target(&bench).home);
    bench.move_to(at);
    bench.press(PointerButton::Primary);
    bench.move_to(at + vec2(-40.0, 30.0));
    bench.apply([TransactionAction::Cancel]);
    bench.release(PointerButton::Primary);
    bench.settle();
    assert!(bench.shows(Role::Button, MOVE));
}

/// The Human with its left foot asked to turn about x by so many degrees, the foot selected.
fn foot_turned_by(degrees: &str) -> Bench {
    let mut bench = Bench::example("human");
    bench.show_tab(PanelTab::Solver);
    let foot = bench.joint("left_foot");
    bench.apply([SelectAction::Joints(vec![foot])]);
    bench.settle();
    bench.toggle(&["Hand orientation"]);
    bench.reveal(Role::SpinButton, "Hand rotation x value");
    bench.enter("Hand rotation x", degrees);
    bench.settle();
    bench
}

fn missing_degrees(bench: &Bench) -> f32 {
    let shin = bench.joint("left_shin");
    let report = bench.session().posed().target_report(shin).expect("a report");
    report.rotation_error.expect("a rotation").to_degrees()
}

#[test]
fn a_foot_that_cannot_turn_that_far_says_so_and_names_the_limit() {
    let [some, more] = ["80", "120"].map(|degrees| {
        let bench = foot_turned_by(degrees);
        let missing = missing_degrees(&bench);
        let sentence = words::cause(bench.session().rig(), &bench.session().why(true)[0]);
        assert!(sentence.starts_with("left_foot is "), "{sentence}");
        assert!(sentence.contains("its limit about x is in the way"), "{sentence}");
        assert_eq!(labels(&bench, &sentence), 4, "as many as for a place that is not reached");
        assert_eq!(
            bench
                .session()
                .solvers()
                .status(bench.session().posed())
                .expect("targets")
                .state
                .to_string(),
            "not reached"
        );
        assert!(bench.count("° of its rotation missing") == 1, "{missing}");
        let short = words::significant(missing);
        assert_eq!(
            bench.count(&format!("{short}°")),
            6,
            "these, the panel's and the list's: {short}"
        );
        missing
    });
    assert!(some > 20.0 && more > some + 30.0, "{some} {more}");
}

#[test]
fn the_remedy_of_a_foot_widens_the_limit_that_is_in_the_way() {
    let mut bench = foot_turned_by("80");
    let tried = bench.session().why(true)[0].remedies[0].clone();
    let name = words::remedy(bench.session().rig(), &tried.remedy);
    assert!(name.starts_with("Widen the limit of left_foot about x by "), "{name}");
    let target = bench.joint("left_shin");
    bench.apply([TargetEdit::ApplyRemedy { target, remedy: tried.remedy }]);
    bench.settle();
    assert!(missing_degrees(&bench) < 0.05);
    assert!(bench.session().why(true).is_empty());
    assert!(
        bench.says("left_foot is at its target now"),
        "{:?}",
        bench.session().shell().message()
    );
}
