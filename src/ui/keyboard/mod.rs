//! Keyboard shortcuts.

pub(in crate::ui) mod focus;
mod global;
pub(in crate::ui) mod viewport;

pub(in crate::ui) use global::global;
