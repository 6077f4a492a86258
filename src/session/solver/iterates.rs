use glam::Vec3;

use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{Report, SubStep};
use crate::kinematics::skeleton::Skeleton;
use crate::session::cached::Cached;

/// Iterates of a solver run, oldest first. Iterate 0 is the start.
///
/// At most 4096 iterates and about 32 MiB are kept. Beyond that every second iterate is dropped, so
/// that the first and the latest remain and the whole run is shown in coarser steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Iterates {
    kept: Vec<Iterate>,
    /// Number of iterations from one kept iterate to the next; the latest may follow sooner.
    stride: u32,
    /// Maximum number of kept iterates.
    capacity: usize,
}

/// The pose and the residual after some iterations of a solver.
#[derive(Clone, Debug, PartialEq)]
pub struct Iterate {
    /// Number of iterations made.
    pub iteration: u32,
    /// Largest distance from a tip to its target, in world units.
    pub error: f32,
    joints: Box<[LocalPose]>,
}

/// The Euler angles of a joint in radians, and its offset.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LocalPose {
    rotation: Vec3,
    offset: Vec3,
}

impl Iterate {
    /// The present pose of `skeleton`, with what a solver reports of it.
    pub(in crate::session) fn new(report: Report, skeleton: &Skeleton) -> Self {
        let joints = skeleton.joints().iter();
        let local = joints.map(|it| LocalPose { rotation: it.rotation, offset: it.offset });
        Self { iteration: report.iterations, error: report.error, joints: local.collect() }
    }

    /// Euler angles in radians and offsets of all joints, in their order.
    pub fn joints(&self) -> impl ExactSizeIterator<Item = (Vec3, Vec3)> + '_ {
        self.joints.iter().map(|local| (local.rotation, local.offset))
    }

    /// Poses `skeleton`, which has the joints of the run.
    pub(in crate::session) fn write(&self, skeleton: &mut Skeleton) {
        for (joint, local) in skeleton.ids().zip(&self.joints) {
            skeleton.write_local(joint, |joint| {
                (joint.rotation, joint.offset) = (local.rotation, local.offset);
            });
        }
    }
}

impl Iterates {
    const MOST: usize = 4096;
    const MOST_BYTES: usize = 32 << 20;
    /// Minimum of the capacity, for skeletons of very many joints.
    const FEWEST: usize = 8;

    pub(in crate::session) fn new(first: Iterate) -> Self {
        let bytes = size_of::<Iterate>() + size_of_val(&*first.joints);
        let capacity = (Self::MOST_BYTES / bytes).clamp(Self::FEWEST, Self::MOST);
        Self { kept: vec![first], stride: 1, capacity }
    }

    /// Adds the next iterate.
    pub(in crate::session) fn push(&mut self, iterate: Iterate) {
        if !self.latest().iteration.is_multiple_of(self.stride) {
            self.kept.pop();
        }
        if self.kept.len() >= self.capacity {
            self.stride *= 2;
            self.kept.retain(|kept| kept.iteration.is_multiple_of(self.stride));
        }
        self.kept.push(iterate);
    }

    /// The kept iterates, oldest first.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Iterate> + '_ {
        self.kept.iter()
    }

    /// The latest iterate.
    pub fn latest(&self) -> &Iterate {
        &self.kept[self.kept.len() - 1]
    }

    /// The latest kept iterate of at most `iteration` iterations.
    pub fn at(&self, iteration: u32) -> &Iterate {
        let after = self.kept.partition_point(|kept| kept.iteration <= iteration);
        &self.kept[after.saturating_sub(1)]
    }

    /// The first kept iterate of more than `iteration` iterations; `None` after the latest.
    pub fn after(&self, iteration: u32) -> Option<&Iterate> {
        self.kept.get(self.kept.partition_point(|kept| kept.iteration <= iteration))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Iterates of a skeleton of `joints` joints, after `made` iterations with these errors.
    fn made(joints: usize, made: u32) -> Iterates {
        let local = LocalPose { rotation: Vec3::ZERO, offset: Vec3::ZERO };
        let iterate = |iteration| Iterate {
            iteration,
            error: iteration as f32,
            joints: vec![local; joints].into(),
        };
        let mut iterates = Iterates::new(iterate(0));
        (1..=made).for_each(|iteration| iterates.push(iterate(iteration)));
        iterates
    }

    #[test]
    fn every_iterate_of_a_short_run_is_kept() {
        let iterates = made(19, 1000);
        assert!(iterates.iter().map(|it| it.iteration).eq(0..=1000));
        assert!((0..=1000).all(|iteration| iterates.at(iteration).iteration == iteration));
    }

    #[test]
    fn a_long_run_keeps_its_first_and_latest_iterate_and_some_between_at_equal_steps() {
        for length in [4095, 4096, 4097, 8192, 8193, 30_000] {
            let iterates = made(1, length);
            let kept: Vec<u32> = iterates.iter().map(|it| it.iteration).collect();
            assert!(kept.len() <= Iterates::MOST && kept.len() >= Iterates::MOST / 2 - 1);
            assert_eq!((kept[0], kept[kept.len() - 1]), (0, length));
            let steps: Vec<u32> = kept.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let (last, whole) = steps.split_last().expect("many");
            assert!(whole.iter().all(|step| *step == whole[0]) && *last <= whole[0], "{length}");
        }
    }

    #[test]
    fn the_iterates_before_and_after_an_iteration_are_the_nearest_kept_ones() {
        let iterates = made(1, 10_001);
        for iteration in 0..=10_001 {
            let (at, after) = (iterates.at(iteration), iterates.after(iteration));
            assert!(at.iteration <= iteration);
            assert!(after.is_none_or(|after| after.iteration > iteration));
            let between = iterates.iter().filter(|it| {
                it.iteration > at.iteration && after.is_none_or(|to| it.iteration < to.iteration)
            });
            assert_eq!(between.count(), 0);
        }
        assert_eq!(iterates.after(10_001), None);
    }

    #[test]
    fn iterates_of_a_large_skeleton_stay_within_their_memory() {
        let joints = 20_000;
        let iterates = made(joints, 500);
        let bytes = iterates.kept.len() * joints * size_of::<LocalPose>();
        assert!(bytes <= Iterates::MOST_BYTES && iterates.kept.len() > 30, "{bytes} bytes");
    }
}

/// The part of the shown iteration of a solver run that the view shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::session) struct Inside {
    /// Index of the shown part; `None` if the iteration is shown as a whole.
    part: Option<usize>,
    /// The parts of the shown iteration.
    parts: Cached<Vec<Shared<SubStep>>>,
    /// Seconds for which the shown part was shown; `None` unless the parts follow each other by
    /// themselves.
    shown_for: Option<f64>,
}

impl Inside {
    pub fn part(&self) -> Option<usize> {
        self.part
    }

    pub fn is_walking(&self) -> bool {
        self.shown_for.is_some()
    }

    pub fn parts(&self, compute: impl FnOnce() -> Vec<SubStep>) -> &[Shared<SubStep>] {
        self.parts.get(|| compute().into_iter().map(Shared::from).collect())
    }

    /// Discards the parts, because another iteration is shown.
    pub fn clear(&mut self) {
        self.parts.clear();
    }

    pub fn show(&mut self, part: Option<usize>) {
        self.part = part;
        if part.is_none() {
            self.shown_for = None;
        }
        if let Some(seconds) = &mut self.shown_for {
            *seconds = 0.0;
        }
    }

    pub fn walk(&mut self, walks: bool) {
        self.shown_for = walks.then_some(0.0);
    }

    /// Lets time pass, in seconds. Returns whether the next of `parts` parts is due.
    pub fn advance(&mut self, passed: f64, parts: usize) -> bool {
        /// Seconds for which a part is shown, and those for which a whole iteration is at least.
        const PART: f64 = 0.9;
        const ITERATION: f64 = 4.0;
        const LEAST: f64 = 0.12;
        let Some(seconds) = &mut self.shown_for else { return false };
        *seconds += passed;
        let length = (ITERATION / parts.max(1) as f64).clamp(LEAST, PART);
        *seconds >= length
    }
}

/// Something that the view shows of a part of an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InsideLayer {
    /// The columns of the Jacobian, as arrows at the tips.
    Columns,
    /// The ellipsoid of J·Jᵀ.
    Ellipsoid,
    /// The moves of the tips, and the turns of the angles.
    Step,
    /// CCD: the rays from the joint to tip and target, and the arc between them.
    Rays,
    /// FABRIK and relaxation: the chain of points of a pass.
    Passes,
    /// Two-bone: the triangle and the circle of all elbows.
    Triangle,
    /// The turns that joints miss to their orientations, and the columns of the Jacobian for them.
    Turns,
}

impl InsideLayer {
    /// All layers.
    pub const ALL: [Self; 7] = [
        Self::Columns,
        Self::Ellipsoid,
        Self::Step,
        Self::Rays,
        Self::Passes,
        Self::Triangle,
        Self::Turns,
    ];
}

/// The layers that are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsideLayers([bool; InsideLayer::ALL.len()]);

impl Default for InsideLayers {
    /// All layers.
    fn default() -> Self {
        Self([true; InsideLayer::ALL.len()])
    }
}

impl InsideLayers {
    /// True if a layer is shown.
    pub fn shows(self, layer: InsideLayer) -> bool {
        self.0[layer as usize]
    }

    /// These layers with one of them shown or hidden.
    #[must_use]
    pub fn with(mut self, layer: InsideLayer, shown: bool) -> Self {
        self.0[layer as usize] = shown;
        self
    }
}
