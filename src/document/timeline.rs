/// The time range that is played, and its frame rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    /// Start in seconds.
    pub start: f64,
    /// End in seconds, after the start.
    pub end: f64,
    /// Frames per second, from [`Timeline::MIN_FRAME_RATE`] to [`Timeline::MAX_FRAME_RATE`]; need
    /// not be whole: television in North America has 30000/1001, about 29.97.
    pub frame_rate: f64,
}

impl Timeline {
    /// Frame rates that the timeline offers; imported motions may have others.
    pub const FRAME_RATES: [f64; 9] =
        [24e3 / 1001.0, 24.0, 25.0, 30e3 / 1001.0, 30.0, 50.0, 60e3 / 1001.0, 60.0, 120.0];
    /// Minimum number of frames per second: one frame in 100 seconds.
    pub const MIN_FRAME_RATE: f64 = 0.01;
    /// Maximum number of frames per second.
    pub const MAX_FRAME_RATE: f64 = 1000.0;
    /// Maximum distance in seconds of start and end from time 0: one day.
    pub const MAX_TIME: f64 = 86_400.0;

    /// True if the timeline starts before it ends, starts and ends within a day of time 0, and has
    /// 0.01 to 1000 frames per second.
    pub fn is_valid(&self) -> bool {
        let times =
            -Self::MAX_TIME <= self.start && self.start < self.end && self.end <= Self::MAX_TIME;
        times && Self::is_frame_rate(self.frame_rate)
    }

    /// True if a timeline can have this number of frames per second.
    pub fn is_frame_rate(rate: f64) -> bool {
        (Self::MIN_FRAME_RATE..=Self::MAX_FRAME_RATE).contains(&rate)
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
        (self.duration() * self.frame_rate + ROUNDING).floor() as usize + 1
    }

    /// Time of a frame in seconds; frame 0 is at the start.
    pub fn time(&self, frame: usize) -> f64 {
        self.start + frame as f64 / self.frame_rate
    }

    /// The number of the frame at a time in seconds, as the timeline shows it: counted from time 0,
    /// and whole at the start. Not whole between frames.
    pub fn number(&self, time: f64) -> f64 {
        (time - self.shift()) * self.frame_rate
    }

    /// Time in seconds of the frame with this [number](Self::number).
    pub fn time_of_number(&self, number: f64) -> f64 {
        number / self.frame_rate + self.shift()
    }

    /// Time in seconds of the nearest frame.
    pub fn snapped(&self, time: f64) -> f64 {
        self.time_of_number(self.number(time).round())
    }

    /// Time in seconds from the whole number of frames that is nearest to the start, to the start.
    fn shift(&self) -> f64 {
        /// A start that is this near to a whole number of frames counts as whole, in frames.
        const ROUNDING: f64 = 1e-6;
        let frames = self.start * self.frame_rate;
        let part = frames - frames.round();
        if part.abs() < ROUNDING { 0.0 } else { part / self.frame_rate }
    }

    /// A time clamped to the range from start to end.
    pub fn clamp(&self, time: f64) -> f64 {
        time.clamp(self.start, self.end)
    }
}

impl Default for Timeline {
    /// 8 seconds, two revolutions of a target with the default period.
    fn default() -> Self {
        Self { start: 0.0, end: 8.0, frame_rate: 30.0 }
    }
}
