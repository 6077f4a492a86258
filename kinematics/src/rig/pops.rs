//! Pops of a rig: steps of a motion in which joints move much farther than the inputs that pose
//! them.
//!
//! The pose before a step, taken along by the FK pose (each joint keeps its rotation relative to
//! FK), is the pose that no target has changed. With p̃ a joint's position in it and p the one
//! after
//! the step, the joint moves by |p − p̃|. A target moves by |(t − t₀) − (p̃ − p₀)|, the change of the
//! vector from its tip, or, if that is more, by what changes of twist and influence move of the
//! joints. A step pops if the ratio of the two is above 2; of a limb, above the bound of
//! [`pop`](crate::pop).

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

use super::evaluate::{EvaluatedSkeleton, TargetOutcome, TargetReport};
use super::limb_frames::LimbFrames;
use super::pop_cause::RigPopCause;
use super::skeleton_rig::SkeletonRig;
use super::target::{Target, TargetKind};
use crate::pop::{self, ElbowStep, PosedLimb};
use crate::skeleton::{JointId, RotationAxis, Skeleton};
use crate::twist::{TwistReference, TwistReferenceKind};

/// A rig at a time, with its pose.
#[derive(Clone, Copy, Debug)]
pub struct RigMoment<'a> {
    /// The rig with the values that it has at the time.
    pub rig: &'a SkeletonRig,
    /// Its pose.
    pub evaluated: &'a EvaluatedSkeleton,
}

/// A step of a motion in which a joint moves much farther than the inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigPop {
    /// The joint whose base or tip moves farthest.
    pub joint: JointId,
    /// Ratio of its way to that of the inputs.
    pub ratio: f32,
    /// The cause.
    pub cause: RigPopCause,
    /// The target whose joints pop.
    pub target: JointId,
}

/// Ratio above which a step of a whole body pops, and factor of the bound of a limb.
const POP: f64 = 2.0;
/// Way of the inputs, in chain lengths, below which a step is measured against this way: joints
/// move by rounding.
const LEAST_WAY: f64 = 1e-3;
/// Part of the farthest way beyond which a way is as far: ways are known to rounding.
const ALIKE: f64 = 0.999;
/// Part of a chain's length beyond which inputs jump.
const JUMP: f64 = 0.1;

impl<'a> RigMoment<'a> {
    /// The pops of a step from this moment to another one, at most one for the whole-body targets,
    /// one for chains that are solved together, and one for each limb. `is_missed` says for both
    /// moments whether the target with an index is missed.
    pub fn pops_to(
        &self,
        after: &RigMoment<'_>,
        is_missed: [&dyn Fn(usize) -> bool; 2],
    ) -> Vec<RigPop> {
        let joints = |moment: &RigMoment<'_>| moment.rig.skeleton.joints().len();
        if joints(self) != joints(after) || self.rig.targets.len() != after.rig.targets.len() {
            return Vec::new();
        }
        let poses = |index: &usize| {
            let both = [self, after].map(|moment| &moment.rig.targets[*index]);
            both.iter().any(|target| after.rig.is_solved_for(target))
        };
        let targets: Vec<usize> = (0..after.rig.targets.len()).filter(poses).collect();
        let (bodies, parts): (Vec<usize>, Vec<usize>) = targets
            .into_iter()
            .partition(|index| after.rig.targets[*index].kind == TargetKind::WholeBody);
        let (limbs, chains): (Vec<usize>, Vec<usize>) =
            parts.into_iter().partition(|index| after.rig.targets[*index].limb().is_some());
        let pulling = limbs.iter().filter(|it| after.rig.pulls_body(&after.rig.targets[**it]));
        let body: Vec<usize> = bodies.iter().chain(pulling).copied().collect();
        let of_limb =
            |index: &usize| Step::of_limb([self, after], *index, is_missed).pop(&[*index]);
        let of_chains =
            |chains: &Vec<usize>| Step::of_chains([self, after], chains, is_missed).pop(chains);
        let chains = after.rig.solved_together(chains);
        let of_body = Step::of_body([self, after], &body, is_missed).pop(&body);
        let parts = limbs.iter().filter_map(of_limb).chain(chains.iter().filter_map(of_chains));
        parts.chain(of_body).collect()
    }
}

/// A step between two moments.
struct Step<'a> {
    before: RigMoment<'a>,
    after: RigMoment<'a>,
    /// The joints that the targets turn.
    joints: Vec<JointId>,
    /// The limb of the target before and after the step; `None` for other targets.
    limb: Option<[LimbFrames; 2]>,
    /// Base and tip of each joint, if these joints had been taken along by FK.
    taken: Vec<[DVec3; 2]>,
    is_missed: [&'a dyn Fn(usize) -> bool; 2],
}

impl<'a> Step<'a> {
    /// The step of the two bones of a target's limb. Its hand hangs on them, or has the rotation that
    /// the target sets.
    fn of_limb(
        [before, after]: [&RigMoment<'a>; 2],
        target: usize,
        is_missed: [&'a dyn Fn(usize) -> bool; 2],
    ) -> Self {
        let limb = after.rig.targets[target].limb_in(&after.rig.skeleton);
        let joints: Vec<JointId> =
            limb.into_iter().flat_map(|limb| [limb.lower, limb.upper]).collect();
        let taken = taken_along(before, after, &joints);
        let frames = |moment: &RigMoment<'_>| moment.rig.limb_frames(moment.evaluated, target);
        let limb = frames(before).zip(frames(after)).map(<[LimbFrames; 2]>::from);
        Self { before: *before, after: *after, joints, limb, taken, is_missed }
    }

    /// The step of the joints that targets of chains turn together.
    fn of_chains(
        [before, after]: [&RigMoment<'a>; 2],
        targets: &[usize],
        is_missed: [&'a dyn Fn(usize) -> bool; 2],
    ) -> Self {
        let joints = after.rig.turned_together(targets);
        let taken = taken_along(before, after, &joints);
        Self { before: *before, after: *after, joints, limb: None, taken, is_missed }
    }

    /// The step of the joints that whole-body targets turn together, and of those that limb targets
    /// pull; the limbs of these are taken along, too.
    fn of_body(
        [before, after]: [&RigMoment<'a>; 2],
        targets: &[usize],
        is_missed: [&'a dyn Fn(usize) -> bool; 2],
    ) -> Self {
        let turned = |index: &usize| after.rig.moved_by(&after.rig.targets[*index]).turned;
        let mut all: Vec<JointId> = targets.iter().flat_map(turned).collect();
        let of_body = |index: &usize| -> Vec<JointId> {
            match after.rig.targets[*index].limb_in(&after.rig.skeleton) {
                Some(limb) => after.rig.body_of(limb).collect(),
                None => turned(index),
            }
        };
        let joints: Vec<JointId> = targets.iter().flat_map(of_body).collect();
        all.extend(&joints);
        let taken = taken_along(before, after, &all);
        Self { before: *before, after: *after, joints, limb: None, taken, is_missed }
    }
}

impl Step<'_> {
    /// The pop of the joints that targets turn together, if there is one.
    fn pop(&self, targets: &[usize]) -> Option<RigPop> {
        let length = targets.iter().map(|it| self.length(*it)).fold(0.0, f64::max);
        let ways = self.joints.iter().map(|joint| (*joint, self.moved(*joint)));
        let ways: Vec<(JointId, f64)> = ways.collect();
        let moved = ways.iter().map(|(_, way)| *way).max_by(f64::total_cmp)?;
        // Two joints share a point: of those that move alike, the one nearer to the root.
        let alike = ways.iter().filter(|(_, way)| *way >= ALIKE * moved);
        let joint = alike.map(|(joint, _)| *joint).min_by_key(|joint| joint.index())?;
        let ways = targets.iter().map(|it| (*it, self.way(*it)));
        let (farthest, way) = ways.max_by(|one, other| one.1.total_cmp(&other.1))?;
        let ratio = moved / way.max(LEAST_WAY * length);
        let calm = self
            .limb
            .as_ref()
            .map_or(1.0, |[before, after]| pop::calm(&before.posed, &after.posed));
        if ratio <= POP * calm || ratio.is_nan() {
            return None;
        }
        let cause = self.cause(targets, farthest, joint, length);
        let target = self.after.rig.targets[farthest].joint;
        Some(RigPop { joint, ratio: ratio as f32, cause, target })
    }

    /// Distance by which a joint's base or tip moves from where FK takes it.
    fn moved(&self, joint: JointId) -> f64 {
        let after = places(&self.after.evaluated.solved, joint);
        let taken = self.taken[joint.index()];
        after.iter().zip(taken).map(|(after, taken)| after.distance(taken)).fold(0.0, f64::max)
    }

    /// Way of a target and of its other inputs.
    fn way(&self, index: usize) -> f64 {
        let [before, after] = self.both(index);
        let tip = |moment: &RigMoment<'_>| places(&moment.evaluated.solved, after.0.joint)[1];
        let place = |report: &TargetReport| report.position.as_dvec3();
        let taken = self.taken[after.0.joint.index()][1] - tip(&self.before);
        let way = ((place(after.1) - place(before.1)) - taken).length();
        let way = if after.0.has_free_place() { 0.0 } else { way };
        // A short chain turns as a whole.
        let lever = self.length(index) * if after.0.kind.is_chain() { 1.0 } else { 0.5 };
        let of_turn = self.wanted_turn(index) * lever;
        let influence = f64::from((after.0.influence - before.0.influence).abs());
        let of_influence = influence * self.distance_from_fk(after.0);
        let twist = |target: &Target| target.limb().map_or(0.0, |limb| f64::from(limb.twist));
        let of_twist = (twist(after.0) - twist(before.0)).abs().min(2.0) * self.length(index) / 2.0;
        let pole = |limb: LimbFrames| match limb.posed.ik.reference {
            TwistReference::Pole(pole) => Some(pole.as_dvec3()),
            _ => None,
        };
        let of_pole = match self.limb.map(|limb| limb.map(pole)) {
            Some([Some(before), Some(after)]) => before.distance(after),
            _ => 0.0,
        };
        way.max(of_influence).max(of_twist).max(of_pole).max(of_turn)
    }

    /// Angle in radians by which the rotation that a target asks for, or the direction of its aim,
    /// turns, seen from the joint above a chain; 0 without either.
    fn wanted_turn(&self, index: usize) -> f64 {
        let [before, after] = self.both(index).map(|(target, _)| target);
        if !(before.turns_joint() && after.turns_joint()) {
            return 0.0;
        }
        let [from, to] = [self.before, self.after].map(|moment| &moment.evaluated.solved);
        let above = after.top_of_chain(&self.after.rig.skeleton).and_then(|top| from[top].parent);
        let rotation = |target: &Target, pose: &Skeleton| {
            let above = above.map_or(Quat::IDENTITY, |it| pose.rotation_in_world(it).as_quat());
            Some(above.inverse() * target.orientation_in_world(pose)?)
        };
        let rotations = rotation(before, from).zip(rotation(after, to));
        let of_rotation = rotations.map(|(from, to)| from.angle_between(to));
        let seen = |point: Vec3, pose: &Skeleton| match above {
            Some(above) => pose.full_transform(above).inverse().transform_point3(point),
            None => point,
        };
        // The eye is where it was, as the joint above takes it along.
        let eye = from.joint(after.joint).map(|_| seen(from.base(after.joint), from));
        let sight = |target: &Target, pose: &Skeleton| {
            Some(seen(target.aim_point_in_world(pose)?, pose) - eye?)
        };
        let sights = sight(before, from).zip(sight(after, to));
        let of_aim = sights.map(|(from, to)| from.angle_between(to));
        f64::from(of_rotation.or(of_aim).filter(|angle| angle.is_finite()).unwrap_or_default())
    }

    /// Largest distance of a joint that a target turns from its place in the FK pose, per
    /// influence.
    fn distance_from_fk(&self, target: &Target) -> f64 {
        let EvaluatedSkeleton { fk, solved, .. } = self.after.evaluated;
        let turned = self.after.rig.moved_by(target).turned;
        let apart = turned.iter().map(|joint| {
            let [fk, solved] = [fk, solved].map(|pose| places(pose, *joint)[1]);
            fk.distance(solved)
        });
        apart.fold(0.0, f64::max) / f64::from(target.influence.max(1e-3))
    }

    fn both(&self, index: usize) -> [(&Target, &TargetReport); 2] {
        [&self.before, &self.after]
            .map(|moment| (&moment.rig.targets[index], &moment.evaluated.targets[index]))
    }

    /// Length of a target's chain or limb in the world.
    fn length(&self, index: usize) -> f64 {
        match self.limb {
            Some([_, after]) => f64::from(after.bones().outer_limit()),
            None => f64::from(self.after.rig.length_of_chain(&self.after.rig.targets[index])),
        }
    }
}

/// Causes.
impl Step<'_> {
    fn cause(
        &self,
        targets: &[usize],
        farthest: usize,
        joint: JointId,
        length: f64,
    ) -> RigPopCause {
        let is_solved = |moment: &RigMoment<'_>, index: usize| {
            let target = &moment.rig.targets[index];
            moment.rig.is_solved_for(target)
                && !matches!(moment.evaluated.targets[index].outcome, TargetOutcome::Off)
        };
        let any = |test: &dyn Fn(usize) -> bool| targets.iter().any(|index| test(*index));
        if any(&|it| is_solved(&self.before, it) != is_solved(&self.after, it)) {
            return RigPopCause::Switched;
        }
        let missed = |moment: usize| any(&|index| (self.is_missed[moment])(index));
        let lost_or_found = match [missed(0), missed(1)] {
            [false, true] => Some(RigPopCause::Lost),
            [true, false] => Some(RigPopCause::Found),
            _ => None,
        };
        let is_limb = self.limb.is_some();
        // A limb exceeds even a jump of its target only for one of these causes.
        if is_limb && let Some(cause) = self.cause_of_limb(farthest) {
            return lost_or_found.unwrap_or(cause);
        }
        if any(&|it| self.target_way(it) > JUMP * length) {
            return RigPopCause::TargetJump;
        }
        if self.joints.iter().any(|joint| self.fk_way(*joint) > JUMP * length) {
            return RigPopCause::FkJump;
        }
        if let Some(cause) = lost_or_found {
            return cause;
        }
        if is_limb {
            return RigPopCause::Unknown;
        }
        if !self.after.rig.is_tracked {
            return RigPopCause::ByItself;
        }
        if let Some(cause) = self.cause_of_limits(&self.joints) {
            return cause;
        }
        let is_missed = missed(0) && missed(1);
        if any(&|it| self.is_stretched(it)) {
            RigPopCause::Straight
        } else if any(&|it| self.is_at_base(it)) {
            RigPopCause::Folded
        } else if is_missed {
            RigPopCause::Found
        } else if self.turns_over(targets) {
            RigPopCause::TurnsOver
        } else if self.returns(joint) {
            RigPopCause::Returns
        } else if self
            .joints
            .iter()
            .any(|it| ends(&self.after.evaluated.solved, *it).contains(&true))
        {
            RigPopCause::AtLimit
        } else {
            RigPopCause::Unknown
        }
    }

    /// Way of a target in the world.
    fn target_way(&self, index: usize) -> f64 {
        let [before, after] = self.both(index).map(|(_, report)| report.position.as_dvec3());
        before.distance(after)
    }

    /// Way of a joint in the FK pose.
    fn fk_way(&self, joint: JointId) -> f64 {
        let [before, after] =
            [&self.before, &self.after].map(|moment| places(&moment.evaluated.fk, joint)[1]);
        before.distance(after)
    }

    fn cause_of_limits(&self, joints: &[JointId]) -> Option<RigPopCause> {
        let mut met = false;
        let mut left = false;
        for joint in joints {
            let [before, after] =
                [&self.before, &self.after].map(|moment| ends(&moment.evaluated.solved, *joint));
            for (before, after) in before.into_iter().zip(after) {
                met |= after && !before;
                left |= before && !after;
            }
        }
        if met { Some(RigPopCause::LimitMet) } else { left.then_some(RigPopCause::LimitLeft) }
    }

    fn cause_of_limb(&self, index: usize) -> Option<RigPopCause> {
        /// Angle in radians from a singular direction below which the elbow swings fast.
        const NEAR: f64 = 0.35;
        /// Bend of the FK pose in radians below which it gives the elbow no side.
        const STRAIGHT: f32 = 0.1;
        let limb = self.limb.as_ref()?;
        let is_limited = limb.iter().any(LimbFrames::is_limited);
        // The pose without limits tells whether limits make the step.
        let posed = |limb: LimbFrames| {
            let pose = if is_limited { limb.solution.pose } else { limb.posed.pose };
            PosedLimb { pose, ..limb.posed }
        };
        let [before, after] = limb.map(posed);
        let step = ElbowStep::between(&before, &after);
        if is_limited && step.is_none_or(|step| step.pop.is_none()) {
            return Some(self.limits_of_limb(index).unwrap_or(RigPopCause::AtLimit));
        }
        let [turned, bent, swung] = pop::parts(&before, &after).map(DVec3::length);
        if swung < turned.max(bent) {
            let is_bent = bent > turned && pop::is_far_out(&before, &after);
            return Some(if is_bent { RigPopCause::Straight } else { RigPopCause::Folded });
        }
        let is_near = || pop::nearest_to_singular(&before, &after) < NEAR;
        match after.kind {
            TwistReferenceKind::Fk if after.fk.bend.abs() < STRAIGHT => {
                Some(RigPopCause::StraightFk)
            }
            TwistReferenceKind::Up
            | TwistReferenceKind::Pole
            | TwistReferenceKind::Stereographic
            | TwistReferenceKind::Fk
                if is_near() =>
            {
                Some(RigPopCause::Singular)
            }
            _ => self.limits_of_limb(index),
        }
    }

    /// The limits of a limb's two bones that are met or left.
    fn limits_of_limb(&self, index: usize) -> Option<RigPopCause> {
        let rig = self.after.rig;
        let limb = rig.targets[index].limb_in(&rig.skeleton)?;
        self.cause_of_limits(&limb.joints().collect::<Vec<_>>())
    }

    /// True if a chain is nearly straight, before or after the step.
    fn is_stretched(&self, index: usize) -> bool {
        const STRAIGHT: f64 = 0.97;
        let joint = self.after.rig.targets[index].joint;
        [&self.before, &self.after].into_iter().any(|moment| {
            let pose = &moment.evaluated.solved;
            let bones = pose.ancestors(joint).map(|joint| {
                let [base, tip] = places(pose, joint);
                let parent = pose[joint].parent.map(|parent| places(pose, parent)[0]);
                let offset = parent.map_or(0.0, |parent| parent.distance(base));
                (offset, base.distance(tip))
            });
            let bones: Vec<(f64, f64)> = bones.collect();
            let length = bones[0].1 + bones.iter().map(|(offset, _)| offset).sum::<f64>();
            root_to_tip(pose, joint) > STRAIGHT * length
        })
    }

    /// True if the tip of a chain is near its base.
    fn is_at_base(&self, index: usize) -> bool {
        const NEAR: f64 = 0.1;
        let joint = self.after.rig.targets[index].joint;
        root_to_tip(&self.after.evaluated.solved, joint) < NEAR * self.length(index)
    }

    /// True if the method needed many iterations, in which it turns bones that are in the way of
    /// others.
    fn turns_over(&self, targets: &[usize]) -> bool {
        const MANY: u32 = 6;
        targets.iter().any(|index| match &self.after.evaluated.targets[*index].outcome {
            TargetOutcome::WholeBody(report) => report.iterations >= MANY,
            _ => false,
        })
    }

    /// True if a third of the joints' rotation, or half of the way of the joint that moves
    /// farthest, leads towards the FK pose.
    fn returns(&self, joint: JointId) -> bool {
        let rotation = |moment: &RigMoment<'_>, joint: JointId| {
            let EvaluatedSkeleton { fk, solved, .. } = moment.evaluated;
            let [fk, solved] = [fk, solved]
                .map(|pose| DQuat::from_mat3(&pose[joint].rotation_f64(pose[joint].rotation)));
            fk.conjugate() * solved
        };
        let (mut before, mut after, mut turned) = (0.0, 0.0, 0.0);
        for joint in &self.joints {
            let [one, other] = [&self.before, &self.after].map(|it| rotation(it, *joint));
            let square = |turn: DQuat| turn.xyz().length().atan2(turn.w.abs()).powi(2);
            before += square(one);
            after += square(other);
            turned += square(one.conjugate() * other);
        }
        if before.sqrt() - after.sqrt() > turned.sqrt() / 3.0 {
            return true;
        }
        let EvaluatedSkeleton { fk, solved, .. } = self.after.evaluated;
        let ends = places(solved, joint).into_iter().zip(self.taken[joint.index()]);
        let way = |(after, taken): &(DVec3, DVec3)| after.distance_squared(*taken);
        let ends = ends.zip(places(fk, joint));
        let farthest = ends.max_by(|one, other| way(&one.0).total_cmp(&way(&other.0)));
        farthest.is_some_and(|((after, taken), fk)| {
            taken.distance(fk) - after.distance(fk) >= 0.5 * after.distance(taken)
        })
    }
}

/// For each angle of a joint, true if it is at an end of its range.
fn ends(pose: &Skeleton, joint: JointId) -> [bool; 3] {
    let joint = &pose[joint];
    RotationAxis::ALL
        .map(|axis| joint.limits.span(axis) > 1e-6 && joint.limits.is_at_end(joint.rotation, axis))
}

/// Distance in the world from the base of a joint's root to the joint's tip.
fn root_to_tip(pose: &Skeleton, joint: JointId) -> f64 {
    let root = pose.ancestors(joint).last().unwrap_or(joint);
    places(pose, joint)[1].distance(places(pose, root)[0])
}

/// Base and tip of a joint's bone in the world.
fn places(pose: &Skeleton, joint: JointId) -> [DVec3; 2] {
    [pose.base(joint), pose.tip(joint)].map(Vec3::as_dvec3)
}

/// Base and tip of each joint in the solved pose of a moment, if those of `turned` had been taken
/// along by the FK pose from another moment: each keeps its rotation and its offset relative to FK.
fn taken_along(
    before: &RigMoment<'_>,
    after: &RigMoment<'_>,
    turned: &[JointId],
) -> Vec<[DVec3; 2]> {
    let joints = before.evaluated.solved.joints().iter();
    let fk = before.evaluated.fk.joints().iter().zip(after.evaluated.fk.joints());
    let solved_after = after.evaluated.solved.iter();
    let transform = after.evaluated.fk.transform().as_daffine3();
    let mut spaces: Vec<(DMat3, DVec3)> = Vec::with_capacity(joints.len());
    let mut taken = Vec::with_capacity(joints.len());
    for ((solved, (fk, fk_after)), (joint, solved_after)) in joints.zip(fk).zip(solved_after) {
        let (local, offset, axis) = if turned.contains(&joint) {
            let [turned, from, to] = [solved, fk, fk_after].map(|it| it.rotation_f64(it.rotation));
            let offset = fk_after.offset.as_dvec3() + (solved.offset - fk.offset).as_dvec3();
            (turned * from.transpose() * to, offset, fk_after.axis)
        } else {
            let local = solved_after.rotation_f64(solved_after.rotation);
            (local, solved_after.offset.as_dvec3(), solved_after.axis)
        };
        let (above, origin) =
            solved.parent.map_or((DMat3::IDENTITY, DVec3::ZERO), |parent| spaces[parent.index()]);
        let base = origin + above * offset;
        let rotation = above * local;
        spaces.push((rotation, base));
        let tip = base + rotation * axis.as_dvec3();
        taken.push([base, tip].map(|point| transform.transform_point3(point)));
    }
    taken
}
