//! The events of one frame, split at every key press and mouse button.

use egui::{Event, Key};

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

    use super::*;

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
