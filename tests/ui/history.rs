//! Undo, redo, and questions before unsaved changes are lost.

use crate::common::arm::{ArmDocument, ArmEdit, ArmSession, Cursor};
use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::document::Document;
use ik_arm::io::{Example, OpenOptions};
use ik_arm::kinematics::chain_ik::{Method, SolverOptions};
use ik_arm::session::{
    Action, Dialog, Edit, Effect, FileAction, JointEdit, PathDialog, PlaybackAction, SelectAction,
    ShellAction, SolverAction, SolverEdit, TransactionAction, ViewAction,
};

use crate::bench::Bench;
use ik_arm::kinematics::skeleton::JointId;

const CTRL: Modifiers = Modifiers::COMMAND;
const SHIFT: Modifiers = Modifiers::SHIFT;

fn moved() -> Bench {
    Bench::after([ArmEdit::SetHand(Vec3::X * 300.0), ArmEdit::SetTwist(1.0)])
}

fn menu(bench: &mut Bench, menu: &str) {
    bench.click(Role::Button, menu);
    bench.settle();
}

#[test]
fn ctrl_z_undoes_one_step_after_the_other_and_redo_repeats_them() {
    for redo in [(CTRL.plus(SHIFT), Key::Z), (CTRL, Key::Y)] {
        let mut bench = moved();
        let last = bench.session().document().clone();
        bench.key_with(CTRL, Key::Z);
        assert_eq!((bench.hand(), bench.session().arm().twist), (Vec3::X * 300.0, 0.0));
        bench.key_with(CTRL, Key::Z);
        assert_eq!(bench.session().document(), &Document::default());
        assert!(bench.says("Undid Move target"));
        bench.key_with(CTRL, Key::Z);
        assert!(bench.says("There is nothing to undo"));
        bench.key_with(redo.0, redo.1);
        bench.key_with(redo.0, redo.1);
        assert_eq!(bench.session().document(), &last);
    }
}

#[test]
fn the_edit_menu_names_what_it_would_undo_and_redo() {
    let mut bench = moved();
    menu(&mut bench, "Edit");
    bench.click(Role::Button, "Undo Set Socket twist Ctrl+Z");
    bench.settle();
    menu(&mut bench, "Edit");
    assert!(bench.shows(Role::Button, "Undo Move target Ctrl+Z"));
    bench.click(Role::Button, "Redo Set Socket twist Ctrl+Shift+Z");
    bench.settle();
    assert_eq!(bench.session().arm().twist, 1.0);
}

#[test]
fn without_a_step_the_edit_menu_offers_none() {
    let mut bench = Bench::new();
    menu(&mut bench, "Edit");
    for name in ["Undo Ctrl+Z", "Redo Ctrl+Shift+Z"] {
        assert!(bench.node(Role::Button, name).accesskit_node().is_disabled(), "{name}");
    }
}

#[test]
fn a_drag_of_the_hand_is_one_step() {
    let mut bench = Bench::new();
    let hand = bench.cursor_on_screen();
    bench.drag_and_drop(PointerButton::Primary, hand, hand + egui::vec2(50.0, 20.0));
    assert_ne!(bench.session().document(), &Document::default());
    bench.key_with(CTRL, Key::Z);
    assert_eq!(bench.session().document(), &Document::default());
}

#[test]
fn undo_during_a_drag_cancels_the_drag() {
    let mut bench = Bench::new();
    let hand = bench.cursor_on_screen();
    bench.drag(PointerButton::Primary, hand, hand + egui::vec2(50.0, 0.0));
    assert_ne!(bench.session().document().rig, Document::default().rig);
    bench.key_with(CTRL, Key::Z);
    assert_eq!(bench.session().document(), &Document::default());
    assert!(!bench.session().history().is_editing());
}

#[test]
fn a_solver_run_is_no_step_and_applying_its_pose_is_one() {
    let mut bench = Bench::example("ten-joints");
    let first = bench.session().document().clone();
    bench.apply_moving([SolverAction::Run(true)]);
    bench.wait(2.0);
    assert!(!bench.session().solvers().is_running());
    assert_eq!(bench.session().document(), &first);
    assert_eq!(bench.session().history().undo_label(), None);
    bench.apply([SolverEdit::ApplyPose]);
    assert_ne!(bench.session().document().rig, first.rig);
    assert_eq!(bench.session().history().undo_label(), Some("Apply pose"));
    bench.key_with(CTRL, Key::Z);
    assert_eq!(bench.session().document().rig, first.rig);
    assert_eq!(bench.session().history().undo_label(), None);
}

#[test]
fn undo_leaves_a_running_solver_running() {
    let mut bench = Bench::example("ten-joints");
    let joint = JointId::new(2);
    let before = bench.session().skeleton()[joint].rotation;
    bench.apply([
        Edit::from(SolverEdit::SetSolver(SolverOptions::new(Method::TransposeFixed))),
        JointEdit::SetRotation { joint, rotation: before + Vec3::Z * 0.2 }.into(),
    ]);
    bench.apply_moving([SolverAction::Run(true)]);
    bench.wait(0.05);
    assert!(bench.session().solvers().is_running());
    bench.key_with(CTRL, Key::Z);
    assert_eq!(bench.session().skeleton()[joint].rotation, before);
    assert!(bench.session().solvers().is_running(), "it runs from the restored pose");
    bench.apply([SolverAction::Reset]);
}

#[test]
fn the_view_and_the_selection_are_no_steps() {
    let mut bench = Bench::example("human");
    let camera = *bench.session().camera();
    bench.apply([
        Action::from(SelectAction::Joints(vec![JointId::new(3)])),
        ViewAction::SetCamera(camera.orbited(1.0, 0.1)).into(),
    ]);
    bench.apply([PlaybackAction::SetTime(2.0)]);
    assert_eq!(bench.session().history().undo_label(), None);
    assert!(!bench.session().history().is_unsaved());
    bench.apply([
        Action::from(JointEdit::SetLocked { joint: JointId::new(3), locked: true }),
        TransactionAction::Undo.into(),
    ]);
    assert_eq!(bench.session().selection().joints(), [3].map(JointId::new));
    assert_eq!(*bench.session().camera(), camera.orbited(1.0, 0.1));
    assert_eq!(bench.session().playback().time(), 2.0);
}

#[test]
fn hundreds_of_steps_can_be_undone() {
    let mut bench = Bench::new();
    let steps = (0..900).map(|step| ArmEdit::SetHand(Vec3::new(step as f32, 0.0, 100.0)));
    bench.apply(steps);
    bench.apply((0..900).map(|_| TransactionAction::Undo));
    assert_eq!(bench.session().document(), &Document::default());
}

#[test]
fn losing_unsaved_changes_needs_confirmation() {
    let example = Example::find("human").expect("there");
    let opened = FileAction::Opened { document: Box::default(), file: None, contents: None };
    for leaving in
        [FileAction::Quit, FileAction::NewEmpty, FileAction::OpenExample(example), opened]
    {
        let mut bench = moved();
        let document = bench.session().document().clone();
        bench.apply([leaving.clone()]);
        assert!(bench.says("The document has unsaved changes."));
        assert_eq!(bench.effects(), []);
        bench.click(Role::Button, "Cancel");
        assert_eq!(bench.session().document(), &document);
        assert_eq!(bench.session().shell().dialog(), None);

        bench.apply([leaving.clone()]);
        bench.click(Role::Button, "Don't save");
        match leaving {
            FileAction::Quit => assert_eq!(bench.effects(), [Effect::Quit]),
            _ => assert_ne!(bench.session().document(), &document),
        }
    }
}

#[test]
fn a_file_action_continues_after_saving_first() {
    let mut bench = moved();
    bench.apply([FileAction::Quit]);
    bench.click(Role::Button, "Save");
    assert!(
        matches!(bench.session().shell().dialog(), Some(Dialog::Path(PathDialog::SaveAs { .. }))),
        "it has no file yet"
    );
    bench.settle();
    bench.key(Key::Enter);
    assert_eq!(bench.effects(), [Effect::Save("ik-arm.json".into())]);
    let quit = bench.tell(FileAction::Saved("ik-arm.json".into()));
    assert_eq!(quit, Some(Effect::Quit));
}

#[test]
fn after_a_failed_save_the_document_stays_open_and_unsaved() {
    let mut bench = moved();
    bench.apply([FileAction::Quit]);
    bench.click(Role::Button, "Save");
    bench.settle();
    bench.key(Key::Enter);
    let why = "the disk is full".to_owned();
    bench.tell(FileAction::NotSaved { path: "ik-arm.json".into(), why });
    bench.settle();
    assert!(bench.says("Not saved: the disk is full"));
    assert!(bench.session().history().is_unsaved());
    // A later save does not end the program any more.
    assert_eq!(bench.tell(FileAction::Saved("x.json".into())), None);
    assert!(!bench.session().history().is_unsaved());
}

#[test]
fn a_cancelled_save_does_not_end_the_program_later() {
    let mut bench = moved();
    bench.apply([FileAction::Quit]);
    bench.click(Role::Button, "Save");
    bench.settle();
    bench.key(Key::Escape);
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None);
    assert_eq!(bench.tell(FileAction::Saved("x.json".into())), None);
}

#[test]
fn a_document_is_saved_until_it_changes_and_again_when_the_change_is_undone() {
    let mut bench = moved();
    assert!(bench.session().history().is_unsaved());
    bench.tell(FileAction::Saved("x.json".into()));
    assert!(!bench.session().history().is_unsaved());
    bench.apply([ArmEdit::SetHand(Vec3::Y * 200.0)]);
    assert!(bench.session().history().is_unsaved());
    bench.apply([TransactionAction::Undo]);
    assert!(!bench.session().history().is_unsaved());
    bench.apply([TransactionAction::Undo]);
    assert!(bench.session().history().is_unsaved());
}

#[test]
fn recent_files_are_offered_again() {
    let mut bench = Bench::new();
    for name in ["/a/one.json", "/a/two.json", "/a/one.json"] {
        bench.tell(FileAction::Saved(name.into()));
    }
    menu(&mut bench, "File");
    menu(&mut bench, "Open recent");
    bench.click(Role::Button, "two.json");
    let open = Effect::Open { path: "/a/two.json".into(), options: OpenOptions::default() };
    assert_eq!(bench.effects(), [open]);
    let recent: Vec<_> =
        bench.session().files().recent().iter().map(|path| path.display()).collect();
    assert_eq!(
        recent.iter().map(ToString::to_string).collect::<Vec<_>>(),
        ["/a/one.json", "/a/two.json"]
    );
}

#[test]
fn changes_kept_by_an_earlier_run_are_offered_as_unsaved() {
    let mut document = Document::default();
    document.edit_arm(|arm| arm.cursor = Cursor::unpinned(Vec3::Y * 123.0));
    let dialog =
        Dialog::Recover { document: Box::new(document.clone()), file: Some("/a/lost.json".into()) };
    let mut bench = Bench::after([ShellAction::OpenDialog(dialog.clone())]);
    assert!(bench.says("ik-arm ended with unsaved changes to lost.json. They can be recovered."));
    bench.click(Role::Button, "Recover");
    bench.settle();
    assert_eq!(bench.session().document(), &document);
    assert!(
        bench.session().history().is_unsaved() && bench.session().files().has_settled_recovery()
    );
    bench.key_with(CTRL, Key::S);
    assert_eq!(bench.effects(), [Effect::Save("/a/lost.json".into())]);

    let mut bench = Bench::after([ShellAction::OpenDialog(dialog)]);
    bench.click(Role::Button, "Discard");
    assert_eq!(bench.session().document(), &Document::default());
    assert!(bench.session().files().has_settled_recovery());
}
