use super::Session;

/// The time that keys, targets and snakes move by, and how it goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Playback {
    /// In seconds.
    pub time: f64,
    pub playing: bool,
    /// Whether it begins again where it ends.
    pub looping: bool,
    /// Seconds of the document in one of the window.
    pub speed: f64,
    /// When the last picture was made, in seconds of the window; nothing before the first.
    pub last: Option<f64>,
}

impl Default for Playback {
    fn default() -> Self {
        Self { time: 0.0, playing: false, looping: true, speed: 1.0, last: None }
    }
}

impl Session {
    /// How fast the time can go.
    pub const SPEEDS: (f64, f64) = (0.1, 4.0);

    /// In seconds.
    pub fn time(&self) -> f64 {
        self.playback.time
    }

    /// Whether the time goes on.
    pub fn is_playing(&self) -> bool {
        self.playback.playing
    }

    /// Whether the time begins again where the timeline ends.
    pub fn is_looping(&self) -> bool {
        self.playback.looping
    }

    /// Seconds of the document in one of the window.
    pub fn speed(&self) -> f64 {
        self.playback.speed
    }

    /// Whether anything changes in time.
    pub fn has_motion(&self) -> bool {
        !self.document.keys.is_empty() || self.skeleton_rig().is_moving()
    }

    /// What has ended begins again at its start; what is stopped stands on a frame.
    pub(super) fn play(&mut self, playing: bool) {
        let timeline = self.document.timeline;
        if playing && !self.playback.playing && self.playback.time >= timeline.end {
            self.set_time(timeline.start);
        } else if !playing && self.playback.playing {
            self.set_time(timeline.snapped(self.playback.time));
        }
        self.playback.playing = playing;
        self.playback.last = None;
    }

    pub(super) fn set_time(&mut self, time: f64) {
        let time = if time.is_finite() { time } else { 0.0 };
        if time != self.playback.time {
            self.playback.time = time;
            self.overrides.clear();
            self.refresh();
        }
    }

    /// Goes on by as much as the window did, however long a picture took.
    pub(super) fn advance_clock(&mut self, seconds: f64) {
        let passed = self.playback.last.map_or(0.0, |last| (seconds - last).max(0.0));
        self.playback.last = Some(seconds);
        self.advance_crowd(passed);
        if !self.playback.playing || passed == 0.0 {
            return;
        }
        let timeline = self.document.timeline;
        let time = self.playback.time + passed * self.playback.speed;
        if time < timeline.end {
            self.set_time(time);
        } else if self.playback.looping {
            self.set_time(timeline.start + (time - timeline.start).rem_euclid(timeline.duration()));
        } else {
            self.set_time(timeline.end);
            self.playback.playing = false;
        }
    }
}
