use crate::open;
use crate::screen::changed;

#[test]
#[ignore = "needs a display of its own"]
fn a_number_that_is_typed_moves_the_hand() {
    let (_folder, places, program) = open();
    program.mouse_to(places.number);
    let before = program.at_rest();

    program.click(places.number);
    program.wait_for_change(&before);
    program.type_text("-300");
    program.key("Return");
    program.wait_until("the thumb moves, and the elbow follows", |now| {
        changed(&before, now, places.thumb, 6.0) > 40
            && changed(&before, now, places.elbow, 40.0) > 300
    });

    program.key("ctrl+z");
    program
        .wait_until("the number is undone", |now| changed(&before, now, places.elbow, 40.0) < 40);
    program.key("ctrl+q");
    assert_eq!(program.end(), Some(0), "the program ends cleanly");
}
