//! Rows of the dope sheet, and their keys.

use std::collections::HashSet;

use egui::Ui;

use crate::document::Channel;
use crate::session::{Key, SelectAction, Session};

/// A row with the keys of all channels or of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::ui) enum DopeSheetRow {
    All,
    Channel(Channel),
}

/// The channels that have keys; channels of the shown rig come first.
pub(in crate::ui) fn channels(session: &Session) -> Vec<Channel> {
    let rig = Some(session.rig());
    let keyed = session.document().keys.tracks().map(|(channel, _)| channel);
    let (mut first, others): (Vec<_>, Vec<_>) = keyed.partition(|channel| channel.rig() == rig);
    first.extend(others);
    first
}

impl DopeSheetRow {
    /// Sorted times of the row's keys between `from` and `to`, in seconds.
    pub fn times(self, session: &Session, from: f64, to: f64) -> Vec<f64> {
        let keys = &session.document().keys;
        match self {
            Self::Channel(channel) => {
                keys.track(channel).map_or_else(Vec::new, |track| times(track, from, to).collect())
            }
            Self::All => {
                let tracks = keys.tracks();
                let mut all: Vec<f64> =
                    tracks.flat_map(|(_, track)| times(track, from, to)).collect();
                all.sort_unstable_by(f64::total_cmp);
                all.dedup();
                all
            }
        }
    }

    /// The row's keys at a time in seconds.
    pub fn keys(self, session: &Session, time: f64) -> Vec<Key> {
        match self {
            Self::Channel(channel) => vec![(channel, time)],
            Self::All => {
                let tracks = session.document().keys.tracks();
                let there = tracks.filter(|(_, track)| track.get(time).is_some());
                there.map(|(channel, _)| (channel, time)).collect()
            }
        }
    }

    /// Channels to which "Add key" adds a key in this row.
    pub fn channels(self, session: &Session) -> Vec<Channel> {
        match self {
            Self::Channel(channel) => vec![channel],
            Self::All => session.keyed_channels().collect(),
        }
    }
}

type Track = crate::kinematics::spline::Spline<glam::Vec3>;

fn times(track: &Track, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
    let knots = track.knots();
    let first = knots.partition_point(|knot| knot.time < from);
    let seen = knots.iter().skip(first).take_while(move |knot| knot.time <= to);
    seen.map(|knot| knot.time)
}

/// The selection after a click on the name of a channel: the channel alone, or none if it was alone
/// before; with Shift or Ctrl it is added or removed.
pub(in crate::ui) fn clicked(ui: &Ui, session: &Session, channel: Channel) -> SelectAction {
    let selected = session.selection().channels();
    let is_selected = selected.contains(&channel);
    let several = ui.input(|input| input.modifiers.shift || input.modifiers.command);
    let goes = is_selected && (several || selected.len() == 1);
    let others = selected.iter().copied().filter(|other| several && *other != channel);
    SelectAction::Channels(others.chain((!goes).then_some(channel)).collect())
}

/// A set of keys with fast lookup.
pub(in crate::ui) struct SelectedKeys {
    keys: HashSet<(Channel, u64)>,
    times: HashSet<u64>,
}

impl SelectedKeys {
    pub fn new(session: &Session) -> Self {
        Self::of(session.selection().keys())
    }

    pub fn of(keys: &[Key]) -> Self {
        let bits = |time: f64| (time + 0.0).to_bits();
        let keys = keys.iter();
        Self {
            keys: keys.clone().map(|(channel, time)| (*channel, bits(*time))).collect(),
            times: keys.map(|(_, time)| bits(*time)).collect(),
        }
    }

    /// True if the set contains a key of the row at `time`.
    pub fn has(&self, row: DopeSheetRow, time: f64) -> bool {
        let bits = (time + 0.0).to_bits();
        match row {
            DopeSheetRow::All => self.times.contains(&bits),
            DopeSheetRow::Channel(channel) => self.keys.contains(&(channel, bits)),
        }
    }
}
