use std::collections::BTreeMap;

use glam::{DQuat, Vec3};

use super::balance_target::Footing;
use crate::Shared;
use crate::chain_ik::{
    ChainSolver, ChainTarget, HeldLimb, Report, SolveError, SolverOptions, TrackStep,
};
use crate::limb_ik::{CarriedLimb, LimbPosture};
use crate::skeleton::{JointId, JointRemap, Skeleton};

/// The state that a step of a motion leaves to the next one, so that small motions of targets and
/// FK poses give small motions of joints: the configurations of the solvers of the whole-body targets
/// and of chains, and how limbs bend. It is about the poses before influences and, for whole-body
/// targets, before chains and limbs.
///
/// The default continues from nothing: the step solves from its FK pose, with restarts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Carried {
    start: Start,
    /// Of the whole-body targets.
    body: Bodies,
    /// Of chains, by the first of the joints of the targets that are solved together.
    chains: BTreeMap<JointId, Bodies>,
    /// By the joint of a limb's target.
    limbs: BTreeMap<JointId, CarriedLimb>,
    /// Of a figure that is balanced, what the last step has left.
    footing: Option<Footing>,
}

/// How the first step begins; after it, the default.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Start {
    /// The posture with which the step begins.
    posture: Option<Shared<Posture>>,
    /// True if the step keeps the posture, false if it solves from there.
    rests_at_posture: bool,
    /// True if the step brings the pose as near to FK as targets allow.
    relaxes: bool,
}

impl Start {
    /// The FK pose, or the posture with which the step begins.
    pub fn first_pose(&self, fk: &Skeleton) -> Skeleton {
        self.posture.as_ref().map_or_else(|| fk.clone(), |posture| posture.posed(fk))
    }
}

/// The configuration with which a motion begins, as a document keeps it: the state before its first
/// step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Posture {
    /// Joints that targets of the whole body and of chains turn.
    pub joints: BTreeMap<JointId, PosturedJoint>,
    /// States of limbs, by the joints of their targets.
    pub limbs: BTreeMap<JointId, LimbPosture>,
}

/// Angles and place of a joint in a [`Posture`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PosturedJoint {
    /// Euler angles in radians, as in [`Joint::rotation`](crate::skeleton::Joint::rotation); `None`
    /// for a joint that solvers move but do not turn.
    pub rotation: Option<Vec3>,
    /// Offset from the parent's base, for a root that solvers may move; `None` for other joints.
    pub offset: Option<Vec3>,
}

impl Posture {
    /// True if it poses nothing.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty() && self.limbs.is_empty()
    }

    /// True if a skeleton with this number of joints has all joints of the posture, and all numbers
    /// are finite.
    pub fn fits(&self, joints: usize) -> bool {
        let has = |joint: &JointId| joint.index() < joints;
        let vectors = self.joints.values().flat_map(|of| [of.rotation, of.offset]).flatten();
        self.joints.keys().chain(self.limbs.keys()).all(has)
            && vectors.into_iter().all(Vec3::is_finite)
            && self.limbs.values().all(LimbPosture::is_finite)
    }

    /// The same posture after joints were renumbered, without those that were removed.
    #[must_use]
    pub fn remapped(&self, remap: &JointRemap) -> Self {
        fn by<T: Copy>(map: &BTreeMap<JointId, T>, remap: &JointRemap) -> BTreeMap<JointId, T> {
            map.iter().filter_map(|(joint, of)| Some((remap.get(*joint)?, *of))).collect()
        }
        Self { joints: by(&self.joints, remap), limbs: by(&self.limbs, remap) }
    }

    /// A pose with the joints of the posture.
    fn posed(&self, pose: &Skeleton) -> Skeleton {
        let mut posed = pose.clone();
        for (joint, of) in &self.joints {
            posed.write_local(*joint, |joint| {
                joint.rotation = of.rotation.unwrap_or(joint.rotation);
                joint.offset = of.offset.unwrap_or(joint.offset);
            });
        }
        posed
    }
}

/// A whole-body target of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyTarget {
    pub tip: ChainTarget,
    pub influence: f32,
}

/// The configurations of targets that are solved together, by a solver of chains: one for each of
/// their influences, the greatest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Bodies(Vec<Body>);

/// Targets of the same or greater influence, solved together.
#[derive(Clone, Debug, PartialEq)]
struct Body {
    solver: ChainSolver,
    step: Option<TrackStep>,
    /// By joint, the rotations by which the pose is blended in.
    turns: Vec<Option<DQuat>>,
}

impl Carried {
    /// The state before the first step of a motion that begins with a posture.
    pub fn from_posture(posture: &Shared<Posture>) -> Self {
        let mut near = Self::near_posture(posture);
        near.start.rests_at_posture = true;
        near
    }

    /// The state before the first step of a motion that begins near a posture, with the pose that
    /// is solved from there.
    pub fn near_posture(posture: &Shared<Posture>) -> Self {
        let limbs = &posture.limbs;
        let limbs = limbs.iter().map(|(joint, it)| (*joint, CarriedLimb::from_posture(it)));
        let start = Start { posture: Some(posture.clone()), ..Start::default() };
        Self { start, limbs: limbs.collect(), ..Self::default() }
    }

    /// The state before the first step of a motion without a posture: the first pose is solved from
    /// the FK pose and then brought as near to it as the targets allow, so that a motion that
    /// closes a loop comes back to its first pose.
    pub fn relaxed() -> Self {
        Self { start: Start { relaxes: true, ..Start::default() }, ..Self::default() }
    }

    /// The posture with which a motion continues from here.
    pub fn to_posture(&self) -> Posture {
        let joints = self.full_bodies().flat_map(Body::joints).collect();
        let limbs = self.limbs.iter();
        let limbs = limbs.filter_map(|(joint, limb)| Some((*joint, limb.to_posture()?)));
        Posture { joints, limbs: limbs.collect() }
    }

    /// True if a target was too far away to be reached in the last step, so that a further step
    /// comes nearer to it, even if nothing else moves.
    pub fn is_held_back(&self) -> bool {
        self.steps().any(|step| step.is_held_back)
    }

    /// About the work of the last step, in the unit of [`ChainSolver::bounded`].
    pub fn work(&self) -> u64 {
        self.bodies().map(|body| body.solver.work()).sum()
    }

    /// True if targets of the whole body or of chains posed joints in the last step.
    pub fn has_body(&self) -> bool {
        self.bodies().next().is_some()
    }

    /// An FK pose with the joints that targets of the whole body and of chains turn as the last step
    /// has posed them, before influences; `None` if they posed none.
    pub fn body_pose(&self, fk: &Skeleton) -> Option<Skeleton> {
        let write = |mut pose: Skeleton, body: &Body| {
            body.solver.write(&mut pose);
            pose
        };
        self.has_body().then(|| self.full_bodies().fold(fk.clone(), write))
    }

    /// All configurations of solvers.
    fn bodies(&self) -> impl Iterator<Item = &Body> {
        [&self.body].into_iter().chain(self.chains.values()).flat_map(|bodies| &bodies.0)
    }

    /// The configurations for all targets that are solved together, of whatever influence.
    fn full_bodies(&self) -> impl Iterator<Item = &Body> {
        [&self.body].into_iter().chain(self.chains.values()).filter_map(|bodies| bodies.0.last())
    }

    fn steps(&self) -> impl Iterator<Item = &TrackStep> {
        self.bodies().filter_map(|body| body.step.as_ref())
    }

    /// How the step begins. The state has no start from then on.
    pub(super) fn take_start(&mut self) -> Start {
        std::mem::take(&mut self.start)
    }

    /// The configurations of whole-body targets.
    pub(super) fn body(&mut self) -> &mut Bodies {
        &mut self.body
    }

    /// The configurations of a chain.
    pub(super) fn chain(&mut self, first: JointId) -> &mut Bodies {
        self.chains.entry(first).or_default()
    }

    /// Forgets chains and limbs whose targets do not pose the skeleton any more.
    pub(super) fn retain_parts(&mut self, is_posing: impl Fn(JointId) -> bool) {
        self.chains.retain(|joint, _| is_posing(*joint));
        self.limbs.retain(|joint, _| is_posing(*joint));
    }

    /// What the last step has left for the balance; `None` before the first one.
    pub(super) fn take_footing(&mut self) -> Option<Footing> {
        self.footing.take()
    }

    pub(super) fn set_footing(&mut self, footing: Footing) {
        self.footing = Some(footing);
    }

    /// The states of limbs, to be restored before a step is repeated.
    pub(super) fn limbs(&self) -> &BTreeMap<JointId, CarriedLimb> {
        &self.limbs
    }

    pub(super) fn restore_limbs(&mut self, limbs: &BTreeMap<JointId, CarriedLimb>) {
        self.limbs.clone_from(limbs);
    }

    pub(super) fn limb(&mut self, joint: JointId) -> &mut CarriedLimb {
        self.limbs.entry(joint).or_default()
    }
}

impl Bodies {
    pub fn forget(&mut self) {
        self.0.clear();
    }

    /// Poses `pose`, the FK pose, by targets, of which there is at least one, while the tips of
    /// `limbs` stay in place; without `poses`, it may leave the pose. Returns the report of the solve
    /// for all of them.
    ///
    /// # Errors
    ///
    /// The error of a solver; the pose is unchanged.
    pub fn step(
        &mut self,
        start: &Start,
        options: &SolverOptions,
        pose: &mut Shared<Skeleton>,
        targets: &[BodyTarget],
        limbs: &[HeldLimb],
        poses: bool,
    ) -> Result<Report, SolveError> {
        let mut influences: Vec<f32> = targets.iter().map(|target| target.influence).collect();
        influences.sort_unstable_by(|one, other| other.total_cmp(one));
        influences.dedup();
        let mut before = Before {
            bodies: std::mem::take(&mut self.0).into_iter().map(Some).collect(),
            start,
            work: ChainSolver::POSE_WORK / influences.len() as u64,
        };
        let last = influences.len() - 1;
        let body = |(index, least): (usize, &f32)| {
            let tips = targets.iter().filter(|target| target.influence >= *least);
            let tips: Vec<ChainTarget> = tips.map(|target| target.tip).collect();
            before.step(options, pose, &tips, limbs, index == last)
        };
        self.0 = influences.iter().enumerate().map(body).collect::<Result<_, _>>()?;
        let report = self.0[last].solver.report();
        if influences == [1.0] {
            // Nothing is blended, so that no rotation is carried on.
            self.0[0].turns.fill(None);
            if poses {
                *pose = self.0[0].posed(pose).into();
            }
        } else {
            let poses: Vec<Skeleton> = self.0.iter().map(|body| body.posed(pose)).collect();
            blend(pose, poses, &influences, &mut self.0);
        }
        Ok(report)
    }
}

/// The bodies of the step before.
struct Before<'a> {
    bodies: Vec<Option<Body>>,
    start: &'a Start,
    /// Most work of a body.
    work: u64,
}

impl Before<'_> {
    /// The next step of the body with these targets: the one before, if there was one.
    fn step(
        &mut self,
        options: &SolverOptions,
        fk: &Skeleton,
        tips: &[ChainTarget],
        limbs: &[HeldLimb],
        has_all_targets: bool,
    ) -> Result<Body, SolveError> {
        let is_same = |body: &Option<Body>| {
            let solver = body.as_ref().map(|body| &body.solver);
            solver.is_some_and(|it| {
                it.options() == options
                    && it.targets().eq(tips.iter().map(|tip| (tip.joint, tip.is_of_mass())))
            })
        };
        let same = self.bodies.iter_mut().find(|it| is_same(it));
        if let Some(mut body) = same.and_then(Option::take) {
            if let Ok(step) = body.solver.track_with_limbs(tips, limbs, fk) {
                body.step = Some(step);
                return Ok(body);
            }
            self.bodies.push(Some(body));
        }
        self.begin(options, fk, tips, limbs, has_all_targets)
    }

    /// A body that begins with this step, with the angles that its joints had in another body.
    fn begin(
        &self,
        options: &SolverOptions,
        fk: &Skeleton,
        tips: &[ChainTarget],
        limbs: &[HeldLimb],
        has_all_targets: bool,
    ) -> Result<Body, SolveError> {
        let mut solver = ChainSolver::bounded_with_limbs(fk, tips, limbs, options, self.work)?;
        // True if targets of less influence do not pull the joints any more.
        let mut is_released = false;
        let Start { posture, rests_at_posture, relaxes } = self.start;
        let posture = posture.as_ref().filter(|posture| !posture.joints.is_empty());
        let rests = posture.is_some() && *rests_at_posture && has_all_targets;
        match posture {
            Some(posture) if rests => solver.rest_at(&posture.posed(fk)),
            Some(posture) => solver.begin_from(&posture.posed(fk)),
            None => {
                let common = |body: &&Body| {
                    let joints = body.solver.target_joints();
                    joints.filter(|joint| tips.iter().any(|tip| tip.joint == *joint)).count()
                };
                if let Some(nearest) = self.bodies.iter().flatten().max_by_key(common) {
                    solver.begin_from(&nearest.posed(fk));
                    is_released = !has_all_targets;
                }
            }
        }
        if !rests {
            solver.run();
            if *relaxes || is_released {
                solver.relax();
            }
        }
        Ok(Body { solver, step: None, turns: vec![None; fk.joints().len()] })
    }
}

impl Body {
    /// The FK pose with the joints that the solver turns as it has solved them.
    fn posed(&self, fk: &Skeleton) -> Skeleton {
        let mut pose = fk.clone();
        self.solver.write(&mut pose);
        pose
    }

    /// The joints that the solver turns, with their angles and places.
    fn joints(&self) -> BTreeMap<JointId, PosturedJoint> {
        let mut joints: BTreeMap<JointId, PosturedJoint> = BTreeMap::new();
        for (joint, rotation) in self.solver.angles() {
            joints.entry(joint).or_default().rotation = Some(rotation);
        }
        for (joint, offset) in self.solver.offsets() {
            joints.entry(joint).or_default().offset = Some(offset);
        }
        joints
    }
}

/// Blends the FK pose `pose` with the poses of bodies, the greatest influence first.
fn blend(
    pose: &mut Shared<Skeleton>,
    mut poses: Vec<Skeleton>,
    influences: &[f32],
    bodies: &mut [Body],
) {
    let Some(mut full) = poses.pop() else { return };
    for index in (0..influences.len()).rev() {
        let turns = &mut bodies[index].turns;
        if let Some(mut below) = poses.pop() {
            let fraction = influences[index] / influences[index - 1];
            turn_towards(&mut below, &full, fraction, turns);
            full = below;
        } else {
            turn_towards(pose.make_mut(), &full, influences[index], turns);
        }
    }
}

/// Turns the joints of a pose towards those of `full`.
fn turn_towards(pose: &mut Skeleton, full: &Skeleton, fraction: f32, turns: &mut [Option<DQuat>]) {
    for ((joint, after), turn) in full.iter().zip(turns) {
        let before = &pose[joint];
        if before.rotation == after.rotation && before.offset == after.offset {
            *turn = None;
            continue;
        }
        let rotation = before.angles_towards(after.rotation, fraction, turn);
        let offset = before.offset.lerp(after.offset, fraction);
        pose.write_local(joint, |joint| (joint.rotation, joint.offset) = (rotation, offset));
    }
}
