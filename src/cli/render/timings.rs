use std::io::{self, Write as _};
use std::time::Duration;

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

/// Prints one line of JSON.
pub fn print(line: &impl Serialize) -> Result<(), io::Error> {
    writeln!(io::stdout(), "{}", serde_json::to_string(line)?)
}
