//! What the side panels are made of.

use egui::{CollapsingHeader, RichText, Ui};

/// A section that can be folded; whether it is, survives a restart.
pub(super) fn section(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) {
    let heading = RichText::new(title).strong().size(13.5);
    CollapsingHeader::new(heading).default_open(true).show_unindented(ui, contents);
    ui.add_space(6.0);
}
