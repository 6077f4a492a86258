use std::sync::LazyLock;

use serde::Deserialize;

use crate::session::TourAction;

/// A term with its meaning.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entry {
    /// The term, as on screen.
    pub term: String,
    /// Its meaning, in two sentences.
    pub text: String,
    /// The step of the tour that shows it, counted from 1, if one does.
    step: Option<usize>,
}

static ENTRIES: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    serde_json::from_str(include_str!("../../../assets/glossary.json"))
        .unwrap_or_else(|error| unreachable!("a test reads the glossary: {error}"))
});

impl Entry {
    /// All entries, in alphabetical order.
    pub fn all() -> &'static [Self] {
        &ENTRIES
    }

    /// The entry of a term; `None` if the glossary lacks it.
    pub fn find(term: &str) -> Option<&'static Self> {
        Self::all().iter().find(|entry| entry.term == term)
    }

    /// The action that begins the step of the tour; `None` without such a step.
    pub fn show_me(&self) -> Option<TourAction> {
        self.step.map(|step| TourAction::Enter(step.saturating_sub(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::TourStep;

    #[test]
    fn the_glossary_is_in_alphabetical_order_and_names_steps_of_the_tour() {
        assert!(Entry::all().is_sorted_by(|one, next| one.term < next.term));
        for entry in Entry::all() {
            let is_step = |step| (1..=TourStep::all().len()).contains(&step);
            assert!(entry.step.is_none_or(is_step), "{}", entry.term);
        }
    }

    #[test]
    fn the_glossary_of_the_docs_has_the_same_entries() {
        let docs = include_str!("../../../docs/glossary.md");
        let rows: Vec<_> = docs.lines().skip_while(|line| !line.starts_with("| ---")).collect();
        let expected = Entry::all().iter().map(|Entry { term, text, step }| {
            let step = step.map(|step| step.to_string()).unwrap_or_default();
            format!("| {term} | {text} | {step} |")
        });
        assert_eq!(rows[1..], expected.collect::<Vec<_>>());
    }

    /// Terms of the README's table of features.
    #[test]
    fn the_glossary_explains_the_terms_of_the_readme() {
        let readme = include_str!("../../../README.md");
        for term in [
            "Auto-key",
            "Baking",
            "BVH",
            "CCD",
            "Damped least squares",
            "Dope sheet",
            "Dual quaternions",
            "FABRIK",
            "FK",
            "Graph editor",
            "IK",
            "Jacobian transpose",
            "Key",
            "Linear blend",
            "Motion trail",
            "Onion skins",
            "Skin",
            "Solver",
            "Spread twist",
            "Target",
            "Two-bone",
            "glTF",
        ] {
            assert!(Entry::find(term).is_some(), "{term}");
            let first = term.split(' ').next().unwrap_or(term).to_lowercase();
            assert!(readme.to_lowercase().contains(&first), "{term} is in the README");
        }
        assert!(readme.contains("(docs/glossary.md)"));
    }

    #[test]
    fn every_entry_has_two_sentences() {
        for entry in Entry::all() {
            assert!(entry.text.ends_with('.'), "{}", entry.term);
            assert_eq!(entry.text.matches(". ").count(), 1, "{}", entry.term);
        }
    }
}
