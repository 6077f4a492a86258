use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

use ik_arm::document::Document;

use crate::screen::{PATIENCE, Places, Program, changed, drag, place_window, settled, xdotool};

/// Where the program keeps what is not saved, in case it ends before.
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
    ik_arm::io::parse("kept", text, None).expect("it opens").document
}

/// The hand, dragged to the left end of its slider.
pub fn change(places: &Places, folder: &Path) {
    place_window();
    settled(folder);
    drag(places.thumb, places.rail_end);
    settled(folder);
}

#[test]
#[ignore = "needs a display of its own"]
fn what_is_not_saved_is_kept_when_the_program_is_ended_and_offered_when_it_starts_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start(folder.path());
    change(&places, folder.path());
    assert!(kept(folder.path()).is_empty(), "half a minute is not over");
    let ended = Command::new("kill").arg(program.0.id().to_string()).status().expect("kill runs");
    assert!(ended.success());
    assert_eq!(program.end(), Some(130));
    let [first] = &kept(folder.path())[..] else { panic!("nothing is kept") };
    let hand = document_of(first).arm.cursor();
    assert!(hand.x < 0.0, "{hand} is not where it was dragged");

    let mut program = Program::start(folder.path());
    place_window();
    let offered = settled(folder.path());
    // Opened by the keyboard: the dialog has it.
    xdotool(&["key", "Return"]);
    let opened = settled(folder.path());
    assert!(changed(&offered, &opened, places.thumb, 6.0) > 40, "the document is not opened");
    // Left alone, it is kept again after half a minute, whatever happens to the program then.
    let given_up = Instant::now() + PATIENCE;
    let second = loop {
        match &kept(folder.path())[..] {
            [one] if one != first => break one.clone(),
            _ => assert!(Instant::now() < given_up, "it is not kept"),
        }
        sleep(Duration::from_millis(500));
    };
    program.0.kill().expect("killed");
    program.end();
    assert_eq!(document_of(&second).arm.cursor(), hand);
}
