use glam::Vec3;

use crate::kinematics::skeleton::JointId;
use crate::rig::{EvaluatedSkeleton, SkeletonRig, Target};

/// A span of frames in which a tip slides away from where its resting target has held it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide {
    /// Joint of the target.
    pub target: JointId,
    /// Time of the first frame in seconds.
    pub from: f64,
    /// Time of the last frame in seconds.
    pub to: f64,
    /// Largest distance of the tip from its place in the first frame, in the world.
    pub by: f32,
}

/// Spans of consecutive frames in which something holds, for each of several things.
pub(super) struct Spans<T> {
    open: Vec<Option<Span<T>>>,
    ended: Vec<Span<T>>,
}

/// Consecutive frames in which something holds.
#[derive(Clone)]
pub(super) struct Span<T> {
    pub index: usize,
    /// Times of the frames in seconds.
    pub times: Vec<f64>,
    pub value: T,
}

impl<T: Copy> Spans<T> {
    pub fn new(count: usize) -> Self {
        Self { open: std::iter::repeat_with(|| None).take(count).collect(), ended: Vec::new() }
    }

    /// Adds a frame; `value` is `None` if the thing does not hold in it. Values of a span are
    /// joined.
    pub fn observe(&mut self, index: usize, time: f64, value: Option<T>, join: impl Fn(T, T) -> T) {
        let open = &mut self.open[index];
        match (open.as_mut(), value) {
            (Some(span), Some(value)) => {
                span.times.push(time);
                span.value = join(span.value, value);
            }
            (None, Some(value)) => *open = Some(Span { index, times: vec![time], value }),
            (Some(_), None) => self.ended.extend(open.take()),
            (None, None) => {}
        }
    }

    /// All spans, in the order of their first frames.
    pub fn ended(self) -> impl Iterator<Item = Span<T>> {
        let mut all: Vec<Span<T>> =
            self.ended.into_iter().chain(self.open.into_iter().flatten()).collect();
        all.sort_by(|one, other| one.times[0].total_cmp(&other.times[0]));
        all.into_iter()
    }
}

/// Spans of frames in which targets rest, with the ways of their tips.
pub(super) struct Slides {
    resting: Vec<Option<Resting>>,
    slides: Vec<Slide>,
}

/// A target that rests.
struct Resting {
    target: Vec3,
    tip: Vec3,
    from: f64,
    to: f64,
    frames: usize,
    by: f32,
    length: f32,
}

impl Slides {
    /// Way of a target, in lengths of its chain, within which it rests.
    const RESTS: f32 = 1e-4;
    /// Way of a tip, in lengths of its chain, beyond which it slides.
    const SLIDES: f32 = 1e-3;
    /// Least number of frames in which a target rests.
    const LEAST_FRAMES: usize = 3;

    pub fn new(targets: usize) -> Self {
        Self {
            resting: std::iter::repeat_with(|| None).take(targets).collect(),
            slides: Vec::new(),
        }
    }

    pub fn observe(
        &mut self,
        index: usize,
        time: f64,
        rig: &SkeletonRig,
        evaluated: &EvaluatedSkeleton,
    ) {
        let target = &rig.targets[index];
        let is_full =
            rig.is_solved_for(target) && target.influence >= 1.0 && !target.has_free_place();
        let place = evaluated.targets[index].position;
        let tip = evaluated.solved.tip(target.joint);
        let length = rig.length_to(target.joint);
        let rests = |resting: &Resting| place.distance(resting.target) < Self::RESTS * length;
        match self.resting[index].as_mut().filter(|resting| is_full && rests(resting)) {
            Some(resting) => {
                resting.by = resting.by.max(tip.distance(resting.tip));
                resting.to = time;
                resting.frames += 1;
            }
            None => {
                self.end(index, target);
                self.resting[index] = is_full.then_some(Resting {
                    target: place,
                    tip,
                    from: time,
                    to: time,
                    frames: 1,
                    by: 0.0,
                    length,
                });
            }
        }
    }

    fn end(&mut self, index: usize, target: &Target) {
        let Some(resting) = self.resting[index].take() else { return };
        let Resting { from, to, frames, by, length, .. } = resting;
        if frames >= Self::LEAST_FRAMES && by > Self::SLIDES * length {
            self.slides.push(Slide { target: target.joint, from, to, by });
        }
    }

    /// All slides, in the order of their first frames.
    pub fn ended(mut self, targets: &[Target]) -> Vec<Slide> {
        for (index, target) in targets.iter().enumerate() {
            self.end(index, target);
        }
        self.slides.sort_by(|one, other| one.from.total_cmp(&other.from));
        self.slides
    }
}
