//! The widget that has the keyboard.

use egui::{Id, Ui};

/// Marks a widget that has the keyboard but no use for Space.
#[derive(Clone, Copy, Default)]
struct IgnoresSpace;

/// Says that this widget has no use for Space.
pub(in crate::ui) fn leave_space(ui: &Ui, widget: Id) {
    ui.data_mut(|data| data.insert_temp(widget, IgnoresSpace));
}

pub(in crate::ui) fn leaves_space(ui: &Ui) -> bool {
    let focused = ui.memory(egui::Memory::focused);
    focused.is_none_or(|id| ui.data(|data| data.get_temp::<IgnoresSpace>(id)).is_some())
}

/// Marks whether a text has the keyboard.
#[derive(Clone, Copy, Default)]
struct TextFocus(bool);

/// Notes at the end of a frame whether a text has the keyboard: Esc takes it away before the next
/// one begins.
pub(in crate::ui) fn remember(ui: &Ui) {
    let typing = TextFocus(ui.text_edit_focused());
    ui.data_mut(|data| data.insert_temp(egui::Id::NULL, typing));
}

pub(in crate::ui) fn was_typing(ui: &Ui) -> bool {
    ui.data(|data| data.get_temp::<TextFocus>(egui::Id::NULL)).is_some_and(|typing| typing.0)
}
