//! Durations of the most recent frames, and the machine that draws them.

use core::fmt;
use core::time::Duration;

use super::parts::Parts;
use crate::render::Counts;
use crate::rig::CrowdTimes;

/// Durations of the stages of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameTime {
    /// Actions, solvers and playback.
    pub solve: Duration,
    /// Layout and tessellation of the panels.
    pub panels: Duration,
    /// Making the scene from the document.
    pub scene: Duration,
    /// Upload of changes and GPU commands.
    pub encode: Duration,
    /// Waiting for vsync or the GPU.
    pub wait: Duration,
    /// Time on the GPU. `None` until it is read back some frames later, and without timestamp
    /// queries.
    pub gpu: Option<Duration>,
    /// Time from the start of the previous frame to the start of this one; `None` unless the
    /// previous frame requested this one without a delay.
    pub interval: Option<Duration>,
    /// Ratio of the size at which the scene is drawn to the size of the viewport, from 0 to
    /// [`Canvas::FINEST`](crate::render::Canvas::FINEST).
    pub resolution_scale: f32,
    /// True if the scene is drawn, false if it is unchanged and the panels alone are.
    pub draws_scene: bool,
}

impl FrameTime {
    /// CPU time: the sum of all stages except the wait.
    pub fn work(&self) -> Duration {
        self.solve + self.panels + self.scene + self.encode
    }

    /// Time from input to presentation: CPU time and wait.
    pub fn total(&self) -> Duration {
        self.work() + self.wait
    }
}

impl fmt::Display for FrameTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ms = |time: Duration| 1000.0 * time.as_secs_f64();
        let (total, percent) = (ms(self.total()), 100.0 * self.resolution_scale);
        let [solve, panels] = [self.solve, self.panels].map(ms);
        let [scene, encode, wait] = [self.scene, self.encode, self.wait].map(ms);
        write!(f, "{total:.1} ms at {percent:.0} % (solve {solve:.1}, panels {panels:.1}, ")?;
        write!(f, "scene {scene:.1}, encode {encode:.1}, wait {wait:.1})")
    }
}

/// Durations of the last [`Self::MOST`] frames, in a ring buffer that never allocates.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTimes {
    /// Frame n is at index n modulo the length of the array.
    frames: [FrameTime; Self::MOST],
    drawn: u64,
}

/// Median and 99th percentile of a set of durations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeSpread {
    /// Duration that half of the frames do not exceed.
    pub median: Duration,
    /// Duration that 99 of 100 frames do not exceed.
    pub slowest: Duration,
}

impl Default for FrameTimes {
    fn default() -> Self {
        Self { frames: [FrameTime::default(); Self::MOST], drawn: 0 }
    }
}

impl FrameTimes {
    /// Maximum number of frames in the buffer.
    pub const MOST: usize = 240;
    /// Index of a frame that changed nothing on screen and is not counted.
    pub const UNCOUNTED: u64 = u64::MAX;

    /// Adds the durations of a frame; a full buffer drops its oldest frame.
    pub fn push(&mut self, frame: FrameTime) {
        let place = self.place(self.drawn);
        self.frames[place] = frame;
        self.drawn += 1;
    }

    /// Number of frames drawn so far, which is the index of the next frame.
    pub fn drawn(&self) -> u64 {
        self.drawn
    }

    /// Sets the GPU time of the frame with the index `frame` and returns that frame, if it is in
    /// the buffer.
    pub fn set_gpu(&mut self, frame: u64, time: Duration) -> Option<&FrameTime> {
        let is_kept = frame < self.drawn && self.drawn - frame <= Self::MOST as u64;
        let place = self.place(frame);
        let kept = self.frames.get_mut(place).filter(|_| is_kept)?;
        kept.gpu = Some(time);
        Some(kept)
    }

    /// The frames in the buffer, oldest first.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = &FrameTime> {
        let count = self.drawn.min(Self::MOST as u64);
        let first = self.drawn - count;
        (0..count as usize).map(move |index| &self.frames[self.place(first + index as u64)])
    }

    /// The newest frame; `None` before the first frame.
    pub fn last(&self) -> Option<&FrameTime> {
        self.frames().last()
    }

    /// Median and 99th percentile of the durations that `part` returns for the frames in the
    /// buffer; `None` if `part` returns `None` for all of them.
    pub fn spread(&self, part: impl Fn(&FrameTime) -> Option<Duration>) -> Option<TimeSpread> {
        let mut times = [Duration::ZERO; Self::MOST];
        let mut count = 0;
        for time in self.frames().filter_map(part) {
            times[count] = time;
            count += 1;
        }
        let times = &mut times[..count];
        times.sort_unstable();
        // Nearest-rank percentile.
        let at = |hundredths: usize| (count * hundredths).div_ceil(100).saturating_sub(1);
        Some(TimeSpread { median: *times.get(at(50))?, slowest: *times.get(at(99))? })
    }

    /// Frames per second during continuous motion, from the median interval; `None` if no frame in
    /// the buffer has an interval.
    pub fn per_second(&self) -> Option<f64> {
        let interval = self.spread(|frame| frame.interval)?.median.as_secs_f64();
        (interval > 0.0).then(|| interval.recip())
    }

    fn place(&self, frame: u64) -> usize {
        (frame % Self::MOST as u64) as usize
    }
}

/// The graphics adapter, and measurements of frames, scene and crowd, for the panels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Machine {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// True if the adapter has timestamp queries.
    pub has_clock: bool,
    /// Durations of the most recent frames.
    pub times: FrameTimes,
    /// Numbers of shapes, labels, triangles and uploaded bytes of the scene that was drawn last;
    /// `None` before the first scene.
    pub counts: Option<Counts>,
    /// Time taken to solve the shown crowd; `None` without a crowd.
    pub crowd: Option<CrowdTimes>,
    /// The parts that are shown in another page; `None` for the whole program.
    pub parts: Option<Parts>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_millis(solve: u64) -> FrameTime {
        FrameTime { solve: Duration::from_millis(solve), ..FrameTime::default() }
    }

    fn after(count: u64) -> FrameTimes {
        let mut times = FrameTimes::default();
        (0..count).for_each(|frame| times.push(of_millis(frame)));
        times
    }

    #[test]
    fn the_last_frames_are_kept_in_the_order_in_which_they_were_drawn() {
        for count in [0, 1, 3, 239, 240, 241, 1000] {
            let times = after(count);
            let kept: Vec<_> = times.frames().copied().collect();
            let first = count.saturating_sub(FrameTimes::MOST as u64);
            assert_eq!(kept, (first..count).map(of_millis).collect::<Vec<_>>());
            assert_eq!(times.last(), kept.last());
            assert_eq!(times.drawn(), count);
        }
    }

    #[test]
    fn the_devices_time_finds_its_frame_as_long_as_that_is_kept() {
        let time = Duration::from_millis(7);
        for (frame, place) in [(700, Some(200)), (739, Some(239)), (500, Some(0)), (499, None)] {
            let mut times = after(740);
            times.set_gpu(frame, time);
            let found = times.frames().position(|frame| frame.gpu == Some(time));
            assert_eq!(found, place, "{frame}");
        }
        let mut times = after(740);
        times.set_gpu(740, time);
        assert_eq!(times, after(740), "it is not drawn yet");
    }

    #[test]
    fn a_spread_has_half_of_all_below_its_median_and_all_but_a_hundredth_below_its_slowest() {
        for count in [1_u64, 2, 3, 100, 101, 200, 240] {
            let times = after(count);
            let spread = times.spread(|frame| Some(frame.solve)).expect("there are frames");
            let below = |bound: Duration| times.frames().filter(|it| it.solve <= bound).count();
            let most = |bound: Duration| times.frames().filter(|it| it.solve < bound).count();
            let count = count as usize;
            assert!(2 * below(spread.median) >= count && 2 * most(spread.median) <= count);
            let (reached, before) = (below(spread.slowest), most(spread.slowest));
            assert!(100 * reached >= 99 * count && 100 * before < 99 * count, "{count}");
        }
        assert_eq!(after(3).spread(|frame| frame.gpu), None);
        assert_eq!(FrameTimes::default().spread(|frame| Some(frame.solve)), None);
    }

    #[test]
    fn frames_a_second_are_counted_only_while_something_moves() {
        let mut times = after(5);
        assert_eq!(times.per_second(), None);
        let interval = Some(Duration::from_millis(20));
        (0..5).for_each(|_| times.push(FrameTime { interval, ..FrameTime::default() }));
        let per_second = times.per_second().expect("something moves");
        assert!((per_second - 50.0).abs() < 1e-9, "{per_second}");
    }

    #[test]
    fn a_frame_is_its_parts() {
        let [solve, panels, scene, encode, wait] = [1, 2, 4, 8, 16].map(Duration::from_millis);
        let frame = FrameTime { solve, panels, scene, encode, wait, ..FrameTime::default() };
        assert_eq!(frame.work(), Duration::from_millis(15));
        assert_eq!(frame.total(), Duration::from_millis(31));
    }
}
