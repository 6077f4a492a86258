use std::io::IsTerminal as _;
use std::time::Duration;

use indicatif::ProgressBar;
use serde::Serialize;

/// Output of `--timings` without a crowd: median times in milliseconds.
#[derive(Serialize)]
pub struct TimingsLine<'a> {
    pub frames: u32,
    pub cpu_ms_median: f64,
    pub frame_ms_median: f64,
    pub adapter: &'a str,
}

/// Output of `--timings` with a crowd: median times in milliseconds.
#[derive(Serialize)]
pub struct CrowdTimingsLine<'a> {
    pub arms: u32,
    pub frames: u32,
    pub solve_ms_median: f64,
    pub frame_ms_median: f64,
    pub adapter: &'a str,
}

/// Converts a time to milliseconds, rounded to whole microseconds.
pub fn milliseconds(time: Duration) -> f64 {
    (time.as_secs_f64() * 1e6).round() / 1e3
}

/// Progress over frames on standard error: in a terminal a bar, otherwise a line for every tenth of
/// the frames.
pub struct FrameProgress {
    bar: ProgressBar,
    frames: u32,
}

impl FrameProgress {
    pub fn new(frames: u32) -> Self {
        Self { bar: ProgressBar::new(u64::from(frames)), frames }
    }

    pub fn show(&self, frame: u32) {
        self.bar.set_position(u64::from(frame));
        let tenth = (self.frames / 10).max(1);
        if !std::io::stderr().is_terminal() && frame.is_multiple_of(tenth) {
            eprintln!("frame {} of {}", frame + 1, self.frames);
        }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
