//! The bake dialog.

use std::sync::Arc;

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::NodeT as _;
use ik_arm::document::{Bake, Channel, Timeline};
use ik_arm::io::{Cancelled, Progress};
use ik_arm::session::{BakeAction, BakeJob, Dialog, Effect, FileAction};
use pollster::block_on;

use crate::bench::Bench;

/// The snake, which follows a path, with the bake dialog open.
fn asked() -> Bench {
    let document = Box::new(crate::common::documents::keyed_snake());
    let mut bench = Bench::after([FileAction::Opened { document, file: None, contents: None }]);
    bench.choose(&["Edit", "Bake to keys…"]);
    bench.settle();
    bench
}

/// Clicks a number, types another and enters it.
fn enter(bench: &mut Bench, name: &str, text: &str) {
    bench.click(Role::SpinButton, name);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.frame([Event::Text(text.to_owned())]);
    bench.key(Key::Enter);
    bench.settle();
}

/// The settings of a bake that starts, and its job.
fn started(bench: &mut Bench) -> (Bake, BakeJob) {
    bench.click(Role::Button, "Bake");
    let [Effect::Bake(settings)] = bench.effects()[..] else { panic!("no bake starts") };
    let job = BakeJob { progress: Arc::new(Progress::default()) };
    bench.apply_moving([BakeAction::Started(job.clone())]);
    (settings, job)
}

#[test]
fn range_rate_and_tolerance_are_asked_for() {
    let mut bench = asked();
    for (name, text) in [
        ("Start", "1"),
        ("End", "2.5"),
        ("Frames per second", "10"),
        ("Tolerance (of the reach)", "0.01"),
    ] {
        enter(&mut bench, name, text);
    }
    bench.settle();
    assert!(bench.says("16 frames"));
    let (settings, _) = started(&mut bench);
    let frames = Timeline { start: 1.0, end: 2.5, frame_rate: 10.0 };
    assert_eq!(settings, Bake { frames, tolerance: 0.01 });
}

#[test]
fn a_range_that_ends_before_it_starts_is_not_baked() {
    let mut bench = asked();
    enter(&mut bench, "End", "-1");
    bench.settle();
    assert!(bench.node(Role::Button, "Bake").accesskit_node().is_disabled());
    assert!(bench.says(
        "a bake must start before it ends, within 86400 s of time 0, at 0.01 to 1000 frames per \
         second, got 0 s to -1 s at 30"
    ));
}

#[test]
fn a_running_bake_shows_its_progress_and_its_keys_are_one_undo_step() {
    let mut bench = asked();
    enter(&mut bench, "End", "1");
    bench.settle();
    let (settings, job) = started(&mut bench);
    assert_eq!(block_on(job.progress.step(30, 120)), Ok(()));
    bench.frame([]);
    assert!(bench.says("25 %"));

    let before = bench.session().document().clone();
    let baked = block_on(settings.run(&before, async |_, _| true)).expect("it is baked");
    let message = format!("Baked: {} of {} keys left", baked.keys, baked.keys_at_frames);
    bench.tell(BakeAction::Ended(job, Ok(Box::new(baked))));
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None);
    assert!(bench.says(&message), "{message}");
    let after = bench.session().document();
    assert_eq!(after.rig.follow_paths, []);
    assert!(after.skeleton().ids().all(|joint| after.keys.has(Channel::Rotation(joint))));
    assert_eq!(bench.session().history().undo_label(), Some("Bake to keys"));
    bench.choose(&["Edit", "Undo Bake to keys"]);
    assert_eq!(bench.session().document(), &before);
}

#[test]
fn a_cancelled_bake_changes_nothing_even_if_it_ends_later() {
    for by_key in [false, true] {
        let mut bench = asked();
        enter(&mut bench, "End", "0.5");
        bench.settle();
        let (settings, job) = started(&mut bench);
        bench.frame([]);
        if by_key {
            bench.key(Key::Escape);
        } else {
            let cancel = bench.rect(Role::Button, "Cancel").center();
            bench.click_at(cancel);
        }
        assert_eq!(block_on(job.progress.step(31, 120)), Err(Cancelled));
        let before = bench.session().document().clone();
        let baked = block_on(settings.run(&before, async |_, _| true)).expect("it is baked");
        bench.tell(BakeAction::Ended(job, Ok(Box::new(baked))));
        bench.settle();
        assert_eq!(bench.session().document(), &before);
        assert!(bench.says("Bake cancelled"));
    }
}

#[test]
fn a_bake_that_fails_says_why() {
    let mut bench = asked();
    let (_, job) = started(&mut bench);
    bench.tell(BakeAction::Ended(job, Err("nothing to bake".to_owned())));
    bench.settle();
    assert!(!matches!(bench.session().shell().dialog(), Some(Dialog::Bake { .. })));
    assert!(bench.says("Not baked: nothing to bake"));
}
