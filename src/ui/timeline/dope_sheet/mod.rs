//! The dope sheet: a row for all keys and one for every keyed channel, joint by joint.

pub(super) mod mouse;

use egui::containers::scroll_area::{DragScroll, ScrollSource};
use egui::{
    Color32, Id, Rect, Response, Role, ScrollArea, Sense, Stroke, TextStyle, Ui, UiBuilder,
    WidgetInfo, accesskit, pos2, vec2,
};

use super::context_menu;
use super::rows::{self, DopeSheetRow, Folds, KeySet, ROW, TimelineAreas};
use super::time_scale::TimeScale;
use crate::document::{Channel, Quantity};
use crate::kinematics::skeleton::JointId;
use crate::session::{Actions, KeysEdit, SelectAction, Session};
use crate::ui::widgets::diamond;
use crate::ui::{labels, style, widgets};
use mouse::DopeSheetView;

/// Distance in points from the centre of a key's diamond to a corner.
const SIZE: f32 = 5.0;
/// The same for the key of one channel, below those of several.
const OF_CHANNEL: f32 = 4.0;
/// The same where keys are dense: at most this part of their mean distance, and at least a number of
/// points.
const DENSE: f32 = 0.15;
const SMALLEST: f32 = 2.0;
/// Space at the left of a name below a heading, in points.
const INDENT: f32 = 12.0;
/// A key that is closer than this distance, in points, to the key at its left has no tooltip.
const NEAR: f32 = 5.0;

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    scale: TimeScale,
    areas: &TimelineAreas,
    ruler: &Response,
    actions: &mut Actions,
) {
    let rows = rows::rows(session, &Folds::kept(ui));
    let Some((&all, rows)) = rows.split_first() else {
        let sentence = "No keys. Pose the rig and press K to add keys at the playhead";
        rows::hint(ui, areas.keys, sentence);
        return;
    };
    let shown = DopeSheet { session, scale, picked: KeySet::new(session), areas, ruler };
    let first = Rect::from_min_size(areas.names.min, vec2(areas.whole.width(), ROW));
    // Tab comes to the name at its left before it comes to the sheet.
    shown.title(ui, all, first, actions);
    let body = ui.interact(areas.keys, Id::unique("timeline rows"), Sense::click_and_drag());
    body.widget_info(|| WidgetInfo::labeled(Role::Group, true, "Dope sheet"));
    shown.row_keys(ui, all, first, actions);
    let rest = Rect::from_min_max(pos2(areas.whole.left(), first.bottom()), areas.whole.max);
    let offset = shown.scrolled(ui, rows, rest, actions);
    if rows.is_empty() {
        let below = rest.intersect(areas.keys);
        let sentence = match session.selection().joints() {
            [] => "Select a joint to see its keys, or unfold all joints at the left",
            _ => "No keys of the selected joints. Press K to add keys at the playhead",
        };
        rows::hint(ui, below, sentence);
    }

    let sheet = DopeSheetView { session, scale, all, rows, area: areas.keys, offset };
    mouse::press(ui, &sheet, &body, ruler, actions);
    mouse::follow(ui, &sheet, actions);
    context_menu::of_rows(ui, &sheet, &body, actions);
    mouse::paint_box(ui, &sheet);
}

/// Colour of a channel's keys, by what it holds: angles, places, or anything else.
fn key_colour(ui: &Ui, channel: Channel) -> Color32 {
    let palette = style::palette(ui);
    match channel.quantity() {
        Quantity::Rotation | Quantity::Angle => style::colour(palette.upper),
        Quantity::Point | Quantity::Length => style::colour(palette.lower),
        _ => ui.visuals().text_color(),
    }
}

struct DopeSheet<'a> {
    session: &'a Session,
    scale: TimeScale,
    picked: KeySet,
    areas: &'a TimelineAreas,
    ruler: &'a Response,
}

impl DopeSheet<'_> {
    /// Shows the visible ones of some rows in a scroll area. Returns the scroll offset in points.
    fn scrolled(
        &self,
        ui: &mut Ui,
        rows: &[DopeSheetRow],
        rect: Rect,
        actions: &mut Actions,
    ) -> f32 {
        // The wheel scrolls over the names only, because over the keys it zooms.
        let mouse_wheel = ui.rect_contains_pointer(self.areas.names);
        let source = ScrollSource { scroll_bar: true, drag: DragScroll::Never, mouse_wheel };
        let scroll = ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            let area = ScrollArea::vertical().id_salt("rows").auto_shrink(false);
            area.scroll_source(source).show_viewport(ui, |ui, seen| {
                ui.set_height(ROW * rows.len() as f32);
                let (top, left) = (ui.max_rect().top(), rect.left());
                let first = (seen.top() / ROW).floor().max(0.0) as usize;
                let count = (seen.height() / ROW).ceil() as usize + 1;
                for (nth, row) in rows.iter().enumerate().skip(first).take(count) {
                    let at = pos2(left, top + ROW * nth as f32);
                    let rect = Rect::from_min_size(at, vec2(rect.width(), ROW));
                    self.title(ui, *row, rect, actions);
                    self.row_keys(ui, *row, rect, actions);
                }
            })
        });
        scroll.inner.state.clamped_offset().y
    }

    /// Shows the name of a row, and the line below it.
    fn title(&self, ui: &Ui, row: DopeSheetRow, rect: Rect, actions: &mut Actions) {
        let name = rect.with_max_x(self.areas.keys.left());
        let line = ui.visuals().widgets.noninteractive.bg_stroke.color.gamma_multiply(0.6);
        ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, Stroke::new(1.0, line));
        match row {
            DopeSheetRow::All { is_folded } => self.heading_of_all(ui, is_folded, name),
            DopeSheetRow::Joint { joint, is_folded } => self.heading(ui, joint, is_folded, name),
            DopeSheetRow::Channel { channel, is_below } => {
                self.name(ui, channel, is_below, name, actions);
            }
        }
    }

    fn row_keys(&self, ui: &Ui, row: DopeSheetRow, rect: Rect, actions: &mut Actions) {
        let keys = rect.with_min_x(self.areas.keys.left());
        self.keys(ui, row, keys, actions);
        if let DopeSheetRow::Channel { channel, .. } = row
            && self.session.history().is_overridden(channel)
        {
            self.overridden(ui, channel, keys);
        }
    }

    /// Shows the name of the row of all keys. A click hides the rows of most joints, or shows those of
    /// all.
    fn heading_of_all(&self, ui: &Ui, is_folded: bool, rect: Rect) {
        let response = self.fold(ui, ["All", "Keys of all joints"], is_folded, rect);
        if response.clicked() {
            Folds::fold_all(ui, !is_folded);
        }
        response.on_hover_text(match is_folded {
            true => "Show the channels of all joints",
            false => "Show the channels of selected joints alone, or of joints with targets",
        });
    }

    /// Shows the name of a joint. A click folds or unfolds its rows.
    fn heading(&self, ui: &Ui, joint: JointId, is_folded: bool, rect: Rect) {
        let joints = &self.session.rig().skeleton;
        let name = joints.joint(joint).map_or("–", |joint| joint.name.as_str());
        let response = self.fold(ui, [name, &format!("Keys of {name}")], is_folded, rect);
        if response.clicked() {
            Folds::fold_joint(ui, name, !is_folded);
        }
        let verb = if is_folded { "Show" } else { "Hide" };
        response.on_hover_text(format!("{verb} the channels of {name}"));
    }

    /// Shows a triangle with a name, and another name to the screen reader.
    fn fold(&self, ui: &Ui, [name, said]: [&str; 2], is_folded: bool, rect: Rect) -> Response {
        let response = ui.interact(rect, Id::unique(("timeline rows of", said)), Sense::click());
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, !is_folded, said));
        rows::paint_state(ui, rect, false, &response);
        let mark = pos2(rect.left() + 12.0, rect.center().y);
        widgets::fold_mark(ui.painter(), mark, is_folded, ui.visuals().weak_text_color());
        let text = rect.with_min_x(rect.left() + INDENT);
        rows::line(ui, text, name, ui.visuals().strong_text_color());
        if response.clicked() {
            self.ruler.request_focus();
        }
        response
    }

    /// Shows the name of a channel, without its joint if it stands below that. A click selects the
    /// channel, and with Shift or Ctrl adds it to the selection or removes it.
    fn name(&self, ui: &Ui, channel: Channel, is_below: bool, rect: Rect, actions: &mut Actions) {
        let session = self.session;
        let selected = session.selection().channels().contains(&channel);
        let shown = labels::channel(session, channel);
        let id = Id::unique(("timeline channel", channel));
        let response = ui.interact(rect, id, Sense::click());
        response.widget_info(|| {
            WidgetInfo::selected(Role::Button, true, selected, format!("Channel {shown}"))
        });
        rows::paint_state(ui, rect, selected, &response);
        let visuals = ui.visuals();
        let is_lit = selected || response.hovered();
        let colour = if is_lit { visuals.strong_text_color() } else { visuals.text_color() };
        let short = labels::channel_of_joint(channel);
        let indent = if is_below { 1.6 * INDENT } else { INDENT };
        let text = rect.with_min_x(rect.left() + indent);
        let joint = session.document().joint_of(channel).filter(|_| !is_below);
        match joint.and_then(|joint| session.rig().skeleton.joint(joint)) {
            Some(joint) => rows::named(ui, text, [&joint.name, &short], colour),
            None => rows::line(ui, text, if is_below { &short } else { &shown }, colour),
        }
        if response.clicked() {
            self.ruler.request_focus();
            let channels = rows::after_click(ui, session.selection().channels(), channel);
            actions.push(SelectAction::Channels(channels));
        }
        context_menu::of_channel(&response, session, channel, actions);
        response.on_hover_text(format!("Select {shown}; Shift or Ctrl adds it to the selection"));
    }

    /// Draws a bar between two keys of a row where its channels are held, and writes so into a long bar.
    /// The row of all keys has none.
    fn holds(&self, ui: &Ui, row: DopeSheetRow, times: &[f64], rect: Rect) {
        const HEIGHT: f32 = 3.0;
        // Least length of a bar, and of one with a word, in points.
        const LEAST: f32 = 3.0 * SIZE;
        const ROOMY: f32 = 64.0;
        if matches!(row, DopeSheetRow::All { .. }) {
            return;
        }
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        let weak = ui.visuals().weak_text_color();
        let tracks = row.tracks(self.session);
        for pair in times.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|time| self.scale.x(time));
            if to - from < LEAST || !rows::are_held(&tracks, [pair[0], pair[1]]) {
                continue;
            }
            let middle = pos2(0.5 * (from + to), rect.center().y);
            let bar = Rect::from_center_size(middle, vec2(to - from, HEIGHT));
            painter.rect_filled(bar, 1.0, weak.gamma_multiply(0.6));
            if bar.width() > ROOMY {
                let font = TextStyle::Small.resolve(ui.style());
                let word = painter.layout_no_wrap("held".to_owned(), font, weak);
                let at = Rect::from_center_size(middle, word.size());
                painter.rect_filled(at.expand2(vec2(4.0, 0.0)), 0.0, ui.visuals().extreme_bg_color);
                painter.galley(at.min, word, weak);
            }
        }
    }

    fn keys(&self, ui: &Ui, row: DopeSheetRow, rect: Rect, actions: &mut Actions) {
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        let (from, to) = self.scale.range();
        let playback = self.session.playback();
        let frame = 1.0 / self.session.document().timeline.frame_rate;
        let is_now = |time: f64| (time - playback.time()).abs() < 0.5 * frame;
        let mut last = f32::NEG_INFINITY;
        let times: Vec<f64> = row.times(self.session, from, to);
        self.holds(ui, row, &times, rect);
        // NaN for a single key, which has no limit then.
        let ends = times.first().zip(times.last());
        let mean_gap = ends.map_or(0.0, |(first, last)| self.scale.x(*last) - self.scale.x(*first))
            / times.len().saturating_sub(1) as f32;
        for (index, &time) in times.iter().enumerate() {
            let x = self.scale.x(time);
            let neighbours = [index.checked_sub(1), Some(index + 1)].into_iter().flatten();
            let gaps =
                neighbours.filter_map(|other| Some((self.scale.x(*times.get(other)?) - x).abs()));
            let gap = gaps.fold(f32::INFINITY, f32::min);
            let room = SMALLEST.max((0.5 * gap).min(DENSE * mean_gap));
            let picked = self.picked.has(row, time);
            if x - last < 1.0 && !picked {
                continue;
            }
            let at = pos2(x, rect.center().y);
            let hovered = x - last >= NEAR && self.key(ui, row, time, at, rect, actions);
            last = x;
            let visuals = ui.visuals();
            let (plain, colour) = match row {
                DopeSheetRow::All { .. } | DopeSheetRow::Joint { .. } => {
                    (SIZE, visuals.weak_text_color())
                }
                DopeSheetRow::Channel { channel, .. } => (OF_CHANNEL, key_colour(ui, channel)),
            };
            let (size, fill, rim) = if picked {
                (SIZE + 1.0, style::accent(ui), Stroke::new(1.5, visuals.strong_text_color()))
            } else {
                let colour = if is_now(time) { visuals.strong_text_color() } else { colour };
                (plain, colour, Stroke::new(1.0, visuals.extreme_bg_color))
            };
            let size = if hovered { size + 1.0 } else { size.min(room) };
            painter.add(diamond(at, size, fill, rim));
        }
    }

    /// Adds the tooltip and the screen reader node of a key. Returns whether the mouse is over the
    /// key.
    fn key(
        &self,
        ui: &Ui,
        row: DopeSheetRow,
        time: f64,
        at: egui::Pos2,
        row_rect: Rect,
        actions: &mut Actions,
    ) -> bool {
        let rect = Rect::from_center_size(at, vec2(2.0 * SIZE, 2.0 * SIZE + 2.0));
        let (id, said) = match row {
            DopeSheetRow::All { .. } => {
                (Id::unique(("timeline keys", time.to_bits())), format!("Keys at {time:.2} s"))
            }
            DopeSheetRow::Joint { joint, .. } => {
                let joints = &self.session.rig().skeleton;
                let name = joints.joint(joint).map_or("–", |joint| &joint.name);
                (
                    Id::unique(("timeline keys of joint", joint, time.to_bits())),
                    format!("Keys of {name} at {time:.2} s"),
                )
            }
            DopeSheetRow::Channel { channel, .. } => (
                Id::unique(("timeline key", channel, time.to_bits())),
                format!("Key of {} at {time:.2} s", labels::channel(self.session, channel)),
            ),
        };
        // A key senses no presses: the whole sheet handles them.
        let response = ui.interact(rect.intersect(row_rect), id, Sense::hover());
        let picked = self.picked.has(row, time);
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, picked, &said));
        ui.ctx().accesskit_node_builder(id, |node| node.add_action(accesskit::Action::Click));
        if ui.input(|input| input.has_accesskit_action_request(id, accesskit::Action::Click)) {
            actions.push(SelectAction::Keys(row.keys(self.session, time)));
        }
        let hovered = response.hovered();
        response.on_hover_text(format!("Click to select, drag to move. {said}"));
        hovered
    }

    /// Draws the mark of an unkeyed change of the channel at the playhead, with a tooltip.
    fn overridden(&self, ui: &Ui, channel: Channel, rect: Rect) {
        let at = pos2(self.scale.x(self.session.playback().time()), rect.center().y);
        let id = Id::unique(("timeline override", channel));
        let size = vec2(4.0 * SIZE, ROW);
        let response =
            ui.interact(Rect::from_center_size(at, size).intersect(rect), id, Sense::hover());
        let key = if KeysEdit::channels_to_key(self.session).contains(&channel) {
            "K"
        } else {
            "Shift+K"
        };
        let name = labels::channel(self.session, channel);
        let said =
            format!("{name}: unkeyed change, press {key} or it is lost when the time changes");
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &said));
        let rim = Stroke::new(2.0, style::accent(ui));
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        painter.add(diamond(at, SIZE + 2.0, Color32::TRANSPARENT, rim));
        response.on_hover_text(said);
    }
}
