//! The tour: its offer at the start, and the card of a step below the view.

mod card;
mod offer;
mod progress;

pub(in crate::ui) use card::{card, height, open_section};
pub(in crate::ui) use offer::offer;
