//! The mouse in the dope sheet: selects and moves keys, draws selection boxes.

use egui::{Event, Key as Button, PointerButton, Pos2, Rect, Response, Stroke, Ui, pos2};

use super::areas::{ROW, take_keyboard};
use super::drag::{self, BoxDrag, KeyDrag, TimelineDrag};
use super::lane::{SelectedKeys, TimelineLane};
use super::time_scale::TimeScale;
use crate::document::Channel;
use crate::session::{
    Actions, EditAction, Key, PlaybackAction, SelectAction, Session, ShellAction, TransactionAction,
};
use crate::ui::{labels, style};

/// Hit radius of a key, in points.
const REACH: f32 = 7.0;
/// Distance in points from which a press is a drag.
const SLACK: f32 = 3.0;

/// The lanes on screen.
pub(in crate::ui) struct LaneView<'a> {
    pub session: &'a Session,
    pub scale: TimeScale,
    pub channels: &'a [Channel],
    pub area: Rect,
    /// Scroll offset of the channels' lanes.
    pub offset: f32,
}

impl LaneView<'_> {
    /// The lane at a screen position.
    pub fn lane(&self, at: Pos2) -> Option<TimelineLane> {
        let y = at.y - self.area.top();
        if y < ROW {
            return Some(TimelineLane::All);
        }
        let row = ((y - ROW + self.offset) / ROW).floor().max(0.0) as usize;
        self.channels.get(row).map(|channel| TimelineLane::Channel(*channel))
    }

    /// Lane and time of the key at a screen position.
    pub fn key(&self, at: Pos2) -> Option<(TimelineLane, f64)> {
        let lane = self.lane(at)?;
        let (from, to) = (self.scale.time(at.x - REACH), self.scale.time(at.x + REACH));
        let off = |time: &f64| (self.scale.x(*time) - at.x).abs();
        let times = lane.times(self.session, from, to).into_iter();
        let nearest = times.min_by(|a, b| off(a).total_cmp(&off(b)))?;
        Some((lane, nearest))
    }

    /// Offset from the top of the first channel's lane, scrolling included.
    fn content_y(&self, at: Pos2) -> f32 {
        at.y - self.area.top() - ROW + self.offset
    }

    /// The keys within a range of times and offsets.
    fn keys_in(&self, times: (f64, f64), ys: (f32, f32)) -> Vec<Key> {
        let centre = |row: usize| ROW * (row as f32 + 0.5);
        let rows = self.channels.iter().enumerate();
        let inside = rows.filter(|(row, _)| (ys.0..=ys.1).contains(&centre(*row)));
        let keys = inside.flat_map(|(_, channel)| {
            let found = TimelineLane::Channel(*channel).times(self.session, times.0, times.1);
            found.into_iter().map(|time| (*channel, time))
        });
        keys.collect()
    }
}

/// Starts a drag at a press.
pub(in crate::ui) fn press(
    ui: &Ui,
    lanes: &LaneView<'_>,
    body: &Response,
    ruler: &Response,
    actions: &mut Actions,
) {
    take_keyboard(ui, body, ruler);
    if !body.contains_pointer() {
        return;
    }
    for event in ui.input(|input| input.events.clone()) {
        let Event::PointerButton { pos, button, pressed: true, modifiers } = event else {
            continue;
        };
        if lanes.session.is_editing() || drag::get(ui).is_some() {
            continue;
        }
        match button {
            PointerButton::Primary => {
                let adds = modifiers.shift || modifiers.command;
                match lanes.key(pos) {
                    Some((lane, time)) => press_key(ui, lanes, lane, time, pos, adds, actions),
                    None => press_lane(ui, lanes, pos, adds),
                }
            }
            PointerButton::Middle => drag::set(ui, TimelineDrag::Pan),
            PointerButton::Secondary => {
                if let Some((lane, time)) = lanes.key(pos)
                    && !SelectedKeys::new(lanes.session).has(lane, time)
                {
                    actions.push(SelectAction::Keys(lane.keys(lanes.session, time)));
                }
            }
            PointerButton::Extra1 | PointerButton::Extra2 => {}
        }
    }
    let asked = body.double_clicked().then(|| ui.input(|input| input.pointer.interact_pos()));
    if let Some(at) = asked.flatten()
        && lanes.key(at).is_none()
        && let Some(lane) = lanes.lane(at)
    {
        actions.push(PlaybackAction::SetTime(drag::pointed_time(
            ui,
            lanes.session,
            lanes.scale,
            at,
        )));
        actions.push(EditAction::Key(lane.channels(lanes.session)));
    }
}

fn press_key(
    ui: &Ui,
    lanes: &LaneView<'_>,
    lane: TimelineLane,
    time: f64,
    pressed: Pos2,
    adds: bool,
    actions: &mut Actions,
) {
    let session = lanes.session;
    let pointed = lane.keys(session, time);
    let selected = session.selected_keys();
    let picked = |of: &[Key]| {
        let of = SelectedKeys::of(of);
        move |key: &&Key| of.has(TimelineLane::Channel(key.0), key.1)
    };
    let (is_selected, is_pointed) = (picked(selected), picked(&pointed));
    let all_selected = pointed.iter().all(|key| is_selected(&key));
    let (keys, clicked) = match (adds, all_selected) {
        // Another click deselects it, unless it is dragged.
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
    drag::set(ui, TimelineDrag::Keys(KeyDrag { keys, time, pressed, moved: false, clicked }));
}

fn press_lane(ui: &Ui, lanes: &LaneView<'_>, at: Pos2, adds: bool) {
    let base = if adds { lanes.session.selected_keys().to_vec() } else { Vec::new() };
    let drag = BoxDrag { time: lanes.scale.time(at.x), y: lanes.content_y(at), base };
    drag::set(ui, TimelineDrag::Box(drag));
}

/// Continues the drag until release or Esc.
pub(in crate::ui) fn follow(ui: &Ui, lanes: &LaneView<'_>, actions: &mut Actions) {
    let Some(mouse) = ui.input(|input| input.pointer.latest_pos()) else {
        return;
    };
    match drag::get(ui) {
        Some(TimelineDrag::Keys(drag)) => move_keys(ui, lanes, drag, mouse, actions),
        Some(TimelineDrag::Box(drag)) => draw_box(ui, lanes, &drag, mouse, actions),
        Some(TimelineDrag::Pan) if drag::is_released(ui) => drag::clear(ui),
        Some(TimelineDrag::Pan | TimelineDrag::Playhead { .. }) | None => {}
    }
}

fn move_keys(ui: &Ui, lanes: &LaneView<'_>, mut drag: KeyDrag, mouse: Pos2, actions: &mut Actions) {
    let session = lanes.session;
    let cancelled = ui.input(|input| input.key_pressed(Button::Escape));
    if cancelled || drag.moved && !session.is_editing() {
        actions.push(SelectAction::Keys(drag.keys));
        drag::clear(ui);
        return;
    }
    if !drag.moved && (mouse - drag.pressed).length() > SLACK {
        actions.push(TransactionAction::Begin);
        drag.moved = true;
        drag::set(ui, TimelineDrag::Keys(drag.clone()));
    }
    if drag.moved {
        let way = f64::from(mouse.x - drag.pressed.x) / lanes.scale.points_per_second();
        let by = drag::snapped(ui, session.document().timeline, drag.time + way) - drag.time;
        let count = labels::count_of_keys(drag.keys.len());
        let said = format!("Move {count}: {by:+.2} s     Ctrl off the frame grid · Esc cancel");
        actions.push(EditAction::MoveKeys { keys: drag.keys.clone(), by });
        actions.push(ShellAction::Report(said));
    }
    if drag::is_released(ui) {
        if drag.moved {
            actions.push(TransactionAction::Commit);
        } else {
            actions.push(SelectAction::Keys(drag.clicked));
        }
        drag::clear(ui);
    }
}

fn draw_box(ui: &Ui, lanes: &LaneView<'_>, drag: &BoxDrag, mouse: Pos2, actions: &mut Actions) {
    if ui.input(|input| input.key_pressed(Button::Escape)) {
        actions.push(SelectAction::Keys(drag.base.clone()));
        drag::clear(ui);
        return;
    }
    let corner = place(lanes, drag);
    let is_box = (mouse - corner).length() > SLACK;
    let mut keys = drag.base.clone();
    if is_box {
        let (time, y) = (lanes.scale.time(mouse.x), lanes.content_y(mouse));
        let times = (drag.time.min(time), drag.time.max(time));
        let inside = lanes.keys_in(times, (drag.y.min(y), drag.y.max(y)));
        let picked = SelectedKeys::of(&keys);
        keys.extend(
            inside.into_iter().filter(|(it, at)| !picked.has(TimelineLane::Channel(*it), *at)),
        );
    }
    if keys != lanes.session.selected_keys() {
        actions.push(SelectAction::Keys(keys));
    }
    if drag::is_released(ui) {
        drag::clear(ui);
    }
}

fn place(lanes: &LaneView<'_>, drag: &BoxDrag) -> Pos2 {
    let y = drag.y - lanes.offset + ROW + lanes.area.top();
    pos2(lanes.scale.x(drag.time), y)
}

/// Draws the selection box.
pub(in crate::ui) fn paint_box(ui: &Ui, lanes: &LaneView<'_>) {
    let (Some(TimelineDrag::Box(drag)), Some(mouse)) =
        (drag::get(ui), ui.input(|input| input.pointer.latest_pos()))
    else {
        return;
    };
    let accent = style::accent(ui);
    let rect = Rect::from_two_pos(place(lanes, &drag), mouse);
    let painter = ui.painter().with_clip_rect(lanes.area);
    let rim = Stroke::new(1.0, accent);
    painter.rect(rect, 0.0, accent.gamma_multiply(0.15), rim, egui::StrokeKind::Inside);
}
