use std::time::{Duration, Instant};

/// Returns a function that returns the time since its previous call; the first call returns the
/// time since the function was made.
pub fn lap_timer() -> impl FnMut() -> Duration {
    let mut last = Instant::now();
    move || {
        let now = Instant::now();
        now - std::mem::replace(&mut last, now)
    }
}
