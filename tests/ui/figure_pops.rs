//! The page Pops of figures, the ticks of the timeline, and the settings of motions.

use egui::accesskit::Role;
use egui::{PointerButton, pos2};
use egui_kittest::SnapshotResults;
use glam::Vec3;
use ik_arm::document::{Target, Theme};
use ik_arm::session::{
    InspectAction, InspectionJob, PanelTab, PlaybackAction, SolverAction, SolverEdit, TargetEdit,
    TransactionAction,
};
use pollster::block_on;

use crate::bench::{Bench, LARGE};
use crate::common::documents::open_example;

/// Runs the inspection that the window would run on a thread.
fn inspect(bench: &mut Bench) {
    let job = bench.session().next_inspection().expect("something new to inspect");
    bench.apply([InspectAction::Started(job.clone())]);
    bench.apply([block_on(job.run())]);
}

/// The chain of the example, each frame solved by itself.
fn jumping() -> Bench {
    let mut bench = Bench::example("jumping-chain");
    bench.show_tab(PanelTab::Pops);
    bench.apply([SolverEdit::SetTracked(false)]);
    bench
}

#[test]
fn the_page_waits_for_the_inspection_and_then_lists_pops_that_lead_to_their_times() {
    let mut bench = jumping();
    assert!(bench.says("Looking through the motion…"));
    inspect(&mut bench);
    assert!(bench.session().next_inspection().is_none(), "all is known");
    bench.click(Role::Link, "0.73 s");
    assert!((bench.session().playback().time() - 0.7333).abs() < 1e-3);
    assert_eq!(bench.session().selection().joints(), [bench.joint("joint_5")]);
}

#[test]
fn continuing_from_frame_to_frame_removes_the_pops() {
    let mut bench = jumping();
    inspect(&mut bench);
    bench.click(Role::Button, "Continue from frame to frame");
    assert!(bench.session().document().rig.is_tracked);
    inspect(&mut bench);
    assert!(bench.says("No pops: joints move as smoothly as their targets."));
}

#[test]
fn without_targets_that_move_the_page_says_what_to_do() {
    let mut bench = Bench::example("ten-joints");
    bench.show_tab(PanelTab::Pops);
    assert!(bench.session().next_inspection().is_none());
    assert!(bench.says(
        "No target moves the figure. Give a target a path or keys: this page then shows where joints \
         jump, where targets are lost and where feet slide, and why."
    ));
}

#[test]
fn nothing_is_inspected_during_a_drag_and_an_old_result_is_not_shown() {
    let mut bench = jumping();
    inspect(&mut bench);
    bench.apply([TransactionAction::Begin]);
    let target = bench.session().rig().targets[0];
    let moved = Target { home: target.home + Vec3::X * 0.1, ..target };
    bench.apply([TargetEdit::SetTarget(moved)]);
    assert!(bench.session().next_inspection().is_none(), "a drag goes on");
    bench.apply([TransactionAction::Commit]);
    assert!(bench.session().inspection().is_none(), "the document is another one");
    assert!(bench.session().next_inspection().is_some());
}

#[test]
fn a_cancelled_inspection_is_made_again() {
    let mut bench = jumping();
    let job = bench.session().next_inspection().expect("something to inspect");
    bench.apply([InspectAction::Started(job.clone())]);
    assert!(bench.session().next_inspection().is_none(), "it runs");
    bench.apply([InspectAction::Started(InspectionJob::new(bench.session().history()))]);
    bench.apply([block_on(job.run())]);
    assert!(bench.session().inspection().is_none(), "it was cancelled");
    assert!(bench.session().next_inspection().is_some());
}

#[test]
fn ticks_of_the_ruler_say_why() {
    let mut bench = Bench::with_timeline(LARGE);
    bench.apply([open_example("jumping-chain")]);
    bench.apply([SolverEdit::SetTracked(false)]);
    inspect(&mut bench);
    let ruler = bench.rect(Role::Slider, "Timeline ruler");
    // The timeline shows 0 to 8 s, with a margin of 16 points at both ends.
    let x = ruler.left() + 16.0 + (ruler.width() - 32.0) * (0.7333 / 8.0);
    bench.move_to(pos2(x, ruler.bottom() - 3.0));
    bench.wait(1.0);
    bench.settle();
    assert!(bench.says(
        "0.73 s: joint_5 moves 53.5 times as far as its target: each frame is solved by itself, and \
         neighbouring frames find other poses"
    ));
}

#[test]
fn the_solver_page_switches_tracking_and_resets_the_posture() {
    let mut bench = Bench::example("ten-joints");
    let target = bench.session().rig().targets[0];
    let posing = Target { influence: 1.0, ..target };
    bench.apply([TargetEdit::SetTarget(posing)]);
    let fresh = bench.session().skeleton_pose().clone();
    bench.apply([TransactionAction::Begin]);
    for step in 1..=40 {
        let home = target.home + Vec3::new(0.03, -0.02, -0.02) * step as f32;
        bench.apply([TargetEdit::SetTarget(Target { home, ..posing })]);
    }
    bench.apply([TransactionAction::Commit, TransactionAction::Begin]);
    bench.apply([TargetEdit::SetTarget(posing)]);
    bench.apply([TransactionAction::Commit]);
    bench.click(Role::Button, "Reset posture");
    assert!(bench.session().document().rig.posture.is_none());
    assert_eq!(*bench.session().skeleton_pose(), fresh, "the pose that is solved from FK");
    bench.click(Role::CheckBox, "Each frame by itself");
    assert!(!bench.session().document().rig.is_tracked);
    bench.apply([TransactionAction::Undo]);
    assert!(bench.session().document().rig.is_tracked);
}

#[test]
fn a_run_starts_from_the_frame_before_or_from_the_fk_pose() {
    let mut bench = Bench::example("jumping-chain");
    bench.apply([PlaybackAction::SetTime(2.0)]);
    bench.apply([SolverAction::Step, SolverAction::Show(0)]);
    let error = |bench: &Bench| bench.session().solvers().run().expect("a run").shown().error;
    let carried = error(&bench);
    bench.click(Role::CheckBox, "Start from the FK pose");
    let from_fk = error(&bench);
    assert!(carried < 0.1 && from_fk > 10.0 * carried, "{carried} {from_fk}");
}

#[test]
fn the_page_and_the_ticks_look_as_they_did() {
    let mut results = SnapshotResults::new();
    for theme in [Theme::Dark, Theme::Light] {
        let mut bench = Bench::with_timeline(LARGE);
        bench.apply([open_example("jumping-chain")]);
        bench.show_tab(PanelTab::Pops);
        bench.apply([SolverEdit::SetTracked(false)]);
        inspect(&mut bench);
        bench.release(PointerButton::Primary);
        bench.snapshot("figure_pops", theme, &mut results);
    }
}
