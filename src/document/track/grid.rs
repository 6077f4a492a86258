use crate::document::{Document, Timeline};

/// The times of a track's steps: at least 60 in a second, each frame of the timeline among them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// Time of step 0 in seconds.
    pub start: f64,
    /// Frames per second.
    rate: f64,
    steps_per_frame: f64,
    /// The first step at or after the last key and the end of the timeline.
    pub last: usize,
}

/// Where a time lies among the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Before step 0.
    Before,
    /// On a step, or within 1e-6 of the time between two.
    On(usize),
    /// After a step and before the next.
    After(usize),
}

impl Grid {
    const LEAST_RATE: f64 = 60.0;
    /// Most steps: more than in a day.
    const MOST: f64 = 1e7;
    /// Times that are nearer to a step than this part of the time between two are on it.
    const ROUNDING: f64 = 1e-6;

    pub fn new(document: &Document) -> Self {
        let Timeline { end, frame_rate, .. } = document.timeline;
        let steps_per_frame = (Self::LEAST_RATE / frame_rate).ceil().max(1.0);
        let grid =
            Self { start: document.motion_start(), rate: frame_rate, steps_per_frame, last: 0 };
        let end = document.keys.times().last().map_or(end, |last| last.max(end));
        let last = if document.moves_rig() { grid.steps_until(end) } else { 0.0 };
        Self { last: (last - Self::ROUNDING).ceil().clamp(0.0, Self::MOST) as usize, ..grid }
    }

    /// Time of a step in seconds: of every `steps_per_frame`th, that of a frame of a timeline with
    /// the same start, bit for bit.
    pub fn time(&self, step: usize) -> f64 {
        self.start + (step as f64 / self.steps_per_frame) / self.rate
    }

    /// True if the steps of both are at the same times.
    pub fn has_same_times(&self, other: &Self) -> bool {
        Self { last: 0, ..*self } == Self { last: 0, ..*other }
    }

    pub fn place(&self, time: f64) -> Place {
        let steps = self.steps_until(time).min(Self::MOST);
        let step = (steps + Self::ROUNDING).floor();
        if step < 0.0 {
            Place::Before
        } else if steps - step <= Self::ROUNDING {
            Place::On(step as usize)
        } else {
            Place::After(step as usize)
        }
    }

    fn steps_until(&self, time: f64) -> f64 {
        (time - self.start) * self.steps_per_frame * self.rate
    }
}

impl Document {
    /// The time in seconds at which the motion of the skeleton begins, before which it does not
    /// move on: [`Document::track_start`], else the earlier of the first key and the start of the
    /// timeline, but at most a minute before that.
    pub fn motion_start(&self) -> f64 {
        const MOST_BEFORE: f64 = 60.0;
        let start = self.timeline.start;
        let first = || self.keys.times().first().map_or(start, |first| first.min(start));
        self.track_start.unwrap_or_else(|| first().max(start - MOST_BEFORE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Channel;

    fn grid(start: f64, end: f64, frame_rate: f64) -> (Grid, Timeline) {
        let timeline = Timeline { start, end, frame_rate };
        let mut document = Document { timeline, ..Document::default() };
        document.key(Channel::Translation, start);
        (Grid::new(&document), timeline)
    }

    #[test]
    fn every_frame_is_on_a_step_whatever_the_rate() {
        for rate in [0.01, 23.976, 24.0, 30e3 / 1001.0, 29.97, 30.0, 60.0, 119.88, 1000.0] {
            for start in [0.0, -3.7, 12.125, 80_000.0] {
                let (grid, timeline) = grid(start, start + 200.0 / rate, rate);
                let per_frame = grid.steps_per_frame as usize;
                for frame in 0..200 {
                    let (step, time) = (frame * per_frame, timeline.time(frame));
                    assert_eq!(grid.time(step), time, "{rate} {start} {frame}");
                    for near in [time, time.next_up(), time.next_down()] {
                        assert_eq!(grid.place(near), Place::On(step), "{rate} {start} {frame}");
                    }
                }
                assert!(
                    rate * grid.steps_per_frame >= 60.0 && grid.place(start - 1.0) == Place::Before
                );
            }
        }
    }

    #[test]
    fn times_between_two_steps_come_after_the_first_of_them() {
        let (grid, _) = grid(1.0, 9.0, 24.0);
        for step in 0..100 {
            let (here, next) = (grid.time(step), grid.time(step + 1));
            assert_eq!(grid.place(here + 0.3 * (next - here)), Place::After(step));
            assert_eq!(grid.place(here + 1e-5 * (next - here)), Place::After(step));
        }
        assert_eq!(grid.last, 8 * 72);
    }
}
