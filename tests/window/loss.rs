//! Losses of the graphics device.

use image::RgbImage;

use crate::open_to_debug;
use crate::recovery::{change, document_of, kept};
use crate::screen::{Program, SIZE, changed, wait_for};

/// A point where a click gives no widget the keyboard.
const NOWHERE: egui::Pos2 = egui::pos2(640.0, 12.0);

/// The screen that is expected after the device was created again, with no widget hovered or
/// focused.
fn expected(program: &Program) -> RgbImage {
    program.click(NOWHERE);
    program.at_rest()
}

/// Presses the debug key and waits for the error.
fn lose_device(program: &Program) {
    program.at_rest();
    let errors = program.count_errors();
    program.key("F12");
    wait_for("the loss of the device", || (program.count_errors() > errors).then_some(()));
}

/// Waits until the new device has drawn the same picture, except for the status line.
fn assert_comes_back(program: &Program, before: &RgbImage) {
    wait_for("a frame of the new device", || program.has_drawn_since_error().then_some(()));
    program.mouse_to(NOWHERE);
    program.wait_until("the same picture as before the loss", |now| {
        is_same_above_the_status(before, now)
    });
}

/// Returns whether all pixels above the status line are equal.
fn is_same_above_the_status(a: &RgbImage, b: &RgbImage) -> bool {
    const STATUS: u32 = 30;
    let mut pixels = a.enumerate_pixels().zip(b.pixels());
    pixels.all(|((_, y, a), b)| y + STATUS >= SIZE.1 || a == b)
}

#[test]
#[ignore = "needs a display of its own"]
fn a_device_lost_again_and_again_is_recreated_with_document_and_picture_intact() {
    let (_folder, places, program) = open_to_debug("1");
    let first = program.at_rest();
    program.drag(places.thumb, places.rail_end);
    program.wait_until("the elbow follows", |now| changed(&first, now, places.elbow, 40.0) > 300);
    let before = expected(&program);

    for _ in 0..4 {
        lose_device(&program);
        assert_comes_back(&program, &before);
    }
    program.drag(places.rail_end, places.thumb);
    program.wait_until("the elbow follows still", |now| {
        changed(&before, now, places.elbow, 40.0) > 300
    });
    program.key("ctrl+z");
    program.wait_until("the drag after the losses is undone", |now| {
        changed(&before, now, places.elbow, 40.0) < 40
    });
    program.key("ctrl+z");
    program.wait_until("the drag before the losses is undone", |now| {
        changed(&first, now, places.elbow, 40.0) < 40
    });
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
    assert_eq!(program.count_errors(), 4);
    let errors = program.errors();
    assert!(!errors.contains("panicked"), "{errors}");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_device_that_cannot_be_recreated_twice_is_there_at_the_third_try() {
    let (_folder, _, program) = open_to_debug("fail-devices:2");
    let before = expected(&program);
    lose_device(&program);
    assert_comes_back(&program, &before);
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_device_that_cannot_be_recreated_three_times_ends_the_program_and_keeps_the_document() {
    let (folder, places, program) = open_to_debug("fail-devices:3");
    change(&program, &places);
    lose_device(&program);
    assert_eq!(program.end(), Some(1));
    let [first] = &kept(folder.path())[..] else { panic!("nothing is kept") };
    let errors = program.errors();
    assert!(errors.contains("could not be created again in three attempts"), "{errors}");
    assert!(errors.contains(&first.display().to_string()), "{errors}");
    let hand = document_of(first).rig.targets[0].home;
    assert!(hand.x < 0.0, "{hand} is not where it was dragged");

    let program = Program::open(folder.path());
    let offered = program.at_rest();
    program.key("Return");
    program.wait_until("the document opens", |now| changed(&offered, now, places.thumb, 6.0) > 40);
    program.kill();
}
