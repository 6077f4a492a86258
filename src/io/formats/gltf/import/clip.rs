use super::sampler::tolerance;
use super::tracks::NodeTracks;
use crate::document::Timeline;
use crate::io::frame_rate;
use crate::io::json::FieldError;
use crate::io::json::JsonPath;

/// Frame rate of a motion whose keys fit no frame rate.
const FALLBACK_RATE: f64 = 60.0;

/// Returns the timeline from the first key to the last. Its frame rate is the one that
/// [`frame_rate::of_times`] finds with as little tolerance as possible, or else [`FALLBACK_RATE`];
/// `own_rate`, if the file tells it. Returns `None` if all keys are at the same time. `at` is the
/// path of the animation.
pub fn timeline(
    tracks: &NodeTracks<'_>,
    own_rate: Option<f64>,
    at: &JsonPath,
) -> Result<Option<Timeline>, FieldError> {
    let Some((start, end)) = time_range(tracks) else { return Ok(None) };
    if start == end {
        return Ok(None);
    }
    let mut times: Vec<f64> = tracks.times().map(|time| time - start).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    let rounded = |time: f64| ((time + start) * f64::from(f32::EPSILON)).max(1e-7);
    let found = own_rate.or_else(|| frame_rate::of_times(&times, rounded));
    let found = found.or_else(|| frame_rate::of_times(&times, |_| 2e-6));
    let found = found.or_else(|| frame_rate::of_times(&times, |time| tolerance(time + start)));
    let frame_rate = found.unwrap_or(FALLBACK_RATE);
    let whole = Timeline {
        start: on_frame(start, Timeline { start: 0.0, end, frame_rate }),
        end,
        frame_rate,
    };
    let timeline = Timeline { end: on_frame(end, whole), ..whole };
    if !timeline.is_valid() {
        let max = Timeline::MAX_TIME;
        let reason = format!("must be within ±{max} s, got {start} to {end} s");
        return Err(FieldError::new(at.clone(), reason));
    }
    Ok(Some(timeline))
}

/// The time of the frame at a time that single precision cannot tell from it; else the time itself.
pub fn on_frame(time: f64, timeline: Timeline) -> f64 {
    let frame = timeline.snapped(time);
    let rounding = (time.abs() * f64::from(f32::EPSILON)).max(1e-7);
    if (frame - time).abs() <= rounding { frame } else { time }
}

/// Times of the first and the last key in seconds; `None` without keys.
pub fn time_range(tracks: &NodeTracks<'_>) -> Option<(f64, f64)> {
    tracks.times().map(|time| (time, time)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}
