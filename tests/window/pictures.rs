//! Pictures saved while the window draws at a smaller size.

use std::fs;
use std::path::Path;

use egui::vec2;

use crate::places::Places;
use crate::screen::{Program, wait_for};

/// Saves a picture by the keyboard, at once after what was done before, and reads the file.
fn picture(program: &Program, path: &Path) -> Vec<u8> {
    program.quickly(&["key", "ctrl+p", "type", "--delay", "0", &path.display().to_string()]);
    program.at_rest();
    program.key("Return");
    wait_for("the picture", || path.exists().then_some(()));
    program.at_rest();
    fs::read(path).expect("a picture")
}

#[test]
#[ignore = "needs a display of its own"]
fn a_picture_saved_right_after_a_drag_is_the_picture_in_full() {
    let folder = tempfile::tempdir().expect("a folder");
    // Settings without a word on the resolution, so that it changes.
    fs::create_dir_all(folder.path().join("ik-arm")).expect("a folder");
    fs::write(folder.path().join("ik-arm/settings.ron"), "()").expect("settings");
    let (places, program) = (Places::new(), Program::open(folder.path()));
    // Of all ways to move, orbiting changes the most pixels.
    program.drag(places.empty, places.empty + vec2(60.0, -40.0));
    let at_once = picture(&program, &folder.path().join("at-once.png"));
    let full = program.at_rest();
    program.wait_until("nothing more sharpens", |now| *now == full);
    let rested = picture(&program, &folder.path().join("rested.png"));
    assert!(at_once == rested, "the pictures differ");
}
