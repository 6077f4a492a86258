//! A line of text to type.

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Key, TextEdit, Ui};

/// Shows a text line with the label `prompt`. If `is_new`, the line takes the keyboard focus and
/// its text is selected. Returns the text, and whether Enter was pressed.
pub(in crate::ui) fn prompt(ui: &mut Ui, prompt: &str, text: &str, is_new: bool) -> (String, bool) {
    let mut typed = text.to_owned();
    let name = ui.label(prompt);
    let id = name.id.with("text");
    if is_new {
        let mut state = TextEditState::default();
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), id);
    }
    if is_new || ui.memory(|memory| memory.focused().is_none()) {
        ui.memory_mut(|memory| memory.request_focus(id));
    }
    let edit = TextEdit::singleline(&mut typed).id(id).desired_width(f32::INFINITY);
    let edit = ui.add(edit).labelled_by(name.id);
    let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    (typed, entered)
}
