use egui::Pos2;
use image::RgbImage;

use crate::open;
use crate::screen::changed;

/// Number of pixels of the ring around a target, which is bright, or violet for the limb of the page.
fn ring(screen: &RgbImage, at: Pos2) -> usize {
    let is_near = |x: u32, y: u32| {
        let distance = Pos2::new(x as f32 + 0.5, y as f32 + 0.5).distance(at);
        (8.0..=10.0).contains(&distance)
    };
    let is_of_ring = |colour: &image::Rgb<u8>| {
        let [red, green, blue] = colour.0;
        red.min(green).min(blue) > 180 || blue > 200 && blue > green.saturating_add(50)
    };
    let pixels = screen.enumerate_pixels();
    pixels.filter(|(x, y, colour)| is_near(*x, *y) && is_of_ring(colour)).count()
}

/// Distances in points from the middle of the hips and of the head beyond their outlines: inside,
/// the skin has one colour.
const HIPS: f32 = 70.0;
const HEAD: f32 = 45.0;

#[test]
#[ignore = "needs a display of its own"]
fn a_mouse_drags_a_slider_and_the_hand_and_the_screen_follows() {
    let (_folder, places, program) = open();
    let first = program.at_rest();

    program.drag(places.thumb, places.rail_end);
    program.wait_until("the thumb moves, and the hand and the elbow follow", |now| {
        changed(&first, now, places.thumb, 6.0) > 40
            && changed(&first, now, places.hand, 30.0) > 300
            && changed(&first, now, places.elbow, 40.0) > 300
    });

    // Resets the slider.
    program.double_click(places.rail_end);
    program.wait_until("the hand is back where it was", |now| {
        changed(&first, now, places.elbow, 40.0) < 40
    });

    let reset = program.at_rest();
    let to = places.hand + egui::vec2(90.0, -140.0);
    program.drag(places.hand, to);
    program.wait_until("the hand is where it was dragged, and the elbow follows", |now| {
        changed(&reset, now, to, 30.0) > 300 && changed(&reset, now, places.elbow, 40.0) > 300
    });

    program.key("ctrl+z");
    program.wait_until("the drag is undone", |now| changed(&reset, now, places.elbow, 40.0) < 40);
    // Without changes it does not ask whether to save them.
    for _ in 0..10 {
        program.key("ctrl+z");
    }
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
    assert_eq!(program.errors(), "", "it has nothing to complain about");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_mouse_drags_the_pelvis_of_the_human_and_the_hands_stay() {
    let (_folder, places, program) = open();
    let arm = program.at_rest();
    program.key("ctrl+alt+n");
    program.wait_until("the Human is shown", |now| changed(&arm, now, places.head, 10.0) > 100);
    // Away from all bones, so that none is highlighted.
    program.mouse_to(places.empty);
    let first = program.at_rest();

    let to = places.pelvis + egui::vec2(8.0, 30.0);
    program.drag(places.pelvis, to);
    program.mouse_to(places.empty);
    program.wait_until("the pelvis and the head move", |now| {
        changed(&first, now, places.pelvis, HIPS) > 150
            && changed(&first, now, places.head, HEAD) > 150
    });
    let dragged = program.at_rest();
    for wrist in places.wrists {
        let [before, after] = [&first, &dragged].map(|screen| ring(screen, wrist));
        assert!(before > 20, "{before} pixels of the target's ring at {wrist}");
        assert!(after * 10 >= before * 9, "{after} of {before} pixels are left at {wrist}");
    }
    for toes in places.toes {
        let moved = changed(&first, &dragged, toes, 4.0);
        assert!(moved <= 2, "{moved} pixels of the toes at {toes} change");
    }

    program.key("ctrl+z");
    program.wait_until("the drag is undone", |now| changed(&first, now, places.head, HEAD) < 20);
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
    assert_eq!(program.errors(), "", "it has nothing to complain about");
}

#[test]
#[ignore = "needs a display of its own"]
fn a_mouse_drags_the_forearm_and_the_elbow_turns_while_the_view_stays() {
    let (_folder, places, program) = open();
    program.mouse_to(places.empty);
    let first = program.at_rest();

    let forearm = places.elbow + (places.hand - places.elbow) * 0.5;
    program.drag(forearm, forearm + egui::vec2(-28.0, 40.0));
    program.mouse_to(places.empty);
    program.wait_until("the elbow turns about the Pointer", |now| {
        changed(&first, now, places.elbow, 40.0) > 300
    });
    let turned = program.at_rest();
    assert_eq!(changed(&first, &turned, places.view_axes, 45.0), 0, "the view does not orbit");

    program.key("ctrl+z");
    // Hides the ring of the elbow.
    program.click(places.empty);
    program.mouse_to(places.empty);
    program.wait_until("the drag is undone", |now| changed(&first, now, places.elbow, 12.0) < 40);
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
    assert_eq!(program.errors(), "", "it has nothing to complain about");
}
