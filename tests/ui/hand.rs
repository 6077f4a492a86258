//! The hand, dragged in the viewport.

use crate::common::arm::{ArmEdit, ArmSession, Step};
use egui::{CursorIcon, Key, PointerButton, Pos2, Vec2, pos2, vec2};
use glam::Vec3;
use ik_arm::document::{AxisView, Camera};
use ik_arm::kinematics::two_bone::Reach;
use ik_arm::session::{PointDrag, PointHandle, ViewAction};

use crate::bench::{Bench, SMALL, bits};

const LEFT: PointerButton = PointerButton::Primary;

/// A pose of awkward numbers, so that a changed bit shows.
pub fn awkward() -> Bench {
    Bench::after([
        ArmEdit::SetRoot(Vec3::new(12.345_679, -7.654_321, 33.333_332)),
        ArmEdit::SetHand(Vec3::new(223.456_79, 98.765_43, 71.234_57)),
    ])
}

/// Screen position at a fraction of an arrow of 80 points.
pub fn on_arrow(bench: &Bench, axis: usize, points: f32) -> Pos2 {
    bench.cursor_on_screen() + along(bench, axis) * points
}

fn on_square(bench: &Bench, axis: usize) -> Pos2 {
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|axis| along(bench, axis));
    bench.cursor_on_screen() + (u + v) * 33.0
}

/// An axis as it lies on screen, one point long where it is seen from the side.
fn along(bench: &Bench, axis: usize) -> Vec2 {
    let camera = bench.session().camera();
    let projection = camera.projection(bench.viewport().aspect_ratio());
    let [right, up] = [projection.right, projection.up].map(Vec3::normalize);
    let axis = Vec3::AXES[axis];
    vec2(axis.dot(right), -axis.dot(up))
}

pub fn grab(bench: &mut Bench, at: Pos2) {
    bench.move_to(at);
    bench.press(LEFT);
}

#[test]
fn the_hand_is_under_the_mouse_from_the_first_pixel_to_the_last_also_past_the_limits() {
    for mut bench in [Bench::new(), Bench::of_size(SMALL)] {
        let start = bench.cursor_on_screen();
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
            let seen = bench.cursor_on_screen();
            assert!(seen.distance(pointer) < 0.05, "{seen} is not under {pointer}");
            let pose = bench.session().pose();
            if pose.reach == Some(Reach::Reached) {
                let hand = bench.on_screen(bench.session().arm().root + pose.hand);
                assert!(hand.distance(pointer) < 0.05, "{hand} is not under {pointer}");
            } else {
                let cursor = bench.hand();
                let beside = pose.hand.cross(cursor).length() / cursor.length();
                assert!(beside < 0.01, "the arm points at the cursor");
            }
            reaches.extend(pose.reach);
        }
        assert_eq!(reaches[0], Reach::Reached);
        assert!(reaches.contains(&Reach::TooFar), "{reaches:?}");
        bench.release(LEFT);
        assert!(!bench.session().history().is_editing());
        let left = bench.hand();
        bench.move_to(start);
        assert_eq!(bench.hand(), left, "what is let go stays");
    }
}

#[test]
fn a_hand_grabbed_off_its_centre_keeps_its_distance_from_the_mouse() {
    let mut bench = Bench::new();
    let (start, beside) = (bench.cursor_on_screen(), vec2(7.0, -5.0));
    grab(&mut bench, start + beside);
    for offset in [Vec2::ZERO, vec2(1.0, 0.0), vec2(-50.0, 30.0)] {
        bench.move_to(start + beside + offset);
        assert!(bench.cursor_on_screen().distance(start + offset) < 0.05);
    }
}

#[test]
fn a_click_on_the_hand_changes_no_bit() {
    let mut bench = awkward();
    let before = bench.session().arm();
    let cursor = bench.cursor_on_screen();
    bench.click_at(cursor);
    assert_eq!(bits(bench.hand()), bits(before.cursor_in_root()));
    assert!(!bench.session().history().is_editing());
}

#[test]
fn a_press_and_its_release_in_one_frame_grab_nothing() {
    let mut bench = Bench::new();
    let cursor = bench.cursor_on_screen();
    bench.move_to(cursor);
    let events = [true, false].map(|down| bench.button(LEFT, down));
    bench.frame(events);
    assert!(!bench.session().history().is_editing());
    bench.move_to(cursor + vec2(100.0, 0.0));
    assert_eq!(bench.hand(), Vec3::new(250.0, 120.0, 60.0));
    bench.move_to(bench.empty_point());
    let events = [true, false].map(|down| bench.button(LEFT, down));
    bench.frame(events);
    bench.move_to(cursor);
    assert_eq!(bench.session().camera(), &Camera::default());
    assert!(bench.session().view().drag().is_none());
}

#[test]
fn a_press_and_a_move_in_one_frame_grab_the_pressed_handle_and_drag_it_at_once() {
    let mut bench = Bench::new();
    let cursor = bench.cursor_on_screen();
    bench.move_to(cursor);
    let to = cursor + vec2(90.0, -100.0);
    bench.frame([bench.button(LEFT, true), egui::Event::PointerMoved(to)]);
    assert!(bench.session().history().point_drag().is_some());
    assert!(bench.cursor_on_screen().distance(to) < 0.05);
}

#[test]
fn out_of_reach_both_the_hand_and_the_cursor_can_be_dragged() {
    let far = Vec3::new(500.0, 220.0, 300.0);
    for take_cursor in [true, false] {
        let mut bench = Bench::after([
            Step::from(ArmEdit::SetHand(far)),
            ViewAction::GlideTo(Camera { distance: 1800.0, ..Camera::default() }).into(),
        ]);
        let hand = bench.on_screen(bench.session().pose().hand);
        let start = if take_cursor { bench.cursor_on_screen() } else { hand };
        grab(&mut bench, start);
        for offset in [vec2(1.0, 1.0), vec2(8.0, -20.0), vec2(60.0, -90.0)] {
            bench.move_to(start + offset);
            let seen = bench.cursor_on_screen();
            assert!(seen.distance(start + offset) < 0.05, "{take_cursor}: {seen}");
        }
    }
}

#[test]
fn esc_and_the_right_button_cancel_a_drag() {
    for by_key in [true, false] {
        let mut bench = awkward();
        let before = bench.session().arm();
        let start = bench.cursor_on_screen();
        bench.drag(LEFT, start, start + vec2(120.0, 90.0));
        assert_ne!(&bench.session().arm(), &before);
        if by_key {
            bench.key(Key::Escape);
        } else {
            bench.press(PointerButton::Secondary);
        }
        assert_eq!(&bench.session().arm(), &before, "by key: {by_key}");
        assert!(!bench.session().history().is_editing());
        assert!(bench.says("Cancelled"));
        bench.move_to(start - vec2(50.0, 0.0));
        if !by_key {
            bench.release(PointerButton::Secondary);
        }
        bench.release(LEFT);
        bench.move_to(start);
        assert_eq!(&bench.session().arm(), &before);
        assert_eq!(bench.session().camera(), &Camera::default());
    }
}

#[test]
fn a_drag_over_a_panel_goes_on_and_can_be_cancelled_there() {
    let mut bench = awkward();
    let before = bench.session().arm();
    let start = bench.cursor_on_screen();
    let to = pos2(100.0, 300.0);
    bench.drag(LEFT, start, to);
    assert!(bench.cursor_on_screen().distance(to) < 0.05);
    bench.press(PointerButton::Secondary);
    assert_eq!(&bench.session().arm(), &before);
}

#[test]
fn an_arrow_moves_its_coordinate_and_no_other_bit() {
    for axis in 0..3 {
        let mut bench = awkward();
        let before = bench.hand();
        let grabbed = on_arrow(&bench, axis, 62.0);
        bench.move_to(grabbed);
        assert_eq!(bench.harness.output().platform_output.cursor_icon, CursorIcon::Grab);
        bench.press(LEFT);
        assert_eq!(
            bench.session().history().point_drag().map(PointDrag::handle),
            Some(PointHandle::Axis(axis))
        );
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
        let mut bench = awkward();
        let before = bench.hand();
        let grabbed = on_square(&bench, axis);
        let start = bench.cursor_on_screen();
        grab(&mut bench, grabbed);
        assert_eq!(
            bench.session().history().point_drag().map(PointDrag::handle),
            Some(PointHandle::Plane(axis))
        );
        for offset in [vec2(2.0, 1.0), vec2(25.0, -10.0), vec2(-20.0, 15.0)] {
            bench.move_to(grabbed + offset);
            for other in 0..3 {
                let kept = bits(bench.hand())[other] == bits(before)[other];
                assert_eq!(kept, other == axis, "{axis}: {before} to {}", bench.hand());
            }
            let seen = bench.cursor_on_screen();
            // The square is offset from the hand, so perspective has a small effect.
            assert!(seen.distance(start + offset) < 4.0, "{seen} for {}", start + offset);
        }
    }
}

#[test]
fn an_arrow_along_the_view_cannot_be_grabbed() {
    let mut bench = Bench::after([ViewAction::SetCamera(Camera::default().along(AxisView::Front))]);
    let cursor = bench.cursor_on_screen();
    bench.move_to(cursor + vec2(17.0, 12.0));
    bench.press(LEFT);
    assert!(
        bench.session().history().point_drag().is_none_or(|d| d.handle() != PointHandle::Axis(2))
    );
}

#[test]
fn the_mouse_cursor_shows_handles() {
    let mut bench = Bench::new();
    let icon = |bench: &Bench| bench.harness.output().platform_output.cursor_icon;
    let cursor = bench.cursor_on_screen();
    bench.move_to(cursor);
    assert_eq!(icon(&bench), CursorIcon::Grab);
    bench.press(LEFT);
    assert_eq!(icon(&bench), CursorIcon::Grabbing);
    bench.release(LEFT);
    bench.move_to(bench.empty_point());
    bench.settle();
    assert_eq!(icon(&bench), CursorIcon::Default);
}
