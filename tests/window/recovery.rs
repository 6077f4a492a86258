use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

use ik_arm::document::Document;

use crate::display::DisplayServer;
use crate::open;
use crate::places::Places;
use crate::screen::{Program, changed, wait_for};

/// Files in which the program keeps unsaved changes.
pub fn kept(settings: &Path) -> Vec<PathBuf> {
    let folder = settings.join("ik-arm/recovery");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.map(|entry| entry.path());
    files.filter(|path| path.extension().is_some_and(|extension| extension == "json")).collect()
}

pub fn document_of(kept: &Path) -> Document {
    let kept = std::fs::read_to_string(kept).expect("whole");
    let kept: serde_json::Value = serde_json::from_str(&kept).expect("JSON");
    let text = kept["document"].as_str().expect("a document");
    ik_arm::io::parse("kept", text, &ik_arm::io::OpenOptions::default()).expect("it opens").document
}

/// Drags the hand to the left end of its slider.
pub fn change(program: &Program, places: &Places) {
    let before = program.at_rest();
    program.drag(places.thumb, places.rail_end);
    program.wait_until("the thumb moves", |now| changed(&before, now, places.thumb, 6.0) > 40);
    // The drag has more movements than the first.
    program.at_rest();
}

#[test]
#[ignore = "needs a display of its own"]
fn unsaved_changes_are_kept_when_the_program_is_terminated_and_offered_at_the_next_start() {
    let (folder, places, program) = open();
    change(&program, &places);
    program.terminate();
    assert_eq!(program.end(), Some(130));
    let [first] = &kept(folder.path())[..] else { panic!("nothing is kept") };
    let hand = document_of(first).rig.targets[0].home;
    assert!(hand.x < 0.0, "{hand} is not where it was dragged");

    let program = Program::open(folder.path());
    let offered = program.at_rest();
    // The dialog has the keyboard focus.
    program.key("Return");
    program.wait_until("the document opens", |now| changed(&offered, now, places.thumb, 6.0) > 40);
    // Without input it is kept again after some seconds, so a crash loses nothing.
    let second = wait_for("another file", || match &kept(folder.path())[..] {
        [one] if one != first => Some(one.clone()),
        _ => None,
    });
    program.kill();
    assert_eq!(document_of(&second).rig.targets[0].home, hand);
}

#[test]
#[ignore = "needs a display of its own"]
fn a_recovered_document_that_is_given_up_is_not_offered_again() {
    let (folder, places, program) = open();
    change(&program, &places);
    program.terminate();
    program.end();
    assert_eq!(kept(folder.path()).len(), 1);

    let program = Program::open(folder.path());
    let offered = program.at_rest();
    program.key("Return");
    program.wait_until("the document opens", |now| changed(&offered, now, places.thumb, 6.0) > 40);
    // Quits before half a minute is over, without saving.
    program.key("ctrl+q");
    program.at_rest();
    program.key("Tab");
    program.key("Return");
    assert_eq!(program.end(), Some(0));
    assert!(kept(folder.path()).is_empty(), "it would be offered again");
}

#[test]
#[ignore = "needs a display of its own"]
fn settings_are_kept_when_the_program_is_killed() {
    let (folder, places, program) = open();
    let before = program.at_rest();
    let file = folder.path().join("ik-arm/settings.ron");
    let settings = || std::fs::read_to_string(&file).unwrap_or_default();
    let earlier = settings();
    program.key("ctrl+alt+n");
    program.wait_until("the figure", |now| changed(&before, now, places.head, 8.0) > 20);
    wait_for("the settings", || (settings() != earlier).then_some(()));
    program.kill();
}

#[test]
#[ignore = "needs a display of its own"]
fn a_tour_that_nobody_reads_on_takes_no_time_of_the_processor() {
    let folder = tempfile::tempdir().expect("a folder");
    let link = Path::new("https://ik-arm.invalid/#tour=1");
    let program = Program::open_file(folder.path(), link);
    program.at_rest();
    // After the time at which changed settings are written.
    sleep(Duration::from_secs(3));
    let before = program.processor_time();
    sleep(Duration::from_secs(2));
    let took = program.processor_time() - before;
    assert!(took < 50, "{took} hundredths of a second in 2 s");
}

#[test]
#[ignore = "needs a display of its own"]
fn unsaved_changes_are_backed_up_within_ten_seconds_of_a_change() {
    let (folder, places, program) = open();
    let before = Instant::now();
    change(&program, &places);
    let file = wait_for("a backup", || kept(folder.path()).pop());
    assert!(before.elapsed() < Duration::from_secs(10), "after {:?}", before.elapsed());
    program.kill();
    let hand = document_of(&file).rig.targets[0].home;
    assert!(hand.x < 0.0, "{hand} is not where it was dragged");
}

#[test]
#[ignore = "needs a display of its own"]
fn unsaved_changes_are_kept_when_the_display_server_dies() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut server = DisplayServer::start();
    let program = Program::open_on(folder.path(), server.display());
    change(&program, &Places::new());
    server.kill();
    assert_eq!(program.end(), Some(1));
    let [file] = &kept(folder.path())[..] else { panic!("nothing is kept") };
    let hand = document_of(file).rig.targets[0].home;
    assert!(hand.x < 0.0, "{hand} is not where it was dragged");
    let errors = program.errors();
    assert!(errors.contains(&file.display().to_string()), "{errors}");
}

/// The middle of the window, where dialogs are.
const MIDDLE: egui::Pos2 = egui::pos2(640.0, 400.0);
/// A point of the status line.
const STATUS: egui::Pos2 = egui::pos2(150.0, 788.0);

#[test]
#[ignore = "needs a display of its own"]
fn two_windows_do_not_offer_the_same_backup() {
    let (folder, places, program) = open();
    // The squares beside the hand are seen near the mouse alone.
    let away_from_the_hand = |program: &Program| {
        program.mouse_to(STATUS);
        program.at_rest()
    };
    let without_dialog = away_from_the_hand(&program);
    change(&program, &places);
    program.terminate();
    program.end();

    let first = Program::open(folder.path());
    let offered = away_from_the_hand(&first);
    assert!(changed(&without_dialog, &offered, MIDDLE, 150.0) > 1000, "it is offered");
    let server = DisplayServer::start();
    let second = Program::open_on(folder.path(), server.display());
    let not_offered = away_from_the_hand(&second);
    assert!(changed(&without_dialog, &not_offered, MIDDLE, 150.0) < 100, "it is offered twice");
    second.kill();
    first.kill();
    // A window that ended without an answer leaves it for the next.
    let third = Program::open(folder.path());
    assert!(changed(&without_dialog, &third.at_rest(), MIDDLE, 150.0) > 1000);
    third.kill();
}

#[test]
#[ignore = "needs a display of its own"]
fn pipes_among_the_backups_do_not_keep_the_window_from_opening() {
    let folder = tempfile::tempdir().expect("a folder");
    let recovery = folder.path().join("ik-arm/recovery");
    std::fs::create_dir_all(&recovery).expect("a folder");
    for name in ["1.json", "1.lock", "2.lock"] {
        let pipe = recovery.join(name);
        let made = std::process::Command::new("mkfifo").arg(pipe).status().expect("mkfifo runs");
        assert!(made.success());
    }
    Program::open(folder.path()).kill();
}

#[test]
#[ignore = "needs a display of its own"]
fn damaged_settings_are_told_once_in_the_status_line() {
    let (folder, _, program) = open();
    let usual = program.at_rest();
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0));
    let settings = folder.path().join("ik-arm/settings.ron");
    std::fs::write(&settings, "(preferences: (theme: \"none").expect("written");

    let program = Program::open(folder.path());
    let told = program.at_rest();
    assert!(changed(&usual, &told, STATUS, 120.0) > 200, "nothing is told");
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0));
    let program = Program::open(folder.path());
    assert!(changed(&usual, &program.at_rest(), STATUS, 120.0) < 50, "it is told again");
    program.kill();
}
