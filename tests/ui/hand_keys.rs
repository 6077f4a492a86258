//! Keys during a drag of the hand.

use egui::{Key, Modifiers, PointerButton, vec2};
use glam::Vec3;
use ik_arm::document::Camera;
use ik_arm::session::{Constraint, PointDrag};

use crate::bench::{Bench, bits};
use crate::hand::{awkward, grab, on_arrow};

const LEFT: PointerButton = PointerButton::Primary;

#[test]
fn keys_lock_an_axis_or_a_plane_and_the_same_key_frees_it() {
    for (axis, key) in [Key::X, Key::Y, Key::Z].into_iter().enumerate() {
        for plane in [false, true] {
            let mut bench = awkward();
            let before = bench.hand();
            let start = bench.cursor_on_screen();
            bench.drag(LEFT, start, start + vec2(40.0, 25.0));
            let modifiers = if plane { Modifiers::SHIFT } else { Modifiers::NONE };
            bench.key_with(modifiers, key);
            let expected = if plane { Constraint::Plane(axis) } else { Constraint::Axis(axis) };
            assert_eq!(
                bench.session().history().point_drag().and_then(PointDrag::constraint),
                Some(expected)
            );
            bench.move_to(start + vec2(60.0, 35.0));
            for other in 0..3 {
                let kept = bits(bench.hand())[other] == bits(before)[other];
                assert_eq!(kept, (other == axis) == plane, "{expected:?}: {}", bench.hand());
            }
            let name = ["x", "y", "z"][axis];
            assert!(
                plane || bench.says(&format!("Target along {name}")),
                "the status line says so"
            );
            bench.key_with(modifiers, key);
            assert_eq!(
                bench.session().history().point_drag().and_then(PointDrag::constraint),
                None
            );
            bench.move_to(start + vec2(61.0, 35.0));
            assert!(bench.cursor_on_screen().distance(start + vec2(61.0, 35.0)) < 0.05);
        }
    }
}

#[test]
fn shift_moves_a_tenth_of_the_way() {
    let mut bench = Bench::new();
    let (before, start) = (bench.hand(), bench.cursor_on_screen());
    let mut free = Bench::new();
    free.drag(LEFT, start, start + vec2(100.0, 40.0));
    let whole = free.hand() - before;
    bench.move_to(start);
    bench.press(LEFT);
    bench.hold(Modifiers::SHIFT);
    bench.move_to(start + vec2(100.0, 40.0));
    let tenth = bench.hand() - before;
    assert!((tenth * 10.0).distance(whole) < 0.1, "{tenth} of {whole}");
    bench.hold(Modifiers::NONE);
    let let_go = bench.hand() - before;
    assert!(let_go.distance(tenth) < 0.01, "letting Shift go does not jump");
}

#[test]
fn ctrl_snaps_to_tens_and_with_shift_to_ones() {
    for (modifiers, step) in
        [(Modifiers::COMMAND, 10.0), (Modifiers::COMMAND | Modifiers::SHIFT, 1.0)]
    {
        let mut bench = awkward();
        let before = bench.hand();
        let grabbed = on_arrow(&bench, 1, 62.0);
        grab(&mut bench, grabbed);
        bench.hold(modifiers);
        bench.move_to(grabbed - vec2(0.0, 47.0));
        let hand = bench.hand();
        assert!((hand.y / step).fract().abs() < 1e-5, "{hand} in steps of {step}");
        assert!(hand.y > before.y);
        assert_eq!([hand.x, hand.z], [before.x, before.z]);
    }
}

#[test]
fn a_typed_offset_holds_until_it_is_accepted_or_cancelled() {
    for accept in [true, false] {
        let mut bench = awkward();
        let before = bench.hand();
        let start = bench.cursor_on_screen();
        bench.drag(LEFT, start, start + vec2(40.0, 25.0));
        bench.key(Key::Y);
        bench.type_text("-12.58");
        bench.key(Key::Backspace);
        assert_eq!(bench.session().history().point_drag().map(PointDrag::typed), Some("-12.5"));
        assert_eq!(bits(bench.hand()), bits(before + Vec3::new(0.0, -12.5, 0.0)));
        assert!(bench.says("typed -12.5"));
        bench.move_to(start + vec2(200.0, 0.0));
        assert_eq!(bench.hand().y, before.y - 12.5, "the mouse no longer moves it");
        bench.key(if accept { Key::Enter } else { Key::Escape });
        let expected = if accept { before - Vec3::new(0.0, 12.5, 0.0) } else { before };
        assert_eq!(bits(bench.hand()), bits(expected));
        assert!(!bench.session().history().is_editing());
        bench.move_to(start);
        bench.release(LEFT);
        assert_eq!(bits(bench.hand()), bits(expected));
        assert_eq!(bench.session().camera(), &Camera::default(), "digits are no view keys here");
    }
}

#[test]
fn typed_numbers_are_for_the_coordinates_that_the_drag_moves() {
    let mut bench = Bench::new();
    let (before, start) = (bench.hand(), bench.cursor_on_screen());
    grab(&mut bench, start);
    bench.type_text("1,-2,.5");
    assert_eq!(bench.hand(), before + Vec3::new(1.0, -2.0, 0.5));
    bench.key_with(Modifiers::SHIFT, Key::Y);
    assert_eq!(bench.hand(), before + Vec3::new(1.0, 0.0, -2.0));
}

#[test]
fn the_status_line_shows_the_keys_and_the_change_while_the_hand_is_dragged() {
    let mut bench = Bench::new();
    let start = bench.cursor_on_screen();
    bench.drag(LEFT, start, start + vec2(30.0, 0.0));
    let moved = bench.session().history().point_drag().expect("held").moved();
    let change = format!("Target freely: {:+.1}, {:+.1}, {:+.1}", moved.x, moved.y, moved.z);
    assert!(bench.says(&change), "{change}");
    for keys in ["Shift", "Ctrl", "X Y Z", "Enter", "Esc"] {
        assert!(bench.says(&format!("{change}     Shift precise")) && bench.says(keys), "{keys}");
    }
}
