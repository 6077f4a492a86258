use std::time::{Duration, Instant};

/// Returns a function that returns the time since its last call, or since now for the first.
pub fn stopwatch() -> impl FnMut() -> Duration {
    let mut last = Instant::now();
    move || {
        let now = Instant::now();
        now - std::mem::replace(&mut last, now)
    }
}
