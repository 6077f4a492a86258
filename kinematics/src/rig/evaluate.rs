use glam::{DQuat, DVec3, Vec3};
use thiserror::Error;

use super::balance_target::{BalanceReport, BalanceWay, Footing};
use super::body_follows::BlockedLimb;
use super::carried::{Bodies, BodyTarget, Carried, Start};
use super::chain::with_others_locked;
use super::skeleton_rig::SkeletonRig;
use super::target::{LimbSettings, MovedJoints, Target, TargetKind, TargetSpace};
use crate::Shared;
use crate::chain_ik::{ChainTarget, Method, Orientation, Report, Root, SolveError};
use crate::limb_ik::{self, Limb, LimbReach, LimbReport, LimbTarget, NoLimb};
use crate::skeleton::{JointId, Skeleton};
use crate::soft_reach::SoftReach;

/// A skeleton posed at a time: by its angles (FK) and by its targets.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluatedSkeleton {
    /// The skeleton with its own angles, or on its path.
    pub fk: Shared<Skeleton>,
    /// The skeleton posed by its targets.
    pub solved: Shared<Skeleton>,
    /// Results for the rig's targets, in their order.
    pub targets: Vec<TargetReport>,
    /// The reason why limb targets pull no body although it should [follow](SkeletonRig::body_follows):
    /// the solver refuses it.
    pub body_refused: Option<SolveError>,
    /// Result for the rig's [balance](SkeletonRig::balance); `None` without one.
    pub balance: Option<BalanceReport>,
}

/// The poses of a step, and what came of its targets.
struct StepPose {
    fk: Shared<Skeleton>,
    solved: Shared<Skeleton>,
    outcomes: Vec<TargetOutcome>,
    body_refused: Option<SolveError>,
}

impl EvaluatedSkeleton {
    /// About the work of the pose, in the unit of
    /// [`ChainSolver::bounded`](crate::chain_ik::ChainSolver::bounded): the number of joints,
    /// once and for each iteration of the whole-body targets' solver.
    pub fn work(&self) -> u64 {
        let iterations = self.targets.iter().find_map(|target| match &target.outcome {
            TargetOutcome::WholeBody(report) => Some(report.iterations),
            _ => None,
        });
        self.fk.joints().len() as u64 * (1 + u64::from(iterations.unwrap_or(0)))
    }
}

/// What the body is solved with, beside the targets.
#[derive(Clone, Copy)]
struct BodyInputs<'a> {
    start: &'a Start,
    /// Of a figure that is balanced.
    footing: Option<&'a Footing>,
    blocked: &'a [BlockedLimb],
}

/// The turns by which body and limbs are solved in a step.
#[derive(Default)]
struct Turns {
    made: usize,
    /// The limbs that limits keep from their targets after the last one.
    blocked: Vec<BlockedLimb>,
}

impl Turns {
    const MOST: usize = 8;
    /// Part of what is missing that a turn must leave at most to be worth another one.
    const WORTH: f32 = 0.8;

    /// Counts a turn. Returns true if limbs are blocked after it, and another one may help.
    fn go_on(&mut self, blocked: Vec<BlockedLimb>) -> bool {
        let most = |limbs: &[BlockedLimb]| limbs.iter().map(|it| it.miss).fold(0.0, f32::max);
        let gains = self.blocked.is_empty() || most(&blocked) <= Self::WORTH * most(&self.blocked);
        self.made += 1;
        self.blocked = blocked;
        !self.blocked.is_empty() && gains && self.made < Self::MOST
    }
}

/// The results that are needed of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StepUse {
    /// The pose; nothing is carried of limbs.
    Pose,
    /// The pose, and the state that the step carries.
    PoseAndState,
    /// The state alone.
    State,
}

/// Result of an evaluation for one target.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetReport {
    /// Position of the target, in the world.
    pub position: Vec3,
    /// Position of the limb's pole, in the world; `None` for another elbow reference.
    pub pole: Option<Vec3>,
    /// Distance from the tip to the target in the evaluated pose, in the world; from the base of a
    /// head that the target leads; 0 for a target whose place is free.
    pub error: f32,
    /// Angle in radians from the rotation of the target's [oriented
    /// joint](Target::oriented_joint) to that which the target asks for, or from the axis of its aim
    /// to the point, in the evaluated pose; `None` without both.
    pub rotation_error: Option<f32>,
    /// The solver's report.
    pub outcome: TargetOutcome,
}

/// The result of solving for a target.
#[derive(Clone, Debug, PartialEq)]
pub enum TargetOutcome {
    /// The target is disabled or has no influence.
    Off,
    /// The target moves the head of a chain, which follows its path.
    Leads,
    /// The report of the solver of all whole-body targets, or of the targets of the chain.
    WholeBody(Report),
    /// The report of the limb.
    Limb(Box<LimbReport>),
    /// The solver refuses the whole-body targets, or its method this one, which asks for a rotation or
    /// an aim.
    Refused(SolveError),
    /// The target's joint does not end a limb.
    NoLimb(NoLimb),
}

impl TargetReport {
    /// True if the joint is farther from the rotation or aim that its target asks for than
    /// [`SkeletonRig::ROTATION_TOLERANCE`].
    pub fn misses_rotation(&self) -> bool {
        self.rotation_error.is_some_and(|angle| angle > SkeletonRig::ROTATION_TOLERANCE)
    }
}

impl SkeletonRig {
    /// Angle in radians within which a joint has the rotation that its target asks for.
    pub const ROTATION_TOLERANCE: f32 = 1e-3;

    /// The skeleton at a time in seconds, as a function of the rig and the time alone: a
    /// [step](SkeletonRig::step) that continues from nothing.
    pub fn evaluate(&self, time: f64) -> EvaluatedSkeleton {
        self.evaluated(time, &mut Carried::default(), StepUse::Pose)
    }

    /// The skeleton at a time in seconds, as a step of a motion: continues from what the step
    /// before has carried. Returns what this step carries to the next. The rig may have changed
    /// since the step before, its targets and joints included.
    ///
    /// The whole-body targets are solved together, from the FK pose, and with
    /// [`SkeletonRig::body_follows`] the bases that limb targets pull; the targets of chains and
    /// limbs then one after the other, in the order of their joints, but each after those that move
    /// the joints that it is on. Chains that have a joint in common are solved together. The work
    /// of the solver is bounded: see [`Status::Bounded`](crate::chain_ik::Status::Bounded) and
    /// [`SolveError::TooMuchWork`].
    ///
    /// With a [balance](SkeletonRig::balance), both are repeated until the centre of mass is where it
    /// should be, and with limbs that their limits keep from targets until these pull the body near
    /// enough; at most eight times.
    ///
    /// Whole-body targets with different influences are solved once for each influence: together
    /// with all targets of at least that influence. Each such pose is blended with the one of the
    /// next lower influence by the ratio of the two, and the first one with the FK pose.
    pub fn step(&self, time: f64, before: &Carried) -> (EvaluatedSkeleton, Carried) {
        let mut carried = before.clone();
        let evaluated = self.evaluated(time, &mut carried, StepUse::PoseAndState);
        (evaluated, carried)
    }

    fn evaluated(&self, time: f64, carried: &mut Carried, of: StepUse) -> EvaluatedSkeleton {
        let StepPose { fk, solved, outcomes, body_refused } = self.posed(time, carried, of);
        let report = |(target, outcome): (&Target, TargetOutcome)| {
            let position = target.in_world(&solved, time);
            let end = |joint| match outcome {
                TargetOutcome::Leads => solved.base(joint),
                _ => solved.tip(joint),
            };
            let is_placed = solved.joint(target.joint).is_some() && !target.has_free_place();
            let error = match is_placed {
                true => end(target.joint).distance(position).min(f32::MAX),
                false => 0.0,
            };
            let pole = target.limb().and_then(|settings| settings.pole_in_world(&solved));
            let rotation_error = self.rotation_error(target, &solved);
            TargetReport { position, pole, error, rotation_error, outcome }
        };
        let targets = self.targets.iter().zip(outcomes).map(report).collect();
        let balance = self.balance_report(&solved);
        EvaluatedSkeleton { fk, solved, targets, body_refused, balance }
    }

    /// [`SkeletonRig::step`] without its pose and reports: changes `carried` to what the step
    /// carries.
    pub fn carry(&self, time: f64, carried: &mut Carried) {
        self.posed(time, carried, StepUse::State);
    }

    /// The last of as many steps at a time in seconds, all with these inputs, as bring targets near
    /// again that the state `before` has left far behind. An edit of a rig is such a change.
    pub fn settle(&self, time: f64, before: &Carried) -> (EvaluatedSkeleton, Carried) {
        const MOST_STEPS: usize = 200;
        let (mut solved, mut carried) = self.step(time, before);
        for _ in 1..MOST_STEPS {
            if !carried.is_held_back() {
                break;
            }
            (solved, carried) = self.step(time, &carried);
        }
        (solved, carried)
    }

    /// True if all targets that pose the skeleton are reached.
    pub fn has_reached_all(&self, evaluated: &EvaluatedSkeleton) -> bool {
        let targets = self.targets.iter().zip(&evaluated.targets);
        targets.filter(|(target, _)| target.is_posing()).all(|(_, report)| self.is_reached(report))
    }

    /// Angle in radians from the rotation of a target's [oriented joint](Target::oriented_joint) to
    /// that which the target asks for, or from the axis of its aim to the point, in a pose; `None`
    /// without both.
    pub fn rotation_error(&self, target: &Target, pose: &Skeleton) -> Option<f32> {
        if let Some(angle) = aim_error(target, pose) {
            return Some(angle);
        }
        let wanted = target.orientation_in_world(pose)?.as_dquat();
        let joint = target.oriented_joint(pose).filter(|joint| pose.joint(*joint).is_some())?;
        let DQuat { x, y, z, w } = pose.rotation_in_world(joint).inverse() * wanted;
        // Exact for small angles, too, where the arc cosine of w loses half of the digits.
        Some((2.0 * DVec3::new(x, y, z).length().atan2(w.abs())) as f32)
    }

    /// True if the tip of a target's joint, and the rotation of its hand or of itself, are as the target asks,
    /// within [`SkeletonRig::tolerance`] and [`SkeletonRig::ROTATION_TOLERANCE`].
    pub fn is_reached(&self, report: &TargetReport) -> bool {
        report.error <= self.tolerance() && !report.misses_rotation()
    }

    /// True if the centre of mass is where the [balance](SkeletonRig::balance) asks for it, within ten
    /// times [`SkeletonRig::tolerance`], or if nothing asks.
    pub fn is_balanced(&self, evaluated: &EvaluatedSkeleton) -> bool {
        let report = evaluated.balance.as_ref();
        report.is_none_or(|report| report.error() <= 10.0 * self.tolerance())
    }

    /// The skeleton at a time in seconds, posed by its targets: [`SkeletonRig::evaluate`] without
    /// the reports.
    pub fn skeleton_at(&self, time: f64) -> Shared<Skeleton> {
        self.posed(time, &mut Carried::default(), StepUse::Pose).solved
    }

    fn posed(&self, time: f64, carried: &mut Carried, of: StepUse) -> StepPose {
        let fk = self.fk_at(time);
        let start = carried.take_start();
        if self.active_balance().is_some() {
            return self.balanced(fk, time, carried, &start, of);
        }
        let has_parts = self.targets.iter().any(|target| self.is_part(target));
        let poses = of != StepUse::State || has_parts;
        let limbs_before = self.body_follows.then(|| carried.limbs().clone());
        let mut turns = Turns::default();
        loop {
            let mut step = self.begin_step(fk.clone());
            let inputs = BodyInputs { start: &start, footing: None, blocked: &turns.blocked };
            self.solve_body(&mut step, inputs, time, carried, poses);
            let carried_on = (of != StepUse::Pose).then_some(&mut *carried);
            self.solve_parts(&mut step, time, carried_on, &start);
            let goes_on = turns.go_on(self.blocked_limbs_of(&step, time));
            match &limbs_before {
                Some(limbs) if goes_on => carried.restore_limbs(limbs),
                _ => return step,
            }
        }
    }

    /// A step that begins with the FK pose.
    fn begin_step(&self, fk: Shared<Skeleton>) -> StepPose {
        let leads = |target: &Target| target.enabled && self.leads_path(target);
        let outcome =
            |target| if leads(target) { TargetOutcome::Leads } else { TargetOutcome::Off };
        let outcomes = self.targets.iter().map(outcome).collect();
        StepPose { solved: fk.clone(), fk, outcomes, body_refused: None }
    }

    /// The step of a figure that is balanced: body and parts by turns, until the centre of mass is
    /// where it should be or does not come much nearer.
    fn balanced(
        &self,
        fk: Shared<Skeleton>,
        time: f64,
        carried: &mut Carried,
        start: &Start,
        of: StepUse,
    ) -> StepPose {
        let limbs_before = carried.limbs().clone();
        let mut footing = carried
            .take_footing()
            .unwrap_or_else(|| self.footing(&self.with_limbs(start.first_pose(&fk), time)));
        let mut way = BalanceWay::default();
        let mut turns = Turns::default();
        loop {
            carried.restore_limbs(&limbs_before);
            let mut step = self.begin_step(fk.clone());
            let inputs = BodyInputs { start, footing: Some(&footing), blocked: &turns.blocked };
            self.solve_body(&mut step, inputs, time, carried, true);
            let carried_on = (of != StepUse::Pose).then_some(&mut *carried);
            self.solve_parts(&mut step, time, carried_on, start);
            footing = self.footing(&step.solved);
            let left = way.left;
            let report = self.balance_report(&step.solved);
            let next = report.and_then(|report| way.next_place(&report));
            let goes_on = turns.go_on(self.blocked_limbs_of(&step, time));
            let turn = turns.made;
            // A pose that is blended with another one shows nothing of the way.
            let gains =
                turn < 2 || footing.is_full && (turn < 3 || way.left <= Turns::WORTH * left);
            match next.filter(|_| turn < Turns::MOST && way.left > self.tolerance() && gains) {
                Some(place) if footing.is_full => footing.aim_at(place),
                Some(_) => {}
                None if goes_on => {}
                None => {
                    carried.set_footing(footing);
                    return step;
                }
            }
        }
    }

    /// Solves the whole-body targets, the bases that limb targets pull, and the balance.
    fn solve_body(
        &self,
        step: &mut StepPose,
        inputs: BodyInputs<'_>,
        time: f64,
        carried: &mut Carried,
        poses: bool,
    ) {
        let BodyInputs { start, footing, blocked } = inputs;
        let StepPose { solved, outcomes, body_refused, .. } = step;
        let active = self.accepted(&self.bodies(), solved, time, outcomes);
        let (indices, active): (Vec<usize>, Vec<BodyTarget>) = active.into_iter().unzip();
        let mut options = self.solver;
        if active.is_empty() && options.method.is_closed_form() {
            // Limbs pull more joints than the closed form has.
            options.method = Method::DampedLeastSquares;
        }
        let pulled = self.base_targets(solved, time, blocked);
        let is_pulled = !pulled.is_empty();
        let balance = footing.and_then(|footing| self.body_target_of_balance(footing));
        let limbs = footing.map_or(&[][..], |footing| &footing.limbs);
        let targets = [active, pulled, Vec::from_iter(balance)].concat();
        if targets.is_empty() {
            return carried.body().forget();
        }
        let solve = carried.body().step(start, &options, solved, &targets, limbs, poses);
        let (outcome, refused) = match solve {
            Ok(report) => (TargetOutcome::WholeBody(report), None),
            Err(error) => (TargetOutcome::Refused(error.clone()), Some(error)),
        };
        indices.into_iter().for_each(|index| outcomes[index] = outcome.clone());
        *body_refused = refused.filter(|_| is_pulled);
    }

    /// The targets with these indices for a solver of chains, without those that the method refuses;
    /// these have the refusal as their outcome.
    fn accepted(
        &self,
        indices: &[usize],
        fk: &Skeleton,
        time: f64,
        outcomes: &mut [TargetOutcome],
    ) -> Vec<(usize, BodyTarget)> {
        let method = self.solver.method;
        let mut accepted = Vec::new();
        for &index in indices {
            let target = &self.targets[index];
            let (joint, tip) = (target.joint, self.tip_target(target, fk, time));
            match method.refusal_of(&tip) {
                Some(reason) => {
                    let refused = SolveError::CannotOrient { method, joint, reason };
                    outcomes[index] = TargetOutcome::Refused(refused);
                }
                None => accepted.push((index, BodyTarget { tip, influence: target.influence })),
            }
        }
        accepted
    }

    /// A pose with its limbs posed by their targets, from the angles that they have in it.
    pub(super) fn with_limbs(&self, pose: Skeleton, time: f64) -> Shared<Skeleton> {
        let mut step = self.begin_step(Shared::from(pose));
        let mut limbs = self.parts();
        limbs.retain(|index| self.targets[*index].limb().is_some());
        for index in PartOrder::new(self, limbs).indices {
            self.solve_limb(&mut step, index, time, None);
        }
        step.solved
    }

    /// Indices of the whole-body targets that are solved.
    pub(super) fn bodies(&self) -> Vec<usize> {
        let is_body =
            |target: &Target| target.kind == TargetKind::WholeBody && self.is_solved_for(target);
        let all = 0..self.targets.len();
        all.filter(|index| is_body(&self.targets[*index])).collect()
    }

    /// Indices of the targets that are solved after the body, those of chains and limbs.
    fn parts(&self) -> Vec<usize> {
        let all = 0..self.targets.len();
        all.filter(|index| self.is_part(&self.targets[*index])).collect()
    }

    /// True if a target is solved after the body.
    fn is_part(&self, target: &Target) -> bool {
        target.kind != TargetKind::WholeBody && self.is_solved_for(target)
    }

    /// The limbs that their limits keep from their targets after a turn.
    fn blocked_limbs_of(&self, step: &StepPose, time: f64) -> Vec<BlockedLimb> {
        let is_stopped = |outcome: &TargetOutcome| match outcome {
            TargetOutcome::Limb(report) => matches!(report.reach, LimbReach::Limited(_)),
            _ => false,
        };
        let outcomes = self.targets.iter().zip(&step.outcomes);
        let stopped = outcomes.filter(|(_, outcome)| is_stopped(outcome)).map(|(target, _)| target);
        self.blocked_limbs(&step.solved, stopped, time)
    }

    /// Solves the targets of chains and limbs.
    fn solve_parts(
        &self,
        step: &mut StepPose,
        time: f64,
        mut carried: Option<&mut Carried>,
        start: &Start,
    ) {
        let parts = self.parts();
        if let Some(carried) = &mut carried {
            carried.retain_parts(|joint| parts.iter().any(|it| self.targets[*it].joint == joint));
        }
        for together in self.solved_together(PartOrder::new(self, parts).indices) {
            match self.targets[together[0]].kind {
                TargetKind::Limb(_) => {
                    self.solve_limb(step, together[0], time, carried.as_deref_mut());
                }
                _ => self.solve_chains(step, &together, time, carried.as_deref_mut(), start),
            }
        }
    }

    fn solve_limb(
        &self,
        step: &mut StepPose,
        index: usize,
        time: f64,
        carried: Option<&mut Carried>,
    ) {
        let target = &self.targets[index];
        let Some(settings) = target.limb() else { return };
        let StepPose { solved, outcomes, .. } = step;
        outcomes[index] = match Limb::ending_at(solved, target.joint) {
            Ok(limb) => {
                let limb_target = target.limb_target(settings, solved, time);
                let solved = solved.make_mut();
                let report = match carried {
                    Some(carried) => {
                        limb_ik::step(solved, limb, &limb_target, carried.limb(target.joint))
                    }
                    None => limb_ik::solve(solved, limb, &limb_target),
                };
                let singular = TargetOutcome::Refused(SolveError::Singular);
                report.map_or(singular, |report| TargetOutcome::Limb(Box::new(report)))
            }
            Err(error) => TargetOutcome::NoLimb(error),
        };
    }

    /// Solves the targets of chains that have joints in common.
    fn solve_chains(
        &self,
        step: &mut StepPose,
        together: &[usize],
        time: f64,
        carried: Option<&mut Carried>,
        start: &Start,
    ) {
        let StepPose { solved, outcomes, .. } = step;
        let (turned, options) = (self.turned_together(together), self.chain_options());
        let mut pose = Shared::from(with_others_locked(solved, &turned));
        let active = self.accepted(together, &pose, time, outcomes);
        let (indices, targets): (Vec<usize>, Vec<BodyTarget>) = active.into_iter().unzip();
        if targets.is_empty() {
            return;
        }
        let mut afresh = Bodies::default();
        let bodies = match carried {
            Some(carried) => carried.chain(self.targets[together[0]].joint),
            None => &mut afresh,
        };
        let outcome = match bodies.step(start, &options, &mut pose, &targets, &[], true) {
            Ok(report) => TargetOutcome::WholeBody(report),
            Err(error) => TargetOutcome::Refused(error),
        };
        indices.into_iter().for_each(|index| outcomes[index] = outcome.clone());
        for joint in turned {
            let rotation = pose[joint].rotation;
            solved.make_mut().write_local(joint, |joint| joint.rotation = rotation);
        }
    }
}

impl SkeletonRig {
    /// A whole-body target at a time in seconds, for a solver of chains, in the FK pose.
    pub(super) fn tip_target(&self, target: &Target, fk: &Skeleton, time: f64) -> ChainTarget {
        let point = self.softened(target, fk, target.in_world(fk, time));
        let placed = ChainTarget::at(target.joint, point).with_weight(target.weight);
        if target.limb().is_some() {
            // The orientation of a limb's target is that of its hand, which no chain turns.
            return placed;
        }
        let rotation = target.orientation_in_world(fk).map(|rotation| {
            Orientation::Rotation(fk.rotation_from_world(rotation.as_dquat()).as_quat())
        });
        let aim = target.aim.zip(target.aim_point_in_world(fk));
        let aim = aim.map(|(aim, point)| Orientation::Aim { axis: aim.axis, point });
        match rotation.or(aim) {
            Some(orientation) => placed
                .with_orientation(orientation)
                .with_orientation_weight(target.orientation_weight),
            None => placed,
        }
    }

    /// The point to which solvers bring the tip of a whole-body target that is at `point`, in the
    /// world. With [`Target::softness`], it stays a little nearer to the base of the chain, so that
    /// joints do not race where the chain becomes straight: its distance from the topmost joint
    /// that turns goes through the curve of [soft limits](crate::soft_reach), at the outer limit
    /// alone. The root must not be free to move.
    pub fn softened(&self, target: &Target, fk: &Skeleton, point: Vec3) -> Vec3 {
        let Ok(soft) = SoftReach::new(target.softness, 1.0, 0.0) else { return point };
        let turns = |joint: &JointId| !fk[*joint].locked;
        let top = fk.ancestors(target.joint).filter(turns).last();
        let is_free = self.solver.root == Root::Free && target.kind == TargetKind::WholeBody;
        let Some(top) = top.filter(|_| !soft.is_hard() && !is_free) else {
            return point;
        };
        let below = fk.ancestors(target.joint).take_while(|joint| *joint != top);
        let offsets = below.map(|joint| f64::from(fk[joint].offset.length())).sum::<f64>();
        let scale = f64::from(fk.transform().matrix3.determinant().abs()).cbrt();
        let most = (offsets + f64::from(fk[target.joint].axis.length())) * scale;
        let base = fk.base(top).as_dvec3();
        let way = point.as_dvec3() - base;
        let distance = way.length();
        if !(distance > 0.5 * most && distance.is_finite()) {
            return point;
        }
        let (softened, _) = soft.between(0.0, most, distance);
        (base + way * (softened / distance)).as_vec3()
    }
}

/// Angle in radians from the axis of a target's aim to its point, in skeleton space, in a pose; `None`
/// without an aim.
fn aim_error(target: &Target, pose: &Skeleton) -> Option<f32> {
    let (aim, point) = target.aim.zip(target.aim_point_in_world(pose))?;
    pose.joint(target.joint)?;
    let space = pose.pose_in_skeleton().full(target.joint);
    let to_skeleton = pose.transform().as_daffine3().inverse();
    let way = to_skeleton.transform_point3(point.as_dvec3()) - space.translation.as_dvec3();
    let axis = space.transform_vector3(aim.axis).as_dvec3();
    Some(axis.cross(way).length().atan2(axis.dot(way)) as f32)
}

impl Target {
    fn limb_target(&self, settings: &LimbSettings, pose: &Skeleton, time: f64) -> LimbTarget {
        self.limb_target_at(settings, pose, self.in_world(pose, time))
    }

    /// A limb target at a point in the world, for the solver of limbs.
    pub(super) fn limb_target_at(
        &self,
        settings: &LimbSettings,
        pose: &Skeleton,
        point: Vec3,
    ) -> LimbTarget {
        LimbTarget {
            point,
            reference: settings.reference_in_world(pose),
            twist: settings.twist,
            soft_reach: settings.soft_reach,
            hand: self.orientation_in_world(pose),
            fk_stretch: settings.fk_stretch,
            influence: self.influence,
            bends_about: settings.bends_about,
        }
    }
}

/// A target that is fixed in a space from which it cannot be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TargetSpaceError {
    /// The skeleton has no such joint.
    #[error("the target of joint {target} must be in the world or on a joint, got joint {joint}")]
    NoJoint {
        /// Joint of the target.
        target: JointId,
        /// The missing joint.
        joint: JointId,
    },
    /// The target moves the joint that it is on.
    #[error("the target of joint {target} must be on a joint that it does not move, got {joint}")]
    Own {
        /// Joint of the target.
        target: JointId,
        /// The joint that the target is on.
        joint: JointId,
    },
    /// A whole-body target is on a joint that another target moves.
    #[error(
        "the whole-body target of joint {target} must be on a joint that no target moves, got {joint}"
    )]
    WholeBody {
        /// Joint of the target.
        target: JointId,
        /// The joint that the target is on.
        joint: JointId,
    },
    /// Limbs or chains whose targets are on each other.
    #[error("the target of joint {target} must not be on a joint whose target depends on it")]
    Cycle {
        /// Joint of one of the targets.
        target: JointId,
    },
}

impl TargetSpaceError {
    /// The reason without the names of the joints.
    pub fn reason(&self) -> &'static str {
        match self {
            Self::NoJoint { .. } => "There is no such joint",
            Self::Own { .. } => "The target moves this joint",
            Self::WholeBody { .. } => "Another target moves this joint",
            Self::Cycle { .. } => "A limb's target on this joint depends on this one",
        }
    }
}

impl SkeletonRig {
    /// Checks that each target can be evaluated after the joints that it is on.
    ///
    /// # Errors
    ///
    /// [`TargetSpaceError`] for the first target that cannot.
    pub fn check_target_spaces(&self) -> Result<(), TargetSpaceError> {
        for target in &self.targets {
            // Of any limb, since a change of its reference brings its pole into use.
            let pole = target.limb().and_then(|limb| limb.pole_space.joint());
            if let Some(joint) = pole.filter(|joint| self.skeleton.joint(*joint).is_none()) {
                return Err(TargetSpaceError::NoJoint { target: target.joint, joint });
            }
        }
        if !self.targets.iter().any(is_on_joint) {
            return Ok(());
        }
        let moved: Vec<_> = self.targets.iter().map(|it| self.moved_by(it)).collect();
        for (target, own) in self.targets.iter().zip(&moved) {
            for joint in target.spaces().filter_map(TargetSpace::joint) {
                let error = if self.skeleton.joint(joint).is_none() {
                    Some(TargetSpaceError::NoJoint { target: target.joint, joint })
                } else if own.moves(&self.skeleton, joint) {
                    Some(TargetSpaceError::Own { target: target.joint, joint })
                } else if target.kind == TargetKind::WholeBody
                    && moved.iter().any(|other| other.moves(&self.skeleton, joint))
                {
                    Some(TargetSpaceError::WholeBody { target: target.joint, joint })
                } else {
                    None
                };
                error.map_or(Ok(()), Err)?;
            }
        }
        let is_part = |index: &usize| self.targets[*index].kind != TargetKind::WholeBody;
        let parts = (0..self.targets.len()).filter(is_part);
        match PartOrder::new(self, parts.collect()).cycle {
            Some(index) => Err(TargetSpaceError::Cycle { target: self.targets[index].joint }),
            None => Ok(()),
        }
    }
}

/// Indices of targets of chains and limbs in the order in which they are solved: those that move a
/// joint before those that depend on it, otherwise in the order of their joints.
pub(super) struct PartOrder {
    pub indices: Vec<usize>,
    /// A target that depends on itself through others.
    cycle: Option<usize>,
}

impl PartOrder {
    /// The order of the targets with these indices.
    pub fn new(rig: &SkeletonRig, mut left: Vec<usize>) -> Self {
        left.sort_by_key(|index| rig.targets[*index].joint);
        if !left.iter().any(|index| is_on_joint(&rig.targets[*index])) {
            return Self { indices: left, cycle: None };
        }
        let mut order = Self { indices: Vec::with_capacity(left.len()), cycle: None };
        let moved: Vec<MovedJoints> =
            rig.targets.iter().map(|target| rig.moved_by(target)).collect();
        let depends = |one: usize, other: usize| {
            one != other && moved[one].depends_on(&rig.skeleton, &rig.targets[one], &moved[other])
        };
        while !left.is_empty() {
            let is_free = |one: &usize| !left.iter().any(|other| depends(*one, *other));
            let next = left.iter().position(is_free);
            if next.is_none() {
                order.cycle = order.cycle.or(left.first().copied());
            }
            order.indices.push(left.remove(next.unwrap_or(0)));
        }
        order
    }
}

fn is_on_joint(target: &Target) -> bool {
    target.spaces().any(|space| space.joint().is_some())
}
