//! Drags in the timeline.

use egui::{Id, Key, Pos2, Ui};

use super::time_scale::TimeScale;
use crate::document::Timeline;
use crate::session::{Actions, Key as KeyOf, PlaybackAction, Session};

#[derive(Clone, Debug)]
pub(in crate::ui) enum TimelineDrag {
    /// The playhead, with the time before the drag.
    Playhead { before: f64 },
    /// Selected keys.
    Keys(KeyDrag),
    /// A selection box.
    Box(BoxDrag),
    /// The visible time range.
    Pan,
}

#[derive(Clone, Debug)]
pub(in crate::ui) struct KeyDrag {
    /// The keys at their times before the drag.
    pub keys: Vec<KeyOf>,
    /// Time of the key under the mouse.
    pub time: f64,
    pub pressed: Pos2,
    /// True once the drag has moved the keys.
    pub moved: bool,
    /// The selection after a click without a drag.
    pub clicked: Vec<KeyOf>,
}

#[derive(Clone, Debug)]
pub(in crate::ui) struct BoxDrag {
    pub time: f64,
    /// Offset in points from the top of the first channel's row.
    pub y: f32,
    /// Keys that stay selected.
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

/// True in the frame of the release.
pub(in crate::ui) fn is_released(ui: &Ui) -> bool {
    ui.input(|input| !input.pointer.any_down() || input.pointer.any_released())
}

/// Moves the playhead with the mouse; Esc restores the time.
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

/// Starts to drag the playhead and pauses playback.
pub(in crate::ui) fn grab_playhead(ui: &Ui, session: &Session, actions: &mut Actions) {
    set(ui, TimelineDrag::Playhead { before: session.time() });
    if session.is_playing() {
        actions.push(PlaybackAction::Play(false));
    }
}

/// The time under the mouse, snapped to frames unless Ctrl is held, within timeline and keys.
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

/// The time snapped to frames, unless Ctrl is held.
pub(in crate::ui) fn snapped(ui: &Ui, timeline: Timeline, time: f64) -> f64 {
    if ui.input(|input| input.modifiers.command) { time } else { timeline.snapped(time) }
}

/// The range of timeline and keys.
pub(in crate::ui) fn span(session: &Session) -> (f64, f64) {
    let Timeline { start, end, .. } = session.document().timeline;
    session.document().keys.tracks().fold((start, end), |(start, end), (_, track)| {
        let knots = track.knots();
        let first = knots.first().map_or(start, |knot| knot.time.min(start));
        (first, knots.last().map_or(end, |knot| knot.time.max(end)))
    })
}

fn id() -> Id {
    Id::unique("timeline drag")
}
