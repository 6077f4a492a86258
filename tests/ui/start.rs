//! The window at the first start: what is open, what is folded, and the hint to drag the hand.

use egui::PointerButton;
use egui::accesskit::Role;
use egui::vec2;
use ik_arm::io::Example;
use ik_arm::session::{FileAction, PanelTab, Preferences, SelectAction};

use crate::bench::{Bench, LARGE, SMALL};
use crate::looks::has_tooltip;

fn first_start() -> Bench {
    Bench::first(LARGE, Preferences::default())
}

#[test]
fn hand_twist_and_guides_are_open_and_all_else_is_folded() {
    let mut bench = first_start();
    for slider in ["Hand x", "Hand y", "Hand z", "Socket twist"] {
        assert!(bench.shows(Role::Slider, slider), "{slider}");
    }
    for guide in ["Cursor", "Pointer", "Inner limit", "Outer limit"] {
        assert!(bench.shows(Role::CheckBox, guide), "{guide}");
    }
    for (role, folded) in [
        (Role::Slider, "Root x"),
        (Role::Slider, "Upper length"),
        (Role::Slider, "IK influence"),
        (Role::Slider, "Softness"),
        (Role::CheckBox, "XY grid"),
    ] {
        assert!(!bench.shows(role, folded), "{folded}");
    }
    for section in ["Limb", "Skin", "Display"] {
        assert!(bench.says(section), "{section}");
    }
    bench.toggle(&["Limb"]);
    for section in ["Root", "Lengths", "FK and IK", "Soft limits", "Hand orientation"] {
        assert!(bench.says(section), "{section}");
    }
}

#[test]
fn the_hint_beside_the_hand_goes_for_good_when_the_hand_is_dragged() {
    for size in [LARGE, SMALL] {
        let mut bench = Bench::first(size, Preferences::default());
        let hint = bench.rect(Role::Label, "Drag the hand");
        assert!(bench.viewport().contains_rect(hint), "{hint:?}");
        let hand = bench.cursor_on_screen();
        assert!(!hint.contains(hand), "the hint does not cover the hand");

        bench.click_at(hand);
        bench.settle();
        assert!(bench.shows(Role::Label, "Drag the hand"), "a click is no drag");

        let slow = bench.cursor_on_screen();
        bench.drag_and_drop(PointerButton::Primary, slow, slow + vec2(30.0, -20.0));
        bench.settle();
        assert!(!bench.shows(Role::Label, "Drag the hand"));
        let preferences = *bench.session().preferences();
        let again = Bench::first(size, preferences);
        assert!(!again.shows(Role::Label, "Drag the hand"), "nor at the next start");
    }
}

#[test]
fn a_press_on_the_hint_moves_the_view_as_beside_it() {
    let mut bench = first_start();
    let hint = bench.rect(Role::Label, "Drag the hand").center();
    let before = *bench.session().camera();
    bench.drag_and_drop(PointerButton::Primary, hint, hint + vec2(60.0, 0.0));
    bench.settle();
    assert_ne!(*bench.session().camera(), before);
}

#[test]
fn the_transport_bar_is_slim_until_there_are_keys_or_the_timeline_is_opened() {
    let mut bench = first_start();
    let roomy = bench.viewport().height();
    assert!(bench.shows(Role::Button, "Timeline") && !bench.shows(Role::Button, "Auto-key"));
    assert!(bench.says("No animation yet: add keys in the timeline"));
    bench.click(Role::Button, "Timeline");
    assert!(bench.shows(Role::Button, "Auto-key"));
    assert!(bench.viewport().height() < roomy - 80.0);
    bench.click(Role::Button, "Hide timeline");
    assert!(!bench.shows(Role::Button, "Auto-key"));

    let mut bench = first_start();
    bench.key(egui::Key::K);
    bench.settle();
    assert!(bench.shows(Role::Button, "Auto-key"), "a first key opens the timeline");
}

#[test]
fn a_drag_along_the_slim_bar_scrubs() {
    let mut bench = first_start();
    let ruler = bench.rect(Role::Slider, "Timeline ruler");
    let left = ruler.left_center() + vec2(16.0, 0.0);
    let right = ruler.right_center() - vec2(16.0, 0.0);
    bench.drag_and_drop(PointerButton::Primary, left, left + (right - left) * 0.5);
    bench.settle();
    let time = bench.session().playback().time();
    assert!((time - 4.0).abs() < 0.05, "half way through 8 s: {time}");
}

#[test]
fn each_tab_shows_its_page_and_the_choice_is_kept_for_each_rig() {
    let mut bench = first_start();
    for (tab, said) in [
        (PanelTab::Twist, "Holonomy"),
        (PanelTab::Reach, "Reach curve"),
        (PanelTab::Pops, "Drag the hand, or play"),
        (PanelTab::Solver, "Two limbs need no iterations"),
        (PanelTab::Triangle, "Elbow triangle"),
        (PanelTab::Pops, "Drag the hand, or play"),
    ] {
        bench.click(Role::Tab, tab.name());
        assert!(bench.says(said), "{said}");
        assert_eq!(bench.session().preferences().tab, tab);
        assert!(has_tooltip(&mut bench, Role::Tab, tab.name()), "{tab:?}");
    }
    bench.apply([FileAction::NewFigure]);
    bench.click(Role::Tab, "Race");
    assert!(bench.shows(Role::Button, "Race all solvers"));
    assert!(!bench.shows(Role::Tab, "Skin"));
    bench.click(Role::Tab, "Triangle");
    assert!(
        bench.shows(Role::ComboBox, "Limb") && bench.says("left_hand"),
        "the first limb of the Human"
    );
    bench.apply([FileAction::New]);
    assert_eq!(bench.session().preferences().tab, PanelTab::Triangle);
}

#[test]
fn a_page_that_is_no_longer_there_gives_way_to_the_first() {
    let mut bench = first_start();
    let candy = Example::find("candy-wrapper").expect("an example");
    bench.apply([FileAction::OpenExample(candy)]);
    bench.click(Role::Tab, "Skin");
    assert!(bench.says("cross-section of the skin"));
    let human = Example::find("human").expect("an example");
    bench.apply([FileAction::OpenExample(human)]);
    assert!(!bench.shows(Role::Tab, "Skin"));
    assert!(bench.says("Press Run to see how the error falls"), "the solver is shown instead");
}

#[test]
fn an_empty_plot_is_not_shown_but_a_sentence_that_tells_how_to_fill_it() {
    let mut bench = first_start();
    bench.show_tab(PanelTab::Pops);
    assert!(!bench.says("Elbow speed / Cursor speed"));
    bench.apply([FileAction::NewFigure]);
    bench.show_tab(PanelTab::Solver);
    assert!(bench.says("Press Run to see how the error falls"));
    assert!(!bench.shows(Role::Slider, "Iteration"));
    bench.show_tab(PanelTab::Race);
    assert!(bench.says("The race runs every solver"));
}

#[test]
fn the_status_bar_tells_what_the_mouse_does_here() {
    let mut bench = first_start();
    bench.move_to(bench.empty_point());
    bench.settle();
    for hint in ["left drag: orbit", "right drag: pan", "wheel: zoom"] {
        assert!(bench.shows(Role::Label, hint), "{hint}");
    }
    bench.move_to(bench.cursor_on_screen());
    bench.settle();
    assert!(bench.shows(Role::Label, "left drag: drag the target of hand"));
    bench.apply([FileAction::NewFigure]);
    bench.apply([SelectAction::Joints(Vec::new())]);
    assert!(bench.shows(Role::Label, "wheel: zoom"));
    assert!(!bench.says("Test adapter"), "the adapter is in the statistics");
}
