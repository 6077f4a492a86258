//! The button that Enter presses.

use egui::Ui;

/// The button that Enter presses.
pub(super) fn first_button(ui: &mut Ui, name: &str) -> bool {
    let button = ui.button(name);
    if ui.memory(|memory| memory.focused().is_none()) {
        button.request_focus();
    }
    button.clicked()
}
