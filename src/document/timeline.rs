/// What is played: from when to when, and how finely time is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    /// In seconds.
    pub start: f64,
    /// In seconds, after the start.
    pub end: f64,
    /// In a second.
    pub frame_rate: u32,
}

impl Timeline {
    /// Those that are offered; imported motions may bring others.
    pub const FRAME_RATES: [u32; 3] = [24, 30, 60];
    pub const HIGHEST_FRAME_RATE: u32 = 1000;
    /// In seconds, before and after 0: about a day.
    pub const FARTHEST: f64 = 86_400.0;

    /// Whether it starts before it ends, within a day of 0, and counts 1 to 1000 frames in a second.
    pub fn is_valid(&self) -> bool {
        let times =
            -Self::FARTHEST <= self.start && self.start < self.end && self.end <= Self::FARTHEST;
        times && (1..=Self::HIGHEST_FRAME_RATE).contains(&self.frame_rate)
    }

    pub fn duration(&self) -> f64 {
        self.end - self.start
    }

    /// How many frames there are from start to end, both included.
    pub fn frames(&self) -> usize {
        /// A last frame that is so little past the end is still there, in frames.
        const ROUNDING: f64 = 1e-6;
        (self.duration() * f64::from(self.frame_rate) + ROUNDING).floor() as usize + 1
    }

    /// When a frame is, counted from the start.
    pub fn time(&self, frame: usize) -> f64 {
        self.start + frame as f64 / f64::from(self.frame_rate)
    }

    /// The nearest time at which there is a frame; frames are counted from 0 s.
    pub fn snapped(&self, time: f64) -> f64 {
        let rate = f64::from(self.frame_rate);
        (time * rate).round() / rate
    }

    /// A time brought from start to end.
    pub fn within(&self, time: f64) -> f64 {
        time.clamp(self.start, self.end)
    }
}

impl Default for Timeline {
    /// 8 seconds, in which targets that move as at first go around twice.
    fn default() -> Self {
        Self { start: 0.0, end: 8.0, frame_rate: 30 }
    }
}
