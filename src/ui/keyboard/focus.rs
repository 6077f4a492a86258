//! Keyboard focus.

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Event, EventFilter, Id, Key, Response, Ui};

/// Marks a widget that makes no use of Space and digits, so that Space plays or pauses and digits
/// choose a view while it has the focus.
#[derive(Clone, Copy, Default)]
struct IgnoresLetters;

/// Lets Space play or pause, and digits choose a view, while `widget` has the keyboard focus.
pub(in crate::ui) fn leave_letters(ui: &Ui, widget: Id) {
    ui.data_mut(|data| data.insert_temp(widget, IgnoresLetters));
}

/// Lets arrow keys act on `widget`, which has the keyboard focus, instead of moving the focus.
pub(in crate::ui) fn take_arrows(ui: &Ui, widget: Id) {
    let arrows =
        EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(widget, arrows));
}

/// True if Space and digits act although a widget has the keyboard focus, or if none has it.
pub(in crate::ui) fn leaves_letters(ui: &Ui) -> bool {
    let focused = ui.memory(egui::Memory::focused);
    focused.is_none_or(|id| ui.data(|data| data.get_temp::<IgnoresLetters>(id)).is_some())
}

/// True if a text field had the keyboard focus at the end of the previous frame.
#[derive(Clone, Copy, Default)]
struct TextFocus(bool);

/// Ends a frame: moves the focus from number to number, and stores for the next frame whether a
/// text field has the keyboard focus, because Esc removes the focus before the next frame runs the
/// panels.
pub(in crate::ui) fn end(ui: &Ui) {
    follow_numbers(ui);
    let typing = TextFocus(ui.text_edit_focused());
    ui.data_mut(|data| data.insert_temp(egui::Id::NULL, typing));
}

pub(in crate::ui) fn was_typing(ui: &Ui) -> bool {
    ui.data(|data| data.get_temp::<TextFocus>(egui::Id::NULL)).is_some_and(|typing| typing.0)
}

/// The numbers of a frame in the order in which they were shown.
#[derive(Clone, Default)]
struct FrameNumbers(Vec<Id>);

/// Marks a number into which the user has typed.
#[derive(Clone, Copy, Default)]
struct IsTyped;

/// The number that the user has left with Tab after typing into it.
#[derive(Clone, Copy)]
struct LeftByTab {
    number: Id,
    /// True if Shift was held, so that the number before is next.
    backwards: bool,
}

fn numbers() -> Id {
    Id::unique("numbers of the frame")
}

/// The number that gets the focus.
#[derive(Clone, Copy)]
struct NextNumber(Id);

/// Begins a frame.
pub(in crate::ui) fn begin(ui: &Ui) {
    ui.data_mut(|data| data.insert_temp(numbers(), FrameNumbers::default()));
    // For Shift+Tab, egui sets the focus only now.
    let next = ui.data_mut(|data| data.remove_temp::<Option<NextNumber>>(numbers()).flatten());
    if let Some(NextNumber(number)) = next {
        edit(ui, number);
    }
}

/// Gives the focus to a number and selects its text.
fn edit(ui: &Ui, number: Id) {
    /// More letters than a number has.
    const ALL: usize = 64;
    ui.memory_mut(|memory| memory.request_focus(number));
    let mut text = TextEditState::load(ui.ctx(), number).unwrap_or_default();
    let all = CCursorRange::two(CCursor::new(0), CCursor::new(ALL));
    text.cursor.set_char_range(Some(all));
    text.store(ui.ctx(), number);
}

/// Lists a number, so that Tab leads from it to the next number once the user has typed into it.
/// From other widgets, and from numbers without typing, Tab leads to the next widget of any kind.
pub(in crate::ui) fn list_number(ui: &Ui, number: &Response) {
    if number.enabled() {
        ui.data_mut(|data| {
            data.get_temp_mut_or_default::<FrameNumbers>(numbers()).0.push(number.id);
        });
    }
    let is_stroke = |event: &Event| match event {
        Event::Text(_) | Event::Paste(_) => true,
        Event::Key { key: Key::Backspace | Key::Delete, pressed, .. } => *pressed,
        _ => false,
    };
    if number.has_focus() && ui.input(|input| input.events.iter().any(is_stroke)) {
        ui.data_mut(|data| data.insert_temp(number.id, IsTyped));
    }
    let is_typed = ui.data(|data| data.get_temp::<IsTyped>(number.id)).is_some();
    if is_typed && ui.input(|input| input.key_pressed(Key::Tab)) {
        let backwards = ui.input(|input| input.modifiers.shift);
        let left = Some(LeftByTab { number: number.id, backwards });
        ui.data_mut(|data| data.insert_temp(numbers(), left));
    }
    if !number.has_focus() {
        ui.data_mut(|data| data.remove::<IsTyped>(number.id));
    }
}

/// Moves the focus from the number that was left with Tab to the next one.
fn follow_numbers(ui: &Ui) {
    let Some(left) = ui.data_mut(|data| data.remove_temp::<Option<LeftByTab>>(numbers()).flatten())
    else {
        return;
    };
    let all = ui.data(|data| data.get_temp::<FrameNumbers>(numbers())).unwrap_or_default().0;
    let step = if left.backwards { -1 } else { 1 };
    let left_at = all.iter().position(|id| *id == left.number);
    let next_at = left_at.and_then(|at| at.checked_add_signed(step));
    if let Some(next) = next_at.and_then(|at| all.get(at)) {
        ui.memory_mut(|memory| memory.request_focus(*next));
        ui.data_mut(|data| data.insert_temp(numbers(), Some(NextNumber(*next))));
        ui.ctx().request_repaint();
    }
}
