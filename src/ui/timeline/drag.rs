//! Drags in the timeline.

use egui::{Id, Key, Pos2, Ui, Vec2};
use glam::Vec3;

use super::rows::KeySet;
use super::time_scale::{TimeScale, span};
use super::value_scale::{ValueKind, ValueScales};
use crate::document::Timeline;
use crate::session::{
    Actions, Key as KeyOf, KeysEdit, PlaybackAction, SelectAction, Session, ShellAction,
    TransactionAction,
};

/// Distance in points that the mouse must exceed for a press to become a drag.
pub(in crate::ui) const SLACK: f32 = 3.0;

#[derive(Clone, Debug)]
pub(in crate::ui) enum TimelineDrag {
    /// The playhead; `before` is the time in seconds before the drag.
    Playhead { before: f64 },
    /// Selected keys, in the graph editor in time and value.
    Keys(KeyDrag),
    /// A tangent handle in the graph editor.
    Tangent(TangentDrag),
    /// A selection box.
    Box(BoxDrag),
    /// The visible time range.
    Pan,
}

#[derive(Clone, Debug)]
pub(in crate::ui) struct KeyDrag {
    /// The dragged keys, with their times before the drag.
    pub keys: Vec<KeyOf>,
    /// Time of the pressed key before the drag, in seconds.
    pub time: f64,
    pub pressed: Pos2,
    /// True once the mouse has moved far enough that the press is a drag, not a click.
    pub moved: bool,
    /// Keys to select if the press turns out to be a click.
    pub clicked: Vec<KeyOf>,
    /// The values that are dragged in the graph editor; `None` in the dope sheet.
    pub values: Option<DraggedValues>,
}

/// One component of the values of dragged keys.
#[derive(Clone, Copy, Debug)]
pub(in crate::ui) struct DraggedValues {
    /// The component: 0, 1 or 2.
    pub axis: usize,
    pub kind: ValueKind,
    /// The scales of the plot, kept during the drag.
    pub scales: ValueScales,
}

#[derive(Clone, Copy, Debug)]
pub(in crate::ui) struct TangentDrag {
    pub key: KeyOf,
    pub value: DraggedValues,
    /// True if the handle is on the side after the key.
    pub is_leaving: bool,
    /// True once the transaction is open.
    pub moved: bool,
}

#[derive(Clone, Debug)]
pub(in crate::ui) struct BoxDrag {
    /// Time at the press, in seconds.
    pub time: f64,
    /// Distance in points from the top of the first channel's row, which may be scrolled out of
    /// view, down to the press.
    pub y: f32,
    /// Keys that stay selected in addition to those in the box.
    pub base: Vec<KeyOf>,
}

/// A press of the mouse; `adds` is true with Shift or Ctrl.
#[derive(Clone, Copy)]
pub(in crate::ui) struct Press {
    pub at: Pos2,
    pub adds: bool,
}

pub(in crate::ui) fn get(ui: &Ui) -> Option<TimelineDrag> {
    ui.data(|data| data.get_temp(id()))
}

pub(in crate::ui) fn set(ui: &Ui, drag: TimelineDrag) {
    ui.data_mut(|data| data.insert_temp(id(), drag));
}

pub(in crate::ui) fn clear(ui: &Ui) {
    ui.data_mut(|data| data.remove::<TimelineDrag>(id()));
}

/// True if the visible time range is dragged.
pub(in crate::ui) fn is_panning(ui: &Ui) -> bool {
    matches!(get(ui), Some(TimelineDrag::Pan))
}

/// True if a drag ends: a mouse button was released in this frame, or none is held.
pub(in crate::ui) fn is_released(ui: &Ui) -> bool {
    ui.input(|input| !input.pointer.any_down() || input.pointer.any_released())
}

/// True if Esc was pressed, which cancels a drag.
pub(in crate::ui) fn is_cancelled(ui: &Ui) -> bool {
    ui.input(|input| input.key_pressed(Key::Escape))
}

/// Starts a drag of the keys `pointed` at a time, and selects them. If the press `adds`, the keys
/// that are selected already are dragged, too.
pub(in crate::ui) fn press_keys(
    ui: &Ui,
    session: &Session,
    pointed: Vec<KeyOf>,
    time: f64,
    pressed: Press,
    values: Option<DraggedValues>,
    actions: &mut Actions,
) {
    let selected = session.selection().keys();
    let picked = |of: &[KeyOf]| {
        let of = KeySet::of(session, of);
        move |key: &&KeyOf| of.has_key(**key)
    };
    let (is_selected, is_pointed) = (picked(selected), picked(&pointed));
    let all_selected = pointed.iter().all(|key| is_selected(&key));
    let (keys, clicked) = match (pressed.adds, all_selected) {
        // Keys that are selected already are deselected by this click, unless they are dragged.
        (true, true) => {
            let others = selected.iter().filter(|key| !is_pointed(key)).copied();
            (selected.to_vec(), others.collect())
        }
        (true, false) => {
            let new = pointed.iter().filter(|key| !is_selected(key));
            let both: Vec<_> = selected.iter().chain(new).copied().collect();
            (both.clone(), both)
        }
        (false, true) => (selected.to_vec(), pointed),
        (false, false) => (pointed.clone(), pointed),
    };
    if keys != selected {
        actions.push(SelectAction::Keys(keys.clone()));
    }
    let (pressed, moved) = (pressed.at, false);
    set(ui, TimelineDrag::Keys(KeyDrag { keys, time, pressed, moved, clicked, values }));
}

/// The shift of dragged keys, and the message on it.
pub(in crate::ui) struct KeyShift {
    /// In seconds.
    pub by: f64,
    /// Change of the values.
    pub raise: Vec3,
    pub said: String,
}

/// Continues a drag of keys: moves them by the shift that `shift` returns for the way of the mouse,
/// in points. At the release of the mouse button it commits the drag, or selects the clicked keys.
/// Esc cancels the drag.
pub(in crate::ui) fn follow_keys(
    ui: &Ui,
    session: &Session,
    mut drag: KeyDrag,
    mouse: Pos2,
    actions: &mut Actions,
    shift: impl FnOnce(&KeyDrag, Vec2) -> KeyShift,
) {
    if is_cancelled(ui) || drag.moved && !session.history().is_editing() {
        actions.push(SelectAction::Keys(drag.keys));
        return clear(ui);
    }
    let way = mouse - drag.pressed;
    if !drag.moved && way.length() > SLACK {
        actions.push(TransactionAction::Begin);
        drag.moved = true;
        set(ui, TimelineDrag::Keys(drag.clone()));
    }
    if drag.moved {
        let KeyShift { by, raise, said } = shift(&drag, way);
        actions.push(KeysEdit::MoveKeys { keys: drag.keys, by, raise });
        actions.push(ShellAction::Report(said));
    }
    if is_released(ui) {
        if drag.moved {
            actions.push(TransactionAction::Commit);
        } else {
            actions.push(SelectAction::Keys(drag.clicked));
        }
        clear(ui);
    }
}

/// Moves the playhead with the mouse while it is dragged; Esc restores the time before the drag.
pub(in crate::ui) fn follow_playhead(
    ui: &Ui,
    session: &Session,
    scale: TimeScale,
    actions: &mut Actions,
) {
    let Some(TimelineDrag::Playhead { before }) = get(ui) else {
        return;
    };
    if is_cancelled(ui) {
        clear(ui);
        actions.push(PlaybackAction::SetTime(before));
        return;
    }
    if let Some(mouse) = ui.input(|input| input.pointer.latest_pos()) {
        actions.push(PlaybackAction::SetTime(pointed_time(ui, session, scale, mouse)));
    }
    if is_released(ui) {
        clear(ui);
    }
}

/// Starts a drag of the playhead and pauses playback.
pub(in crate::ui) fn grab_playhead(ui: &Ui, session: &Session, actions: &mut Actions) {
    set(ui, TimelineDrag::Playhead { before: session.playback().time() });
    if session.playback().is_playing() {
        actions.push(PlaybackAction::Play(false));
    }
}

/// The time under the mouse in seconds, snapped to frames unless Ctrl is held, and clamped to
/// the timeline and all keys.
pub(in crate::ui) fn pointed_time(
    ui: &Ui,
    session: &Session,
    scale: TimeScale,
    mouse: Pos2,
) -> f64 {
    let timeline = session.document().timeline;
    let (first, last) = span(session);
    snapped(ui, timeline, scale.time(mouse.x)).clamp(first, last)
}

/// The time in seconds, snapped to frames unless Ctrl is held.
pub(in crate::ui) fn snapped(ui: &Ui, timeline: Timeline, time: f64) -> f64 {
    if ui.input(|input| input.modifiers.command) { time } else { timeline.snapped(time) }
}

fn id() -> Id {
    Id::unique("timeline drag")
}
