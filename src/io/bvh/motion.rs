use super::hierarchy::{Channel, Node};
use super::text::{Fault, Text, Word};
use crate::document::Timeline;

/// What the channels of all joints are, frame by frame.
pub struct Motion {
    frames: usize,
    /// How many channels all joints have.
    width: usize,
    values: Vec<f32>,
    pub timing: Timing,
}

/// When the frames are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    pub frame_rate: u32,
    /// In seconds, where it is no whole part of a second.
    step: Option<f64>,
}

/// Reads what stands after the word MOTION, and what is odd there.
pub fn read(text: &mut Text<'_>, nodes: &[Node]) -> Result<(Motion, Option<Fault>), Fault> {
    let count = labelled(text, &["Frames"])?;
    let frames = count.whole("")?;
    let timing = Timing::read(labelled(text, &["Frame", "Time"])?, frames)?;
    let channels: Vec<(&Node, Channel)> =
        nodes.iter().flat_map(|node| node.channels.iter().map(move |it| (node, *it))).collect();
    let width = channels.len();
    // What is said may be far more than the file has: a number has a digit and a space.
    let most = text.left().div_ceil(2);
    let mut values = Vec::with_capacity(frames.saturating_mul(width).min(most));
    for frame in 0..if width == 0 { 0 } else { frames } {
        let Some(line) = text.line() else {
            let reason = format!("{frames} frames are said, and there are {frame}");
            return Err(Fault::new(count.at, "", reason));
        };
        read_frame(line, frame, &channels, &mut values)?;
    }
    let odd = text.line().map(|line| {
        Fault::new(line.at, "", format!("{frames} frames are said; what follows them is ignored"))
    });
    Ok((Motion { frames, width, values, timing }, odd))
}

fn labelled<'a>(text: &mut Text<'a>, label: &[&str]) -> Result<Word<'a>, Fault> {
    if text.label(label) {
        return Ok(text.word());
    }
    let word = text.word();
    let reason = format!("{}, expected {}:", word.found(), label.join(" "));
    Err(Fault::new(word.at, "", reason))
}

fn read_frame(
    line: Word<'_>,
    frame: usize,
    channels: &[(&Node, Channel)],
    values: &mut Vec<f32>,
) -> Result<(), Fault> {
    let width = channels.len();
    let mut words = line.words();
    for (index, (node, channel)) in channels.iter().enumerate() {
        let Some(word) = words.next() else {
            let reason = format!(
                "frame {frame} has {index} numbers; it must have {width}, and the next is {}",
                channel.name()
            );
            return Err(Fault::new(line.end(), &node.name, reason));
        };
        let value = word.number(&node.name).map_err(|fault| {
            let reason = format!("{} of frame {frame}: {}", channel.name(), fault.reason);
            Fault { reason, ..fault }
        })?;
        values.push(value);
    }
    match words.next() {
        None => Ok(()),
        Some(word) => {
            let count = width + 1 + words.count();
            let reason = format!("frame {frame} has {count} numbers; it must have {width}");
            Err(Fault::new(word.at, "", reason))
        }
    }
}

impl Motion {
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// The numbers of some channels that stand side by side in every frame.
    pub fn of(&self, start: usize, width: usize) -> impl Iterator<Item = &[f32]> + Clone {
        let rows = self.values.chunks_exact(self.width.max(1));
        rows.map(move |row| row.get(start..start + width).unwrap_or_default())
    }
}

impl Timing {
    fn read(word: Word<'_>, frames: usize) -> Result<Self, Fault> {
        let step: f64 =
            word.text.parse().ok().filter(|step: &f64| step.is_finite()).ok_or_else(|| {
                Fault::new(word.at, "", format!("{}, expected a time in seconds", word.found()))
            })?;
        if step <= 0.0 {
            let reason = format!("Frame Time is {step} s; it must be above 0");
            return Err(Fault::new(word.at, "", reason));
        }
        let timing = Self::new(step);
        let end = timing.time(frames.saturating_sub(1));
        if end > Timeline::FARTHEST {
            let farthest = Timeline::FARTHEST;
            let reason = format!("{frames} frames of {step} s are longer than {farthest} s");
            return Err(Fault::new(word.at, "", reason));
        }
        Ok(timing)
    }

    fn new(step: f64) -> Self {
        /// How far a frame's time may be from a whole part of a second: files round it.
        const ROUNDING: f64 = 1e-3;
        let rate = step.recip().round();
        let highest = f64::from(Timeline::HIGHEST_FRAME_RATE);
        let is_whole = (1.0..=highest).contains(&rate) && (step * rate - 1.0).abs() < ROUNDING;
        let frame_rate = rate.clamp(1.0, highest) as u32;
        Self { frame_rate, step: (!is_whole).then_some(step) }
    }

    /// In seconds.
    pub fn time(&self, frame: usize) -> f64 {
        match self.step {
            None => frame as f64 / f64::from(self.frame_rate),
            Some(step) => frame as f64 * step,
        }
    }
}
