//! The areas of the timeline on screen; its rows, their keys, and clicks on their names.

use std::collections::{BTreeMap, HashMap, HashSet};

use egui::{Color32, FontId, Id, Rect, Response, StrokeKind, TextStyle, Ui, UiBuilder, pos2, vec2};
use glam::Vec3;

use crate::document::Channel;
use crate::kinematics::skeleton::JointId;
use crate::kinematics::spline::Spline;
use crate::session::{Key, KeysEdit, Session};

/// Width in points of the column of channel names.
pub(super) const NAMES: f32 = 180.0;
/// Height of the ruler in points.
pub(super) const RULER: f32 = 24.0;
/// Width in points of an axis of values beside the curves.
pub(super) const VALUES: f32 = 42.0;
/// Height of a row in points.
pub(super) const ROW: f32 = 20.0;
/// Number of channels with keys up to which all are shown at first.
const MOST_CHANNELS: usize = 8;

/// Moves the keyboard focus to the ruler if the mouse is pressed or clicked in `area`. The ruler
/// has the keyboard focus for the whole timeline.
pub(super) fn take_keyboard(ui: &Ui, area: &Response, ruler: &Response) {
    let touched = ui.input(|input| input.pointer.any_pressed() || input.pointer.any_click());
    if touched && area.contains_pointer() {
        ruler.request_focus();
    }
}

/// Rectangles of the parts of the timeline.
pub(super) struct TimelineAreas {
    pub whole: Rect,
    /// The names of the channels, left of the keys.
    pub names: Rect,
    pub ruler: Rect,
    pub keys: Rect,
}

impl TimelineAreas {
    pub fn new(whole: Rect) -> Self {
        let split = (whole.left() + NAMES).min(whole.right());
        let top = (whole.top() + RULER).min(whole.bottom());
        Self {
            whole,
            names: Rect::from_min_max(pos2(whole.left(), top), pos2(split, whole.bottom())),
            ruler: Rect::from_min_max(pos2(split, whole.top()), pos2(whole.right(), top)),
            keys: Rect::from_min_max(pos2(split, top), whole.max),
        }
    }
}

/// Paints a row that can be clicked as selected or under the mouse, and its keyboard focus.
pub(super) fn paint_state(ui: &Ui, rect: Rect, is_selected: bool, row: &Response) {
    let visuals = ui.visuals();
    let inside = rect.shrink2(vec2(2.0, 1.0));
    if is_selected {
        ui.painter().rect_filled(inside, 4.0, visuals.selection.bg_fill);
    } else if row.hovered() {
        ui.painter().rect_filled(inside, 4.0, visuals.widgets.hovered.weak_bg_fill);
    }
    if row.has_focus() {
        ui.painter().rect_stroke(inside, 4.0, visuals.selection.stroke, StrokeKind::Inside);
    }
}

/// Shows a sentence in weak colour in the middle of an empty area.
pub(in crate::ui) fn hint(ui: &mut Ui, area: Rect, sentence: &str) {
    let rect = Rect::from_center_size(area.center(), vec2(area.width(), ROW).min(area.size()));
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
        ui.centered_and_justified(|ui| {
            let text = egui::RichText::new(sentence).weak();
            ui.add(egui::Label::new(text).truncate().selectable(false));
        });
    });
}

/// Draws one line of text, truncated to the width of the rectangle.
pub(in crate::ui) fn line(ui: &Ui, rect: Rect, text: &str, colour: Color32) {
    let font: FontId = TextStyle::Body.resolve(ui.style());
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, colour);
    job.wrap = egui::text::TextWrapping::truncate_at_width((rect.width() - 14.0).max(8.0));
    let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
    let at = pos2(rect.left() + 10.0, rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, colour);
}

/// Writes the name of a joint, and beside it fainter that of its only channel, if it has room.
pub(in crate::ui) fn named(ui: &Ui, rect: Rect, [joint, channel]: [&str; 2], colour: Color32) {
    const LEAST: f32 = 40.0;
    line(ui, rect, joint, ui.visuals().strong_text_color());
    let font: FontId = TextStyle::Body.resolve(ui.style());
    let galley = ui.fonts_mut(|fonts| fonts.layout_no_wrap(joint.to_owned(), font, colour));
    let beside = rect.with_min_x(rect.left() + galley.size().x + 6.0);
    if beside.width() > LEAST {
        line(ui, beside, channel, colour);
    }
}

/// A row with the keys of all channels, of all of a joint, or of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum DopeSheetRow {
    /// The heading of all others.
    All { is_folded: bool },
    /// The heading of a joint with several channels that have keys.
    Joint { joint: JointId, is_folded: bool },
    Channel {
        channel: Channel,
        /// True if it stands below the heading of its joint.
        is_below: bool,
    },
}

/// What the user has folded or unfolded.
#[derive(Clone, Default)]
pub(in crate::ui) struct Folds {
    /// By the names of joints, whether their rows are folded.
    joints: HashMap<String, bool>,
    /// True if the rows of most joints are hidden, see [`rows`]; `None` if the number of channels
    /// decides.
    all: Option<bool>,
}

impl Folds {
    fn id() -> Id {
        Id::unique("folded rows of the timeline")
    }

    pub fn kept(ui: &Ui) -> Self {
        ui.data(|data| data.get_temp(Self::id())).unwrap_or_default()
    }

    fn keep(self, ui: &Ui) {
        ui.data_mut(|data| data.insert_temp(Self::id(), self));
    }

    /// Folds the rows of a joint, or unfolds them.
    pub fn fold_joint(ui: &Ui, name: &str, is_folded: bool) {
        let mut folds = Self::kept(ui);
        folds.joints.insert(name.to_owned(), is_folded);
        folds.keep(ui);
    }

    /// Hides the rows of most joints, or shows those of all.
    pub fn fold_all(ui: &Ui, is_folded: bool) {
        Self { all: Some(is_folded), ..Self::kept(ui) }.keep(ui);
    }

    /// True if the rows of most joints are hidden: at first where all would not be seen at once.
    fn hides_most(&self, channels: usize) -> bool {
        self.all.unwrap_or(channels > MOST_CHANNELS)
    }
}

/// The row of all keys, and below it those of channels without a joint, then joint by joint in the
/// order of the skeleton. If the row of all keys is folded, only those of the selected joints or, if
/// none is selected, the folded ones of joints with targets. A joint with several channels has a
/// heading. Empty without keys.
pub(in crate::ui) fn rows(session: &Session, folds: &Folds) -> Vec<DopeSheetRow> {
    let channels = channels(session);
    if channels.is_empty() {
        return Vec::new();
    }
    let is_folded = folds.hides_most(channels.len());
    let selected = session.selection().joints();
    let rig = session.rig();
    let is_shown = |joint: JointId| match selected {
        [] => rig.target_of_end(joint).is_some(),
        _ => selected.contains(&joint),
    };
    let mut of_joint: BTreeMap<Option<JointId>, Vec<Channel>> = BTreeMap::new();
    for channel in channels {
        let joint = session.document().joint_of(channel);
        if !is_folded || joint.is_some_and(is_shown) {
            of_joint.entry(joint).or_default().push(channel);
        }
    }
    let skeleton = session.skeleton();
    let mut rows = vec![DopeSheetRow::All { is_folded }];
    for (joint, channels) in of_joint {
        let heading = joint.filter(|_| channels.len() > 1);
        let name = heading.and_then(|joint| skeleton.joint(joint)).map(|joint| &joint.name);
        let at_first = is_folded && selected.is_empty();
        let is_folded = name.and_then(|name| folds.joints.get(name).copied()).unwrap_or(at_first);
        rows.extend(heading.map(|joint| DopeSheetRow::Joint { joint, is_folded }));
        let is_below = heading.is_some();
        let row = |channel| DopeSheetRow::Channel { channel, is_below };
        rows.extend(channels.into_iter().filter(|_| !is_folded).map(row));
    }
    rows
}

/// The channels that have keys.
pub(in crate::ui) fn channels(session: &Session) -> Vec<Channel> {
    session.document().keys.tracks().map(|(channel, _)| channel).collect()
}

impl DopeSheetRow {
    /// Sorted times of the row's keys between `from` and `to`, in seconds.
    pub fn times(self, session: &Session, from: f64, to: f64) -> Vec<f64> {
        let tracks = self.tracks(session);
        let mut all: Vec<f64> =
            tracks.into_iter().flat_map(|(_, track)| times(track, from, to)).collect();
        all.sort_unstable_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// The row's keys at a time in seconds.
    pub fn keys(self, session: &Session, time: f64) -> Vec<Key> {
        let tracks = self.tracks(session).into_iter();
        let there = tracks.filter(|(_, track)| track.get(time).is_some());
        there.map(|(channel, _)| (channel, time)).collect()
    }

    /// The channels of the row that have keys. That of one channel is looked up: a selection box over
    /// many rows asks for it at each of its keys.
    pub fn tracks(self, session: &Session) -> Vec<(Channel, &Spline<Vec3>)> {
        let keys = &session.document().keys;
        match self {
            Self::All { .. } => keys.tracks().collect(),
            Self::Joint { joint, .. } => {
                let is_below = |channel| session.document().joint_of(channel) == Some(joint);
                keys.tracks().filter(|(channel, _)| is_below(*channel)).collect()
            }
            Self::Channel { channel, .. } => {
                keys.track(channel).map(|track| (channel, track)).into_iter().collect()
            }
        }
    }

    /// Channels to which "Add key" adds a key in this row.
    pub fn channels(self, session: &Session) -> Vec<Channel> {
        match self {
            Self::Channel { channel, .. } => vec![channel],
            Self::Joint { .. } => {
                self.tracks(session).into_iter().map(|(channel, _)| channel).collect()
            }
            Self::All { .. } => KeysEdit::keyed_channels(session.shown()).collect(),
        }
    }
}

/// True if no track changes between two neighbouring times of their keys.
pub(super) fn are_held(tracks: &[(Channel, &Spline<Vec3>)], [from, to]: [f64; 2]) -> bool {
    /// Of the largest component: what rounding may change.
    const ROUNDING: f32 = 1e-5;
    // Enough times for a cubic curve, which is level at most twice.
    let times = [0.25, 0.5, 0.75, 1.0].map(|part| from + part * (to - from));
    tracks.iter().all(|(_, track)| {
        track.at(from).is_none_or(|start| {
            let most = ROUNDING * start.abs().max_element();
            let held = |time| track.at(time).is_some_and(|it| it.abs_diff_eq(start, most));
            times.into_iter().all(held)
        })
    })
}

fn times(track: &Spline<Vec3>, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
    let knots = track.knots();
    let first = knots.partition_point(|knot| knot.time < from);
    let seen = knots.iter().skip(first).take_while(move |knot| knot.time <= to);
    seen.map(|knot| knot.time)
}

/// The selection after a click on a name: that channel or joint alone, or none if it was alone
/// before; with Shift or Ctrl it is added or removed.
pub(in crate::ui) fn after_click<'a, T: Copy + PartialEq + 'a, C: FromIterator<T>>(
    ui: &Ui,
    selected: impl IntoIterator<Item = &'a T>,
    name: T,
) -> C {
    let selected: Vec<T> = selected.into_iter().copied().collect();
    let several = ui.input(|input| input.modifiers.shift || input.modifiers.command);
    let goes = selected.contains(&name) && (several || selected.len() == 1);
    let others = selected.into_iter().filter(|other| several && *other != name);
    others.chain((!goes).then_some(name)).collect()
}

/// A set of keys with fast lookup.
pub(in crate::ui) struct KeySet {
    keys: HashSet<(Channel, u64)>,
    joints: HashSet<(JointId, u64)>,
    times: HashSet<u64>,
}

impl KeySet {
    pub fn new(session: &Session) -> Self {
        Self::of(session, session.selection().keys())
    }

    pub fn of(session: &Session, keys: &[Key]) -> Self {
        let bits = |time: f64| (time + 0.0).to_bits();
        let keys = keys.iter();
        let joint =
            |(channel, time): &Key| Some((session.document().joint_of(*channel)?, bits(*time)));
        Self {
            keys: keys.clone().map(|(channel, time)| (*channel, bits(*time))).collect(),
            joints: keys.clone().filter_map(joint).collect(),
            times: keys.map(|(_, time)| bits(*time)).collect(),
        }
    }

    /// True if the set contains a key of the row at `time`.
    pub fn has(&self, row: DopeSheetRow, time: f64) -> bool {
        let bits = (time + 0.0).to_bits();
        match row {
            DopeSheetRow::All { .. } => self.times.contains(&bits),
            DopeSheetRow::Joint { joint, .. } => self.joints.contains(&(joint, bits)),
            DopeSheetRow::Channel { channel, .. } => self.has_key((channel, time)),
        }
    }

    pub fn has_key(&self, (channel, time): Key) -> bool {
        self.keys.contains(&(channel, (time + 0.0).to_bits()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::Example;
    use crate::session::Preferences;

    /// In the walk a foot that stands has equal keys, and each pair of keys that differ moves it.
    #[test]
    fn a_foot_is_held_between_equal_keys_alone() {
        let walk = Example::find("walk").expect("an example").open().expect("valid");
        let session = Session::with_document(Preferences::default(), walk.document);
        let mut held = 0;
        for name in ["left_foot", "right_foot"] {
            let joint = session.skeleton().find(name).expect("a joint");
            let row = DopeSheetRow::Joint { joint, is_folded: true };
            let tracks = row.tracks(&session);
            assert_eq!(tracks.len(), 2, "{name}: its place and its rotation");
            for pair in row.times(&session, 0.0, 2.0).windows(2) {
                let [from, to] = [pair[0], pair[1]];
                let is_equal = tracks.iter().all(|(_, track)| track.get(from) == track.get(to));
                let is_held = are_held(&tracks, [from, to]);
                assert!(is_equal || !is_held, "{name} from {from} s to {to} s");
                held += usize::from(is_held);
            }
        }
        assert!(held >= 4, "{held} stands");
    }
}
