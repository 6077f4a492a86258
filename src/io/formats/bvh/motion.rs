use super::hierarchy::{BvhChannel, BvhNode};
use super::text::{Scanner, TextError, Token};
use crate::document::Timeline;
use crate::io::frame_rate;

/// The values of all channels in each frame.
pub struct MotionData {
    frames: usize,
    /// Number of channels of all joints together.
    width: usize,
    values: Vec<f32>,
    pub timing: FrameTiming,
}

/// The times of the frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTiming {
    /// Frames per second, as far as a timeline can have them.
    pub frame_rate: f64,
    /// Time from one frame to the next in seconds; `None` if it is 1 / `frame_rate`.
    step: Option<f64>,
}

/// Reads the text after the word MOTION. Text after the last frame is ignored, with a warning.
pub fn read(
    text: &mut Scanner<'_>,
    nodes: &[BvhNode],
) -> Result<(MotionData, Option<TextError>), TextError> {
    let count = labelled(text, &["Frames"])?;
    let frames = count.whole("")?;
    let timing = FrameTiming::read(labelled(text, &["Frame", "Time"])?, frames)?;
    let channels: Vec<(&BvhNode, BvhChannel)> =
        nodes.iter().flat_map(|node| node.channels.iter().map(move |it| (node, *it))).collect();
    let width = channels.len();
    // The header can claim more frames than the file has. A number takes at least two bytes, a
    // digit and a space, so the rest of the text limits how many there can be.
    let max_values = text.remaining().div_ceil(2);
    let mut values = Vec::with_capacity(frames.saturating_mul(width).min(max_values));
    for frame in 0..if width == 0 { 0 } else { frames } {
        let Some(line) = text.line() else {
            let reason =
                format!("Frames must be {frame}, the number of lines that follow, got {frames}");
            return Err(TextError::new(count.at, "", reason));
        };
        read_frame(line, frame, &channels, &mut values)?;
    }
    let warning = text.line().map(|line| {
        TextError::new(
            line.at,
            "",
            format!("ignored: text after the {frames} frames of the header"),
        )
    });
    Ok((MotionData { frames, width, values, timing }, warning))
}

fn labelled<'a>(text: &mut Scanner<'a>, label: &[&str]) -> Result<Token<'a>, TextError> {
    if text.label(label) {
        return Ok(text.word());
    }
    let word = text.word();
    let reason = format!("{}, expected {}:", word.found(), label.join(" "));
    Err(TextError::new(word.at, "", reason))
}

fn read_frame(
    line: Token<'_>,
    frame: usize,
    channels: &[(&BvhNode, BvhChannel)],
    values: &mut Vec<f32>,
) -> Result<(), TextError> {
    let width = channels.len();
    let mut words = line.words();
    for (index, (node, channel)) in channels.iter().enumerate() {
        let Some(word) = words.next() else {
            let reason = format!(
                "frame {frame} must have {width} numbers, got {index} before {}",
                channel.name()
            );
            return Err(TextError::new(line.end(), &node.name, reason));
        };
        let value = word.number(&node.name).map_err(|error| {
            let reason = format!("{} of frame {frame}: {}", channel.name(), error.reason);
            TextError { reason, ..error }
        })?;
        values.push(value);
    }
    match words.next() {
        None => Ok(()),
        Some(word) => {
            let count = width + 1 + words.count();
            let reason = format!("frame {frame} must have {width} numbers, got {count}");
            Err(TextError::new(word.at, "", reason))
        }
    }
}

impl MotionData {
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// For each frame, the values of the `width` channels that begin with channel `start`.
    pub fn channels(&self, start: usize, width: usize) -> impl Iterator<Item = &[f32]> + Clone {
        let rows = self.values.chunks_exact(self.width.max(1));
        rows.map(move |row| row.get(start..start + width).unwrap_or_default())
    }
}

impl FrameTiming {
    fn read(word: Token<'_>, frames: usize) -> Result<Self, TextError> {
        let step: f64 =
            word.text.parse().ok().filter(|step: &f64| step.is_finite()).ok_or_else(|| {
                TextError::new(word.at, "", format!("{}, expected a time in seconds", word.found()))
            })?;
        if step <= 0.0 {
            let reason = format!("Frame Time must be above 0 s, got {step}");
            return Err(TextError::new(word.at, "", reason));
        }
        let timing = Self::new(step, last_digit(word.text));
        let end = timing.time(frames.saturating_sub(1));
        if end > Timeline::MAX_TIME {
            let max_time = Timeline::MAX_TIME;
            let reason =
                format!("motion must last at most {max_time} s, got {frames} frames of {step} s");
            return Err(TextError::new(word.at, "", reason));
        }
        Ok(timing)
    }

    /// `unit` is the value of the last digit of `step`.
    fn new(step: f64, unit: f64) -> Self {
        let rate = frame_rate::of_frame_time(step, unit);
        let frame_rate = rate.clamp(Timeline::MIN_FRAME_RATE, Timeline::MAX_FRAME_RATE);
        Self { frame_rate, step: (frame_rate != rate).then_some(step) }
    }

    /// Time of a frame, in seconds.
    pub fn time(&self, frame: usize) -> f64 {
        match self.step {
            None => frame as f64 / self.frame_rate,
            Some(step) => frame as f64 * step,
        }
    }
}

/// The value of the last digit of a number: 0.001 for "0.033" and for "3.3e-2".
fn last_digit(number: &str) -> f64 {
    let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    10_f64.powi(exponent.saturating_sub(i32::try_from(decimals).unwrap_or(i32::MAX)))
}
