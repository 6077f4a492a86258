/// The time range that is played, and its frame rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    /// Start in seconds.
    pub start: f64,
    /// End in seconds, after the start.
    pub end: f64,
    /// Frames per second.
    pub frame_rate: u32,
}

impl Timeline {
    /// Frame rates that the timeline offers; imported motions may have others.
    pub const FRAME_RATES: [u32; 3] = [24, 30, 60];
    /// Maximum number of frames per second.
    pub const MAX_FRAME_RATE: u32 = 1000;
    /// Maximum distance in seconds of start and end from time 0: one day.
    pub const MAX_TIME: f64 = 86_400.0;

    /// Whether the timeline starts before it ends, starts and ends within a day of time 0, and has
    /// 1 to 1000 frames per second.
    pub fn is_valid(&self) -> bool {
        let times =
            -Self::MAX_TIME <= self.start && self.start < self.end && self.end <= Self::MAX_TIME;
        times && (1..=Self::MAX_FRAME_RATE).contains(&self.frame_rate)
    }

    /// Duration in seconds.
    pub fn duration(&self) -> f64 {
        self.end - self.start
    }

    /// Number of frames from start to end, both included.
    pub fn frames(&self) -> usize {
        /// Tolerance in frames: the last frame still counts if rounding puts it past the end by
        /// less than this.
        const ROUNDING: f64 = 1e-6;
        (self.duration() * f64::from(self.frame_rate) + ROUNDING).floor() as usize + 1
    }

    /// Time of a frame in seconds; frame 0 is at the start.
    pub fn time(&self, frame: usize) -> f64 {
        self.start + frame as f64 / f64::from(self.frame_rate)
    }

    /// The time of the nearest frame in seconds, for frames counted from time 0 instead of from the
    /// start.
    pub fn snapped(&self, time: f64) -> f64 {
        let rate = f64::from(self.frame_rate);
        (time * rate).round() / rate
    }

    /// A time clamped to the range from start to end.
    pub fn clamp(&self, time: f64) -> f64 {
        time.clamp(self.start, self.end)
    }
}

impl Default for Timeline {
    /// 8 seconds, two revolutions of a target with the default period.
    fn default() -> Self {
        Self { start: 0.0, end: 8.0, frame_rate: 30 }
    }
}
