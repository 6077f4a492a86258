//! Drags in the timeline.

use egui::{Id, Key, Pos2, Ui};

use super::time_scale::{TimeScale, span};
use super::value_scale::{ValueKind, ValueScales};
use crate::document::Timeline;
use crate::session::{
    Actions, Key as KeyOf, PlaybackAction, SelectAction, Session, TransactionAction,
};

#[derive(Clone, Debug)]
pub(in crate::ui) enum TimelineDrag {
    /// The playhead; `before` is the time in seconds before the drag.
    Playhead { before: f64 },
    /// Selected keys.
    Keys(KeyDrag),
    /// Selected keys in the graph editor, in time and value.
    Points(PointsDrag),
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
}

#[derive(Clone, Debug)]
pub(in crate::ui) struct PointsDrag {
    /// The dragged keys, with their times before the drag.
    pub keys: Vec<KeyOf>,
    /// Component of the values that is dragged: 0, 1 or 2.
    pub axis: usize,
    pub kind: ValueKind,
    /// Time of the pressed key before the drag, in seconds.
    pub time: f64,
    pub pressed: Pos2,
    /// True once the mouse has moved far enough that the press is a drag, not a click.
    pub moved: bool,
    /// Keys to select if the press turns out to be a click.
    pub clicked: Vec<KeyOf>,
    /// The scales of the plot, kept during the drag.
    pub scales: ValueScales,
}

#[derive(Clone, Copy, Debug)]
pub(in crate::ui) struct TangentDrag {
    pub key: KeyOf,
    /// Component of the value: 0, 1 or 2.
    pub axis: usize,
    pub kind: ValueKind,
    /// True if the handle is on the side after the key.
    pub is_leaving: bool,
    /// True once the transaction is open.
    pub moved: bool,
    /// The scales of the plot, kept during the drag.
    pub scales: ValueScales,
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

pub(in crate::ui) fn get(ui: &Ui) -> Option<TimelineDrag> {
    ui.data(|data| data.get_temp(id()))
}

pub(in crate::ui) fn set(ui: &Ui, drag: TimelineDrag) {
    ui.data_mut(|data| data.insert_temp(id(), drag));
}

pub(in crate::ui) fn clear(ui: &Ui) {
    ui.data_mut(|data| data.remove::<TimelineDrag>(id()));
}

/// True if a drag ends: a mouse button was released in this frame, or none is held.
pub(in crate::ui) fn is_released(ui: &Ui) -> bool {
    ui.input(|input| !input.pointer.any_down() || input.pointer.any_released())
}

/// Ends a drag of keys once the mouse button is released: commits it if the keys have `moved`, else
/// selects the `clicked` keys.
pub(in crate::ui) fn release_keys(
    ui: &Ui,
    moved: bool,
    clicked: Vec<KeyOf>,
    actions: &mut Actions,
) {
    if !is_released(ui) {
        return;
    }
    if moved {
        actions.push(TransactionAction::Commit);
    } else {
        actions.push(SelectAction::Keys(clicked));
    }
    clear(ui);
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
    if ui.input(|input| input.key_pressed(Key::Escape)) {
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
