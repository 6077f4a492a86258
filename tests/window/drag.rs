use crate::screen::{Places, Program, changed, drag, mouse_to, place_window, settled, xdotool};

#[test]
#[ignore = "needs a display of its own"]
fn a_mouse_drags_a_slider_and_the_hand_and_the_screen_follows() {
    let folder = tempfile::tempdir().expect("a folder");
    let places = Places::new();
    let mut program = Program::start(folder.path());
    place_window();
    let first = settled(folder.path());

    drag(places.thumb, places.rail_end);
    let slid = settled(folder.path());
    assert!(changed(&first, &slid, places.thumb, 6.0) > 40, "the thumb has not moved");
    assert!(changed(&first, &slid, places.hand, 30.0) > 300, "the hand has not moved");
    assert!(changed(&first, &slid, places.elbow, 40.0) > 300, "the elbow has not followed");

    // Double-click on the rail resets it: the hand is back where it was.
    mouse_to(places.rail_end);
    xdotool(&["click", "--repeat", "2", "--delay", "80", "1"]);
    let reset = settled(folder.path());
    assert!(changed(&first, &reset, places.elbow, 40.0) < 40, "the hand has not been reset");

    let to = places.hand + egui::vec2(90.0, -140.0);
    drag(places.hand, to);
    let dragged = settled(folder.path());
    assert!(changed(&reset, &dragged, to, 30.0) > 300, "the hand is not where it was dragged");
    assert!(changed(&reset, &dragged, places.elbow, 40.0) > 300, "the elbow has not followed");

    // Without changes it does not ask whether to save them.
    xdotool(&["key", "ctrl+z"]);
    let undone = settled(folder.path());
    assert!(changed(&reset, &undone, places.elbow, 40.0) < 40, "the drag has not been undone");
    xdotool(&["key", "--repeat", "10", "--delay", "50", "ctrl+z"]);
    xdotool(&["key", "ctrl+q"]);
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
}
