//! Terms: underlined labels that explain themselves, and the glossary.

use egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use ik_arm::document::{Target, Theme};
use ik_arm::kinematics::chain_ik::{Method, SolverOptions};
use ik_arm::rig::TargetKind;
use ik_arm::session::{
    Action, FileAction, PanelTab, Preferences, SelectAction, SolverEdit, TargetEdit,
};

use crate::bench::{Bench, LARGE, SMALL};
use crate::common::documents::open_example;

/// Holds the mouse over a label until it explains its term, and follows *Show me* to a step.
fn show_me(bench: &mut Bench, label: &str, meaning: &str, step: usize) {
    let at = bench.harness.query_all_by_role_and_label(Role::Label, label).last();
    bench.move_to(at.expect("a label").rect().center());
    bench.frame([]);
    bench.wait(0.7);
    assert!(bench.says(meaning), "{label}");
    bench.click(Role::Link, "Show me");
    let tour = bench.session().tour().map(|tour| tour.number() + 1);
    assert_eq!(tour, Some(step), "{label}");
}

#[test]
fn a_term_of_the_arm_explains_itself_and_shows_its_step() {
    for (label, tab, meaning, step) in [
        ("Twist", None, "The angle by which the elbow is turned", 4),
        ("Reference", None, "The rule that says where on its circle", 8),
        ("Softness", None, "Lets the hand slow down", 7),
        ("Stretch", None, "Lets the limbs become longer", 6),
        ("Holonomy", Some(PanelTab::Twist), "The angle by which a transported elbow", 8),
        ("Gain", Some(PanelTab::Twist), "The degrees by which the elbow turns", 8),
    ] {
        let mut bench = Bench::first(LARGE, Preferences::default());
        bench.toggle(&["Limb", "Soft limits"]);
        tab.into_iter().for_each(|tab| bench.show_tab(tab));
        show_me(&mut bench, label, meaning, step);
    }
}

#[test]
fn a_term_of_the_solver_explains_itself_and_shows_its_step() {
    for (label, meaning) in [
        ("Damping λ", "Makes the solver damped least squares take"),
        ("Tolerance", "The distance from its target"),
        ("Error", "The largest distance from a tip"),
    ] {
        let mut bench = Bench::first(LARGE, Preferences::default());
        bench.apply([open_example("ten-joints")]);
        let solver = SolverOptions::new(Method::DampedLeastSquares);
        bench.apply([SolverEdit::SetSolver(solver)]);
        bench.show_tab(PanelTab::Solver);
        show_me(&mut bench, label, meaning, 11);
    }
    let mut bench = Bench::first(LARGE, Preferences::default());
    bench.apply([FileAction::NewFigure]);
    let lower = bench.joint("left_forearm");
    let target = bench.session().rig().targets[bench.session().rig().target(lower).expect("one")];
    let of_body = Target { kind: TargetKind::WholeBody, ..target };
    bench.apply([Action::from(TargetEdit::SetTarget(of_body))]);
    bench.apply([SelectAction::Joints(vec![lower])]);
    bench.reveal(Role::Slider, "IK influence");
    show_me(&mut bench, "Influence", "Blends two poses", 10);
}

#[test]
fn the_glossary_lists_every_term_with_its_meaning_and_its_step() {
    for size in [LARGE, SMALL] {
        let mut bench = Bench::first(size, Preferences::default());
        bench.choose(&["Help", "Glossary"]);
        for (term, meaning) in [
            ("Baking", "Writes the poses"),
            ("Cursor", "The target of the arm's hand"),
            ("Twist reference", "The rule that says where"),
        ] {
            assert!(bench.says(term) && bench.says(meaning), "{term}");
            assert!(bench.shows(Role::Link, &format!("Show me: {term}")));
        }
        bench.click(Role::Link, "Show me: Cursor");
        assert_eq!(bench.session().tour().map(|tour| tour.number() + 1), Some(6));
        bench.click(Role::Button, "Leave");
        assert_eq!(bench.session().shell().dialog(), None, "the glossary does not come back");
        bench.choose(&["Help", "Glossary"]);
        bench.click(Role::Button, "Close");
        assert_eq!(bench.session().shell().dialog(), None);
    }
}

#[test]
fn a_term_is_underlined_with_dots() {
    // Points from dot to dot.
    const SPACING: u32 = 4;
    let offers_tour = false;
    for theme in [Theme::Dark, Theme::Light] {
        let preferences = Preferences { offers_tour, theme, ..Preferences::default() };
        let mut bench = Bench::first(LARGE, preferences);
        let picture = bench.harness.render().expect("a picture");
        let rect = bench.rect(Role::Label, "Reference");
        let (left, right) = (rect.left().round() as u32, rect.right() as u32);
        // Right of the word, on the panel.
        let panel = *picture.get_pixel(left - 3, rect.center().y as u32);
        let differs = |x: u32, y: u32| *picture.get_pixel(x, y) != panel;
        let rows = rect.center().y as u32 + 4..rect.bottom() as u32 + 3;
        let is_dotted = |y: u32| {
            let dots = (left..right).step_by(SPACING as usize);
            dots.clone().all(|x| differs(x, y)) && dots.clone().all(|x| !differs(x + 2, y))
        };
        assert!(rows.into_iter().any(is_dotted), "{theme:?}: no dots under {rect:?}");
    }
}
