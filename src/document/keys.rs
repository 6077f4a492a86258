use core::ops::RangeInclusive;
use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;

use super::channel::{Channel, Quantity, is_on};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointId, JointRemap, exact_angles};
use crate::kinematics::spline::{Interpolation, Knot, Segment, Spline};

/// The keys of a document: for every keyed channel a track, the spline through its keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keys {
    /// One track per keyed channel, never empty. An edit copies the map and the tracks that it
    /// changes; all other tracks stay shared.
    tracks: Shared<Tracks>,
}

type Tracks = BTreeMap<Channel, Shared<Spline<Vec3>>>;

impl Keys {
    /// True if no channel is keyed.
    pub fn is_empty(&self) -> bool {
        self.tracks.is_empty()
    }

    /// All keyed channels with their tracks, sorted by channel.
    pub fn tracks(&self) -> impl Iterator<Item = (Channel, &Spline<Vec3>)> {
        self.tracks.iter().map(|(channel, track)| (*channel, &**track))
    }

    /// The track of a channel; `None` without keys.
    pub fn track(&self, channel: Channel) -> Option<&Spline<Vec3>> {
        self.tracks.get(&channel).map(|track| &**track)
    }

    /// [`Keys::track`], shared.
    pub(super) fn shared_track(&self, channel: Channel) -> Option<Shared<Spline<Vec3>>> {
        self.tracks.get(&channel).cloned()
    }

    /// The channels whose keys differ from those in `other`.
    pub(super) fn changed_channels(&self, other: &Self) -> BTreeSet<Channel> {
        if self.tracks == other.tracks {
            return BTreeSet::new();
        }
        let all = self.tracks.keys().chain(other.tracks.keys()).copied();
        all.filter(|channel| self.tracks.get(channel) != other.tracks.get(channel)).collect()
    }

    /// True if a channel is keyed.
    pub fn has(&self, channel: Channel) -> bool {
        self.tracks.contains_key(&channel)
    }

    /// Size in bytes of the parts of these keys that are not shared with `other`.
    pub(crate) fn unshared_bytes(&self, other: Option<&Self>) -> usize {
        if other.is_some_and(|other| self.tracks.is_same(&other.tracks)) {
            return 0;
        }
        let is_shared = |channel: &Channel, track: &Shared<_>| {
            let theirs = other.and_then(|other| other.tracks.get(channel));
            theirs.is_some_and(|theirs| theirs.is_same(track))
        };
        let own = self.tracks.iter().filter(|(channel, track)| !is_shared(channel, track));
        let knots = own.map(|(_, track)| size_of_val(track.knots())).sum::<usize>();
        self.tracks.len() * size_of::<(Channel, Shared<Spline<Vec3>>)>() + knots
    }

    /// Total number of keys of all channels.
    pub fn count(&self) -> usize {
        self.tracks.values().map(|track| track.knots().len()).sum()
    }

    /// Adds a key at a time in seconds with a Catmull–Rom curve, or sets the value of the channel's
    /// key at that time, which keeps its curve. Does nothing if the time or the value is not
    /// finite.
    pub fn insert(&mut self, channel: Channel, time: f64, value: Vec3) {
        if time.is_finite() && value.is_finite() {
            self.tracks.make_mut().entry(channel).or_default().make_mut().insert(time, value);
        }
    }

    /// Adds a key as the user interface does, with an automatic curve, or sets the value of the
    /// channel's key at that time, which keeps its curve. Switches are not interpolated and keep
    /// the default. Does nothing if the time or the value is not finite.
    pub fn insert_auto(&mut self, channel: Channel, time: f64, value: Vec3) {
        let new = || Knot { interpolation: new_interpolation(channel), ..Knot::new(time, value) };
        let key = self.key(channel, time).unwrap_or_else(new);
        self.insert_key(channel, Knot { value, ..key });
    }

    /// Adds a key with its interpolation and slopes, or replaces the channel's key at its time.
    /// Does nothing if the time, the value or a slope is not finite.
    pub fn insert_key(&mut self, channel: Channel, key: Knot<Vec3>) {
        let slopes = key.slopes.iter().flat_map(|it| [it.arriving, it.leaving]);
        if key.time.is_finite() && slopes.chain([key.value]).all(Vec3::is_finite) {
            self.tracks.make_mut().entry(channel).or_default().make_mut().insert_knot(key);
        }
    }

    /// The key of a channel at a time in seconds; `None` if there is none.
    pub fn key(&self, channel: Channel, time: f64) -> Option<Knot<Vec3>> {
        self.track(channel)?.knot(time).copied()
    }

    /// Replaces all keys of a channel by those of a track.
    pub(crate) fn set_track(&mut self, channel: Channel, track: Spline<Vec3>) {
        if track.is_empty() {
            self.clear(channel);
        } else {
            self.tracks.make_mut().insert(channel, Shared::from(track));
        }
    }

    /// Removes a key and returns its value; `None` if the channel has no key at that time.
    pub fn remove(&mut self, channel: Channel, time: f64) -> Option<Vec3> {
        let value = self.track(channel)?.get(time)?;
        self.remove_all(&[(channel, time)]);
        Some(value)
    }

    /// Removes keys, each given by its channel and time.
    pub fn remove_all(&mut self, keys: &[(Channel, f64)]) {
        let mut times: BTreeMap<Channel, Vec<f64>> = BTreeMap::new();
        for (channel, time) in keys {
            times.entry(*channel).or_default().push(*time);
        }
        for (channel, mut times) in times {
            times.sort_unstable_by(f64::total_cmp);
            let Some(track) = self.track(channel) else { continue };
            let goes = |time: f64| times.binary_search_by(|other| other.total_cmp(&time)).is_ok();
            let left = track.knots().iter().filter(|knot| !goes(knot.time));
            let left = left.copied().collect();
            self.set_track(channel, left);
        }
    }

    /// Removes all keys of a channel.
    pub fn clear(&mut self, channel: Channel) {
        if self.has(channel) {
            self.tracks.make_mut().remove(&channel);
        }
    }

    /// Interpolated value of a channel at a time in seconds, before the limits of joints are
    /// applied; `None` without keys.
    pub fn value(&self, channel: Channel, time: f64) -> Option<Vec3> {
        let track = self.track(channel)?;
        match (channel, channel.quantity()) {
            (Channel::Target(joint), _) => self.target(joint, time),
            (Channel::Pin(joint), _) => self.pin(joint, time),
            (_, Quantity::Switch) => track.step(time),
            (_, Quantity::Length) => Some(track.at(time)?.max(Vec3::X * min_length(track))),
            (_, Quantity::Fraction) => Some(track.at(time)?.clamp(Vec3::ZERO, Vec3::X)),
            (_, Quantity::Rotation) => rotation(track, time),
            (_, Quantity::Point | Quantity::Angle | Quantity::Number | Quantity::Numbers) => {
                track.at(time)
            }
        }
    }

    /// The times of all keys in seconds, ascending and without duplicates.
    pub fn times(&self) -> Vec<f64> {
        let knots = self.tracks.values().flat_map(|track| track.knots());
        let mut times: Vec<f64> = knots.map(|knot| knot.time).collect();
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Renumbers the joints of channels; drops the keys of removed joints.
    pub fn remap(&mut self, remap: &JointRemap) {
        let remapped = |(channel, track): (&Channel, &Shared<Spline<Vec3>>)| {
            Some((channel.remapped(remap)?, track.clone()))
        };
        self.tracks = Shared::from(self.tracks.iter().filter_map(remapped).collect::<Tracks>());
    }
}

/// The curve of new keys.
fn new_interpolation(channel: Channel) -> Interpolation {
    if channel.is_switch() { Interpolation::default() } else { Interpolation::Auto }
}

/// Interpolated angles of a joint; `None` without keys.
fn rotation(track: &Spline<Vec3>, time: f64) -> Option<Vec3> {
    match track.segment(time) {
        Some(Segment { from, to, part }) if from.interpolation == Interpolation::Slerp => {
            let [from, to] = [from, to].map(|knot| knot.value.as_dvec3());
            Some(exact_angles::slerp(from, to, part).as_vec3())
        }
        _ => track.at(time),
    }
}

/// Minimum interpolated value of a keyed length: a thousandth of the longest key. A spline can
/// overshoot to 0 and below, but a bone must have a length above 0.
fn min_length(track: &Spline<Vec3>) -> f32 {
    const FRACTION: f32 = 1e-3;
    let longest = track.knots().iter().map(|knot| knot.value.x).fold(0.0, f32::max);
    (FRACTION * longest).max(f32::MIN_POSITIVE)
}

/// Points of a target whose pin is keyed. A plant is a stretch of time in which a keyed pin holds
/// the target in the world. The splines of the points end where plants begin and end, so that
/// keys of one plant move the target neither in another one nor on the way to it.
impl Keys {
    /// Interpolated value of [`Channel::Pin`] at a time in seconds: on the spline through the keys
    /// of one plant alone, its ends included. A plant without keys is at the last key before it.
    fn pin(&self, joint: JointId, time: f64) -> Option<Vec3> {
        let pin = self.track(Channel::Pin(joint))?;
        let Some(switch) = self.track(Channel::Pinned(joint)) else {
            return pin.at(time);
        };
        pin.at_among(stretch(switch, time), time).or_else(|| pin.step(time))
    }

    /// Interpolated value of [`Channel::Target`] at a time in seconds. A key in a plant, its ends
    /// included, ends the spline before it and begins the one after it.
    fn target(&self, joint: JointId, time: f64) -> Option<Vec3> {
        let target = self.track(Channel::Target(joint))?;
        let Some(switch) = self.track(Channel::Pinned(joint)) else {
            return target.at(time);
        };
        let is_end = |knot: &&Knot<Vec3>| is_planted(switch, knot.time);
        let (past, future) = split(target, |knot| knot.time <= time);
        let start = past.iter().rfind(is_end).map_or(f64::NEG_INFINITY, |knot| knot.time);
        let end = future.iter().find(is_end).map_or(f64::INFINITY, |knot| knot.time);
        target.at_among(start..=end, time)
    }

    /// Time in seconds at which the last plant of a joint's target before `time` begins; `None` if
    /// none does.
    pub(super) fn last_plant_start(&self, joint: JointId, time: f64) -> Option<f64> {
        let (past, _) = split(self.track(Channel::Pinned(joint))?, |knot| knot.time < time);
        let starts = |pair: &&[Knot<Vec3>]| !is_on(pair[0].value) && is_on(pair[1].value);
        Some(past.windows(2).rfind(starts)?[1].time)
    }
}

/// The stretch of time around `time`, in seconds, from one change of a switch to the next.
fn stretch(switch: &Spline<Vec3>, time: f64) -> RangeInclusive<f64> {
    let (past, future) = split(switch, |knot| knot.time <= time);
    let is_now = is_on_after(past, switch);
    let differs = |knot: &Knot<Vec3>| is_on(knot.value) != is_now;
    let last = past.iter().rposition(differs).map(|last| switch.knots()[last + 1].time);
    let next = future.iter().find(|knot| differs(knot)).map(|next| next.time);
    last.unwrap_or(f64::NEG_INFINITY)..=next.unwrap_or(f64::INFINITY)
}

/// True if a time, in seconds, is in a plant or at one of its ends.
fn is_planted(switch: &Spline<Vec3>, time: f64) -> bool {
    let (before, _) = split(switch, |knot| knot.time < time);
    let (until, _) = split(switch, |knot| knot.time <= time);
    [before, until].into_iter().any(|past| is_on_after(past, switch))
}

/// The knots of a spline for which `is_past` holds, and those after them.
fn split(
    spline: &Spline<Vec3>,
    is_past: impl Fn(&Knot<Vec3>) -> bool,
) -> (&[Knot<Vec3>], &[Knot<Vec3>]) {
    let knots = spline.knots();
    knots.split_at(knots.partition_point(is_past))
}

/// True if a switch is on after its knots `past`. Before its first knot it is as at that knot.
fn is_on_after(past: &[Knot<Vec3>], switch: &Spline<Vec3>) -> bool {
    past.last().or(switch.knots().first()).is_some_and(|knot| is_on(knot.value))
}
