//! A row of buttons, of which one is chosen.

use egui::{Align, Button, Layout, Ui};

/// One of the buttons.
pub(in crate::ui) struct Segment<'a, T> {
    pub name: &'a str,
    pub tooltip: &'a str,
    pub value: T,
}

/// Shows the buttons, all as wide, and returns the value of one that was pressed and is not `now`.
pub(in crate::ui) fn segments<T: PartialEq + Copy>(
    ui: &mut Ui,
    now: T,
    choices: &[Segment<'_, T>],
) -> Option<T> {
    let mut pressed = None;
    ui.columns(choices.len(), |columns| {
        for (column, Segment { name, tooltip, value }) in columns.iter_mut().zip(choices) {
            let is_now = *value == now;
            column.with_layout(Layout::top_down_justified(Align::Center), |ui| {
                let button = ui.add(Button::selectable(is_now, *name).frame_when_inactive(true));
                if button.on_hover_text(*tooltip).clicked() && !is_now {
                    pressed = Some(*value);
                }
            });
        }
    });
    pressed
}
