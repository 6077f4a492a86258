//! The default button of a dialog.

use egui::Ui;

/// A button that takes the keyboard, so that Enter presses it.
pub(super) fn first_button(ui: &mut Ui, name: &str) -> bool {
    let button = ui.button(name);
    if ui.memory(|memory| memory.focused().is_none()) {
        button.request_focus();
    }
    button.clicked()
}
