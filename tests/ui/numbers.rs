//! The numbers beside the rails: typed, shown, refused.

use crate::common::arm::{Arm, ArmEdit, ArmSession};
use core::f32::consts::TAU;

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::NodeT as _;
use glam::Vec3;
use ik_arm::session::PanelTab;

use crate::bench::{Bench, bits};
use crate::panel::SLIDERS;
use crate::sliders::{awkward, is_same_but, value};

fn values(arm: &Arm) -> [f32; 9] {
    SLIDERS.map(|slider| value(arm, slider))
}

#[test]
fn typed_values_may_go_beyond_the_thumbs_range() {
    for (slider, typed) in [
        ("Hand x", 4321.5),
        ("Hand y", -1000.25),
        ("Hand z", 0.125),
        ("Root z", -98765.0),
        ("Upper length", 2500.0),
        ("Lower length", 0.5),
    ] {
        let mut bench = Bench::new();
        let before = bench.session().arm();
        bench.enter(slider, &typed.to_string());
        let after = bench.session().arm();
        assert_eq!(value(&after, slider), typed, "{slider}");
        assert!(is_same_but(slider, &after, &before), "{slider}: {after:?}");
    }
}

#[test]
fn large_numbers_are_shown_rounded_and_kept_exactly() {
    for (number, shown) in [
        (-9_999.9, "-9999.9"),
        (9_999.96, "10000"),
        (-123_456.79, "-123457"),
        (-1.25e30, "-1.2e30"),
        (1e-20, "0.0"),
    ] {
        let mut bench = Bench::after([ArmEdit::SetHand(Vec3::new(number, 0.0, 0.0))]);
        bench.click(Role::SpinButton, "Hand x value");
        bench.key(Key::Enter);
        bench.settle();
        assert_eq!(bits(bench.hand()), bits(Vec3::new(number, 0.0, 0.0)));
        let value = bench.node(Role::SpinButton, "Hand x value").value();
        assert_eq!(value.as_deref(), Some(shown));
    }
}

#[test]
fn esc_leaves_a_typed_number_alone_and_forgets_it() {
    let mut bench = Bench::new();
    for key in [Key::Escape, Key::Enter] {
        bench.click(Role::SpinButton, "Hand x value");
        if key == Key::Escape {
            bench.type_text("77");
        }
        bench.key(key);
        bench.settle();
        assert_eq!(&bench.session().arm(), &Arm::default(), "{key:?}");
        bench.wait(1.0);
    }
}

#[test]
fn text_that_is_not_a_number_is_ignored() {
    let mut bench = Bench::new();
    for typed in ["", "12x", "nan", "inf", "1e99", "3-"] {
        bench.enter("Hand x", typed);
        assert_eq!(&bench.session().arm(), &Arm::default(), "{typed}");
    }
}

#[test]
fn showing_a_value_or_focusing_its_field_does_not_change_it() {
    let mut bench = Bench::after(awkward());
    let before = bench.session().arm();
    bench.wait(0.5);
    assert_eq!(values(&bench.session().arm()).map(f32::to_bits), values(&before).map(f32::to_bits));
    for slider in SLIDERS {
        bench.focus(Role::SpinButton, &format!("{slider} value"));
        bench.key(Key::Tab);
        bench.settle();
        bench.click(Role::SpinButton, &format!("{slider} value"));
        bench.key(Key::Enter);
        bench.settle();
        assert_eq!(&bench.session().arm(), &before, "{slider}");
    }
}

#[test]
fn the_socket_twist_wraps() {
    let mut bench = Bench::new();
    for (typed, kept, shown) in [
        ("370", 10.0, 10.0),
        ("-10", 350.0, -10.0),
        ("725", 5.0, 5.0),
        ("360", 0.0, 0.0),
        ("90°", 90.0, 90.0),
        ("190", 190.0, -170.0),
        ("-180", 180.0, 180.0),
        ("-360", 0.0, 0.0),
    ] {
        bench.enter("Socket twist", typed);
        let twist = value(&bench.session().arm(), "Socket twist");
        assert!((twist - kept).abs() < 1e-3, "{typed} gives {twist}");
        assert!((0.0..TAU).contains(&bench.session().arm().twist));
        let number = bench.node(Role::Slider, "Socket twist").accesskit_node().numeric_value();
        let off = number.expect("a number") - shown;
        assert!(off.abs() < 1e-3, "{typed} is shown {off}° away from {shown}");
    }
    bench.focus(Role::Slider, "Socket twist");
    bench.key(Key::ArrowLeft);
    assert!((value(&bench.session().arm(), "Socket twist") - 359.0).abs() < 1e-3);
    bench.key(Key::PageUp);
    assert!((value(&bench.session().arm(), "Socket twist") - 9.0).abs() < 1e-3);
    assert_eq!(bits(bench.hand()), bits(Arm::default().cursor_in_root()));
}

#[test]
fn an_invalid_length_is_refused_with_a_message() {
    for slider in ["Upper length", "Lower length"] {
        for typed in ["0", "-5"] {
            let mut bench = Bench::new();
            bench.enter(slider, typed);
            assert_eq!(&bench.session().arm(), &Arm::default(), "{slider} {typed}");
            let message = format!("The length of a bone must be finite and above 0, got {typed}");
            assert_eq!(bench.session().shell().message(), Some(message.as_str()));
            assert!(bench.shows(Role::Alert, &message), "the status line says it");
            assert_eq!(
                bench.node(Role::SpinButton, &format!("{slider} value")).value(),
                Some(format!("{:.1}", value(&Arm::default(), slider)))
            );
        }
    }
}

#[test]
fn no_number_on_screen_is_infinite_or_the_largest_one() {
    let huge = [Vec3::splat(f32::MAX), Vec3::splat(1e38), Vec3::new(-3e38, 3e38, 1.0)];
    for hand in huge {
        let mut bench = Bench::new();
        bench.apply([ArmEdit::SetHand(hand), ArmEdit::SetRoot(-hand)]);
        bench.apply([ArmEdit::SetUpper(3e38), ArmEdit::SetLower(3e38)]);
        for tab in [PanelTab::Triangle, PanelTab::Twist, PanelTab::Reach, PanelTab::Pops] {
            bench.show_tab(tab);
            for node in bench.harness.root().children_recursive() {
                let node = node.accesskit_node();
                let texts = [node.label(), node.value()];
                for text in texts.into_iter().flatten() {
                    let words =
                        text.split(|it: char| !it.is_alphanumeric() && !".+-−".contains(it));
                    for word in words {
                        let is_bad = ["inf", "-inf", "+inf", "NaN"].contains(&word)
                            || word.contains("3.4e38")
                            || word.contains("e38") && word.contains("3.40")
                            || word.len() > 24 && word.bytes().all(|it| it.is_ascii_digit());
                        assert!(!is_bad, "{tab:?}, {:?}: {text}", node.role());
                    }
                }
            }
        }
    }
}
