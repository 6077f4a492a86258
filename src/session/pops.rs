use std::collections::VecDeque;

use crate::document::Arm;
use crate::kinematics::ik::Ik;
use crate::kinematics::pop::{Change, Moment, Pop, Step};
use crate::kinematics::two_bone::TwoBonePose;

/// How fast the arm's elbow has been beside its cursor, in the last steps that were dragged or
/// played: not saved, and not undone.
#[derive(Clone, Debug, PartialEq)]
pub struct Pops {
    samples: VecDeque<PopSample>,
    last: PreviousMoment,
    run: u32,
}

/// One step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PopSample {
    /// Samples of one drag, or of one stretch that was played, have the same number.
    pub run: u32,
    /// PopSampleKind posed the arm.
    pub ik: Ik,
    pub kind: PopSampleKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PopSampleKind {
    /// The cursor moved, and nothing else.
    Step(Step),
    /// Something else changed the pose, once or many times in a row.
    Change(Change),
}

/// Steps in a row that popped, for one reason.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spike {
    /// The place of its highest step among the samples.
    pub at: usize,
    /// The ratio of that.
    pub ratio: f32,
    pub pop: Pop,
    /// PopSampleKind posed the arm.
    pub ik: Ik,
}

/// How the cursor comes to move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CursorMove {
    /// By a drag, in the viewport or of a slider, that began at a revision.
    Dragged(u64),
    Played,
    /// At once: typed, undone, another time chosen.
    Set,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct PreviousMoment {
    moment: Moment,
    cause: CursorMove,
    time: f64,
}

impl Pops {
    const MOST: usize = 600;

    /// None yet of an arm that stands so.
    pub(super) fn new(arm: &Arm, pose: TwoBonePose, time: f64) -> Self {
        let last = PreviousMoment { moment: moment(arm, pose), cause: CursorMove::Set, time };
        Self { samples: VecDeque::new(), last, run: 0 }
    }

    /// The last 600, the oldest first.
    pub fn samples(&self) -> impl ExactSizeIterator<Item = &PopSample> + Clone {
        self.samples.iter()
    }

    /// The oldest first.
    pub fn spikes(&self) -> Vec<Spike> {
        // A hand that goes into a limit and comes out again pops once.
        const APART: usize = 4;
        let mut spikes: Vec<(Spike, usize)> = Vec::new();
        for (at, sample) in self.samples.iter().enumerate() {
            let PopSampleKind::Step(Step { ratio, pop: Some(pop), .. }) = sample.kind else {
                continue;
            };
            let spike = Spike { at, ratio, pop, ik: sample.ik };
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

    /// Compares the arm with the last one.
    pub(super) fn watch(&mut self, arm: &Arm, pose: TwoBonePose, cause: CursorMove, time: f64) {
        self.go_on(moment(arm, pose), cause, time);
    }

    fn go_on(&mut self, moment: Moment, cause: CursorMove, time: f64) {
        let last = &mut self.last;
        // PopSampleKind is played begins again.
        let cause =
            if cause == CursorMove::Played && time < last.time { CursorMove::Set } else { cause };
        let is_elsewhen = cause == CursorMove::Set && time != last.time;
        if cause != last.cause || cause == CursorMove::Set {
            self.run = self.run.wrapping_add(1);
        }
        let before = last.moment;
        (last.cause, last.time) = (cause, time);
        match Change::between(&before, &moment) {
            _ if is_elsewhen => {}
            Some(_) if before.pose == moment.pose => {}
            Some(change) => self.push(moment.ik, PopSampleKind::Change(change)),
            None if cause == CursorMove::Set => {}
            None => match Step::between(&before, &moment) {
                Some(step) => self.push(moment.ik, PopSampleKind::Step(step)),
                // Short ones add up.
                None => return,
            },
        }
        self.last.moment = moment;
    }

    fn push(&mut self, ik: Ik, kind: PopSampleKind) {
        let sample = PopSample { run: self.run, ik, kind };
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
            (Pop::Singular { nearest: one }, Pop::Singular { nearest: other }) => {
                Pop::Singular { nearest: one.min(other) }
            }
            (pop, _) => pop,
        };
        Self { pop, ..higher }
    }

    /// Whether the same cause of the cursor would pop again: nothing has been done about it.
    pub fn persists(self, arm: &Arm) -> bool {
        match self.pop {
            Pop::Singular { .. } => self.ik.reference == arm.reference(),
            _ => self.ik.soft_reach == arm.soft_reach && self.ik.bones == arm.bones,
        }
    }
}

fn moment(arm: &Arm, pose: TwoBonePose) -> Moment {
    Moment {
        pose,
        cursor: arm.cursor_in_root(),
        ik: arm.ik(),
        spin: arm.twist,
        pinned_root: arm.is_pinned().then_some(arm.root),
        weight: arm.influence,
        fk: arm.fk,
    }
}
