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
        actions.push(FileAction::NewEmpty);
    } else if pressed(Modifiers::COMMAND.plus(Modifiers::ALT), Key::N) {
        actions.push(FileAction::NewFigure);
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
        actions.push(ShellAction::OpenDialog(
            session.files().export_dialog(session.document()).into(),
        ));
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

/// Splits a frame's events so that the panels can answer each key press and mouse button before the
/// next one arrives.
///
/// A slow frame gathers several presses: Ctrl+S and the first letters of a file name, or Ctrl+1 and
/// the release of Ctrl. In one pass the letters would act as shortcuts, since the dialog is not
/// open yet, and every key would have the modifiers that are held at the end of the frame. Each
/// part holds at most one press, the modifiers that were held at that press, and the text that it
/// types.
///
/// Returns at least one part, which may be empty, so that a frame without events is drawn too.
pub fn strokes(events: Vec<Event>) -> Vec<Vec<Event>> {
    let mut parts = vec![Vec::new()];
    let mut has_press = false;
    for event in events {
        let is_press = is_press(&event);
        if has_press && (is_press || matches!(event, Event::ModifiersChanged(_))) {
            parts.push(Vec::new());
            has_press = false;
        }
        has_press |= is_press;
        if let Some(part) = parts.last_mut() {
            part.push(event);
        }
    }
    parts
}

/// Moves key, text and clipboard events of `stroke` to `deferred`, because they are meant for a
/// file dialog that is not open yet. Returns the other events and Esc, which cancels the wait for
/// that dialog.
pub fn hold_typed(stroke: Vec<Event>, deferred: &mut Vec<Event>) -> Vec<Event> {
    let is_typed = |event: &Event| match event {
        Event::Key { key, .. } => *key != Key::Escape,
        Event::Text(_) | Event::Ime(_) | Event::Copy | Event::Cut | Event::Paste(_) => true,
        _ => false,
    };
    let (typed, rest) = stroke.into_iter().partition(is_typed);
    deferred.extend::<Vec<_>>(typed);
    rest
}

/// True if the event is a key press, a clipboard event, or a press or release of a mouse button.
/// Releases count, because egui reports a click at the release.
fn is_press(event: &Event) -> bool {
    match event {
        Event::Key { pressed, .. } => *pressed,
        Event::PointerButton { .. } | Event::Copy | Event::Cut | Event::Paste(_) => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use egui::Modifiers;

    use crate::ui::keyboard::*;

    fn key(key: Key, pressed: bool, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }
    }

    #[test]
    fn a_key_keeps_the_modifiers_that_were_held_when_it_was_pressed() {
        let parts = strokes(vec![
            Event::ModifiersChanged(Modifiers::CTRL),
            key(Key::Num1, true, Modifiers::CTRL),
            key(Key::Num1, false, Modifiers::CTRL),
            Event::ModifiersChanged(Modifiers::NONE),
        ]);
        let [first, last] = &parts[..] else { panic!("{parts:?}") };
        assert_eq!(first.len(), 3);
        assert_eq!(last[..], [Event::ModifiersChanged(Modifiers::NONE)]);
    }

    #[test]
    fn every_key_is_on_its_own_with_the_text_that_it_types() {
        let text = |text: &str| Event::Text(text.to_owned());
        let parts = strokes(vec![
            key(Key::A, true, Modifiers::NONE),
            text("a"),
            key(Key::B, true, Modifiers::NONE),
            text("b"),
            key(Key::A, false, Modifiers::NONE),
        ]);
        let [first, second] = &parts[..] else { panic!("{parts:?}") };
        assert_eq!(first[1], text("a"));
        assert_eq!(second[1], text("b"));
    }

    #[test]
    fn what_is_typed_is_held_but_not_esc_nor_the_mouse() {
        let text = Event::Text("a".to_owned());
        let escape = key(Key::Escape, true, Modifiers::NONE);
        let moved = Event::PointerMoved(egui::pos2(1.0, 2.0));
        let pressed = key(Key::A, true, Modifiers::NONE);
        let mut deferred = vec![Event::Text("b".to_owned())];
        let stroke = vec![pressed.clone(), moved.clone(), text.clone(), escape.clone()];
        assert_eq!(hold_typed(stroke, &mut deferred), [moved, escape]);
        assert_eq!(deferred[1..], [pressed, text]);
    }

    #[test]
    fn nothing_is_lost_and_nothing_changes_places() {
        let events: Vec<_> = [Key::A, Key::B, Key::C]
            .into_iter()
            .flat_map(|it| [key(it, true, Modifiers::NONE), key(it, false, Modifiers::NONE)])
            .collect();
        assert_eq!(strokes(events.clone()).concat(), events);
        assert_eq!(strokes(Vec::new()), [Vec::new()]);
    }
}
