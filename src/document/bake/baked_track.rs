use glam::Vec3;

use crate::document::{Channel, Timeline, Track};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::spline::Spline;

/// Keys of a baked channel.
#[derive(Clone, Debug)]
pub(super) struct BakedTrack {
    /// [`Channel::Rotation`] or [`Channel::Offset`].
    pub channel: Channel,
    pub joint: JointId,
    /// All keys, those outside the range too.
    pub spline: Spline<Vec3>,
    /// The frames that have a key, ascending.
    pub frames: Vec<usize>,
}

/// The frames of a bake, and what is kept of the keys around them.
#[derive(Clone, Copy, Debug)]
pub(super) struct BakedFrames {
    timeline: Timeline,
    /// True if the document's timeline starts before the range.
    starts_late: bool,
    /// True if the document's timeline ends after the range.
    ends_early: bool,
}

impl BakedFrames {
    pub fn new(own: Timeline, timeline: Timeline) -> Self {
        let last = timeline.time(timeline.frames() - 1);
        Self { timeline, starts_late: own.start < timeline.start, ends_early: last < own.end }
    }

    pub fn count(&self) -> usize {
        self.timeline.frames()
    }

    /// Time of a frame in seconds.
    pub fn time(&self, frame: usize) -> f64 {
        self.timeline.time(frame)
    }

    /// The frames between two times, both excluded. Infinite times are allowed.
    pub fn between(&self, from: f64, to: f64) -> core::ops::Range<usize> {
        let position = |time: f64| (time - self.timeline.start) * self.timeline.frame_rate;
        // Conversion saturates. Frames next to the bounds may be included by rounding; their values
        // do not change.
        let first = position(from).floor() as usize;
        let last = position(to).ceil() as usize;
        first..last.saturating_add(1).min(self.count())
    }

    /// The keys of a channel outside the range. Where the document's timeline goes on beyond the
    /// range, the two frames beyond it have keys too, which keep the channel as it was there: two,
    /// because a key shapes the curve up to the second key away from it.
    pub fn surroundings(&self, track: &Track, channel: Channel) -> Spline<Vec3> {
        let (start, end) = (self.time(0), self.time(self.count() - 1));
        let is_outside = |time: f64| time < start || time > end;
        let knots = track.document().keys.track(channel).into_iter().flat_map(Spline::knots);
        let mut spline: Spline<Vec3> =
            knots.filter(|knot| is_outside(knot.time)).copied().collect();
        let frame = 1.0 / self.timeline.frame_rate;
        let before = [start - 2.0 * frame, start - frame].map(|time| (self.starts_late, time));
        let after = [end + frame, end + 2.0 * frame].map(|time| (self.ends_early, time));
        for (_, time) in before.into_iter().chain(after).filter(|(is_open, _)| *is_open) {
            if let Some(value) = channel.value(track.at(time).document()) {
                spline.insert(time, value);
            }
        }
        spline
    }
}
