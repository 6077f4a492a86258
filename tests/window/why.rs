use std::fs;

use egui::accesskit::Role;
use egui::{Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use ik_arm::io::Example;
use ik_arm::session::{Actions, FileAction, Session};
use ik_arm::ui::{self, Machine};

use crate::places::HARNESS_MARGIN;
use crate::screen::{Program, SIZE, changed};

const REMEDY: &str = "Widen the limit of shin about z by 78°";

/// The place of the remedy's button and that of the shin's tip, in the window with the example.
fn places(example: Example) -> [Pos2; 2] {
    let mut session = Session::default();
    session.apply(FileAction::OpenExample(example));
    let (shown, pose) = (session.clone(), session.skeleton_pose().clone());
    let size = Vec2::new(SIZE.0 as f32, SIZE.1 as f32) + 2.0 * HARNESS_MARGIN;
    let mut harness = Harness::builder()
        .with_size(size)
        .with_context_setup(ui::style::install)
        .build_ui(move |ui| {
            ui::show(ui, &shown, &Machine::default(), &mut Actions::new());
        });
    harness.run_steps(4);
    let button = harness.get_by_role_and_label(Role::Button, REMEDY).rect().center();
    let viewport = harness.get_by(|node| {
        let label = node.label().unwrap_or_default();
        node.role() == Role::Image && label.starts_with("Viewport")
    });
    let viewport = viewport.rect().translate(-HARNESS_MARGIN);
    let shin = session.skeleton().find("shin").expect("a shin");
    let at = session.camera().projection(viewport.aspect_ratio()).project(pose.tip(shin));
    let at = at.expect("in the picture");
    let tip = viewport.center() + Vec2::new(at.x, -at.y) * viewport.size() / 2.0;
    [button - HARNESS_MARGIN, tip]
}

#[test]
#[ignore = "needs a display of its own"]
fn a_click_on_the_remedy_of_the_note_brings_the_tip_to_its_target() {
    let example = Example::find("at-a-limit").expect("an example");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("leg.json");
    fs::write(&file, example.text).expect("written");
    let [button, tip] = places(example);
    let program = Program::open_file(folder.path(), &file);
    let before = program.at_rest();
    program.click(button);
    program.wait_until("the shin bends, and the note goes", |now| {
        changed(&before, now, tip, 16.0) > 60 && changed(&before, now, button, 60.0) > 60
    });
    program.key("ctrl+z");
    program.wait_until("the remedy is undone", |now| changed(&before, now, tip, 12.0) < 20);
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
    assert_eq!(program.errors(), "", "it has nothing to complain about");
}
