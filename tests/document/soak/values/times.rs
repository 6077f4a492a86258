//! Times, channels and keys.

use crate::common::arm::channels;
use ik_arm::document::{Channel, Timeline};
use ik_arm::session::{Key, KeysEdit};

use super::Values;

impl Values<'_> {
    pub fn time(&mut self) -> f64 {
        if self.is_wild() {
            return self.one_of(&[
                f64::NAN,
                f64::INFINITY,
                f64::MAX,
                f64::MIN,
                1e300,
                -1e18,
                5e-324,
                -0.0,
                1e-9,
            ]);
        }
        let timeline = self.session.document().timeline;
        match self.random.below(8) {
            0 => self.one_of(&[timeline.start, timeline.end, 0.0, -1.0, 100.0]),
            1 => {
                let key = self.key();
                key.1
            }
            2 | 3 => timeline.time(self.random.below(timeline.frames().min(1000))),
            _ => f64::from(self.random.below(17) as u32) * 0.5,
        }
    }

    pub fn channel(&mut self) -> Channel {
        let shown = KeysEdit::all_channels(self.session.shown());
        if !shown.is_empty() && self.chance(0.6) {
            return self.one_of(&shown);
        }
        let joint = self.joint();
        match self.random.below(20) {
            0 => Channel::Rotation(joint),
            1 => Channel::Offset(joint),
            2..=4 => {
                let of_target = Channel::of_target(self.aimed());
                self.one_of(&of_target)
            }
            5 => Channel::Overlay(self.layer()),
            6 => Channel::Translation,
            7 => Channel::BalanceInfluence,
            _ => self.one_of(&channels::ALL),
        }
    }

    /// None, one or several, with repetitions.
    pub fn channels(&mut self) -> Vec<Channel> {
        match self.random.below(6) {
            0 => KeysEdit::channels_to_key(self.session),
            count => (0..count).map(|_| self.channel()).collect(),
        }
    }

    /// Mostly an existing key, if there is one.
    pub fn key(&mut self) -> Key {
        let keys = &self.session.document().keys;
        let count = keys.tracks().count();
        if count > 0 && self.chance(0.9) {
            let place = self.random.below(count);
            if let Some((channel, track)) = keys.tracks().nth(place) {
                return (channel, track.knots()[self.random.below(track.knots().len())].time);
            }
        }
        (self.channel(), f64::from(self.random.below(9) as u32))
    }

    pub fn keys(&mut self) -> Vec<Key> {
        match self.random.below(6) {
            0 => self.session.selection().keys().to_vec(),
            count => (0..count).map(|_| self.key()).collect(),
        }
    }

    /// Offset of moved keys.
    pub fn shift(&mut self) -> f64 {
        let mut times = || self.time();
        let (from, to) = (times(), times());
        to - from
    }

    pub fn timeline(&mut self) -> Timeline {
        let (start, end) = (self.time(), self.time());
        let (start, end) =
            if self.chance(0.9) { (start.min(end), end.max(start)) } else { (end, start) };
        let frame_rate = self.one_of(&[
            24.0,
            30.0,
            60.0,
            1.0,
            1000.0,
            0.0,
            7.0,
            29.97,
            0.01,
            1001.0,
            -30.0,
            f64::NAN,
            f64::INFINITY,
        ]);
        Timeline { start, end, frame_rate }
    }

    /// Time of the window: advances, stands still, jumps or goes back.
    pub fn seconds(&mut self) -> f64 {
        if self.is_wild() {
            return self.one_of(&[f64::NAN, f64::INFINITY, f64::MAX, -1.0, 1e17]);
        }
        *self.clock += match self.random.below(12) {
            0 => 0.0,
            1 => 7.5,
            2 => -0.5,
            _ => 1.0 / 60.0,
        };
        *self.clock
    }

    pub fn speed(&mut self) -> f64 {
        f64::from(self.number(4.0))
    }
}
