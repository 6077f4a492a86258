//! `ik-arm tour` and `ik-arm gui --tour`, as a person runs them.

use ik_arm::session::{TourEnd, TourStep};

use crate::run;

#[test]
fn the_whole_text_of_the_tour_is_printed_with_the_numbers_of_its_scenes() {
    let output = run(&["tour"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let text = str::from_utf8(&output.stdout).expect("UTF-8");
    for (number, step) in TourStep::all().iter().enumerate() {
        assert!(text.contains(&format!("{}. {}", number + 1, step.title)), "{}", step.title);
    }
    assert!(text.lines().all(|line| line.chars().count() <= 90), "lines fit into a terminal");
    assert!(!text.contains(['{', '}']), "every figure is filled in");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("cos φ = (upper² + lower² − distance²) / (2 · upper · lower)"));
    let answers = TourStep::all().iter().map(|step| step.guess.right_answer());
    for answer in answers {
        assert!(words.contains(&format!("Answer: {answer} What happens: ")), "{answer}");
    }
    for sentence in TourEnd::get().sentences {
        assert!(words.contains(&format!("- {sentence}")), "{sentence}");
    }
}

#[test]
fn a_step_that_the_tour_does_not_have_is_refused_with_the_range() {
    for step in ["0", "14", "-1", "two"] {
        let output = run(&["gui", &format!("--tour={step}")]);
        assert_eq!(output.status.code(), Some(2), "{step}");
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(said.contains(step) && said.contains("--tour"), "{said}");
    }
    let said = String::from_utf8(run(&["gui", "--tour", "14"]).stderr).expect("UTF-8");
    assert!(said.contains("1..=13"), "{said}");
}
