//! An inspection of a motion: targets that are missed and lost, pops with their causes, joints at
//! their limits, and feet that slide.

mod spans;

use std::collections::BTreeMap;

use super::{Document, Posed, Timeline, Track};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointId, RotationAxis};
use crate::rig::{
    EvaluatedSkeleton, Posture, RigMoment, RigPop, RigPopCause, SkeletonRig, TargetOutcome,
    TargetReport,
};
pub use spans::Slide;
use spans::{Slides, Spans};

/// The faults of the motion of a skeleton, frame by frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inspection {
    /// For each target that poses the skeleton in a frame, the frame in which its tip is farthest
    /// from it.
    pub worst: Vec<WorstMiss>,
    /// Spans of frames in which a whole-body target is missed, although a solve of the frame by
    /// itself reaches it.
    pub lost: Vec<LostSpan>,
    /// Frames in which joints move much farther than targets.
    pub pops: Vec<FramePop>,
    /// The highest of pops that follow each other.
    pub peaks: Vec<FramePop>,
    /// Spans of frames in which an angle of a joint that a target turns is at an end of its range.
    pub at_limits: Vec<LimitSpan>,
    /// Spans of frames in which a target with full influence rests and its tip moves.
    pub slides: Vec<Slide>,
    /// If targets are lost, a posture with which the motion loses none.
    pub better_posture: Option<Shared<Posture>>,
}

/// The frame in which a tip is farthest from its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstMiss {
    /// Joint of the target.
    pub joint: JointId,
    /// Distance in the world.
    pub error: f32,
    /// Time of the frame in seconds.
    pub time: f64,
}

/// A span of frames in which a target is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostSpan {
    /// Joint of the target.
    pub target: JointId,
    /// Time of the first frame in seconds.
    pub from: f64,
    /// Time of the last frame in seconds.
    pub to: f64,
    /// Largest distance from tip to target, in the world.
    pub miss: f32,
}

/// A pop in the step to a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FramePop {
    /// Time of the frame in seconds.
    pub time: f64,
    /// The pop.
    pub pop: RigPop,
}

/// A span of frames in which a joint is at its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitSpan {
    /// The joint.
    pub joint: JointId,
    /// Time of the first frame in seconds.
    pub from: f64,
    /// Time of the last frame in seconds.
    pub to: f64,
}

/// A frame of a motion.
struct Frame {
    time: f64,
    rig: SkeletonRig,
    evaluated: EvaluatedSkeleton,
}

impl Frame {
    fn new(posed: &Posed) -> Self {
        let (rig, evaluated) = (&posed.document().rig, posed.evaluated_skeleton());
        Self { time: posed.time(), rig: rig.clone(), evaluated: evaluated.clone() }
    }

    fn moment(&self) -> RigMoment<'_> {
        RigMoment { rig: &self.rig, evaluated: &self.evaluated }
    }

    /// The report of a target that poses the skeleton; `None` for one that does not.
    fn posing(&self, index: usize) -> Option<&TargetReport> {
        let target = &self.rig.targets[index];
        self.rig.is_solved_for(target).then(|| &self.evaluated.targets[index])
    }

    /// True if a whole-body target is missed, at full influence.
    fn is_missed(&self, index: usize) -> bool {
        let Some(report) = self.posing(index) else { return false };
        let TargetOutcome::WholeBody(solved) = &report.outcome else { return false };
        let is_full = self.rig.targets[index].influence >= 1.0;
        !solved.converged() && (!is_full || report.error > self.rig.tolerance())
    }
}

impl Inspection {
    /// Inspects the motion of a track's document at the frames of a timeline, which may differ from
    /// the document's. With `loops`, also looks at the step from the last frame to the first.
    /// `go_on` is called after each frame with the number of frames so far; `None` once it returns
    /// false.
    pub async fn new(
        track: &Track,
        frames: Timeline,
        loops: bool,
        mut go_on: impl AsyncFnMut(usize) -> bool,
    ) -> Option<Self> {
        let mut inspector = Inspector::new(track.document());
        let at = |frame: usize| Frame::new(&track.at(frames.time(frame)));
        let last = frames.frames() - 1;
        let mut before = at(0);
        inspector.look_at(&before);
        for frame in 1..=last {
            let after = at(frame);
            inspector.look_at(&after);
            inspector.look_at_step(&before, &after);
            before = after;
            if !go_on(frame).await {
                return None;
            }
        }
        if loops && last > 0 {
            inspector.pops.extend(seam([&at(last - 1), &before, &at(0), &at(1)]));
        }
        Some(inspector.inspection(track, frames))
    }
}

/// Of all pops with the same target and cause that are at most three frames of a timeline apart, the
/// one with the highest ratio; in the order of their times.
fn peaks(pops: &[FramePop], timeline: Timeline) -> Vec<FramePop> {
    const APART: f64 = 3.5;
    let mut peaks: Vec<FramePop> = Vec::new();
    // By target and cause, the latest peak and the time of its latest pop.
    let mut latest: BTreeMap<(JointId, &str), (usize, f64)> = BTreeMap::new();
    for pop in pops {
        let next = (peaks.len(), pop.time);
        let (peak, last) = latest.entry((pop.pop.target, pop.pop.cause.name())).or_insert(next);
        if (pop.time - *last) * timeline.frame_rate >= APART {
            *peak = peaks.len();
        }
        *last = pop.time;
        match peaks.get_mut(*peak) {
            Some(peak) if peak.pop.ratio >= pop.pop.ratio => {}
            Some(peak) => *peak = *pop,
            None => peaks.push(*pop),
        }
    }
    peaks.sort_by(|one, other| one.time.total_cmp(&other.time));
    peaks
}

/// Remedies.
impl Inspection {
    /// If targets are lost, looks for a posture with which the motion loses none: the motion is
    /// tracked backwards from a solve of a frame that is lost, and then inspected from there. Ends
    /// without one if `go_on` returns false.
    pub async fn find_better_posture(
        &mut self,
        track: &Track,
        frames: Timeline,
        mut go_on: impl AsyncFnMut(usize) -> bool,
    ) {
        /// Most spans from which a posture is sought.
        const MOST: usize = 3;
        /// Places in a span, from 0 to 1, from which the motion is tracked backwards.
        const PLACES: [f64; 5] = [0.5, 1.0, 0.0, 0.75, 0.25];
        for LostSpan { from, to, .. } in self.lost.iter().take(MOST) {
            for time in PLACES.map(|place| from + (to - from) * place) {
                let Some(posture) = track.posture_reaching(time) else { continue };
                let mut document = track.document().clone();
                document.rig.posture = Some(posture.clone());
                let track = Track::new(&document);
                let again = Self::new(&track, frames, false, &mut go_on).await;
                let Some(again) = again else { return };
                if again.lost.is_empty() {
                    self.better_posture = Some(posture);
                    return;
                }
            }
        }
    }
}

/// The findings of an inspection so far.
struct Inspector {
    worst: Vec<Option<WorstMiss>>,
    pops: Vec<FramePop>,
    missed: Spans<f32>,
    limits: Spans<()>,
    slides: Slides,
}

impl Inspector {
    fn new(document: &Document) -> Self {
        let targets = document.rig.targets.len();
        Self {
            worst: vec![None; targets],
            pops: Vec::new(),
            missed: Spans::new(targets),
            limits: Spans::new(document.skeleton().joints().len()),
            slides: Slides::new(targets),
        }
    }

    fn look_at(&mut self, frame: &Frame) {
        for index in 0..frame.rig.targets.len() {
            let report = frame.posing(index);
            if let Some(TargetReport { error, .. }) = report {
                let worst = &mut self.worst[index];
                if worst.is_none_or(|worst| *error > worst.error) {
                    let joint = frame.rig.targets[index].joint;
                    *worst = Some(WorstMiss { joint, error: *error, time: frame.time });
                }
            }
            let miss = report.map(|report| report.error).filter(|_| frame.is_missed(index));
            self.missed.observe(index, frame.time, miss, f32::max);
            self.slides.observe(index, frame.time, &frame.rig, &frame.evaluated);
        }
        let influences = frame.rig.influences();
        for (joint, of) in frame.evaluated.solved.iter() {
            let is_at_end = |axis: &RotationAxis| {
                !of.limits.is_fixed(*axis) && of.limits.is_at_end(of.rotation, *axis)
            };
            let is_turned = influences[joint.index()] > 0.0;
            let is_met = is_turned && RotationAxis::ALL.iter().any(is_at_end);
            self.limits.observe(joint.index(), frame.time, is_met.then_some(()), |_, ()| ());
        }
    }

    fn look_at_step(&mut self, before: &Frame, after: &Frame) {
        let missed = [&|index| before.is_missed(index), &|index| after.is_missed(index)]
            as [&dyn Fn(usize) -> bool; 2];
        let pops = before.moment().pops_to(&after.moment(), missed);
        self.pops.extend(pops.into_iter().map(|pop| FramePop { time: after.time, pop }));
    }

    fn inspection(self, track: &Track, frames: Timeline) -> Inspection {
        let targets = &track.document().rig.targets;
        let lost = self.missed.ended().filter(|span| is_lost(track, span.index, &span.times));
        let lost = lost.map(|span| LostSpan {
            target: targets[span.index].joint,
            from: span.times[0],
            to: span.times[span.times.len() - 1],
            miss: span.value,
        });
        let limits = self.limits.ended().map(|span| LimitSpan {
            joint: JointId::new(span.index),
            from: span.times[0],
            to: span.times[span.times.len() - 1],
        });
        Inspection {
            worst: self.worst.into_iter().flatten().collect(),
            lost: lost.collect(),
            peaks: peaks(&self.pops, frames),
            pops: self.pops,
            at_limits: limits.collect(),
            slides: self.slides.ended(targets),
            better_posture: None,
        }
    }
}

/// The pop in the step from the last frame to the first: a joint that moves more than twice as far
/// as in the steps before and after. The frames are the last but one, the last, the first and the
/// second.
fn seam([before, last, first, second]: [&Frame; 4]) -> Option<FramePop> {
    const LEAST_WAY: f32 = 1e-3;
    let way = |from: &Frame, to: &Frame| {
        let [from, to] = [from, to].map(|frame| frame.evaluated.solved.pose());
        let moved = from.ids().map(|joint| (joint, from.tip(joint).distance(to.tip(joint))));
        moved.max_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or_default()
    };
    let (joint, moved) = way(last, first);
    let usual = way(before, last).1.max(way(first, second).1).max(LEAST_WAY * last.rig.reach());
    let ratio = moved / usual;
    let target = last.rig.targets.first().map_or(joint, |target| target.joint);
    let pop = RigPop { joint, ratio, cause: RigPopCause::Seam, target };
    (ratio > 2.0).then_some(FramePop { time: last.time, pop })
}

/// True if a solve of one of some frames by itself reaches a target. Of many frames, some are
/// looked at, the first and the last among them.
fn is_lost(track: &Track, index: usize, times: &[f64]) -> bool {
    const MOST: usize = 32;
    let last = times.len() - 1;
    let step = last.div_ceil(MOST).max(1);
    let looked_at = (0..last).step_by(step).chain([last]);
    looked_at.map(|frame| times[frame]).any(|time| {
        let frame = Frame::new(&track.by_itself(time));
        !frame.is_missed(index)
    })
}
