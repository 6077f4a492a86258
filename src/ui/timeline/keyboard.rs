//! Shortcuts of the focused timeline, and shortcuts of keys and playback in the whole window.

use egui::{Event, Key, Modifiers, Ui};

use super::{drag, ruler, time_scale};
use crate::session::{Actions, KeysEdit, PlaybackAction, SelectAction, Session, ShellAction};
use crate::ui::keyboard::{focus, viewport};

/// Handles shortcuts of keys and playback in the whole window, except during a drag in the viewport
/// and while a text field, a modal dialog or a popup is in use.
pub(in crate::ui) fn everywhere(ui: &Ui, session: &Session, actions: &mut Actions) {
    let is_busy = ui.text_edit_focused()
        || session.history().drag().is_some()
        || session.shell().is_asking()
        || egui::Popup::is_any_open(ui.ctx());
    if is_busy {
        return;
    }
    let consumed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
    let pressed = |key| ui.input(|input| input.key_pressed(key));
    let modifiers = ui.input(|input| input.modifiers);
    if pressed(Key::K) && modifiers.shift_only() {
        actions.push(KeysEdit::Key(KeysEdit::all_channels(session.shown())));
    } else if pressed(Key::K) && modifiers.is_none() {
        actions.push(KeysEdit::Key(KeysEdit::channels_to_key(session)));
    }
    if focus::leaves_letters(ui) && pressed(Key::Space) && modifiers.is_none() {
        if session.playback().is_playing() || session.document().is_moving() {
            actions.push(PlaybackAction::Play(!session.playback().is_playing()));
        } else {
            actions.push(ShellAction::Report(
                "Nothing to play: press K at two times to add keys".to_owned(),
            ));
        }
    }
    let pasted = ui.input(|input| {
        let is_paste = |event: &Event| matches!(event, Event::Paste(_));
        input.events.iter().any(is_paste)
    });
    if session.selection().can_paste() && (pasted || consumed(Modifiers::COMMAND, Key::V)) {
        actions.push(KeysEdit::PasteKeys);
    }
    if has_the_word(ui, session) {
        let delete = consumed(Modifiers::NONE, Key::Delete);
        if delete || consumed(Modifiers::NONE, Key::Backspace) {
            actions.push(KeysEdit::DeleteKeys(session.selection().keys().to_vec()));
        }
    }
}

/// True if shortcuts act on the selected keys: there are any, and the timeline has the keyboard
/// focus or no joint is selected.
pub(in crate::ui) fn has_the_word(ui: &Ui, session: &Session) -> bool {
    let is_used = ui.memory(|memory| memory.has_focus(ruler::id()));
    !session.selection().keys().is_empty() && (is_used || session.selection().joints().is_empty())
}

/// True if a drag in the timeline is in progress, which Esc cancels.
pub(in crate::ui) fn holds(ui: &Ui) -> bool {
    drag::get(ui).is_some()
}

/// Handles shortcuts while the timeline has the keyboard focus: left and right arrow step by a
/// frame, up and down arrow by a key, Home and End go to the start and the end. Other keys act as
/// in the viewport.
pub(in crate::ui) fn focused(ui: &Ui, session: &Session, actions: &mut Actions) {
    if !ui.memory(|memory| memory.has_focus(ruler::id())) {
        return;
    }
    focus::take_arrows(ui, ruler::id());
    focus::leave_letters(ui, ruler::id());
    let pressed = |key| viewport::pressed(ui, key);
    let consumed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
    let timeline = session.document().timeline;
    let to = if pressed(Key::ArrowLeft) {
        Some(next_frame(session, -1.0))
    } else if pressed(Key::ArrowRight) {
        Some(next_frame(session, 1.0))
    } else if pressed(Key::ArrowUp) {
        key_before(session)
    } else if pressed(Key::ArrowDown) {
        key_after(session)
    } else if consumed(Modifiers::NONE, Key::Home) {
        Some(timeline.start)
    } else if pressed(Key::End) {
        Some(timeline.end)
    } else {
        None
    };
    actions.extend(to.map(PlaybackAction::SetTime));
    if consumed(Modifiers::COMMAND, Key::A) {
        let tracks = session.document().keys.tracks();
        let keys = tracks.flat_map(|(channel, track)| {
            track.knots().iter().map(move |knot| (channel, knot.time))
        });
        actions.push(SelectAction::Keys(keys.collect()));
    }
    // In the timeline Delete never deletes joints.
    for key in [Key::Delete, Key::Backspace] {
        consumed(Modifiers::NONE, key);
    }
    viewport::viewport(ui, session, actions);
}

/// The time in seconds of the next frame if `by` is positive, otherwise of the previous frame.
fn next_frame(session: &Session, by: f64) -> f64 {
    /// Distance from a frame, in frames, below which a time counts as on the frame.
    const ROUNDING: f64 = 1e-6;
    let timeline = session.document().timeline;
    let frame = timeline.number(session.playback().time());
    let next =
        if by > 0.0 { (frame + ROUNDING).floor() + 1.0 } else { (frame - ROUNDING).ceil() - 1.0 };
    let (first, last) = time_scale::span(session);
    timeline
        .time_of_number(next)
        .clamp(first.min(session.playback().time()), last.max(session.playback().time()))
}

/// Time in seconds of the last key before the playhead; `None` if there is no key.
pub(in crate::ui) fn key_before(session: &Session) -> Option<f64> {
    let time = session.playback().time();
    let tracks = session.document().keys.tracks();
    let before = tracks.filter_map(|(_, track)| {
        let index = track.knots().partition_point(|knot| knot.time < time);
        Some(track.knots().get(index.checked_sub(1)?)?.time)
    });
    before.max_by(f64::total_cmp)
}

/// Time in seconds of the first key after the playhead; `None` if there is no key.
pub(in crate::ui) fn key_after(session: &Session) -> Option<f64> {
    let time = session.playback().time();
    let tracks = session.document().keys.tracks();
    let after = tracks.filter_map(|(_, track)| {
        let index = track.knots().partition_point(|knot| knot.time <= time);
        Some(track.knots().get(index)?.time)
    });
    after.min_by(f64::total_cmp)
}
