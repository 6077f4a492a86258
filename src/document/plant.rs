//! Plants: stretches of time in which a keyed pin holds the Cursor in the world.

use core::ops::RangeInclusive;

use glam::Vec3;

use super::channel::Channel;
use super::document::Document;
use super::keys::Keys;
use crate::kinematics::spline::{Knot, Spline};

/// Points of a Cursor whose pin is keyed. Their splines end where plants begin and end, so that
/// keys of one plant move the hand neither in another one nor on the way to it.
impl Keys {
    /// Interpolated value of [`Channel::Pin`] at a time in seconds: on the spline through the keys
    /// of one plant alone, its ends included. A plant without keys is at the last key before it.
    pub(super) fn pin(&self, time: f64) -> Option<Vec3> {
        let pin = self.track(Channel::Pin)?;
        let Some(switch) = self.track(Channel::Pinned) else {
            return pin.at(time);
        };
        pin.at_among(stretch(switch, time), time).or_else(|| pin.step(time))
    }

    /// Interpolated value of [`Channel::Hand`] at a time in seconds. A key in a plant, its ends
    /// included, ends the spline before it and begins the one after it.
    pub(super) fn hand(&self, time: f64) -> Option<Vec3> {
        let hand = self.track(Channel::Hand)?;
        let Some(switch) = self.track(Channel::Pinned) else {
            return hand.at(time);
        };
        let is_end = |knot: &&Knot<Vec3>| is_planted(switch, knot.time);
        let (past, future) = split(hand, |knot| knot.time <= time);
        let start = past.iter().rfind(is_end).map_or(f64::NEG_INFINITY, |knot| knot.time);
        let end = future.iter().find(is_end).map_or(f64::INFINITY, |knot| knot.time);
        hand.at_among(start..=end, time)
    }
}

impl Document {
    /// Keys the pin or a point of the Cursor at the start of the timeline, with its value in
    /// `former`, if it has no keys and the pin has keys or another value than in `former`. So its
    /// first key at `time`, in seconds, does not change the arm before that time.
    pub(crate) fn key_before_switch(&mut self, channel: Channel, former: &Self, time: f64) {
        let is_switched =
            self.keys.has(Channel::Pinned) || self.arm.is_pinned() != former.arm.is_pinned();
        let is_of_pin = matches!(channel, Channel::Hand | Channel::Pin | Channel::Pinned);
        let start = self.timeline.start;
        if is_of_pin && is_switched && start < time && !self.keys.has(channel) {
            let value = channel.value(former).unwrap_or_default();
            self.keys.insert_auto(channel, start, value);
        }
    }

    /// Keys the hand where the last plant before `time`, in seconds, begins, unless it has no keys,
    /// or one from there until `time`. So a key at `time` does not change how the hand arrives.
    pub(super) fn key_hand_at_plant(&mut self, time: f64) {
        let start = self.keys.track(Channel::Pinned).and_then(|it| last_start(it, time));
        let Some((start, hand)) = start.zip(self.keys.track(Channel::Hand)) else { return };
        let is_since = |knot: &Knot<Vec3>| (start..=time).contains(&knot.time);
        if let Some(value) = self.keys.hand(start)
            && !hand.knots().iter().any(is_since)
        {
            self.keys.insert_auto(Channel::Hand, start, value);
        }
    }
}

/// The stretch of time around `time`, in seconds, from one change of a switch to the next.
fn stretch(switch: &Spline<Vec3>, time: f64) -> RangeInclusive<f64> {
    let (past, future) = split(switch, |knot| knot.time <= time);
    let is_now = is_on_after(past, switch);
    let differs = |knot: &Knot<Vec3>| is_on(knot) != is_now;
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

/// The time in seconds at which a switch was last switched on before `time`; `None` if it was not.
fn last_start(switch: &Spline<Vec3>, time: f64) -> Option<f64> {
    let (past, _) = split(switch, |knot| knot.time < time);
    let starts = |pair: &&[Knot<Vec3>]| !is_on(&pair[0]) && is_on(&pair[1]);
    Some(past.windows(2).rfind(starts)?[1].time)
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
    past.last().or(switch.knots().first()).is_some_and(is_on)
}

fn is_on(knot: &Knot<Vec3>) -> bool {
    knot.value.x >= 0.5
}
