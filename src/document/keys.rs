use core::f32::consts::TAU;
use std::collections::BTreeMap;

use glam::Vec3;

use super::{Arm, Channel, Document, HandSpace, Quantity, RigKind, Shared, TwistReferenceKind};
use crate::kinematics::skeleton::JointRemap;
use crate::kinematics::spline::Spline;

/// What changes in time: for every keyed channel, the knots that it goes through.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keys {
    /// None is empty. An edit copies the map and the tracks that it changes; all others stay shared.
    tracks: Shared<Tracks>,
}

type Tracks = BTreeMap<Channel, Shared<Spline<Vec3>>>;

impl Keys {
    pub fn is_empty(&self) -> bool {
        self.tracks.is_empty()
    }

    /// Every channel that has a key, with all its keys.
    pub fn tracks(&self) -> impl Iterator<Item = (Channel, &Spline<Vec3>)> {
        self.tracks.iter().map(|(channel, track)| (*channel, &**track))
    }

    pub fn track(&self, channel: Channel) -> Option<&Spline<Vec3>> {
        self.tracks.get(&channel).map(|track| &**track)
    }

    pub fn has(&self, channel: Channel) -> bool {
        self.tracks.contains_key(&channel)
    }

    /// Bytes that these keys take and `other` does not share.
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

    /// How many keys there are in all.
    pub fn count(&self) -> usize {
        self.tracks.values().map(|track| track.knots().len()).sum()
    }

    /// Puts a key, in the place of one that is there. Numbers that are not finite are refused.
    pub fn insert(&mut self, channel: Channel, time: f64, value: Vec3) {
        if time.is_finite() && value.is_finite() {
            self.tracks.make_mut().entry(channel).or_default().make_mut().insert(time, value);
        }
    }

    /// Takes a key away, and gives its value.
    pub fn remove(&mut self, channel: Channel, time: f64) -> Option<Vec3> {
        let value = self.track(channel)?.get(time)?;
        self.remove_all(&[(channel, time)]);
        Some(value)
    }

    /// Takes many keys away, each named by its channel and time.
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
            let left: Spline<Vec3> = left.copied().collect();
            if left.is_empty() {
                self.clear(channel);
            } else {
                self.tracks.make_mut().insert(channel, Shared::from(left));
            }
        }
    }

    /// Takes all keys of a channel away.
    pub fn clear(&mut self, channel: Channel) {
        if self.has(channel) {
            self.tracks.make_mut().remove(&channel);
        }
    }

    /// What a channel is at a time, before it is brought within what is valid there: limits of
    /// joints are not known here. Nothing without keys.
    pub fn value(&self, channel: Channel, time: f64) -> Option<Vec3> {
        let track = self.track(channel)?;
        match channel.quantity() {
            Quantity::Switch => track.step(time),
            Quantity::Length => Some(track.at(time)?.max(Vec3::X * shortest(track))),
            Quantity::Fraction => Some(track.at(time)?.clamp(Vec3::ZERO, Vec3::X)),
            Quantity::Point | Quantity::Angle | Quantity::Angles => track.at(time),
        }
    }

    /// Every time at which there is a key, in order.
    pub fn times(&self) -> Vec<f64> {
        let knots = self.tracks.values().flat_map(|track| track.knots());
        let mut times: Vec<f64> = knots.map(|knot| knot.time).collect();
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Lets the keys follow their joints to new places; those whose joints are gone go too.
    pub fn follow(&mut self, moved: &JointRemap) {
        let follow = |(channel, track): (&Channel, &Shared<Spline<Vec3>>)| {
            Some((channel.moved(moved)?, track.clone()))
        };
        self.tracks = Shared::from(self.tracks.iter().filter_map(follow).collect::<Tracks>());
    }
}

/// A keyed length never falls below a thousandth of its longest key: a spline overshoots, and a
/// bone needs a length.
fn shortest(track: &Spline<Vec3>) -> f32 {
    const PART: f32 = 1e-3;
    let longest = track.knots().iter().map(|knot| knot.value.x).fold(0.0, f32::max);
    (PART * longest).max(f32::MIN_POSITIVE)
}

impl Document {
    /// The document as it stands at a time: every keyed channel has the value that its keys give.
    /// What moves without keys, such as a [`FollowPath`](super::FollowPath), is not in it: see
    /// [`SkeletonRig::at`](super::SkeletonRig::at).
    pub fn at(&self, time: f64) -> Self {
        let mut posed = self.clone();
        posed.keys_to(time);
        posed
    }

    /// Whether the pose of the rig that is shown changes in time.
    pub fn is_posed_by_time(&self) -> bool {
        let slithers = self.rig == RigKind::Skeleton && self.skeleton_rig.follow_path.is_some();
        slithers || self.keys.tracks().any(|(channel, _)| channel.poses(self.rig))
    }

    /// Keys a channel as it is now, at a time; the elbow's spin unwrapped to be near the keys that it has.
    pub fn key(&mut self, channel: Channel, time: f64) {
        let Some(mut value) = channel.value(self) else {
            return;
        };
        if channel == Channel::Twist
            && let Some(near) = self.keys.value(channel, time)
        {
            value.x += ((near.x - value.x) / TAU).round() * TAU;
        }
        self.keys.insert(channel, time, value);
    }

    /// Measures the arm's elbow from elsewhere and leaves it where it is, at every key of its spin too.
    #[must_use]
    pub fn measured_from(&self, twist_reference: TwistReferenceKind) -> Self {
        let mut after = Self { arm: self.arm.measured_from(twist_reference), ..self.clone() };
        let Some(track) = self.keys.track(Channel::Twist) else {
            return after;
        };
        let mut shift = 0.0;
        for knot in track.knots() {
            let posed = Arm { transported: None, ..self.at(knot.time).arm };
            let measured = posed.measured_from(twist_reference).keyed_spin();
            let (old, turned) = (knot.value.x, measured - knot.value.x);
            shift = turned + ((shift - turned) / TAU).round() * TAU;
            after.keys.insert(Channel::Twist, knot.time, Vec3::new(old + shift, 0.0, 0.0));
        }
        after
    }

    /// Measures the hand's angles in another space and leaves the hand as it is turned, at every key of
    /// its angles too.
    #[must_use]
    pub fn with_wrist_in(&self, space: HandSpace) -> Self {
        let mut after = self.clone();
        after.arm.wrist = self.arm.wrist.measured_in(space, &self.arm.pose());
        let mut last = None;
        for knot in self.keys.track(Channel::Wrist).into_iter().flat_map(Spline::knots) {
            let posed = self.at(knot.time).arm;
            // Angles go on from those of the key before.
            let wrist = posed.wrist.measured_in_from(space, &posed.pose(), last);
            last = Some(wrist.angles);
            after.keys.insert(Channel::Wrist, knot.time, wrist.angles);
        }
        after
    }

    /// Gives every keyed channel the value that its keys give at a time.
    pub(crate) fn keys_to(&mut self, time: f64) {
        let keys = self.keys.clone();
        if keys.has(Channel::Hand) || keys.has(Channel::Pin) || keys.has(Channel::Root) {
            // Playing never transports.
            self.arm.forget_way();
        }
        for (channel, _) in keys.tracks() {
            if let Some(value) = keys.value(channel, time) {
                channel.set(self, value);
            }
        }
    }
}
