//! The hand, dragged in the viewport.

use egui::{CursorIcon, Key, Modifiers, PointerButton, Pos2, Vec2, pos2, vec2};
use glam::Vec3;
use ik_arm::document::{AxisView, Camera};
use ik_arm::kinematics::two_bone::Reach;
use ik_arm::session::{Action, Constraint, Handle};

use crate::bench::{Bench, SMALL, bits};

const LEFT: PointerButton = PointerButton::Primary;

/// A pose of awkward numbers, so that a bit that changes is seen.
fn odd() -> Bench {
    Bench::after([
        Action::SetRoot(Vec3::new(12.345_679, -7.654_321, 33.333_332)),
        Action::SetHand(Vec3::new(223.456_79, 98.765_43, 71.234_57)),
    ])
}

/// Where an arrow of 80 points is, or a part of it, on screen: as a person sees it.
fn on_arrow(bench: &Bench, axis: usize, points: f32) -> Pos2 {
    bench.cursor_place() + along(bench, axis) * points
}

fn on_square(bench: &Bench, axis: usize) -> Pos2 {
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|axis| along(bench, axis));
    bench.cursor_place() + (u + v) * 33.0
}

/// An axis as it lies on screen, one point long where it is seen from the side.
fn along(bench: &Bench, axis: usize) -> Vec2 {
    let camera = bench.session().camera();
    let projection = camera.projection(bench.viewport().aspect_ratio());
    let [right, up] = [projection.right, projection.up].map(Vec3::normalize);
    let axis = Vec3::AXES[axis];
    vec2(axis.dot(right), -axis.dot(up))
}

fn grab(bench: &mut Bench, at: Pos2) {
    bench.move_to(at);
    bench.press(LEFT);
}

#[test]
fn the_hand_is_under_the_pointer_from_the_first_pixel_to_the_last_also_past_the_limits() {
    for mut bench in [Bench::new(), Bench::of_size(SMALL)] {
        let start = bench.cursor_place();
        grab(&mut bench, start);
        assert_eq!(bench.hand(), Vec3::new(250.0, 120.0, 60.0), "a press alone moves nothing");
        let mut reaches = Vec::new();
        let path = [vec2(1.0, 0.0), vec2(2.0, 1.0), vec2(3.0, -2.0)].into_iter();
        let path = path.chain((1..30).map(|step| vec2(9.0, -6.0) * step as f32));
        let path =
            path.chain((1..30).map(|step| vec2(240.0, -160.0) + vec2(-20.0, 12.0) * step as f32));
        for offset in path {
            let pointer = start + offset;
            bench.move_to(pointer);
            let seen = bench.cursor_place();
            assert!(seen.distance(pointer) < 0.05, "{seen} is not under {pointer}");
            let pose = *bench.session().pose();
            if pose.reach == Reach::Reached {
                let hand = bench.place(bench.session().arm().root + pose.hand);
                assert!(hand.distance(pointer) < 0.05, "{hand} is not under {pointer}");
            } else {
                let cursor = bench.hand();
                let beside = pose.hand.cross(cursor).length() / cursor.length();
                assert!(beside < 0.01, "the arm points at the cursor");
            }
            reaches.push(pose.reach);
        }
        assert_eq!(reaches[0], Reach::Reached);
        assert!(reaches.contains(&Reach::TooFar), "{reaches:?}");
        bench.release(LEFT);
        assert!(!bench.session().is_editing());
        let left = bench.hand();
        bench.move_to(start);
        assert_eq!(bench.hand(), left, "what is let go stays");
    }
}

#[test]
fn a_hand_taken_beside_its_middle_keeps_its_distance_from_the_pointer() {
    let mut bench = Bench::new();
    let (start, beside) = (bench.cursor_place(), vec2(7.0, -5.0));
    grab(&mut bench, start + beside);
    for offset in [Vec2::ZERO, vec2(1.0, 0.0), vec2(-50.0, 30.0)] {
        bench.move_to(start + beside + offset);
        assert!(bench.cursor_place().distance(start + offset) < 0.05);
    }
}

#[test]
fn a_click_on_the_hand_changes_no_bit() {
    let mut bench = odd();
    let before = *bench.session().arm();
    let place = bench.cursor_place();
    bench.click_at(place);
    assert_eq!(bits(bench.hand()), bits(before.cursor));
    assert!(!bench.session().is_editing());
}

#[test]
fn a_press_and_its_release_in_one_frame_hold_nothing() {
    let mut bench = Bench::new();
    let place = bench.cursor_place();
    bench.move_to(place);
    let events = [true, false].map(|down| bench.button(LEFT, down));
    bench.frame(events);
    assert!(!bench.session().is_editing());
    bench.move_to(place + vec2(100.0, 0.0));
    assert_eq!(bench.hand(), Vec3::new(250.0, 120.0, 60.0));
    bench.move_to(bench.empty_place());
    let events = [true, false].map(|down| bench.button(LEFT, down));
    bench.frame(events);
    bench.move_to(place);
    assert_eq!(bench.session().camera(), &Camera::default());
    assert!(bench.session().view_drag().is_none());
}

#[test]
fn a_press_with_a_move_in_one_frame_takes_what_was_pressed_and_follows_at_once() {
    let mut bench = Bench::new();
    let place = bench.cursor_place();
    bench.move_to(place);
    let to = place + vec2(90.0, -100.0);
    bench.frame([bench.button(LEFT, true), egui::Event::PointerMoved(to)]);
    assert!(bench.session().hand_drag().is_some());
    assert!(bench.cursor_place().distance(to) < 0.05);
}

#[test]
fn a_hand_out_of_reach_is_taken_where_it_is_and_so_is_its_cursor() {
    let far = Vec3::new(500.0, 220.0, 300.0);
    for take_cursor in [true, false] {
        let mut bench = Bench::after([
            Action::SetHand(far),
            Action::GlideTo(Camera { distance: 1800.0, ..Camera::default() }),
        ]);
        let hand = bench.place(bench.session().pose().hand);
        let start = if take_cursor { bench.cursor_place() } else { hand };
        grab(&mut bench, start);
        for offset in [vec2(1.0, 1.0), vec2(8.0, -20.0), vec2(60.0, -90.0)] {
            bench.move_to(start + offset);
            let seen = bench.cursor_place();
            assert!(seen.distance(start + offset) < 0.05, "{take_cursor}: {seen}");
        }
    }
}

#[test]
fn esc_and_the_right_button_take_a_drag_back() {
    for by_key in [true, false] {
        let mut bench = odd();
        let before = *bench.session().arm();
        let start = bench.cursor_place();
        bench.drag(LEFT, start, start + vec2(120.0, 90.0));
        assert_ne!(bench.session().arm(), &before);
        if by_key {
            bench.key(Key::Escape);
        } else {
            bench.press(PointerButton::Secondary);
        }
        assert_eq!(bench.session().arm(), &before, "by key: {by_key}");
        assert!(!bench.session().is_editing());
        assert!(bench.says("Taken back"));
        bench.move_to(start - vec2(50.0, 0.0));
        if !by_key {
            bench.release(PointerButton::Secondary);
        }
        bench.release(LEFT);
        bench.move_to(start);
        assert_eq!(bench.session().arm(), &before);
        assert_eq!(bench.session().camera(), &Camera::default());
    }
}

#[test]
fn a_drag_over_a_panel_goes_on_and_can_be_taken_back_there() {
    let mut bench = odd();
    let before = *bench.session().arm();
    let start = bench.cursor_place();
    let to = pos2(100.0, 300.0);
    bench.drag(LEFT, start, to);
    assert!(bench.cursor_place().distance(to) < 0.05);
    bench.press(PointerButton::Secondary);
    assert_eq!(bench.session().arm(), &before);
}

#[test]
fn an_arrow_moves_its_coordinate_and_no_other_bit() {
    for axis in 0..3 {
        let mut bench = odd();
        let before = bench.hand();
        let grabbed = on_arrow(&bench, axis, 62.0);
        bench.move_to(grabbed);
        assert_eq!(bench.harness.output().platform_output.cursor_icon, CursorIcon::Grab);
        bench.press(LEFT);
        assert_eq!(bench.session().hand_drag().map(|d| d.handle()), Some(Handle::Axis(axis)));
        let step = along(&bench, axis);
        for part in [3.0, 20.0, 45.0, -30.0, 60.0] {
            bench.move_to(grabbed + step * part);
            for other in 0..3 {
                let kept = bits(bench.hand())[other] == bits(before)[other];
                assert_eq!(kept, other != axis, "{axis}: {before} to {}", bench.hand());
            }
        }
        assert!(bench.hand()[axis] > before[axis] + 10.0, "with the arrow");
        assert_eq!(bench.harness.output().platform_output.cursor_icon, CursorIcon::Grabbing);
        bench.release(LEFT);
    }
}

#[test]
fn a_square_keeps_its_coordinate_bit_for_bit_and_moves_the_others() {
    for axis in 0..3 {
        let mut bench = odd();
        let before = bench.hand();
        let grabbed = on_square(&bench, axis);
        let start = bench.cursor_place();
        grab(&mut bench, grabbed);
        assert_eq!(bench.session().hand_drag().map(|d| d.handle()), Some(Handle::Plane(axis)));
        for offset in [vec2(2.0, 1.0), vec2(25.0, -10.0), vec2(-20.0, 15.0)] {
            bench.move_to(grabbed + offset);
            for other in 0..3 {
                let kept = bits(bench.hand())[other] == bits(before)[other];
                assert_eq!(kept, other == axis, "{axis}: {before} to {}", bench.hand());
            }
            let seen = bench.cursor_place();
            // The square is not quite in the hand's place, so perspective shows a little.
            assert!(seen.distance(start + offset) < 4.0, "{seen} for {}", start + offset);
        }
    }
}

#[test]
fn keys_lock_an_axis_or_a_plane_and_the_same_key_frees_it() {
    for (axis, key) in [Key::X, Key::Y, Key::Z].into_iter().enumerate() {
        for plane in [false, true] {
            let mut bench = odd();
            let before = bench.hand();
            let start = bench.cursor_place();
            bench.drag(LEFT, start, start + vec2(40.0, 25.0));
            let modifiers = if plane { Modifiers::SHIFT } else { Modifiers::NONE };
            bench.key_with(modifiers, key);
            let expected = if plane { Constraint::Plane(axis) } else { Constraint::Axis(axis) };
            assert_eq!(bench.session().hand_drag().and_then(|d| d.constraint()), Some(expected));
            bench.move_to(start + vec2(60.0, 35.0));
            for other in 0..3 {
                let kept = bits(bench.hand())[other] == bits(before)[other];
                assert_eq!(kept, (other == axis) == plane, "{expected:?}: {}", bench.hand());
            }
            let name = ["x", "y", "z"][axis];
            assert!(plane || bench.says(&format!("Move along {name}")), "the status line says so");
            bench.key_with(modifiers, key);
            assert_eq!(bench.session().hand_drag().and_then(|d| d.constraint()), None);
            bench.move_to(start + vec2(61.0, 35.0));
            assert!(bench.cursor_place().distance(start + vec2(61.0, 35.0)) < 0.05);
        }
    }
}

#[test]
fn shift_moves_a_tenth_of_the_way() {
    let mut bench = Bench::new();
    let (before, start) = (bench.hand(), bench.cursor_place());
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
        let mut bench = odd();
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
fn a_typed_offset_leads_until_it_is_accepted_or_taken_back() {
    for accept in [true, false] {
        let mut bench = odd();
        let before = bench.hand();
        let start = bench.cursor_place();
        bench.drag(LEFT, start, start + vec2(40.0, 25.0));
        bench.key(Key::Y);
        bench.type_text("-12.58");
        bench.key(Key::Backspace);
        assert_eq!(bench.session().hand_drag().map(|d| d.typed()), Some("-12.5"));
        assert_eq!(bits(bench.hand()), bits(before + Vec3::new(0.0, -12.5, 0.0)));
        assert!(bench.says("typed -12.5"));
        bench.move_to(start + vec2(200.0, 0.0));
        assert_eq!(bench.hand().y, before.y - 12.5, "the pointer no longer leads");
        bench.key(if accept { Key::Enter } else { Key::Escape });
        let expected = if accept { before - Vec3::new(0.0, 12.5, 0.0) } else { before };
        assert_eq!(bits(bench.hand()), bits(expected));
        assert!(!bench.session().is_editing());
        bench.move_to(start);
        bench.release(LEFT);
        assert_eq!(bits(bench.hand()), bits(expected));
        assert_eq!(bench.session().camera(), &Camera::default(), "digits are no view keys here");
    }
}

#[test]
fn typed_numbers_are_for_the_coordinates_that_the_drag_moves() {
    let mut bench = Bench::new();
    let (before, start) = (bench.hand(), bench.cursor_place());
    grab(&mut bench, start);
    bench.type_text("1,-2,.5");
    assert_eq!(bench.hand(), before + Vec3::new(1.0, -2.0, 0.5));
    bench.key_with(Modifiers::SHIFT, Key::Y);
    assert_eq!(bench.hand(), before + Vec3::new(1.0, 0.0, -2.0));
}

#[test]
fn an_arrow_along_the_view_cannot_be_taken() {
    let mut bench = Bench::after([Action::SetCamera(Camera::default().along(AxisView::Front))]);
    let place = bench.cursor_place();
    bench.move_to(place + vec2(17.0, 12.0));
    bench.press(LEFT);
    assert!(bench.session().hand_drag().is_none_or(|d| d.handle() != Handle::Axis(2)));
}

#[test]
fn the_status_line_shows_the_keys_and_the_change_while_the_hand_is_dragged() {
    let mut bench = Bench::new();
    let start = bench.cursor_place();
    bench.drag(LEFT, start, start + vec2(30.0, 0.0));
    let moved = bench.session().hand_drag().expect("held").moved();
    let change = format!("Move freely: {:+.1}, {:+.1}, {:+.1}", moved.x, moved.y, moved.z);
    assert!(bench.says(&change), "{change}");
    for keys in ["Shift", "Ctrl", "X Y Z", "Enter", "Esc"] {
        assert!(bench.says(&format!("{change}     Shift fine")) && bench.says(keys), "{keys}");
    }
}

#[test]
fn the_pointer_shows_what_can_be_taken() {
    let mut bench = Bench::new();
    let icon = |bench: &Bench| bench.harness.output().platform_output.cursor_icon;
    let place = bench.cursor_place();
    bench.move_to(place);
    assert_eq!(icon(&bench), CursorIcon::Grab);
    bench.press(LEFT);
    assert_eq!(icon(&bench), CursorIcon::Grabbing);
    bench.release(LEFT);
    bench.move_to(bench.empty_place());
    bench.settle();
    assert_eq!(icon(&bench), CursorIcon::Default);
}
