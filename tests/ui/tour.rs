//! The tour in the window: every step done with the mouse and with the keyboard, at two sizes.

use crate::common::arm::ArmSession;
use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2, Rect, Vec2, pos2};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{SnapshotResults, try_image_snapshot_options};
use glam::{Quat, Vec3};
use ik_arm::document::Theme;
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::rig::LimbPart;
use ik_arm::session::{
    PlaybackAction, Preferences, SelectAction, SolverAction, TourAction, TourEnd, TourStep, filled,
};

use crate::bench::{Bench, LARGE, SMALL, snapshot_options};
use crate::common::all_cases;
use crate::looks::has_tooltip;

const LEFT: PointerButton = PointerButton::Primary;
const SIZES: [Vec2; 2] = [LARGE, SMALL];
const THEMES: [Theme; 2] = [Theme::Dark, Theme::Light];

/// In a step of the tour, counted from 1, as at the first start of the program.
fn in_step(number: usize, size: Vec2, theme: Theme) -> Bench {
    let mut bench = Bench::first(size, Preferences { theme, ..Preferences::default() });
    bench.apply([TourAction::Enter(number - 1)]);
    bench
}

fn step(number: usize) -> &'static TourStep {
    &TourStep::all()[number - 1]
}

fn is_done(bench: &Bench, number: usize) -> bool {
    bench.session().tour().is_some_and(|tour| tour.is_done(number - 1) && tour.shows_result())
}

/// The answer to the step's question, as the card marks a guess.
fn mark(step: &TourStep, guess: usize) -> String {
    let mark = if step.guess.is_right(guess) { "Right" } else { "Not quite" };
    format!("{mark}: {}", step.guess.right_answer())
}

/// Moves the mouse through points with the button down, and releases it.
fn drag_through(bench: &mut Bench, points: impl IntoIterator<Item = Pos2>) {
    let mut points = points.into_iter();
    bench.move_to(points.next().expect("a start"));
    bench.press(LEFT);
    points.for_each(|at| bench.move_to(at));
    bench.release(LEFT);
    bench.settle();
}

/// Points from one to the other, both included.
fn line(from: Pos2, to: Pos2, steps: u16) -> impl Iterator<Item = Pos2> {
    (0..=steps).map(move |step| from + (to - from) * f32::from(step) / f32::from(steps))
}

/// Scrolls the left panel until a slider is in sight.
fn reveal(bench: &mut Bench, slider: &str) {
    let bottom = bench.rect(Role::Button, "Back").bottom();
    for _ in 0..20 {
        let rail = bench.rect(Role::Slider, slider);
        if rail.bottom() < bottom {
            return;
        }
        bench.move_to(pos2(rail.center().x, bottom - 60.0));
        bench.wheel(-2.0);
        bench.settle();
    }
    panic!("{slider} cannot be scrolled to");
}

/// Drags along a slider's rail between two parts of its length.
fn drag_rail(bench: &mut Bench, slider: &str, from: f32, to: f32) {
    reveal(bench, slider);
    let rail = bench.rect(Role::Slider, slider);
    let at = |part: f32| pos2(rail.left() + rail.width() * part, rail.center().y);
    drag_through(bench, line(at(from), at(to), 60));
}

/// Does the task of a step as its text says, with the mouse.
fn do_with_the_mouse(bench: &mut Bench, number: usize) {
    let limb = bench.session().limb().map(|limb| limb.frames);
    let hand = limb.as_ref().map_or(Vec3::ZERO, |limb| limb.origin(LimbPart::Cursor));
    let on_screen = |bench: &Bench, point: Vec3| bench.on_screen(point);
    match number {
        1 => {
            let along = on_screen(bench, hand + Vec3::X * 40.0) - on_screen(bench, hand);
            let arrow = on_screen(bench, hand) + along.normalized() * 62.0;
            let over = on_screen(bench, hand - Vec3::X * 330.0) - on_screen(bench, hand);
            drag_through(bench, line(arrow, arrow + over, 60));
        }
        2 => {
            bench.click(Role::Button, "FK");
            drag_rail(bench, "Elbow bend", 0.7, 0.2);
        }
        3 => {
            let from = on_screen(bench, hand);
            let away = from - on_screen(bench, Vec3::ZERO);
            drag_through(bench, line(from, from + away * 0.6, 80));
        }
        4 => {
            let pose = bench.session().pose();
            let axis = pose.pointer.direction;
            let centre = axis * pose.along;
            let turned = |part: f32| {
                let angle = part * 120.0_f32.to_radians();
                centre + Quat::from_axis_angle(axis, angle) * (pose.elbow - centre)
            };
            let points: Vec<_> =
                (0..=30).map(|at| on_screen(bench, turned(at as f32 / 30.0))).collect();
            drag_through(bench, points);
        }
        5 => {
            reveal(bench, "Lower length");
            let rail = bench.rect(Role::Slider, "Lower length");
            let start = rail.center();
            bench.move_to(start);
            bench.press(LEFT);
            for pixel in 0..(rail.width() as u16) {
                let lower = bench.session().arm().bones.lower();
                let way = if lower > 200.0 { -1.0 } else { 1.0 };
                if (lower - 200.0).abs() < 4.0 {
                    break;
                }
                let step = f32::from(pixel) * 0.5 * way;
                bench.move_to(start + Vec2::new(step, 0.0));
            }
            bench.release(LEFT);
            bench.settle();
        }
        6 => {
            let from = on_screen(bench, hand);
            let away = from - on_screen(bench, Vec3::ZERO);
            drag_through(bench, line(from, from + away * 1.6, 40));
        }
        7 => drag_rail(bench, "Softness", 0.0, 0.6),
        8 => {
            for reference in ["Pole", "Stereographic", "Transport"] {
                bench.click(Role::ComboBox, "Twist reference");
                bench.click(Role::Button, reference);
            }
        }
        9 => {
            bench.click(Role::CheckBox, "Pinned to world");
            let root = on_screen(bench, bench.session().arm().root);
            drag_through(bench, line(root, root + Vec2::new(-30.0, -30.0), 20));
        }
        10 => {
            bench.key(Key::Space);
            bench.wait(0.3);
            bench.click_at(bench.rect(Role::Button, "IK").center());
            bench.wait(0.2);
        }
        11 => {
            bench.click_at(bench.rect(Role::Button, "Race all solvers").center());
            bench.wait(8.0);
        }
        12 => {
            let pelvis = bench.session().skeleton_pose().tip(JointId::new(0));
            let from = on_screen(bench, pelvis);
            drag_through(bench, line(from, from - Vec2::new(0.0, 60.0), 20));
        }
        _ => {
            let from = on_screen(bench, hand);
            let across = on_screen(bench, hand + Vec3::X * 0.1) - from;
            drag_through(bench, line(from, from + across * 6.5, 30));
        }
    }
}

#[test]
fn every_step_notices_its_task_done_with_the_mouse() {
    let looks = SIZES.into_iter().flat_map(|size| THEMES.map(|theme| (size, theme)));
    // Every other look has each size and each theme.
    let looks =
        looks.filter(|(size, theme)| all_cases() || (*size == LARGE) == (*theme == Theme::Dark));
    for (size, theme) in looks {
        for (number, step) in (1..).zip(TourStep::all()) {
            let mut bench = in_step(number, size, theme);
            bench.click(Role::Button, step.guess.answers[0]);
            assert!(!is_done(&bench, number), "a guess is not the task of step {number}");
            do_with_the_mouse(&mut bench, number);
            assert!(is_done(&bench, number), "step {number} at {size:?}");
            assert!(bench.says("What happened"), "step {number}");
            assert!(bench.says(&mark(step, 0)), "step {number}");
        }
    }
}

/// Gives the focus to a widget and presses keys.
fn press_keys(bench: &mut Bench, role: Role, name: &str, keys: &[Key]) {
    bench.focus(role, name);
    keys.iter().for_each(|key| bench.key(*key));
}

fn enter_number(bench: &mut Bench, name: &str, text: &str) {
    bench.focus(Role::SpinButton, name);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.type_text(text);
    bench.key(Key::Enter);
    bench.settle();
}

#[test]
fn every_step_notices_its_task_done_without_a_mouse() {
    for (number, step) in (1..).zip(TourStep::all()) {
        let mut bench = in_step(number, SMALL, Theme::Dark);
        press_keys(&mut bench, Role::Button, step.guess.answers[1], &[Key::Space]);
        assert!(bench.says("Now try it"), "step {number}");
        match number {
            1 => press_keys(&mut bench, Role::Slider, "Hand x", &[Key::PageDown; 36]),
            2 => {
                press_keys(&mut bench, Role::Button, "FK", &[Key::Space]);
                press_keys(&mut bench, Role::Slider, "Elbow bend", &[Key::PageDown; 4]);
            }
            3 => press_keys(&mut bench, Role::Slider, "Hand x", &[Key::PageUp; 9]),
            4 => press_keys(&mut bench, Role::Slider, "Socket twist", &[Key::PageUp; 10]),
            5 => enter_number(&mut bench, "Lower length value", "200"),
            6 => press_keys(&mut bench, Role::Slider, "Hand x", &[Key::PageUp; 30]),
            7 => enter_number(&mut bench, "Softness value", "0.1"),
            8 => {
                press_keys(&mut bench, Role::ComboBox, "Twist reference", &[Key::Space]);
                press_keys(&mut bench, Role::Button, "Transport", &[Key::Enter]);
            }
            9 => {
                press_keys(&mut bench, Role::CheckBox, "Pinned to world", &[Key::Space]);
                press_keys(&mut bench, Role::Slider, "Root x", &[Key::PageUp; 4]);
            }
            10 => {
                press_keys(&mut bench, Role::Button, "IK", &[Key::Space]);
                press_keys(&mut bench, Role::Button, "Play", &[Key::Space]);
                bench.wait(0.1);
            }
            11 => {
                press_keys(&mut bench, Role::Button, "Race all solvers", &[Key::Space]);
                bench.wait(8.0);
            }
            12 => press_keys(&mut bench, Role::Slider, "Skeleton y", &[Key::PageUp; 4]),
            _ => press_keys(&mut bench, Role::Slider, "Target x", &[Key::PageUp; 7]),
        }
        assert!(is_done(&bench, number), "step {number}");
    }
}

/// The part of the window that the card of a step takes.
fn card(bench: &Bench) -> Rect {
    let (view, next) = (bench.viewport(), bench.rect(Role::Button, next(bench)));
    Rect::from_min_max(view.left_bottom(), pos2(view.right(), next.bottom() + 6.0))
}

fn next(bench: &Bench) -> &'static str {
    if bench.shows(Role::Button, "Finish") { "Finish" } else { "Next" }
}

/// Expects that texts of the card are above its lower row of buttons, not scrolled out of sight.
fn expect_in_sight<'a>(bench: &Bench, texts: impl IntoIterator<Item = &'a str>) {
    let row = bench.rect(Role::Button, "Back").top() - 4.0;
    let top = bench.rect(Role::Button, "Leave").bottom();
    for text in texts {
        let mut nodes = bench.harness.query_all_by_label_contains(text);
        let is_in_sight =
            nodes.any(|node| node.rect().top() >= top - 4.0 && node.rect().bottom() <= row);
        assert!(is_in_sight, "{text}");
    }
}

/// The text with the scene's numbers, as a screen reader has it.
fn said(bench: &Bench, text: &str) -> String {
    filled(text, bench.session()).replace('*', "")
}

#[test]
fn cards_show_all_of_their_text_at_every_stage() {
    for size in SIZES {
        for (number, step) in (1..).zip(TourStep::all()) {
            let mut bench = in_step(number, size, Theme::Dark);
            let text = said(&bench, step.text);
            let question = [text.as_str(), "Guess first", step.guess.question];
            let answers = step.guess.answers.iter().copied();
            expect_in_sight(&bench, question.into_iter().chain(answers));

            bench.click(Role::Button, step.guess.answers[0]);
            let (task, keyboard) = (said(&bench, step.task), step.keyboard.replace('*', ""));
            expect_in_sight(&bench, [&text, "Now try it", &task, "Do it for me", &keyboard]);

            bench.apply_moving([TourAction::Demonstrate]);
            bench.wait(if number == 11 { 8.0 } else { 0.1 });
            let result = said(&bench, step.result);
            expect_in_sight(&bench, ["What happened", &result, &mark(step, 0)]);
            let height = bench.viewport().height();
            assert!(height > 220.0, "room for the scene of step {number}: {height}");
        }
        let bench = in_step(TourStep::all().len() + 1, size, Theme::Dark);
        let TourEnd { title, sentences, next } = TourEnd::get();
        assert!(bench.says(title));
        let texts = sentences.iter().chain([next]).map(|text| text.replace('*', ""));
        let texts: Vec<_> = texts.collect();
        expect_in_sight(&bench, texts.iter().map(String::as_str));
    }
}

#[test]
fn cards_look_as_they_did() {
    let mut results = SnapshotResults::new();
    for theme in THEMES {
        for (size, width) in [(LARGE, "large"), (SMALL, "small")] {
            for number in 1..=TourStep::all().len() + 1 {
                let mut bench = in_step(number, size, theme);
                // The question, the task and the result in turn.
                if number <= TourStep::all().len() && number % 3 != 1 {
                    bench.click(Role::Button, step(number).guess.answers[0]);
                }
                if number % 3 == 0 {
                    bench.apply_moving([TourAction::Demonstrate]);
                    bench.wait(0.1);
                }
                let theme = format!("{theme:?}").to_lowercase();
                let name = format!("tour/{number:02}_{width}_{theme}");
                let options = snapshot_options(200);
                results.add(try_image_snapshot_options(&picture(&mut bench), name, &options));
            }
        }
    }
}

/// The card's part of the window's picture.
fn picture(bench: &mut Bench) -> image::RgbaImage {
    let card = card(bench);
    let window = bench.harness.render().expect("a picture");
    let [x, y] = [card.left() as u32, card.top() as u32];
    let (width, height) = (card.width() as u32, card.height() as u32);
    image::imageops::crop_imm(&window, x, y, width, height).to_image()
}

#[test]
fn the_card_leads_through_the_steps_and_back_to_the_own_document() {
    let mut bench = Bench::first(LARGE, Preferences::default());
    bench.apply([SelectAction::Joints(Vec::new())]);
    let before = bench.session().document().clone();
    bench.click(Role::Button, "Take the tour");
    for (number, step) in (1..).zip(TourStep::all()) {
        assert_eq!(bench.session().tour().map(|tour| tour.number() + 1), Some(number));
        assert!(bench.says(step.title));
        for name in ["Back", next(&bench), "Leave"] {
            let is_first = number == 1 && name == "Back";
            assert!(is_first || has_tooltip(&mut bench, Role::Button, name), "{name}");
        }
        let name = next(&bench);
        bench.click(Role::Button, name);
    }
    assert!(bench.says(TourEnd::get().title));
    bench.click(Role::Button, "Back");
    assert!(bench.says(step(TourStep::all().len()).title));
    bench.click(Role::Button, "Next");
    bench.click(Role::Button, "Finish");
    assert!(bench.session().tour().is_none());
    assert_eq!(*bench.session().document(), before);
    assert!(!bench.shows(Role::Button, "Take the tour"), "it is not offered again");
}

#[test]
fn any_step_can_be_entered_from_its_dot_and_left() {
    let mut bench = in_step(1, SMALL, Theme::Light);
    let dot = format!("Step 7: {}", step(7).title);
    assert!(has_tooltip(&mut bench, Role::Button, &dot));
    bench.click(Role::Button, &dot);
    assert!(bench.says("The limbs are 200.0 mm and 300.0 mm long"));
    assert!(bench.shows(Role::Slider, "Softness"), "the section of the step is open");
    bench.click(Role::Button, "Back");
    assert!(bench.says(step(6).title));
    bench.click(Role::Button, "Leave");
    assert!(bench.session().tour().is_none());
    bench.choose(&["Help", "Tour"]);
    assert!(bench.says(step(1).title));
}

#[test]
fn each_guess_is_marked_right_or_not_quite_with_the_right_answer() {
    for (guess, said) in
        [(0, "Not quite: It vanishes"), (1, "Not quite: It vanishes"), (2, "Right: It vanishes")]
    {
        let mut bench = in_step(5, SMALL, Theme::Dark);
        bench.click(Role::Button, step(5).guess.answers[guess]);
        assert!(!bench.says("It vanishes"), "the answer comes after the task");
        do_with_the_mouse(&mut bench, 5);
        assert!(bench.says(said), "{said}");
    }
    let mut bench = in_step(5, SMALL, Theme::Dark);
    do_with_the_mouse(&mut bench, 5);
    assert!(bench.says("Answer: It vanishes"), "without a guess");
}

#[test]
fn the_two_poses_of_nearly_straight_are_shown_after_the_guess() {
    let mut bench = in_step(7, LARGE, Theme::Dark);
    assert!(!bench.says("Nearly straight: hand"));
    bench.click(Role::Button, step(7).guess.answers[2]);
    do_with_the_mouse(&mut bench, 7);
    assert!(bench.says("Nearly straight: hand"));
}

#[test]
fn sections_that_the_tour_opened_close_again_when_it_ends() {
    let mut bench = Bench::first(LARGE, Preferences::default());
    bench.toggle(&["Limb", "Root"]);
    let shown = |bench: &Bench| {
        ["Softness", "Upper length", "Root x"].map(|slider| bench.shows(Role::Slider, slider))
    };
    assert_eq!(shown(&bench), [false, false, true]);
    for number in [5, 7, 9, 12] {
        bench.apply([TourAction::Enter(number - 1)]);
    }
    bench.apply([TourAction::Enter(8)]);
    assert_eq!(shown(&bench), [true, true, true]);
    bench.click(Role::Button, "Leave");
    assert_eq!(shown(&bench), [false, false, true], "only what the tour opened");
    bench.toggle(&["Lengths"]);
    bench.choose(&["Help", "Tour"]);
    bench.click(Role::Button, "Leave");
    assert_eq!(shown(&bench), [false, true, true], "what the user opened later stays open");
}

#[test]
fn the_offer_goes_for_good_when_it_is_declined() {
    for size in SIZES {
        let mut bench = Bench::first(size, Preferences::default());
        let take = bench.rect(Role::Button, "Take the tour");
        assert!(bench.viewport().contains_rect(take));
        for name in ["Take the tour", "Just play"] {
            assert!(has_tooltip(&mut bench, Role::Button, name), "{name}");
        }
        bench.click(Role::Button, "Just play");
        assert!(!bench.shows(Role::Button, "Take the tour"));
        let again = Bench::first(size, *bench.session().preferences());
        assert!(!again.shows(Role::Button, "Take the tour"));
    }
}

#[test]
fn do_it_for_me_shows_the_result_without_a_mouse() {
    let mut bench = in_step(5, SMALL, Theme::Dark);
    bench.click(Role::Button, step(5).guess.answers[2]);
    assert!(has_tooltip(&mut bench, Role::Button, "Do it for me"));
    bench.click(Role::Button, "Do it for me");
    assert!(
        bench.says(
            "It vanished: the nearest distance, the difference of the lengths, is now 0.0 mm."
        )
    );
    assert!(!is_done(&bench, 5), "the dot of the step stays empty");
}

#[test]
fn a_run_of_one_solver_is_no_race() {
    let mut bench = in_step(11, LARGE, Theme::Dark);
    bench.apply_moving([SolverAction::Run(true)]);
    bench.wait(3.0);
    assert!(!is_done(&bench, 11));
    bench.apply([SolverAction::Reset]);
    bench.apply([PlaybackAction::Play(false)]);
}

#[test]
fn tab_reaches_the_whole_card_in_reading_order() {
    let mut bench = in_step(1, SMALL, Theme::Dark);
    let mut visited = Vec::new();
    for _ in 0..80 {
        bench.key(Key::Tab);
        bench.settle();
        let focused = bench.focused().expect("something has the focus");
        if visited.first() == Some(&focused) {
            break;
        }
        visited.push(focused);
    }
    let step = step(1);
    let answers = step.guess.answers.iter().copied();
    let dot = format!("Step 1: {}", step.title);
    let card: Vec<&str> = ["Leave"].into_iter().chain(answers).chain([&dot, "Next"]).collect();
    let places: Vec<_> =
        card.iter().map(|name| visited.iter().position(|(_, it)| it == name)).collect();
    assert!(places.iter().all(Option::is_some), "{card:?} in {visited:?}");
    assert!(places.is_sorted(), "{card:?} in {visited:?}");
}
