//! The glossary: terms of the user interface, each with two sentences and often a step of the tour.

mod dialog;
mod entry;
mod term;

pub(in crate::ui) use dialog::dialog;
pub(in crate::ui) use term::{term, term_label};
