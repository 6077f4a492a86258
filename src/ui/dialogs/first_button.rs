//! The default button of a dialog.

use egui::Ui;

use crate::ui::widgets;

/// Shows a button that takes the keyboard focus if no widget has it, so that Enter presses the
/// button. Returns whether the button was pressed.
pub(super) fn first_button(ui: &mut Ui, name: &str) -> bool {
    let button = widgets::primary_button(ui, name, None);
    if ui.memory(|memory| memory.focused().is_none()) {
        button.request_focus();
    }
    button.clicked()
}
