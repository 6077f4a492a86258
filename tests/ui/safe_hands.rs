//! Input goes where it is meant: dialogs take the keyboard, keys have the state of the moment when
//! they were pressed, and view changes are not unsaved changes.

use crate::common::arm::{ArmEdit, Step};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::document::{Camera, Document, Overlay, Target, Theme};
use ik_arm::io::Example;
use ik_arm::session::{
    Action, Dialog, DisplayEdit, DragInput, Effect, ExportJob, FileAction, Grip, GripRing,
    JointEdit, PathDialog, SelectAction, ShellAction, SolverAction, SolverState, TargetEdit,
    TransactionAction, ViewAction,
};

use crate::bench::Bench;
use ik_arm::kinematics::chain_ik::Status;
use ik_arm::kinematics::skeleton::{JointId, RotationAxis};

const CTRL: Modifiers = Modifiers::COMMAND;

fn human() -> Bench {
    Bench::example("human")
}

/// The text of a dialog's field.
fn typed(bench: &Bench, prompt: &str) -> String {
    bench.node(Role::TextInput, prompt).accesskit_node().value().unwrap_or_default()
}

#[test]
fn after_a_click_in_the_view_a_dialog_opened_by_key_takes_the_keyboard_and_selects_its_text() {
    for (modifiers, key, prompt) in [
        (CTRL, Key::S, "Document file"),
        (CTRL, Key::O, "Document, Scotty3D scene (.js3d), .bvh, .glb, .gltf, .obj or .urdf"),
        (CTRL, Key::P, "PNG file"),
        (CTRL, Key::E, "File"),
    ] {
        let mut bench = human();
        bench.click_at(bench.empty_point());
        bench.settle();
        let before = bench.session().clone();
        bench.key_with(modifiers, key);
        bench.settle();
        bench.type_text("a1s7r5t.csv");
        bench.settle();
        assert_eq!(typed(&bench, prompt), "a1s7r5t.csv", "{prompt}");
        assert_eq!(bench.session().camera(), before.camera(), "{prompt}");
        assert_eq!(bench.session().document(), before.document(), "{prompt}");
        bench.key(Key::Escape);
        bench.settle();
        assert_eq!(bench.session().shell().dialog(), None, "{prompt}");
    }
}

#[test]
fn a_joint_is_named_after_a_click_on_it() {
    let mut bench = human();
    let joint = bench.joint("head");
    let tip = bench.session().skeleton_pose().tip(JointId::new(joint.index()));
    let base = bench.session().skeleton_pose().base(JointId::new(joint.index()));
    bench.click_at(bench.on_screen(base.lerp(tip, 0.5)));
    bench.settle();
    assert_eq!(bench.session().selection().active(), Some(joint));
    let joints = bench.session().skeleton_pose().len();
    bench.key(Key::F2);
    bench.settle();
    bench.type_text("Start 5");
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bench.session().skeleton().joints()[joint.index()].name, "Start 5");
    assert_eq!(bench.session().skeleton_pose().len(), joints, "no letter adds a joint");
    assert!(!bench.session().solvers().is_running(), "no letter runs the solver");
}

#[test]
fn letters_that_arrive_in_the_frame_of_the_key_that_opens_a_dialog_are_typed_into_it() {
    let mut bench = human();
    bench.apply([SelectAction::Joints(vec![JointId::new(3)])]);
    bench.click_at(bench.empty_point());
    bench.apply([SelectAction::Joints(vec![JointId::new(3)])]);
    let press = |key| Event::Key {
        key,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let text = |text: &str| Event::Text(text.to_owned());
    bench.frame([press(Key::F2), press(Key::A), text("a"), press(Key::T), text("t")]);
    bench.settle();
    assert_eq!(
        bench.session().shell().dialog(),
        Some(&Dialog::Rename { joint: JointId::new(3), name: "at".to_owned() })
    );
}

#[test]
fn nothing_behind_an_open_dialog_reacts() {
    let mut bench = human();
    bench.apply([JointEdit::SetRotation { joint: JointId::new(3), rotation: Vec3::splat(0.1) }]);
    bench.click_at(bench.empty_point());
    bench.key_with(CTRL, Key::Q);
    bench.settle();
    assert!(matches!(bench.session().shell().dialog(), Some(Dialog::Unsaved { .. })));
    let before = bench.session().clone();
    for key in [Key::A, Key::R, Key::S, Key::T, Key::Num1, Key::Num5, Key::F, Key::K, Key::F1] {
        bench.key(key);
    }
    for key in [Key::Z, Key::Y, Key::O, Key::E, Key::P, Key::S, Key::Num3] {
        bench.key_with(CTRL, key);
    }
    bench.frame([Event::Copy]);
    bench.wheel(3.0);
    bench.settle();
    assert_eq!(bench.session(), &before);
    assert_eq!(bench.effects(), []);
    let empty = bench.empty_point();
    bench.drag_and_drop(PointerButton::Primary, empty, empty + egui::vec2(100.0, 60.0));
    bench.settle();
    assert_eq!(bench.session().camera(), before.camera());

    bench.key(Key::Escape);
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None, "Esc cancels");
    bench.key_with(CTRL, Key::Q);
    bench.settle();
    bench.key(Key::Enter);
    bench.settle();
    assert!(
        matches!(bench.session().shell().dialog(), Some(Dialog::Path(PathDialog::SaveAs { .. }))),
        "Enter saves"
    );
}

#[test]
fn a_key_has_the_modifiers_that_were_held_when_it_was_pressed() {
    let mut bench = Bench::new();
    bench.click_at(bench.empty_point());
    bench.settle();
    let key = |pressed| Event::Key {
        key: Key::Num1,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: CTRL,
    };
    bench.frame([
        Event::ModifiersChanged(CTRL),
        key(true),
        key(false),
        Event::ModifiersChanged(Modifiers::NONE),
    ]);
    bench.wait(0.5);
    let back = Camera::default().along(ik_arm::document::AxisView::Back);
    assert_eq!(bench.session().camera().yaw, back.yaw);
}

#[test]
fn a_click_has_the_modifiers_that_were_held_when_the_button_was_pressed() {
    let mut bench = human();
    bench.apply([SelectAction::Joints(vec![JointId::new(4)])]);
    let at = bench.empty_point();
    bench.move_to(at);
    let count = bench.session().skeleton_pose().len();
    let button = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: CTRL,
    };
    bench.frame([
        Event::ModifiersChanged(CTRL),
        button(true),
        button(false),
        Event::ModifiersChanged(Modifiers::NONE),
    ]);
    bench.settle();
    assert_eq!(bench.session().skeleton_pose().len(), count + 1);
}

#[test]
fn view_changes_are_not_unsaved_changes() {
    for look in [
        Action::from(ShellAction::SetTheme(Theme::Light)),
        DisplayEdit::ShowOverlay(Overlay::SingularityGlobe, true).into(),
        DisplayEdit::ShowOverlay(Overlay::Labels, false).into(),
        ViewAction::ShowCrowd(true).into(),
        ViewAction::ShowExplain(false).into(),
        ViewAction::SetCamera(Camera::default().orbited(1.0, 0.2)).into(),
    ] {
        let mut bench = Bench::new();
        bench.apply_moving([look.clone()]);
        assert!(!bench.session().history().is_unsaved(), "{look:?}");
        bench.apply_moving([FileAction::Quit]);
        assert_eq!(bench.session().shell().dialog(), None, "{look:?}");
    }
}

#[test]
fn an_edit_is_unsaved_whatever_view_changes_come_before_and_after() {
    let mut bench = Bench::after([DisplayEdit::ShowOverlay(Overlay::SingularityGlobe, true)]);
    bench.apply([
        Step::from(ArmEdit::SetTwist(0.5)),
        DisplayEdit::ShowOverlay(Overlay::SingularityGlobe, false).into(),
    ]);
    assert!(bench.session().history().is_unsaved());
    bench.apply([TransactionAction::Undo]);
    assert!(bench.session().history().is_unsaved(), "only the globe is back");
    bench.apply([TransactionAction::Undo]);
    assert!(!bench.session().history().is_unsaved(), "the twist is restored");
    bench.apply([TransactionAction::Redo, TransactionAction::Redo]);
    assert!(bench.session().history().is_unsaved());
    assert_eq!(bench.tell(FileAction::Saved("x.json".into())), None);
    bench.apply([DisplayEdit::ShowOverlay(Overlay::SingularityGlobe, true)]);
    assert!(!bench.session().history().is_unsaved());
    assert_eq!(bench.tell(FileAction::Quit), Some(Effect::Quit));
}

#[test]
fn the_reading_of_a_ring_shows_the_angle_after_limits() {
    let mut bench = human();
    let joint = bench.joint("left_shin");
    bench.apply([
        Action::from(TargetEdit::RemoveTarget(joint)),
        SelectAction::Joints(vec![joint]).into(),
    ]);
    let limits = bench.session().skeleton().joints()[joint.index()].limits;
    let free: Vec<_> =
        RotationAxis::ALL.into_iter().filter(|axis| !limits.is_fixed(*axis)).collect();
    let [axis] = free[..] else { panic!("a knee has one free axis: {limits:?}") };
    let limit = limits.range(axis).expect("limited");
    let ring = GripRing::of_joint(bench.session().posed(), JointId::new(joint.index()), axis)
        .expect("the free axis has a ring");
    for fixed in RotationAxis::ALL.into_iter().filter(|other| *other != axis) {
        assert_eq!(
            GripRing::of_joint(bench.session().posed(), JointId::new(joint.index()), fixed),
            None,
            "a fixed axis has none"
        );
    }
    let grip = Grip::Ring(joint, axis);
    let before = bench.session().skeleton().joints()[joint.index()].rotation[axis.index()];
    let projection = bench.session().camera().projection(1.0);
    let ray = projection.ray(projection.project(ring.centre).expect("seen") + glam::Vec2::X * 0.05);
    bench.apply([TransactionAction::Grab { grip, ray, forward: projection.forward }]);
    let most = (limit.max - limit.min).to_degrees();
    bench.apply([TransactionAction::TypeOffset(format!("{}", most + 90.0))]);
    bench.apply([TransactionAction::Drag(DragInput { ray, precise: false, snap: false })]);
    let now = bench.session().skeleton().joints()[joint.index()].rotation[axis.index()];
    assert_eq!(now, limit.max);
    let turned = (now - before).to_degrees();
    assert!(bench.says(&format!("{turned:+.1}°, at its limit")), "{turned}");
    bench.apply([TransactionAction::Cancel]);
}

#[test]
fn the_solver_panel_and_the_status_line_describe_the_iterate_or_the_evaluated_pose() {
    let example = Example::find("ten-joints").expect("there");
    let mut bench = Bench::after([FileAction::OpenExample(example)]);
    let status = |bench: &Bench| {
        bench.session().solvers().status(bench.session().posed()).expect("it has a target")
    };
    let tip_to_target = |bench: &Bench| {
        let session = bench.session();
        let target = session.rig().targets[0];
        session.skeleton_pose().tip(target.joint).distance(target.at(session.playback().time()))
    };
    assert_eq!(status(&bench).state, SolverState::NotReached);
    assert!(bench.shows(Role::Label, "not reached") && bench.shows(Role::Label, "evaluated pose"));
    assert!((status(&bench).error - tip_to_target(&bench)).abs() < 1e-5);
    bench.apply_moving([SolverAction::Run(true)]);
    bench.wait(3.0);
    assert_eq!(status(&bench).state, SolverState::Ended(Status::Converged));
    let latest = bench.session().solvers().shown_iteration().expect("a run").latest;
    assert!(bench.says(&format!("iteration {latest} of {latest}, converged")));

    bench.apply([JointEdit::SetRotation { joint: JointId::new(2), rotation: Vec3::splat(0.7) }]);
    assert_eq!(
        status(&bench).state,
        SolverState::Ended(Status::Converged),
        "it is solved from the turned joint"
    );
    bench.apply([SolverAction::Show(1)]);
    assert_eq!(status(&bench).state, SolverState::Earlier);
    assert!(bench.says("iteration 1 of") && bench.says("not converged yet"));
    assert!(!bench.says(", converged"));

    bench.apply([SolverAction::Reset]);
    assert_eq!(status(&bench).state, SolverState::NotReached, "nothing was applied");
    assert!((status(&bench).error - tip_to_target(&bench)).abs() < 1e-5);
    let target = bench.session().rig().targets[0];
    bench.apply([TargetEdit::SetTarget(Target { influence: 1.0, ..target })]);
    assert_eq!(status(&bench).state, SolverState::Reached, "the evaluated pose is at the target");
    assert!(bench.shows(Role::Label, "reached"));
}

#[test]
fn deleting_a_joint_asks_what_becomes_of_its_children() {
    let mut bench = human();
    let shoulder = bench.joint("left_upper_arm");
    let names = |bench: &Bench| -> Vec<String> {
        let joints = bench.session().skeleton().joints();
        joints.iter().map(|joint| joint.name.clone()).collect()
    };
    let places = |bench: &Bench| -> Vec<(Vec3, Vec3)> {
        let pose = bench.session().skeleton_pose();
        (0..pose.len())
            .map(|joint| (pose.base(JointId::new(joint)), pose.tip(JointId::new(joint))))
            .collect()
    };
    let before = (names(&bench), places(&bench));
    bench.apply([SelectAction::Joints(vec![shoulder])]);
    bench.click_at(bench.empty_point() + egui::vec2(0.0, 1.0));
    bench.apply([SelectAction::Joints(vec![shoulder])]);
    bench.key(Key::Delete);
    bench.settle();
    assert!(bench.node(Role::Button, "Keep children").is_focused(), "the default keeps them");
    bench.key(Key::Escape);
    bench.settle();
    assert_eq!(names(&bench), before.0, "Esc deletes nothing");
    bench.key(Key::Delete);
    bench.settle();
    bench.key(Key::Enter);
    bench.settle();
    let (mut kept, mut stay) = before.clone();
    kept.remove(shoulder.index());
    stay.remove(shoulder.index());
    assert_eq!(names(&bench), kept);
    for ((base, tip), (now_base, now_tip)) in stay.into_iter().zip(places(&bench)) {
        assert!(base.distance(now_base) < 1e-4 && tip.distance(now_tip) < 1e-4, "nothing moves");
    }
    bench.apply([TransactionAction::Undo]);
    assert_eq!((names(&bench), places(&bench)), before);

    bench.apply([SelectAction::Joints(vec![shoulder])]);
    bench.key(Key::Delete);
    bench.settle();
    bench.click(Role::Button, "Delete children too");
    assert!(names(&bench).len() < kept.len());

    let leaf = names(&bench).len() - 1;
    bench.apply([SelectAction::Joints(vec![JointId::new(leaf)])]);
    bench.choose(&["More", "Delete"]);
    assert_eq!(names(&bench).len(), leaf, "a joint without children is deleted at once");
}

#[test]
fn an_export_over_a_file_asks_and_the_folder_is_remembered() {
    let folder = tempfile::tempdir().expect("a folder");
    let there = folder.path().join("walk.glb");
    std::fs::write(&there, "precious").expect("written");
    let mut bench = human();
    bench.key_with(CTRL, Key::E);
    bench.settle();
    bench.type_text(&there.display().to_string());
    bench.key(Key::Enter);
    bench.settle();
    assert!(bench.says("walk.glb already exists"));
    assert_eq!(bench.effects(), []);
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bench.effects(), [], "Enter twice overwrites nothing");
    let Some(Dialog::Path(PathDialog::Export(export))) = bench.session().shell().dialog() else {
        panic!("it is kept")
    };
    assert_eq!(export.path, there, "with its path");
    bench.click(Role::Button, "Export");
    bench.click(Role::Button, "Replace");
    let effects = bench.effects();
    assert!(matches!(&effects[..], [Effect::Export(export)] if export.path == there));

    bench.key_with(CTRL, Key::E);
    bench.settle();
    assert!(bench.says(&format!("In {}", folder.path().display())), "the folder is shown");
    bench.type_text("other.glb");
    bench.key(Key::Enter);
    bench.settle();
    let effects = bench.effects();
    let other = folder.path().join("other.glb");
    assert!(matches!(&effects[..], [Effect::Export(export)] if export.path == other));
    assert_eq!(bench.session().files().export_folder(), Some(folder.path()));
}

#[test]
fn saving_as_over_another_file_asks_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let there = folder.path().join("there.json");
    std::fs::write(&there, "precious").expect("written");
    let mut bench = human();
    bench.key_with(CTRL, Key::S);
    bench.settle();
    bench.type_text(&there.display().to_string());
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bench.effects(), []);
    bench.click(Role::Button, "Replace");
    assert_eq!(bench.effects(), [Effect::Save(there)]);
}

/// The bench with a document that was opened from `there`, and changed.
fn opened_and_changed(there: &std::path::Path) -> Bench {
    let document = Document::default();
    ik_arm::io::save(&document, there).expect("saved");
    let mut bench = Bench::after([FileAction::Opened {
        document: Box::new(document),
        file: Some(there.to_owned()),
        contents: None,
    }]);
    bench.apply([ArmEdit::SetHand(Vec3::new(100.0, 50.0, 0.0))]);
    bench
}

#[test]
fn saving_over_a_file_that_another_program_has_changed_asks() {
    let folder = tempfile::tempdir().expect("a folder");
    let there = folder.path().join("shared.json");
    let mut bench = opened_and_changed(&there);
    bench.key_with(CTRL, Key::S);
    bench.settle();
    assert_eq!(bench.effects(), [Effect::Save(there.clone())], "an unchanged file is saved");

    std::fs::write(&there, "the work of another program").expect("written");
    bench.key_with(CTRL, Key::S);
    bench.settle();
    assert_eq!(bench.effects(), []);
    assert!(bench.says("Another program has changed shared.json"));
    bench.click(Role::Button, "Cancel");
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None);
    assert_eq!(bench.effects(), []);

    bench.key_with(CTRL, Key::S);
    bench.settle();
    bench.key(Key::Enter);
    bench.settle();
    let save_as = bench.session().shell().dialog().cloned();
    assert!(matches!(save_as, Some(Dialog::Path(PathDialog::SaveAs { .. }))), "{save_as:?}");
    bench.click(Role::Button, "Save");
    bench.settle();
    assert!(bench.says("already exists"), "the same name asks, too");
    bench.key(Key::Escape);
    bench.key(Key::Escape);
    bench.settle();

    bench.key_with(CTRL, Key::S);
    bench.settle();
    bench.click(Role::Button, "Overwrite");
    bench.settle();
    assert_eq!(bench.effects(), [Effect::Save(there.clone())]);
    bench.tell(FileAction::Saved(there.clone()));
    bench.key_with(CTRL, Key::S);
    bench.settle();
    assert_eq!(bench.effects(), [Effect::Save(there)], "what this program wrote is no change");
}

#[test]
fn quitting_goes_on_after_a_changed_file_is_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let there = folder.path().join("shared.json");
    let mut bench = opened_and_changed(&there);
    std::fs::write(&there, "the work of another program").expect("written");
    bench.key_with(CTRL, Key::Q);
    bench.settle();
    bench.click(Role::Button, "Save");
    bench.settle();
    assert_eq!(bench.effects(), []);
    bench.click(Role::Button, "Overwrite");
    bench.settle();
    assert_eq!(bench.effects(), [Effect::Save(there.clone())]);
    assert_eq!(bench.tell(FileAction::Saved(there)), Some(Effect::Quit));
}

#[test]
fn a_file_that_is_gone_is_saved_again_without_a_question() {
    let folder = tempfile::tempdir().expect("a folder");
    let there = folder.path().join("shared.json");
    let mut bench = opened_and_changed(&there);
    std::fs::remove_file(&there).expect("it was there");
    bench.key_with(CTRL, Key::S);
    bench.settle();
    assert_eq!(bench.effects(), [Effect::Save(there)]);
}

#[test]
fn quitting_during_an_export_asks() {
    let mut bench = Bench::new();
    let progress = std::sync::Arc::new(ik_arm::io::Progress::default());
    let job = ExportJob { path: "walk.glb".into(), progress };
    bench.apply_moving([FileAction::ExportStarted(job.clone())]);
    bench.key_with(CTRL, Key::Q);
    bench.wait(0.2);
    assert!(bench.says("walk.glb is being exported"));
    assert_eq!(bench.effects(), []);
    bench.key(Key::Enter);
    bench.wait(0.2);
    assert_eq!(bench.session().shell().dialog(), None, "Enter lets it go on");
    assert!(!job.progress.is_cancelled());
    bench.key_with(CTRL, Key::Q);
    bench.wait(0.2);
    bench.click_at(bench.rect(Role::Button, "Cancel export and quit").center());
    bench.wait(0.2);
    assert!(job.progress.is_cancelled());
    assert_eq!(bench.effects(), [Effect::Quit]);
}

#[test]
fn a_file_that_cannot_be_opened_leaves_dialog_and_path_and_an_error_that_looks_like_one() {
    let mut bench = Bench::new();
    bench.key_with(CTRL, Key::O);
    bench.settle();
    bench.type_text("/nowhere/walk.bvh");
    bench.key(Key::Enter);
    bench.settle();
    let effects = bench.effects();
    assert!(matches!(effects[..], [Effect::Open { .. }]));
    let why = "/nowhere/walk.bvh: there is no such file".to_owned();
    bench.apply([FileAction::NotOpened { path: "/nowhere/walk.bvh".into(), why: why.clone() }]);
    let prompt = "Document, Scotty3D scene (.js3d), .bvh, .glb, .gltf, .obj or .urdf";
    assert_eq!(typed(&bench, prompt), "/nowhere/walk.bvh");
    assert!(bench.shows(Role::Alert, &why), "in the dialog");
    bench.key(Key::Escape);
    bench.settle();
    assert!(bench.shows(Role::Alert, &format!("Not opened: {why}")), "in the status line");
    bench.apply([ArmEdit::SetTwist(0.3)]);
    assert!(!bench.says("Not opened"), "until the next change");
}

#[test]
fn enter_in_the_frame_of_the_key_that_opens_a_question_answers_it() {
    let mut bench = human();
    bench.apply([JointEdit::SetRotation { joint: JointId::new(3), rotation: Vec3::splat(0.1) }]);
    bench.click_at(bench.empty_point());
    let key = |key, modifiers| Event::Key {
        key,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers,
    };
    bench.frame([
        Event::ModifiersChanged(CTRL),
        key(Key::Q, CTRL),
        Event::ModifiersChanged(Modifiers::NONE),
        key(Key::Enter, Modifiers::NONE),
    ]);
    bench.settle();
    assert!(
        matches!(bench.session().shell().dialog(), Some(Dialog::Path(PathDialog::SaveAs { .. }))),
        "Enter saves"
    );
}

#[test]
fn a_name_that_another_joint_has_is_refused_where_it_is_typed() {
    let mut bench = human();
    bench.apply([SelectAction::Joints(vec![bench.joint("head")])]);
    bench.key(Key::F2);
    bench.settle();
    bench.type_text("neck");
    bench.key(Key::Enter);
    bench.settle();
    assert!(bench.shows(Role::Alert, "Another joint has this name"));
    assert_eq!(typed(&bench, "Joint name"), "neck", "what was typed is kept");
    bench.type_text("2");
    bench.key(Key::Enter);
    bench.settle();
    assert_eq!(bench.session().shell().dialog(), None);
    bench.joint("neck2");
}

#[test]
fn a_gliding_camera_is_saved_at_its_destination() {
    let mut bench = Bench::new();
    let back = bench.session().camera().along(ik_arm::document::AxisView::Back);
    bench.apply_moving([ViewAction::GlideTo(back)]);
    bench.tell(FileAction::SaveAs("view.json".into()));
    assert_eq!(*bench.session().camera(), back);
}
