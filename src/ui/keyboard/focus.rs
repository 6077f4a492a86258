//! Keyboard focus.

use egui::{Id, Ui};

/// Marks a widget that makes no use of Space, so that Space plays or pauses while it has the focus.
#[derive(Clone, Copy, Default)]
struct IgnoresSpace;

/// Lets Space play or pause while `widget` has the keyboard focus.
pub(in crate::ui) fn leave_space(ui: &Ui, widget: Id) {
    ui.data_mut(|data| data.insert_temp(widget, IgnoresSpace));
}

pub(in crate::ui) fn leaves_space(ui: &Ui) -> bool {
    let focused = ui.memory(egui::Memory::focused);
    focused.is_none_or(|id| ui.data(|data| data.get_temp::<IgnoresSpace>(id)).is_some())
}

/// Whether a text field had the keyboard focus at the end of the previous frame.
#[derive(Clone, Copy, Default)]
struct TextFocus(bool);

/// Stores for the next frame whether a text field has the keyboard focus, because Esc removes the
/// focus before the next frame runs the panels.
pub(in crate::ui) fn remember(ui: &Ui) {
    let typing = TextFocus(ui.text_edit_focused());
    ui.data_mut(|data| data.insert_temp(egui::Id::NULL, typing));
}

pub(in crate::ui) fn was_typing(ui: &Ui) -> bool {
    ui.data(|data| data.get_temp::<TextFocus>(egui::Id::NULL)).is_some_and(|typing| typing.0)
}
