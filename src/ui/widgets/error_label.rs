//! A label for errors.

use egui::accesskit::Role;
use egui::{Label, RichText, Ui};

/// Shows text in the error colour; screen readers announce it as an alert.
pub(in crate::ui) fn error_label(ui: &mut Ui, text: &str) {
    let colour = ui.visuals().error_fg_color;
    let label = Label::new(RichText::new(text).color(colour)).selectable(false);
    let response =
        ui.add(if ui.layout().is_horizontal() { label.truncate() } else { label.wrap() });
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_role(Role::Alert);
        node.set_label(text);
    });
}
