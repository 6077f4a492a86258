//! The mouse in the dope sheet: selects and moves keys, draws selection boxes.

use egui::{Event, PointerButton, Pos2, Rect, Response, Stroke, Ui, Vec2, pos2};
use glam::Vec3;

use crate::session::{Actions, Key, KeysEdit, PlaybackAction, SelectAction, Session};
use crate::ui::timeline::drag::{self, BoxDrag, KeyDrag, KeyShift, Press, TimelineDrag};
use crate::ui::timeline::rows::{DopeSheetRow, KeySet, ROW, take_keyboard};
use crate::ui::timeline::time_scale::TimeScale;
use crate::ui::{labels, style};

/// Hit radius of a key, in points.
const REACH: f32 = 7.0;

/// The dope sheet as it lies on screen.
pub(in crate::ui) struct DopeSheetView<'a> {
    pub session: &'a Session,
    pub scale: TimeScale,
    /// The row of all keys, which is not scrolled, and those below it.
    pub all: DopeSheetRow,
    pub rows: &'a [DopeSheetRow],
    pub area: Rect,
    /// Scroll offset of these rows in points.
    pub offset: f32,
}

impl DopeSheetView<'_> {
    /// The row at a screen position; `None` below the last row.
    pub fn row(&self, at: Pos2) -> Option<DopeSheetRow> {
        let y = at.y - self.area.top();
        if y < ROW {
            return Some(self.all);
        }
        let row = ((y - ROW + self.offset) / ROW).floor().max(0.0) as usize;
        self.rows.get(row).copied()
    }

    /// Row, and time in seconds, of the key nearest to a screen position; `None` if no key of the
    /// row is within `REACH`.
    pub fn key(&self, at: Pos2) -> Option<(DopeSheetRow, f64)> {
        let row = self.row(at)?;
        let (from, to) = (self.scale.time(at.x - REACH), self.scale.time(at.x + REACH));
        let off = |time: &f64| (self.scale.x(*time) - at.x).abs();
        let times = row.times(self.session, from, to).into_iter();
        let nearest = times.min_by(|a, b| off(a).total_cmp(&off(b)))?;
        Some((row, nearest))
    }

    /// Distance in points from the top of the first of these rows, which may be scrolled out of
    /// view, down to a screen position.
    fn content_y(&self, at: Pos2) -> f32 {
        at.y - self.area.top() - ROW + self.offset
    }

    /// The keys within a range of times in seconds, in the rows whose centres are within a range of
    /// [`Self::content_y`].
    fn keys_in(&self, times: (f64, f64), ys: (f32, f32)) -> Vec<Key> {
        // The row of all keys has those of the others too.
        let all_y = self.offset - 0.5 * ROW;
        if let DopeSheetRow::All { is_folded: true } = self.all
            && (ys.0..=ys.1).contains(&all_y)
        {
            return self.keys_of(&[self.all], times);
        }
        let centre = |row: usize| ROW * (row as f32 + 0.5);
        let rows = self.rows.iter().enumerate();
        let inside = rows.filter(|(row, _)| (ys.0..=ys.1).contains(&centre(*row)));
        // A heading has the keys of the rows below it, unless they are folded.
        let own =
            inside.filter(|(_, row)| !matches!(row, DopeSheetRow::Joint { is_folded: false, .. }));
        let own: Vec<_> = own.map(|(_, row)| *row).collect();
        self.keys_of(&own, times)
    }

    /// The keys of some rows within a range of times in seconds.
    fn keys_of(&self, rows: &[DopeSheetRow], times: (f64, f64)) -> Vec<Key> {
        let keys = rows.iter().flat_map(|row| {
            let found = row.times(self.session, times.0, times.1);
            found.into_iter().flat_map(|time| row.keys(self.session, time))
        });
        keys.collect()
    }
}

/// Handles presses and double-clicks in the dope sheet: starts drags, selects the key at a right
/// click, and adds keys at a double-click.
pub(in crate::ui) fn press(
    ui: &Ui,
    sheet: &DopeSheetView<'_>,
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
        if sheet.session.history().is_editing() || drag::get(ui).is_some() {
            continue;
        }
        match button {
            PointerButton::Primary => {
                let adds = modifiers.shift || modifiers.command;
                match sheet.key(pos) {
                    Some((row, time)) => {
                        let (session, press) = (sheet.session, Press { at: pos, adds });
                        let keys = row.keys(session, time);
                        drag::press_keys(ui, session, keys, time, press, None, actions);
                    }
                    None => press_background(ui, sheet, pos, adds),
                }
            }
            PointerButton::Middle => drag::set(ui, TimelineDrag::Pan),
            PointerButton::Secondary => {
                if let Some((row, time)) = sheet.key(pos)
                    && !KeySet::new(sheet.session).has(row, time)
                {
                    actions.push(SelectAction::Keys(row.keys(sheet.session, time)));
                }
            }
            PointerButton::Extra1 | PointerButton::Extra2 => {}
        }
    }
    if body.double_clicked()
        && let Some(at) = ui.input(|input| input.pointer.interact_pos())
        && sheet.key(at).is_none()
        && let Some(row) = sheet.row(at)
    {
        let time = drag::pointed_time(ui, sheet.session, sheet.scale, at);
        actions.push(PlaybackAction::SetTime(time));
        actions.push(KeysEdit::Key(row.channels(sheet.session)));
    }
}

fn press_background(ui: &Ui, sheet: &DopeSheetView<'_>, at: Pos2, adds: bool) {
    let base = if adds { sheet.session.selection().keys().to_vec() } else { Vec::new() };
    let drag = BoxDrag { time: sheet.scale.time(at.x), y: sheet.content_y(at), base };
    drag::set(ui, TimelineDrag::Box(drag));
}

/// Continues the drag until the release of the mouse button or Esc.
pub(in crate::ui) fn follow(ui: &Ui, sheet: &DopeSheetView<'_>, actions: &mut Actions) {
    let Some(mouse) = ui.input(|input| input.pointer.latest_pos()) else {
        return;
    };
    match drag::get(ui) {
        Some(TimelineDrag::Keys(drag)) => {
            let shift = |drag: &KeyDrag, way| shift(ui, sheet, drag, way);
            drag::follow_keys(ui, sheet.session, drag, mouse, actions, shift);
        }
        Some(TimelineDrag::Box(drag)) => draw_box(ui, sheet, &drag, mouse, actions),
        Some(TimelineDrag::Pan) if drag::is_released(ui) => drag::clear(ui),
        Some(_) | None => {}
    }
}

/// The shift of dragged keys for the way of the mouse, in points.
fn shift(ui: &Ui, sheet: &DopeSheetView<'_>, drag: &KeyDrag, way: Vec2) -> KeyShift {
    let later = drag.time + f64::from(way.x) / sheet.scale.points_per_second();
    let by = drag::snapped(ui, sheet.session.document().timeline, later) - drag.time;
    let count = labels::count_of_keys(drag.keys.len());
    let said = if drag::is_released(ui) {
        format!("Moved {count} by {by:+.2} s")
    } else {
        format!("Move {count}: {by:+.2} s     Ctrl off the frame grid · Esc cancel")
    };
    KeyShift { by, raise: Vec3::ZERO, said }
}

fn draw_box(
    ui: &Ui,
    sheet: &DopeSheetView<'_>,
    drag: &BoxDrag,
    mouse: Pos2,
    actions: &mut Actions,
) {
    if drag::is_cancelled(ui) {
        actions.push(SelectAction::Keys(drag.base.clone()));
        return drag::clear(ui);
    }
    let corner = place(sheet, drag);
    let is_box = (mouse - corner).length() > drag::SLACK;
    let mut keys = drag.base.clone();
    if is_box {
        let (time, y) = (sheet.scale.time(mouse.x), sheet.content_y(mouse));
        let times = (drag.time.min(time), drag.time.max(time));
        let inside = sheet.keys_in(times, (drag.y.min(y), drag.y.max(y)));
        let picked = KeySet::of(sheet.session, &keys);
        keys.extend(inside.into_iter().filter(|key| !picked.has_key(*key)));
    }
    if keys != sheet.session.selection().keys() {
        actions.push(SelectAction::Keys(keys));
    }
    if drag::is_released(ui) {
        drag::clear(ui);
    }
}

fn place(sheet: &DopeSheetView<'_>, drag: &BoxDrag) -> Pos2 {
    let y = drag.y - sheet.offset + ROW + sheet.area.top();
    pos2(sheet.scale.x(drag.time), y)
}

/// Draws the selection box.
pub(in crate::ui) fn paint_box(ui: &Ui, sheet: &DopeSheetView<'_>) {
    let (Some(TimelineDrag::Box(drag)), Some(mouse)) =
        (drag::get(ui), ui.input(|input| input.pointer.latest_pos()))
    else {
        return;
    };
    let accent = style::accent(ui);
    let rect = Rect::from_two_pos(place(sheet, &drag), mouse);
    let painter = ui.painter().with_clip_rect(sheet.area);
    let rim = Stroke::new(1.0, accent);
    painter.rect(rect, 0.0, accent.gamma_multiply(0.15), rim, egui::StrokeKind::Inside);
}
