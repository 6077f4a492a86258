//! The export dialog.

use crate::common::arm::{ArmEdit, Step, channels};
use std::sync::Arc;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::io::{self, Cancelled, Progress};
use ik_arm::session::{Effect, Export, ExportJob, FileAction, KeysEdit, PlaybackAction};
use pollster::block_on;

use crate::bench::Bench;

fn asked() -> Bench {
    let mut bench = Bench::example("keyframes");
    bench.key_with(Modifiers::COMMAND, Key::E);
    bench.settle();
    bench
}

fn exported(bench: &mut Bench) -> Export {
    match &bench.effects()[..] {
        [Effect::Export(export)] => export.clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_format_sets_the_extension_of_the_path_and_enter_exports() {
    for (format, path) in [
        ("BVH", "ik-arm.bvh"),
        ("CSV", "ik-arm.csv"),
        ("Animated PNG", "ik-arm.apng"),
        ("PNG sequence", "ik-arm_####.png"),
        ("PNG", "ik-arm.png"),
    ] {
        let mut bench = asked();
        assert!(bench.says("4.00 s, from 0.00 s"));
        bench.click(Role::Button, format);
        bench.settle();
        bench.click(Role::Button, "GLB");
        bench.settle();
        bench.click(Role::Button, format);
        bench.settle();
        bench.focus(Role::TextInput, "File");
        bench.key(Key::Enter);
        let export = exported(&mut bench);
        assert_eq!(export, Export { path: path.into(), frame_rate: 30.0, size: (1280, 800) });
        assert_eq!(bench.session().shell().dialog(), None);
    }
}

#[test]
fn a_path_with_an_unknown_extension_is_not_exported() {
    let mut bench = asked();
    bench.focus(Role::TextInput, "File");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.type_text("arm.fbx");
    bench.settle();
    assert!(bench.node(Role::Button, "Export").accesskit_node().is_disabled());
    bench.key(Key::Enter);
    assert_eq!(bench.effects(), []);
}

#[test]
fn a_running_export_shows_its_progress_and_can_be_cancelled() {
    let mut bench = asked();
    bench.click(Role::Button, "Export");
    let export = exported(&mut bench);
    let progress = Arc::new(Progress::default());
    let job = ExportJob { path: export.path.clone(), progress: Arc::clone(&progress) };
    bench.apply_moving([FileAction::ExportStarted(job)]);
    assert_eq!(block_on(progress.step(30, 120)), Ok(()));
    bench.frame([]);
    assert!(bench.says("Exporting ik-arm.glb") && bench.says("25 %"));
    // A second one waits.
    bench.apply_moving([FileAction::Export(export)]);
    assert!(bench.says("Another export is running; cancel it or wait"));
    let cancel = bench.rect(Role::Button, "Cancel").center();
    bench.click_at(cancel);
    assert_eq!(block_on(progress.step(31, 120)), Err(Cancelled));
    bench.tell(FileAction::ExportEnded(Ok("Export cancelled".to_owned())));
    bench.settle();
    assert!(bench.says("Export cancelled") && !bench.says("25 %"));
}

#[test]
fn a_document_with_keys_survives_saving_and_opening() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("saved.json");
    let mut bench = Bench::after([
        Step::from(ArmEdit::SetHand(Vec3::new(100.0, 200.0, 50.0))),
        KeysEdit::Key(vec![channels::HAND, channels::TWIST]).into(),
        PlaybackAction::SetTime(1.5).into(),
        ArmEdit::SetHand(Vec3::new(-100.0, 200.0, 50.0)).into(),
        KeysEdit::Key(vec![channels::HAND]).into(),
    ]);
    bench.key_with(Modifiers::COMMAND, Key::S);
    bench.settle();
    bench.focus(Role::TextInput, "Document file");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.type_text(path.to_str().expect("a path"));
    bench.key(Key::Enter);
    let [Effect::Save(to)] = &bench.effects()[..] else { panic!("it is not saved") };
    io::save(bench.session().document(), to).expect("saved");
    bench.tell(FileAction::Saved(to.clone()));
    let saved = bench.session().document().clone();
    assert!(!bench.session().history().is_unsaved());

    let opened = io::open(&path, &io::OpenOptions::default()).expect("it opens");
    let mut again = Bench::after([FileAction::Opened {
        document: Box::new(opened.document),
        file: Some(path),
        contents: None,
    }]);
    assert_eq!(again.session().document(), &saved);
    again.apply([PlaybackAction::SetTime(0.75)]);
    assert_eq!(again.hand(), Vec3::new(0.0, 200.0, 50.0));
}

#[test]
fn a_name_without_an_extension_keeps_the_chosen_format() {
    for (format, name, path) in [
        ("PNG sequence", "walk", "walk_####.png"),
        ("PNG sequence", "walk.", "walk_####.png"),
        ("CSV", "walk", "walk.csv"),
        ("CSV", "walk.bvh", "walk.bvh"),
    ] {
        let mut bench = asked();
        bench.click(Role::Button, format);
        bench.focus(Role::TextInput, "File");
        bench.key_with(Modifiers::COMMAND, Key::A);
        bench.type_text(name);
        bench.settle();
        bench.click(Role::Button, "Export");
        let written = exported(&mut bench).path;
        assert_eq!(written.file_name().and_then(|it| it.to_str()), Some(path), "{format}, {name}");
    }
}

#[test]
fn a_format_leaves_the_dots_of_a_name() {
    let mut bench = asked();
    bench.focus(Role::TextInput, "File");
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.type_text("walk.v2");
    bench.settle();
    bench.click(Role::Button, "PNG sequence");
    bench.click(Role::Button, "Export");
    let written = exported(&mut bench).path;
    assert_eq!(written.file_name().and_then(|it| it.to_str()), Some("walk.v2_####.png"));
}
