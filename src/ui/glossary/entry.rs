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
    /// The step of the tour that shows it, counted from 1.
    step: usize,
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

    /// The action that begins the step of the tour.
    pub fn show_me(&self) -> TourAction {
        TourAction::Enter(self.step.saturating_sub(1))
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
            assert!((1..=TourStep::all().len()).contains(&entry.step), "{}", entry.term);
        }
    }

    #[test]
    fn every_entry_has_two_sentences() {
        for entry in Entry::all() {
            assert!(entry.text.ends_with('.'), "{}", entry.term);
            assert_eq!(entry.text.matches(". ").count(), 1, "{}", entry.term);
        }
    }
}
