//! The resolution of the scene while something moves, and at rest.
//!
//! The program must be smooth on a machine without a graphics card, where a software adapter draws
//! on the processor. There the time of a frame grows with the number of its pixels: at 1280×800 on
//! two cores a drag of a figure in its skin takes 40 ms a frame in full, and 23 to 28 ms with a
//! budget of 33 ms (docs/performance.md). While something moves, nobody looks at single pixels, so
//! the scene is drawn smaller and scaled up; a tenth of a second after the last motion it is drawn
//! in full. Labels and panels always have the full resolution.
//!
//! A picture at rest is looked at closely, and is drawn once. So the scene is drawn at twice the
//! width and height after it has not changed for a while, and scaled down, which smooths its edges.
//! This is left out where it would take long or much memory.
//!
//! The controller reads the durations of the frames. Two slow frames in a row lower the scale to
//! the largest one that is predicted to fit the budget; twenty fast ones raise it by one step. The
//! gap between the two thresholds keeps the scale from swinging. A graphics card that meets the
//! budget draws in full.

use std::time::Duration;

use web_time::Instant;

use crate::render::Canvas;
use crate::scene::Scene;
use crate::ui::FrameTime;

/// Fractions of the viewport's width and height at which the scene is drawn while it moves.
const SCALES: [f32; 5] = [1.0, 0.85, 0.7, 0.6, 0.5];

/// Time without motion after which the scene is drawn at full resolution.
const REST: Duration = Duration::from_millis(100);

/// Time without any change after which the scene is drawn at [`Canvas::FINEST`].
const STILL: Duration = Duration::from_millis(150);

/// The longest time that a picture at rest may be predicted to take: longer ones would be felt by
/// who moves the mouse again.
const LONGEST: Duration = Duration::from_millis(400);

/// The largest number of pixels of a viewport that is drawn finer. Four times as many take 0.2 GB.
/// On a larger one the pixels are small.
const MOST_PIXELS: u32 = 1_600_000;

/// Number of slow frames in a row before the resolution is lowered.
const SLOW_FRAMES: u32 = 2;

/// Number of fast frames in a row before the resolution is raised.
const FAST_FRAMES: u32 = 20;

/// Fractions of the budget: frames above the first are slow. The resolution is raised only if the
/// predicted frame time is below the second.
const SLOW: f32 = 0.85;
const SAFE: f32 = 0.65;

/// How a scene differs from the one that was drawn before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SceneChange {
    /// It is the same.
    Nothing,
    /// It differs, for example in what is highlighted.
    Step,
    /// It differs as it does in a drag, in playback or when the camera moves.
    Motion,
}

impl SceneChange {
    /// Compares two scenes, of which the first was drawn. `is_driven` is true while a button of the
    /// mouse is held or the motion plays.
    pub fn new(before: Option<&Scene>, now: Option<&Scene>, is_driven: bool) -> Self {
        match (before, now) {
            (Some(before), Some(now)) if before == now => Self::Nothing,
            (Some(before), Some(now)) if is_driven || before.camera != now.camera => Self::Motion,
            _ => Self::Step,
        }
    }
}

/// Chooses the ratio of the size at which the scene is drawn to the size of the viewport. While the
/// scene moves, it is as large as a budget for the frame time allows, but not below [`SCALES`];
/// afterwards it is 1, and at rest [`Canvas::FINEST`], where that is fast enough.
#[derive(Clone, Debug, Default)]
pub(super) struct DynamicResolution {
    /// Index into [`SCALES`].
    step: usize,
    /// Time of the last motion; `None` at rest.
    moved: Option<Instant>,
    /// Time of the last change; `None` before the first.
    changed: Option<Instant>,
    /// Times of the last two frames that drew the scene in full; 0 before them. The faster one counts,
    /// since a frame may also wait for a shader. Finer frames do not: a picture at rest must not become
    /// coarse again because it took longer than predicted.
    full: [Duration; 2],
    is_small_enough: bool,
    slow: u32,
    fast: u32,
}

impl DynamicResolution {
    /// The scale of a frame at the time `now`, for a viewport of a size in pixels. Without a budget
    /// it is 1.
    pub fn next(
        &mut self,
        change: SceneChange,
        (width, height): (u32, u32),
        budget: Option<Duration>,
        now: Instant,
    ) -> f32 {
        if budget.is_none() {
            *self = Self::default();
            return 1.0;
        }
        self.is_small_enough = width.saturating_mul(height) <= MOST_PIXELS;
        if change != SceneChange::Nothing {
            self.changed = Some(now);
        }
        if change == SceneChange::Motion {
            self.moved = Some(now);
        } else if self.moved.is_some_and(|moved| now.duration_since(moved) >= REST) {
            self.moved = None;
        }
        match self.moved {
            Some(_) => SCALES[self.step],
            None if self.may_be_finer() && self.still_in(now).is_none() => Canvas::FINEST,
            None => 1.0,
        }
    }

    /// Time from `now` until the scene must be drawn at a higher resolution, unless it changes
    /// again; `None` if it has its highest.
    pub fn rests_in(&self, now: Instant) -> Option<Duration> {
        let rests = self.moved.map(|moved| (moved + REST).saturating_duration_since(now));
        rests.or_else(|| self.still_in(now).filter(|_| self.may_be_finer()))
    }

    /// Time from `now` until the scene has not changed for [`STILL`]; `None` from then on.
    fn still_in(&self, now: Instant) -> Option<Duration> {
        let left = (self.changed? + STILL).saturating_duration_since(now);
        (!left.is_zero()).then_some(left)
    }

    fn may_be_finer(&self) -> bool {
        let predicted = self.full[0].min(self.full[1]).mul_f32(Canvas::FINEST.powi(2));
        self.is_small_enough && predicted <= LONGEST
    }

    /// Adapts the resolution to the time that a frame took, if it drew the scene at the present
    /// scale.
    pub fn measure(&mut self, frame: &FrameTime, time: Duration, budget: Option<Duration>) {
        let scale = frame.resolution_scale;
        if frame.draws_scene && scale == 1.0 {
            self.full = [self.full[1], time];
        }
        let is_telling = frame.draws_scene && scale == SCALES[self.step];
        let Some(budget) = budget.filter(|_| is_telling) else { return };
        let used = time.as_secs_f32() / budget.as_secs_f32();
        // Assumes that the frame time is proportional to the number of pixels.
        let larger = self.step.saturating_sub(1);
        let used_larger = used * (SCALES[larger] / scale).powi(2);
        self.slow = if used > SLOW { self.slow + 1 } else { 0 };
        self.fast = if used_larger < SAFE { self.fast + 1 } else { 0 };
        if self.slow >= SLOW_FRAMES {
            let fits = |scale: &f32| *scale <= SCALES[self.step] * (SLOW / used).sqrt();
            let smaller = SCALES.iter().position(fits).unwrap_or(SCALES.len() - 1);
            self.set_step(smaller);
        } else if self.fast >= FAST_FRAMES {
            self.set_step(larger);
        }
    }

    fn set_step(&mut self, step: usize) {
        (self.step, self.slow, self.fast) = (step, 0, 0);
    }
}

/// Returns a function that returns the time since its previous call; the first call returns the
/// time since the function was made.
pub fn lap_timer() -> impl FnMut() -> Duration {
    let mut last = Instant::now();
    move || {
        let now = Instant::now();
        now - std::mem::replace(&mut last, now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTION: SceneChange = SceneChange::Motion;
    const STEP: SceneChange = SceneChange::Step;
    const NOTHING: SceneChange = SceneChange::Nothing;
    const SIZE: (u32, u32) = (724, 711);
    const BUDGET: Option<Duration> = Some(Duration::from_millis(33));

    /// Numbers from 0 to 1, the same on every run.
    fn numbers() -> impl Iterator<Item = f32> {
        let mut state = 7_u64;
        std::iter::from_fn(move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            Some((state >> 40) as f32 / (1_u64 << 24) as f32)
        })
    }

    /// A frame that draws the scene at a scale.
    fn drawn(resolution_scale: f32) -> FrameTime {
        FrameTime { resolution_scale, draws_scene: true, ..FrameTime::default() }
    }

    /// Shares of frames in motion, on a machine whose frames take `fixed` milliseconds and
    /// `in_full` more for a picture in full, with up to a tenth of noise.
    fn scales(fixed: f32, in_full: f32, frames: usize) -> Vec<f32> {
        let mut resolution = DynamicResolution::default();
        let now = Instant::now();
        let mut scales = Vec::new();
        for noise in numbers().take(frames) {
            let scale = resolution.next(MOTION, SIZE, BUDGET, now);
            let time = (fixed + in_full * scale * scale) * (0.9 + 0.2 * noise);
            resolution.measure(&drawn(scale), Duration::from_secs_f32(time / 1000.0), BUDGET);
            scales.push(scale);
        }
        scales
    }

    #[test]
    fn frames_fit_the_budget_after_eight_or_are_as_small_as_possible() {
        for fixed in [2.0, 10.0, 20.0] {
            for in_full in [1.0, 20.0, 40.0, 65.0, 200.0] {
                for scale in &scales(fixed, in_full, 500)[8..] {
                    let time = fixed + in_full * scale * scale;
                    let fits = time * 0.9 <= 33.0 || *scale == 0.5;
                    assert!(fits, "{time} ms at {scale} ({fixed} and {in_full} ms)");
                }
            }
        }
    }

    #[test]
    fn the_size_does_not_swing() {
        for fixed in [2.0, 10.0, 20.0] {
            for in_full in [1.0, 20.0, 28.0, 40.0, 65.0, 200.0] {
                let scales = scales(fixed, in_full, 2_000);
                let changes = scales.windows(2).filter(|pair| pair[0] != pair[1]).count();
                assert!(changes <= 4, "{changes} changes ({fixed} and {in_full} ms)");
            }
        }
    }

    #[test]
    fn a_fast_machine_draws_in_full() {
        assert!(scales(2.0, 20.0, 500).iter().all(|scale| *scale == 1.0));
    }

    #[test]
    fn the_picture_grows_again_when_frames_become_fast() {
        let mut resolution = DynamicResolution::default();
        let now = Instant::now();
        let mut draw = |milliseconds| {
            let scale = resolution.next(MOTION, SIZE, BUDGET, now);
            resolution.measure(&drawn(scale), Duration::from_millis(milliseconds), BUDGET);
            scale
        };
        let slow: Vec<f32> = (0..6).map(|_| draw(200)).collect();
        assert_eq!(slow.last(), Some(&0.5));
        let fast: Vec<f32> = (0..100).map(|_| draw(5)).collect();
        assert_eq!(fast.last(), Some(&1.0));
    }

    #[test]
    fn frames_of_the_panels_alone_tell_nothing_about_the_scene() {
        let mut resolution = DynamicResolution::default();
        let now = Instant::now();
        for _ in 0..4 {
            let scale = resolution.next(MOTION, SIZE, BUDGET, now);
            resolution.measure(&drawn(scale), Duration::from_millis(90), BUDGET);
            let panels = FrameTime { draws_scene: false, ..drawn(scale) };
            resolution.measure(&panels, Duration::from_millis(9), BUDGET);
        }
        assert!(resolution.next(MOTION, SIZE, BUDGET, now) < 1.0);
    }

    #[test]
    fn the_scene_is_drawn_in_full_a_tenth_of_a_second_after_it_rests() {
        let mut resolution = DynamicResolution { step: 4, ..DynamicResolution::default() };
        let start = Instant::now();
        let at = |milliseconds| start + Duration::from_millis(milliseconds);
        assert_eq!(resolution.rests_in(at(0)), None);
        assert_eq!(resolution.next(STEP, SIZE, BUDGET, at(0)), 1.0);
        assert_eq!(resolution.next(MOTION, SIZE, BUDGET, at(10)), 0.5);
        assert_eq!(resolution.next(NOTHING, SIZE, BUDGET, at(60)), 0.5);
        assert_eq!(resolution.rests_in(at(60)), Some(Duration::from_millis(50)));
        assert_eq!(resolution.next(MOTION, SIZE, BUDGET, at(100)), 0.5);
        assert_eq!(resolution.rests_in(at(250)), Some(Duration::ZERO));
        assert_eq!(resolution.next(NOTHING, SIZE, BUDGET, at(200)), 1.0);
    }

    #[test]
    fn a_scene_that_stays_the_same_is_drawn_finer_once() {
        let mut resolution = DynamicResolution::default();
        let start = Instant::now();
        let at = |milliseconds| start + Duration::from_millis(milliseconds);
        assert_eq!(resolution.next(MOTION, SIZE, BUDGET, at(0)), 1.0);
        assert_eq!(resolution.next(NOTHING, SIZE, BUDGET, at(100)), 1.0);
        assert_eq!(resolution.rests_in(at(100)), Some(Duration::from_millis(50)));
        assert_eq!(resolution.next(NOTHING, SIZE, BUDGET, at(150)), Canvas::FINEST);
        assert_eq!(resolution.rests_in(at(150)), None);
        assert_eq!(resolution.next(STEP, SIZE, BUDGET, at(500)), 1.0, "a highlight");
        assert_eq!(resolution.rests_in(at(500)), Some(STILL));
        assert_eq!(resolution.next(NOTHING, SIZE, BUDGET, at(900)), Canvas::FINEST);
    }

    #[test]
    fn a_scene_that_would_take_long_or_much_memory_is_not_drawn_finer() {
        let start = Instant::now();
        let scale_at_rest = |milliseconds: &[u64], size| {
            let mut resolution = DynamicResolution::default();
            for time in milliseconds {
                resolution.next(STEP, size, BUDGET, start);
                resolution.measure(&drawn(1.0), Duration::from_millis(*time), BUDGET);
            }
            let scale = resolution.next(NOTHING, size, BUDGET, start + STILL);
            assert_eq!(resolution.rests_in(start + STILL), None);
            scale
        };
        assert_eq!(scale_at_rest(&[900, 60], SIZE), 2.0, "one slow frame does not count");
        assert_eq!(scale_at_rest(&[60, 900], SIZE), 2.0);
        assert_eq!(scale_at_rest(&[110, 110], SIZE), 1.0);
        assert_eq!(scale_at_rest(&[9, 9], (1360, 1100)), 2.0);
        assert_eq!(scale_at_rest(&[9, 9], (3840, 2160)), 1.0);
    }

    #[test]
    fn a_finer_picture_stays_even_if_it_took_longer_than_predicted() {
        let mut resolution = DynamicResolution::default();
        let start = Instant::now();
        resolution.next(STEP, SIZE, BUDGET, start);
        for _ in 0..2 {
            resolution.measure(&drawn(1.0), Duration::from_millis(99), BUDGET);
        }
        for frame in 1..5 {
            let now = start + frame * STILL;
            assert_eq!(resolution.next(NOTHING, SIZE, BUDGET, now), Canvas::FINEST);
            resolution.measure(&drawn(Canvas::FINEST), Duration::from_secs(1), BUDGET);
        }
    }

    #[test]
    fn without_a_budget_the_scene_is_always_drawn_in_full() {
        let mut resolution = DynamicResolution { step: 4, ..DynamicResolution::default() };
        let now = Instant::now();
        assert_eq!(resolution.next(MOTION, SIZE, None, now), 1.0);
        resolution.measure(&drawn(1.0), Duration::from_secs(1), None);
        assert_eq!(resolution.next(MOTION, SIZE, None, now), 1.0);
        assert_eq!(resolution.next(NOTHING, SIZE, None, now + STILL), 1.0);
        assert_eq!(resolution.rests_in(now), None);
    }
}
