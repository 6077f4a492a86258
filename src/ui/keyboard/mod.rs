//! Keyboard shortcuts. Those of this file act in the whole window.

pub(in crate::ui) mod focus;
pub(in crate::ui) mod viewport;

use egui::{Event, Key, KeyboardShortcut, Modifiers, Ui};

use super::{commands, timeline};
use crate::io::OpenOptions;
use crate::session::{
    Actions, Dialog, FileAction, SelectAction, Session, ShellAction, SolverAction,
    TransactionAction, ViewAction,
};

/// Handles shortcuts of the whole window. In a modal dialog only Esc acts.
pub(super) fn global(ui: &Ui, session: &Session, actions: &mut Actions) {
    if session.shell().is_asking() {
        let escapes = ui.input(|input| input.key_pressed(Key::Escape));
        if escapes && !egui::Popup::is_any_open(ui.ctx()) {
            actions.push(ShellAction::CloseDialog);
        }
        return;
    }
    let pressed = |modifiers, key| {
        ui.input_mut(|input| input.consume_shortcut(&KeyboardShortcut::new(modifiers, key)))
    };
    if pressed(Modifiers::COMMAND, Key::Q) {
        actions.push(FileAction::Quit);
    }
    // A text field has an undo of its own.
    if !ui.text_edit_focused() {
        let redo = Modifiers::COMMAND.plus(Modifiers::SHIFT);
        if pressed(redo, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
            actions.push(TransactionAction::Redo);
        } else if pressed(Modifiers::COMMAND, Key::Z) {
            actions.push(TransactionAction::Undo);
        }
    }
    if pressed(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::N) {
        actions.push(FileAction::NewSkeleton);
    } else if pressed(Modifiers::COMMAND, Key::N) {
        actions.push(FileAction::New);
    }
    if pressed(Modifiers::COMMAND, Key::O) {
        actions.push(commands::open());
    }
    if pressed(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S) {
        actions.push(commands::save_as(session));
    }
    if pressed(Modifiers::COMMAND, Key::S) {
        actions.push(FileAction::Save);
    }
    let dropped = ui.input(|input| input.raw.dropped_files.first().map(|it| it.path().to_owned()));
    if let Some(path) = dropped {
        actions.push(FileAction::Open { path, options: OpenOptions::default() });
    }
    if pressed(Modifiers::COMMAND, Key::E) {
        actions.push(ShellAction::OpenDialog(session.export_dialog().into()));
    }
    if pressed(Modifiers::COMMAND, Key::P) {
        actions.push(commands::save_picture(session));
    }
    if pressed(Modifiers::NONE, Key::F1) {
        actions.push(ShellAction::OpenDialog(Dialog::Shortcuts));
    }
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        if timeline::holds(ui) && !session.history().is_editing() {
            // The timeline cancels its own drag.
        } else if session.history().is_editing() {
            actions.push(TransactionAction::Cancel);
        } else if session.view().drag().is_some() {
            actions.push(ViewAction::Cancel);
        } else if session.shell().dialog().is_some() {
            actions.push(ShellAction::CloseDialog);
        } else if focus::was_typing(ui) || egui::Popup::is_any_open(ui.ctx()) {
            // egui leaves the text field or closes the popup.
        } else if session.solvers().shown_iteration().is_some() {
            actions.push(SolverAction::Reset);
        } else if !session.selection().joints().is_empty() {
            actions.push(SelectAction::Joints(Vec::new()));
        } else if !session.selection().keys().is_empty() {
            actions.push(SelectAction::Keys(Vec::new()));
        }
    }
    timeline::everywhere(ui, session, actions);
    let copied = ui.input(|input| input.events.contains(&Event::Copy));
    if copied && !ui.text_edit_focused() {
        let is_of_keys = timeline::has_the_word(ui, session);
        if is_of_keys {
            actions.push(SelectAction::CopyKeys);
        } else {
            actions.push(ShellAction::CopyPose);
        }
    }
}
