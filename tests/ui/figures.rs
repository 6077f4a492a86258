//! The arm's figures and formulas: their numbers, and the lines that light up in the view.

use core::f32::consts::PI;

use crate::common::arm::{ArmEdit, ArmSession};
use egui::accesskit::Role;
use egui::{Pos2, Rect, Vec2, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::Vec3;
use ik_arm::document::{Camera, Overlay};
use ik_arm::session::{LimbFigure, PanelTab, SelectAction, ViewAction};

use crate::bench::{Bench, SMALL};
use crate::common::all_cases;

/// The rows of the page, with what they light up.
const ROWS: [(&str, LimbFigure); 18] = [
    ("Root", LimbFigure::Root),
    ("Limb", LimbFigure::Limb),
    ("Socket", LimbFigure::Socket),
    ("Upper limb", LimbFigure::Upper),
    ("Lower limb", LimbFigure::Lower),
    ("Yaw theta z", LimbFigure::Yaw),
    ("Level h c", LimbFigure::Level),
    ("Pitch theta y", LimbFigure::Pitch),
    ("Distance D", LimbFigure::Distance),
    ("Upper d 1", LimbFigure::Upper),
    ("Lower d 2", LimbFigure::Lower),
    ("Along h e", LimbFigure::Along),
    ("Height o e", LimbFigure::Out),
    ("Shoulder theta e", LimbFigure::ShoulderAngle),
    ("Elbow angle phi", LimbFigure::ElbowAngle),
    ("Cursor c", LimbFigure::Cursor),
    ("Elbow in Socket", LimbFigure::Out),
    ("Elbow e", LimbFigure::Elbow),
];

fn hover(bench: &mut Bench, at: Pos2) -> Option<LimbFigure> {
    bench.move_to(at);
    bench.settle();
    bench.session().selection().figure()
}

/// Scrolls to the row of a name on the right side of the window, and returns the name's rectangle.
fn row(bench: &mut Bench, name: &str) -> Rect {
    let find = |bench: &Bench| {
        let right = bench.viewport().right();
        let names = bench.harness.query_all_by_role_and_label(Role::Label, name);
        names.map(|node| node.rect()).find(|rect| rect.left() > right).expect("a row")
    };
    for _ in 0..40 {
        let rect = find(bench);
        if rect.bottom() < bench.viewport().bottom() - 8.0 {
            return rect;
        }
        bench.move_to(Pos2::new(rect.center().x, bench.viewport().center().y));
        bench.wheel(-3.0);
        bench.settle();
    }
    panic!("{name} cannot be scrolled to");
}

#[test]
fn the_page_of_a_figure_names_its_limb_and_chooses_another_one() {
    let mut bench = Bench::example("human");
    bench.show_tab(PanelTab::Triangle);
    assert!(bench.says("Select a joint of another limb"));
    let bones = |bench: &Bench| bench.session().limb_of_page().is_some();
    assert!(bones(&bench));
    bench.apply([SelectAction::Joints(vec![bench.joint("head")])]);
    assert!(bench.says("head belongs to no limb. This page shows the one named above."));
    assert!(bench.says("Law of cosines") && bones(&bench), "the page is not empty");
    bench.click(Role::ComboBox, "Limb");
    // The list of targets has buttons of these names, too.
    let items = bench.harness.get_all_by_role_and_label(Role::Button, "right_foot");
    let item = items.map(|item| item.rect()).max_by(|a, b| a.left().total_cmp(&b.left()));
    bench.click_at(item.expect("an item").center());
    bench.settle();
    assert_eq!(bench.session().selection().active(), Some(bench.joint("right_foot")));
    assert!(bench.says("The limb of the selected joint") && bench.says("Law of cosines"));
    assert!(bones(&bench));
    let limb = bench.session().limb().expect("a limb");
    assert_eq!(limb.target, bench.joint("right_shin"));
}

#[test]
fn every_row_lights_up_what_it_is_about_while_the_mouse_is_over_it() {
    for mut bench in [Bench::new(), Bench::of_size(SMALL)] {
        bench.unfold_formulas();
        let mut seen = Vec::new();
        for (name, figure) in ROWS {
            let at = row(&mut bench, name).center();
            assert_eq!(hover(&mut bench, at), Some(figure), "{name}");
            assert_eq!(bench.session().overlays().figure, Some(figure), "{name}");
            seen.push(figure);
        }
        assert!(LimbFigure::ALL.iter().all(|figure| seen.contains(figure)), "{seen:?}");
        let away = bench.empty_point();
        assert_eq!(hover(&mut bench, away), None);
    }
}

#[test]
fn the_value_at_the_end_of_a_row_lights_up_the_same_thing() {
    let mut bench = Bench::new();
    bench.unfold_formulas();
    let row = row(&mut bench, "Pitch theta y");
    let value = Pos2::new(bench.harness.ctx.content_rect().right() - 40.0, row.center().y);
    assert_eq!(hover(&mut bench, value), Some(LimbFigure::Pitch));
}

#[test]
fn the_sides_of_the_triangle_light_up_the_limbs() {
    let mut bench = Bench::after([ArmEdit::SetHand(Vec3::new(360.0, 0.0, 0.0))]);
    let grid = if all_cases() { (40, 60) } else { (20, 30) };
    let seen: Vec<LimbFigure> = pointed(&mut bench, grid).into_iter().map(|it| it.0).collect();
    for figure in [
        LimbFigure::Upper,
        LimbFigure::Lower,
        LimbFigure::Distance,
        LimbFigure::Along,
        LimbFigure::Out,
        LimbFigure::ShoulderAngle,
        LimbFigure::ElbowAngle,
    ] {
        assert!(seen.contains(&figure), "{figure:?} in {seen:?}");
    }
}

#[test]
fn hand_and_elbow_are_on_the_sides_of_the_triangle_where_the_view_shows_them() {
    for (yaw, is_right) in [(0.2, true), (0.2 + PI, false)] {
        for (twist, is_above) in [(0.0, true), (PI, false)] {
            let hand = Vec3::new(360.0, 0.0, 0.0);
            let mut bench = Bench::after([ArmEdit::SetHand(hand), ArmEdit::SetTwist(twist)]);
            bench.apply([ViewAction::SetCamera(Camera { yaw, ..Camera::default() })]);
            let points = pointed(&mut bench, (10, 16));
            let middle = |figure: LimbFigure| {
                let own = points.iter().filter(|it| it.0 == figure).map(|it| it.1.to_vec2());
                own.clone().fold(Vec2::ZERO, |sum, it| sum + it) / own.count() as f32
            };
            let [upper, lower] = [LimbFigure::Upper, LimbFigure::Lower].map(middle);
            assert_eq!(lower.x > upper.x, is_right, "yaw {yaw}: {upper}, {lower}");
            let base = middle(LimbFigure::Distance);
            assert_eq!(upper.y < base.y, is_above, "twist {twist}: {upper}, {base}");
        }
    }
}

/// What lights up at places all over the triangle's drawing, in columns and rows.
fn pointed(bench: &mut Bench, (columns, rows): (u8, u8)) -> Vec<(LimbFigure, Pos2)> {
    let panel = triangle(bench);
    let mut seen = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let part = vec2(column.into(), row.into()) / vec2(columns.into(), rows.into());
            let at = panel.lerp_inside(part);
            bench.move_to(at);
            bench.frame([]);
            seen.extend(bench.session().selection().figure().map(|figure| (figure, at)));
        }
    }
    seen
}

/// The rectangle of the triangle's drawing.
fn triangle(bench: &Bench) -> Rect {
    let name = "Triangle: upper limb 200.0, lower limb 300.0, distance 360.0, angle at the shoulder \
                56.4 degrees, angle at the elbow 89.8 degrees";
    bench.rect(Role::Image, name)
}

#[test]
fn both_right_triangles_light_up_level_yaw_and_pitch() {
    let mut bench = Bench::after([ArmEdit::SetHand(Vec3::new(250.0, 150.0, 200.0))]);
    bench.unfold_formulas();
    let name =
        "Cursor from above: x 250.0, z 200.0, level 320.2; from the side: level 320.2, y 150.0";
    bench.reveal(Role::Image, name);
    let drawing = bench.rect(Role::Image, name);
    let mut seen = [Vec::new(), Vec::new()];
    let (columns, rows) = if all_cases() { (60, 40) } else { (30, 20) };
    for column in 0..columns {
        for row in 0..rows {
            let part = vec2(column as f32, row as f32) / vec2(columns as f32, rows as f32);
            bench.move_to(drawing.lerp_inside(part));
            bench.frame([]);
            let half = usize::from(2 * column >= columns);
            seen[half].extend(bench.session().selection().figure());
        }
    }
    for (half, figures) in [
        [LimbFigure::Level, LimbFigure::Yaw, LimbFigure::Cursor],
        [LimbFigure::Distance, LimbFigure::Pitch, LimbFigure::Cursor],
    ]
    .iter()
    .enumerate()
    {
        for figure in figures {
            assert!(seen[half].contains(figure), "{figure:?}");
        }
    }
}

#[test]
fn another_page_and_a_closed_panel_light_nothing_up() {
    let mut bench = Bench::new();
    let at = row(&mut bench, "Root").center();
    assert_eq!(hover(&mut bench, at), Some(LimbFigure::Root));
    bench.show_tab(PanelTab::Reach);
    assert_eq!(bench.session().selection().figure(), None);
    bench.show_tab(PanelTab::Triangle);
    assert_eq!(hover(&mut bench, at), Some(LimbFigure::Root));
    bench.choose(&["View", "Explain panel"]);
    assert_eq!(bench.session().selection().figure(), None);
}

#[test]
fn the_hierarchy_shows_the_axes_of_its_frames_in_the_view() {
    let mut bench = Bench::new();
    bench.click(Role::CheckBox, "Axes in the view");
    assert!(bench.session().document().display.shows(Overlay::Frames));
    bench.click(Role::CheckBox, "Axes in the view");
    assert!(!bench.session().document().display.shows(Overlay::Frames));
}

#[test]
fn the_law_of_cosines_is_filled_in_with_the_lengths_of_the_pose() {
    // A triangle of the sides 200, 300 and 400.
    let mut bench = Bench::after([ArmEdit::SetHand(Vec3::new(240.0, 0.0, 320.0))]);
    bench.unfold_formulas();
    let cosine =
        (200.0_f64.powi(2) + 400.0_f64.powi(2) - 300.0_f64.powi(2)) / (2.0 * 200.0 * 400.0);
    let angle = cosine.acos().to_degrees();
    for line in [
        "d 2² = d 1² + D² − 2 d 1 D cos theta e".to_owned(),
        "300.0² = 200.0² + 400.0² − 2 · 200.0 · 400.0 cos theta e".to_owned(),
        format!("cos theta e = {cosine:.4}, so theta e = {angle:.1}°"),
    ] {
        assert!(bench.shows(Role::Label, &line), "{line}");
    }
}

#[test]
fn the_error_of_the_cosine_grows_near_the_straight_arm_and_the_solvers_does_not() {
    for distance in [499.99_f32, 499.999, 100.001] {
        let mut bench = Bench::after([ArmEdit::SetHand(Vec3::new(distance, 0.0, 0.0))]);
        bench.unfold_formulas();
        let pose = bench.session().pose();
        let exact = {
            // Heron's formula in f64.
            let (a, b, c) = (200.0, f64::from(pose.distance), 300.0);
            let s = 0.5 * (a + b + c);
            2.0 * ((s - a) * (s - b)).sqrt().atan2((s * (s - c)).sqrt())
        };
        let d = pose.distance;
        let cosine = (200.0 * 200.0 + d * d - 300.0 * 300.0) / (2.0 * 200.0 * d);
        let errors = [cosine.clamp(-1.0, 1.0).acos(), pose.shoulder_angle()]
            .map(|angle| (f64::from(angle) - exact).abs().to_degrees() * 1e6);
        assert!(errors[0] > 20.0 * errors[1], "{distance}: {errors:?}");
        for error in errors {
            let text = format!("{error:.1}");
            assert!(bench.shows(Role::Label, &text), "{distance}: {text}");
        }
    }
}

#[test]
fn positions_are_those_of_the_pose_in_root_and_socket_space() {
    let hand = Vec3::new(240.0, 0.0, 320.0);
    let mut bench = Bench::after([ArmEdit::SetHand(hand)]);
    bench.unfold_formulas();
    let pose = bench.session().pose();
    let text = |point: Vec3| format!("({:.1}, {:.1}, {:.1})", point.x, point.y, point.z);
    for point in [hand, Vec3::new(pose.along, pose.out, 0.0), pose.elbow] {
        assert!(bench.says(&text(point)), "{point}");
    }
}
