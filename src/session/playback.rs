use crate::document::Timeline;

/// The playhead and the settings of the transport bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Playback {
    /// In seconds.
    time: f64,
    playing: bool,
    looping: bool,
    /// 1 for real time.
    speed: f64,
    auto_key: bool,
    /// Window time of the last frame in seconds; `None` before the first.
    last_frame: Option<f64>,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            time: 0.0,
            playing: false,
            looping: true,
            speed: 1.0,
            auto_key: false,
            last_frame: None,
        }
    }
}

impl Playback {
    /// Slowest and fastest speed.
    pub const SPEEDS: (f64, f64) = (0.1, 4.0);

    /// Paused at the start of another document's timeline, with the same speed and looping.
    pub fn restarted(&self, timeline: &Timeline) -> Self {
        Self { time: timeline.start, looping: self.looping, speed: self.speed, ..Self::default() }
    }

    pub fn time(&self) -> f64 {
        self.time
    }

    pub fn is_playing(&self) -> bool {
        self.playing
    }

    pub fn is_looping(&self) -> bool {
        self.looping
    }

    pub fn is_auto_key(&self) -> bool {
        self.auto_key
    }

    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Whether a frame at this window time was made already.
    pub fn has_frame_at(&self, seconds: f64) -> bool {
        self.last_frame == Some(seconds)
    }

    /// Moves the playhead; returns whether it has moved.
    pub fn set_time(&mut self, time: f64) -> bool {
        let time = if time.is_finite() { time } else { 0.0 };
        std::mem::replace(&mut self.time, time) != time
    }

    pub fn set_playing(&mut self, playing: bool) {
        self.playing = playing;
    }

    pub fn set_looping(&mut self, looping: bool) {
        self.looping = looping;
    }

    pub fn set_auto_key(&mut self, auto_key: bool) {
        self.auto_key = auto_key;
    }

    pub fn set_speed(&mut self, speed: f64) {
        let (slowest, fastest) = Self::SPEEDS;
        if speed.is_finite() {
            self.speed = speed.clamp(slowest, fastest);
        }
    }

    /// Lets the next frame begin a new interval, so that a pause does not count as time.
    pub fn forget_last_frame(&mut self) {
        self.last_frame = None;
    }

    /// Seconds of the window since the last frame.
    pub fn advance_frame(&mut self, seconds: f64) -> f64 {
        let passed = self.last_frame.map_or(0.0, |last| (seconds - last).max(0.0));
        self.last_frame = Some(seconds);
        passed
    }

    /// The playhead after `passed` seconds, and whether it is still playing.
    pub fn played(&self, passed: f64, timeline: &Timeline) -> (f64, bool) {
        let time = self.time + passed * self.speed;
        if time < timeline.end {
            (time, true)
        } else if self.looping {
            (timeline.start + (time - timeline.start).rem_euclid(timeline.duration()), true)
        } else {
            (timeline.end, false)
        }
    }
}
