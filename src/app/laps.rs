use std::time::{Duration, Instant};

/// Tells how long it is since it was last asked, or made.
pub(super) fn laps() -> impl FnMut() -> Duration {
    let mut last = Instant::now();
    move || {
        let now = Instant::now();
        now - std::mem::replace(&mut last, now)
    }
}
