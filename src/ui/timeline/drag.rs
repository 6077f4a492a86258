//! What the pointer holds in the timeline, from frame to frame.

use egui::{Id, Key, Pos2, Ui};

use super::time_scale::TimeScale;
use crate::document::Timeline;
use crate::session::{Actions, Key as KeyOf, PlaybackAction, Session};

#[derive(Clone, Debug)]
pub(in crate::ui) enum TimelineDrag {
    /// The time, and what it was before.
    Playhead { before: f64 },
    /// Keys that are moved.
    Keys(KeyDrag),
    /// A box that selects what is in it.
    Box(BoxDrag),
    /// The lanes themselves.
    Pan,
}

#[derive(Clone, Debug)]
pub(in crate::ui) struct KeyDrag {
    /// Where the keys were.
    pub keys: Vec<KeyOf>,
    /// When the key is that the pointer holds.
    pub time: f64,
    pub pressed: Pos2,
    /// Whether they have been moved, so that there is something to take back.
    pub moved: bool,
    /// What is selected if it was a click after all.
    pub clicked: Vec<KeyOf>,
}

#[derive(Clone, Debug)]
pub(in crate::ui) struct BoxDrag {
    pub time: f64,
    /// Below the top of the first lane, in points.
    pub y: f32,
    /// What stays selected.
    pub base: Vec<KeyOf>,
}

pub(in crate::ui) fn get(ui: &Ui) -> Option<TimelineDrag> {
    ui.data(|data| data.get_temp(id()))
}

pub(in crate::ui) fn set(ui: &Ui, held: TimelineDrag) {
    ui.data_mut(|data| data.insert_temp(id(), held));
}

pub(in crate::ui) fn clear(ui: &Ui) {
    ui.data_mut(|data| data.remove::<TimelineDrag>(id()));
}

/// Whether the pointer lets go in this frame.
pub(in crate::ui) fn is_released(ui: &Ui) -> bool {
    ui.input(|input| !input.pointer.any_down() || input.pointer.any_released())
}

/// The time follows the pointer that holds it; Esc takes it back.
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
    if let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) {
        actions.push(PlaybackAction::SetTime(pointed_time(ui, session, scale, pointer)));
    }
    if is_released(ui) {
        clear(ui);
    }
}

/// Takes hold of the time; what plays stands.
pub(in crate::ui) fn grab_playhead(ui: &Ui, session: &Session, actions: &mut Actions) {
    set(ui, TimelineDrag::Playhead { before: session.time() });
    if session.is_playing() {
        actions.push(PlaybackAction::Play(false));
    }
}

/// The frame at the pointer, or with Ctrl the very time, within the timeline and its keys.
pub(in crate::ui) fn pointed_time(
    ui: &Ui,
    session: &Session,
    scale: TimeScale,
    pointer: Pos2,
) -> f64 {
    let timeline = session.document().timeline;
    let (first, last) = span(session);
    snapped(ui, timeline, scale.time(pointer.x)).clamp(first, last)
}

/// On a frame, unless Ctrl is held.
pub(in crate::ui) fn snapped(ui: &Ui, timeline: Timeline, time: f64) -> f64 {
    if ui.input(|input| input.modifiers.command) { time } else { timeline.snapped(time) }
}

/// From the start or the first key to the end or the last key.
pub(in crate::ui) fn span(session: &Session) -> (f64, f64) {
    let Timeline { start, end, .. } = session.document().timeline;
    session.document().keys.tracks().fold((start, end), |(start, end), (_, track)| {
        let knots = track.knots();
        let first = knots.first().map_or(start, |knot| knot.time.min(start));
        (first, knots.last().map_or(end, |knot| knot.time.max(end)))
    })
}

fn id() -> Id {
    Id::unique("held in the timeline")
}
