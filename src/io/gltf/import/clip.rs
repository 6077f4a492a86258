use super::sampler::tolerance;
use super::tracks::NodeTracks;
use crate::document::Timeline;
use crate::io::field_error::FieldError;
use crate::io::json_path::JsonPath;

/// Common frame rates in frames per second, ascending.
const COMMON_RATES: [u32; 8] = [24, 25, 30, 48, 50, 60, 100, 120];
/// Frame rate of a motion whose keys fit none of the common frame rates.
const FALLBACK_RATE: u32 = 60;

/// Returns the timeline from the first key to the last. Its frame rate is the lowest common one
/// that has a frame at every key, or else [`FALLBACK_RATE`]. Returns `None` if all keys are at the
/// same time. `at` is the path of the animation.
pub fn timeline(tracks: &NodeTracks<'_>, at: &JsonPath) -> Result<Option<Timeline>, FieldError> {
    let Some((start, last)) = time_range(tracks) else { return Ok(None) };
    let frames_at = |rate: u32| {
        tracks.times().all(|time| {
            let frame = (time - start) * f64::from(rate);
            (frame - frame.round()).abs() <= tolerance(time) * f64::from(rate)
        })
    };
    let fitting = COMMON_RATES.into_iter().find(|rate| frames_at(*rate));
    let frame_rate = fitting.unwrap_or(FALLBACK_RATE);
    let rate = f64::from(frame_rate);
    let frames = (last - start) * rate;
    let frames = if fitting.is_some() { frames.round() } else { frames.ceil() };
    let timeline = Timeline { start, end: start + frames / rate, frame_rate };
    if frames > 0.0 && !timeline.is_valid() {
        let max = Timeline::MAX_TIME;
        let reason = format!("must be within ±{max} s, got {start} to {last} s");
        return Err(FieldError::new(at.clone(), reason));
    }
    Ok((frames > 0.0).then_some(timeline))
}

/// Times of the first and the last key in seconds; `None` without keys.
pub fn time_range(tracks: &NodeTracks<'_>) -> Option<(f64, f64)> {
    tracks.times().map(|time| (time, time)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}
