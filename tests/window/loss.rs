//! The graphics device is lost.

use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use image::RgbImage;

use crate::recovery::{change, document_of, kept};
use crate::screen::{
    PATIENCE, Places, Program, SIZE, changed, drag, mouse_to, place_window, screenshot, settled,
    xdotool,
};

/// Beside all that takes the keyboard.
const NOWHERE: egui::Pos2 = egui::pos2(640.0, 12.0);

/// The screen as it is to be when the device is lost and made anew: with the pointer where the menu
/// was, and the keyboard at nothing.
fn expected(places: &Places, folder: &Path) -> RgbImage {
    mouse_to(NOWHERE);
    xdotool(&["click", "1"]);
    mouse_to(places.lose_device);
    settled(folder)
}

/// Through the menu Help.
fn lose_device(places: &Places, folder: &Path) {
    mouse_to(places.help);
    xdotool(&["click", "1"]);
    sleep(Duration::from_millis(700));
    mouse_to(places.lose_device);
    settled(folder);
    xdotool(&["click", "1"]);
}

/// Waits until the menu is gone and all is as before, but for what the line at the bottom says.
fn assert_comes_back(before: &RgbImage, folder: &Path) {
    let given_up = Instant::now() + PATIENCE;
    loop {
        let differing = changed_above_the_status(before, &screenshot(folder));
        if differing == 0 {
            return;
        }
        assert!(Instant::now() < given_up, "{differing} pixels are others than before the loss");
        sleep(Duration::from_millis(400));
    }
}

/// How many pixels differ above the line at the bottom, which says what has happened.
fn changed_above_the_status(a: &RgbImage, b: &RgbImage) -> usize {
    const STATUS: u32 = 30;
    let pixels = a.enumerate_pixels().zip(b.pixels());
    pixels.filter(|((_, y, a), b)| *y + STATUS < SIZE.1 as u32 && a != b).count()
}

#[test]
#[ignore = "needs a display of its own"]
fn a_lost_device_is_made_anew_again_and_again_with_the_document_and_the_picture_intact() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start_to_debug(folder.path(), "1");
    place_window();
    let first = settled(folder.path());
    drag(places.thumb, places.rail_end);
    let before = expected(&places, folder.path());
    assert!(changed(&first, &before, places.elbow, 40.0) > 300, "the elbow has not followed");

    for _ in 0..4 {
        lose_device(&places, folder.path());
        assert_comes_back(&before, folder.path());
    }
    drag(places.rail_end, places.thumb);
    let dragged = settled(folder.path());
    assert!(changed(&before, &dragged, places.elbow, 40.0) > 300, "nothing moves any more");
    for _ in 0..2 {
        xdotool(&["key", "ctrl+z"]);
        settled(folder.path());
    }
    let undone = settled(folder.path());
    assert!(
        changed(&first, &undone, places.elbow, 40.0) < 40,
        "what was done before the loss is not undone"
    );
    xdotool(&["key", "ctrl+q"]);
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
    let errors = program.errors();
    assert_eq!(errors.matches("ERROR").count(), 4, "{errors}");
    assert!(!errors.contains("panicked"), "{errors}");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_device_that_fails_twice_while_it_is_made_anew_is_there_at_the_third_try() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start_to_debug(folder.path(), "fail-devices:2");
    place_window();
    let before = expected(&places, folder.path());
    lose_device(&places, folder.path());
    assert_comes_back(&before, folder.path());
    xdotool(&["key", "ctrl+q"]);
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_device_that_fails_three_times_while_it_is_made_anew_ends_the_program_with_all_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start_to_debug(folder.path(), "fail-devices:3");
    change(&places, folder.path());
    lose_device(&places, folder.path());
    assert_eq!(program.end(), Some(1));
    let [first] = &kept(folder.path())[..] else { panic!("nothing is kept") };
    let errors = program.errors();
    assert!(errors.contains("three tries to make it anew failed"), "{errors}");
    assert!(errors.contains(&first.display().to_string()), "{errors}");
    let hand = document_of(first).arm.cursor();
    assert!(hand.x < 0.0, "{hand} is not where it was dragged");

    let mut program = Program::start(folder.path());
    place_window();
    let offered = settled(folder.path());
    xdotool(&["key", "Return"]);
    let opened = settled(folder.path());
    assert!(changed(&offered, &opened, places.thumb, 6.0) > 40, "the document is not opened");
    program.0.kill().expect("killed");
    program.end();
}
