//! The balance of a figure: its switch, its influence and what the centre of mass goes over.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use glam::Vec2;
use ik_arm::document::{BalanceOver, BalanceTarget, Channel};
use ik_arm::kinematics::chain_ik::{Method, SolverOptions};
use ik_arm::session::{SolverEdit, TargetEdit, TransactionAction};

use crate::bench::Bench;

fn balance(bench: &Bench) -> Option<BalanceTarget> {
    bench.session().rig().balance
}

/// Distance of the centre of mass from where it should be.
fn error(bench: &Bench) -> f32 {
    let evaluated = bench.session().posed().evaluated_skeleton();
    evaluated.balance.as_ref().expect("a balance").error()
}

#[test]
fn a_check_box_balances_the_figure_in_one_undo_step() {
    let mut bench = Bench::example("human");
    bench.click(Role::CheckBox, "Keep balance");
    bench.settle();
    assert_eq!(balance(&bench), Some(BalanceTarget::default()));
    assert!(error(&bench) < 1e-3, "{}", error(&bench));
    assert!(bench.says("balanced"));
    bench.apply([TransactionAction::Undo]);
    assert_eq!(balance(&bench), None);
}

#[test]
fn the_influence_has_a_slider_and_a_key_and_goes_with_the_balance() {
    let mut bench = Bench::example("human");
    bench.click(Role::CheckBox, "Keep balance");
    bench.enter("Balance influence", "0.5");
    assert_eq!(balance(&bench).expect("a balance").influence, 0.5);
    bench.click(Role::Button, "Key Balance influence");
    let has_key = |bench: &Bench| bench.session().document().keys.has(Channel::BalanceInfluence);
    assert!(has_key(&bench));
    bench.click(Role::CheckBox, "Keep balance");
    assert_eq!((balance(&bench), has_key(&bench)), (None, false));
}

#[test]
fn the_centre_goes_over_a_point_whose_coordinates_are_typed() {
    let mut bench = Bench::example("human");
    bench.click(Role::CheckBox, "Keep balance");
    bench.click(Role::ComboBox, "Balance over");
    bench.settle();
    bench.click(Role::Button, "Point");
    bench.settle();
    let BalanceOver::Point(before) = balance(&bench).expect("a balance").over else {
        panic!("a point, not {:?}", balance(&bench));
    };
    assert!(before.length() < 0.2, "the point is where the centre was: {before}");
    bench.click(Role::SpinButton, "Balance x");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([Event::Text("0.04".to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
    let over = BalanceOver::Point(Vec2::new(0.04, before.y));
    assert_eq!(balance(&bench).expect("a balance").over, over);
    assert!(error(&bench) < 2e-3, "{}", error(&bench));
}

#[test]
fn a_method_that_cannot_balance_is_told_and_invalid_balances_are_refused() {
    let mut bench = Bench::example("human");
    bench.click(Role::CheckBox, "Keep balance");
    bench.apply([SolverEdit::SetSolver(SolverOptions::new(Method::Fabrik))]);
    bench.settle();
    let told = "Not solved: fabrik cannot balance a body; transpose, dls, ccd can";
    assert!(bench.says(told));
    let before = balance(&bench);
    let invalid = BalanceTarget { weight: 0.0, ..BalanceTarget::default() };
    bench.apply([SolverEdit::SetBalance(Some(invalid))]);
    assert_eq!(balance(&bench), before);
    let targets = bench.session().rig().targets.clone();
    bench.apply(targets.into_iter().map(|target| TargetEdit::RemoveTarget(target.joint)));
    assert!(bench.shows(Role::CheckBox, "Keep balance"), "a balance can be removed");
    bench.click(Role::CheckBox, "Keep balance");
    bench.settle();
    assert!(!bench.shows(Role::CheckBox, "Keep balance"), "without targets nothing balances");
}
