use std::collections::VecDeque;

use crate::kinematics::ik::Ik;
use crate::kinematics::pop::{ElbowStep, InputChange, PopCause, PosedLimb};
use crate::kinematics::twist::{TransportedFrame, TwistReferenceKind};
use crate::rig::LimbFrames;

/// Ratios of elbow speed to Cursor speed in the latest dragged or played steps of a limb. Neither
/// saved nor undone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pops {
    samples: VecDeque<PopSample>,
    /// `None` without a limb.
    previous: Option<PreviousMoment>,
    run: u32,
}

/// One step of the elbow, with the input that caused it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PopSample {
    /// Number of the drag or playback that the sample belongs to.
    pub run: u32,
    /// The solver's settings in this step.
    pub ik: Ik,
    /// Kind of the twist reference.
    pub reference: TwistReferenceKind,
    /// The input that changed.
    pub kind: PopSampleKind,
}

/// The input that changed the pose in a [`PopSample`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PopSampleKind {
    /// Only the Cursor moved.
    Step(ElbowStep),
    /// Another input changed, once or several times in a row.
    Change(InputChange),
}

/// Consecutive steps that popped for the same reason.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spike {
    /// Index of the sample with the highest ratio.
    pub at: usize,
    /// The highest ratio of elbow speed to Cursor speed.
    pub ratio: f32,
    /// The cause.
    pub pop: PopCause,
    /// The solver's settings at the pop.
    pub ik: Ik,
    /// Kind of the twist reference at the pop.
    pub reference: TwistReferenceKind,
}

/// Cause of a move of the Cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::session) enum CursorMove {
    /// A drag in the viewport or of a slider, with the revision at which it began.
    Dragged(u64),
    /// Playback.
    Played,
    /// A jump by a typed value, an undo step or another time.
    Set,
}

/// The limb in the previous step, to which the next step is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PreviousMoment {
    moment: PosedLimb,
    cause: CursorMove,
    time: f64,
}

impl Pops {
    /// Maximum number of samples.
    const MOST: usize = 600;

    /// Starts without samples; the first step is compared to this pose at a time in seconds.
    pub(in crate::session) fn new(moment: PosedLimb, time: f64) -> Self {
        let previous = PreviousMoment { moment, cause: CursorMove::Set, time };
        Self { samples: VecDeque::new(), previous: Some(previous), run: 0 }
    }

    /// The latest samples, at most 600, oldest first.
    pub fn samples(&self) -> impl ExactSizeIterator<Item = &PopSample> + Clone {
        self.samples.iter()
    }

    /// The pops among the samples, oldest first.
    pub fn spikes(&self) -> Vec<Spike> {
        // Similar pops that are fewer samples apart count as one: a hand that enters a limit and
        // leaves it at once pops once.
        const APART: usize = 4;
        let mut spikes: Vec<(Spike, usize)> = Vec::new();
        for (at, sample) in self.samples.iter().enumerate() {
            let PopSampleKind::Step(ElbowStep { ratio, pop: Some(pop), .. }) = sample.kind else {
                continue;
            };
            let PopSample { ik, reference, .. } = *sample;
            let spike = Spike { at, ratio, pop, ik, reference };
            match spikes.last_mut() {
                Some((last, end))
                    if self.samples[*end].run == sample.run
                        && at - *end < APART
                        && last.is_like(spike) =>
                {
                    *last = last.joined(spike);
                    *end = at;
                }
                _ => spikes.push((spike, at)),
            }
        }
        spikes.into_iter().map(|(spike, _)| spike).collect()
    }

    /// Records the step from the previous pose to this one.
    pub(in crate::session) fn record(&mut self, moment: PosedLimb, cause: CursorMove, time: f64) {
        let Some(previous) = &mut self.previous else { return };
        // Playback that loops back to the start is a jump.
        let cause = if cause == CursorMove::Played && time < previous.time {
            CursorMove::Set
        } else {
            cause
        };
        let has_jumped_in_time = cause == CursorMove::Set && time != previous.time;
        if cause != previous.cause || cause == CursorMove::Set {
            self.run = self.run.wrapping_add(1);
        }
        let before = previous.moment;
        (previous.cause, previous.time) = (cause, time);
        match InputChange::between(&before, &moment) {
            _ if has_jumped_in_time => {}
            Some(_) if before.pose == moment.pose => {}
            Some(change) => self.push(&moment, PopSampleKind::Change(change)),
            None if cause == CursorMove::Set => {}
            None => match ElbowStep::between(&before, &moment) {
                Some(step) => self.push(&moment, PopSampleKind::Step(step)),
                // Steps that are too short to measure add up, since the previous arm is kept.
                None => return,
            },
        }
        self.previous = Some(PreviousMoment { moment, cause, time });
    }

    fn push(&mut self, moment: &PosedLimb, kind: PopSampleKind) {
        let sample = PopSample { run: self.run, ik: moment.ik, reference: moment.kind, kind };
        if let (PopSampleKind::Change(_), Some(last)) = (kind, self.samples.back_mut())
            && last.run == sample.run
            && last.kind == kind
        {
            *last = sample;
            return;
        }
        if self.samples.len() >= Self::MOST {
            self.samples.pop_front();
        }
        self.samples.push_back(sample);
    }
}

impl Spike {
    fn is_like(self, other: Self) -> bool {
        core::mem::discriminant(&self.pop) == core::mem::discriminant(&other.pop)
            && self.ik == other.ik
    }

    fn joined(self, other: Self) -> Self {
        let higher = if other.ratio > self.ratio { other } else { self };
        let pop = match (self.pop, other.pop) {
            (PopCause::Singular { nearest: one }, PopCause::Singular { nearest: other }) => {
                PopCause::Singular { nearest: one.min(other) }
            }
            (pop, _) => pop,
        };
        Self { pop, ..higher }
    }

    /// True if the same move of the Cursor would pop again, because the settings that caused the
    /// pop are unchanged.
    pub fn persists(self, now: &PosedLimb) -> bool {
        match self.pop {
            PopCause::Singular { .. } => {
                // The map of the reference FK follows from the angles.
                let is_same = self.ik.reference == now.ik.reference;
                self.reference == now.kind && (is_same || now.kind == TwistReferenceKind::Fk)
            }
            _ => self.ik.soft_reach == now.ik.soft_reach && self.ik.bones == now.ik.bones,
        }
    }
}

/// Parallel transport of a frame along the Pointer's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransportPath {
    start: TransportedFrame,
    now: TransportedFrame,
}

impl TransportPath {
    /// A path that starts at the frame from which the limb's twist is measured.
    pub(in crate::session) fn new(frames: &LimbFrames) -> Self {
        let start = frames.solution.transported;
        Self { start, now: start }
    }

    pub(in crate::session) fn advance(&mut self, frames: &LimbFrames) {
        let direction = frames.solution.transported.direction;
        if direction != self.now.direction {
            self.now = self.now.to(direction);
        }
    }

    /// The frame transported along the path to the present Pointer, in Root space.
    pub fn transported(&self) -> TransportedFrame {
        self.now
    }

    /// Holonomy of the path: the angle about the Pointer, in radians in (−π, π], from the start
    /// frame transported straight to the present Pointer to the frame transported along the path.
    /// It equals the solid angle that the path encloses.
    pub fn holonomy(&self) -> f32 {
        self.start.turn_to(self.now)
    }
}
