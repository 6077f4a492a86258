//! What the keys do when no widget has them.

use egui::{Event, Key, KeyboardShortcut, Modifiers, Ui};

use super::focus;
use crate::session::{Action, Dialog, Session};
use crate::ui::{commands, timeline};

/// Keys that act wherever the keyboard is; while a dialog has it, only Esc does.
pub(in crate::ui) fn global(ui: &Ui, session: &Session, actions: &mut Vec<Action>) {
    if session.is_asking() {
        let escapes = ui.input(|input| input.key_pressed(Key::Escape));
        if escapes && !egui::Popup::is_any_open(ui.ctx()) {
            actions.push(Action::CloseDialog);
        }
        return;
    }
    let pressed = |modifiers, key| {
        ui.input_mut(|input| input.consume_shortcut(&KeyboardShortcut::new(modifiers, key)))
    };
    if pressed(Modifiers::COMMAND, Key::Q) {
        actions.push(Action::Quit);
    }
    // A text that is typed has steps of its own.
    if !ui.text_edit_focused() {
        let redo = Modifiers::COMMAND.plus(Modifiers::SHIFT);
        if pressed(redo, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
            actions.push(Action::Redo);
        } else if pressed(Modifiers::COMMAND, Key::Z) {
            actions.push(Action::Undo);
        }
    }
    if pressed(Modifiers::COMMAND, Key::O) {
        actions.push(commands::open());
    }
    if pressed(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S) {
        actions.push(commands::save_as());
    }
    if pressed(Modifiers::COMMAND, Key::S) {
        actions.push(Action::Save);
    }
    let dropped = ui.input(|input| input.raw.dropped_files.first().map(|it| it.path().to_owned()));
    if let Some(path) = dropped {
        actions.push(Action::Open { path, skeleton: None });
    }
    if pressed(Modifiers::COMMAND, Key::E) {
        actions.push(Action::OpenDialog(session.export_dialog()));
    }
    if pressed(Modifiers::COMMAND, Key::P) {
        actions.push(commands::save_picture());
    }
    if pressed(Modifiers::NONE, Key::F1) {
        actions.push(Action::OpenDialog(Dialog::Shortcuts));
    }
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        if timeline::holds(ui) && !session.is_editing() {
            // It lets go of what it holds.
        } else if session.is_editing() {
            actions.push(Action::CancelEdit);
        } else if session.view_drag().is_some() {
            actions.push(Action::CancelView);
        } else if session.dialog().is_some() {
            actions.push(Action::CloseDialog);
        } else if focus::was_typing(ui) || egui::Popup::is_any_open(ui.ctx()) {
            // It leaves the text, or closes the list.
        } else if session.is_running() {
            actions.push(Action::CancelRun);
        } else if session.comparison().is_some() {
            actions.push(Action::Comparison(false));
        } else if !session.selection().is_empty() {
            actions.push(Action::Select(Vec::new()));
        } else if !session.selected_keys().is_empty() {
            actions.push(Action::SelectKeys(Vec::new()));
        }
    }
    timeline::everywhere(ui, session, actions);
    let copied = ui.input(|input| input.events.contains(&Event::Copy));
    if copied && !ui.text_edit_focused() {
        let is_of_keys = timeline::has_the_word(ui, session);
        actions.push(if is_of_keys { Action::CopyKeys } else { Action::CopyPose });
    }
}
