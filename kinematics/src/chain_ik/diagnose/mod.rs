//! Finds out why tips are not at their targets, by trying what would help.
//!
//! Evidence comes from the pose to which the solver came: the reach of the bones against the
//! distance of the target, and the moments with which the target pulls at joints, limits and locked
//! joints. What the evidence suggests is then tried with a solve of its own, in this order:
//!
//! | tried | if the tip then reaches its target |
//! | --- | --- |
//! | (nothing: the bones are too short or too long) | out of reach |
//! | more iterations | out of iterations |
//! | a slightly bent start; other methods; the middle of the limits | singular or stalled |
//! | the target alone, and with the target that pulls against it | conflict |
//! | no limits where the target pushes | limits |
//! | unlocked joints | locked |
//!
//! A cause whose remedy brings the tip to its target excludes the ones tried after it, except that
//! limits and locked joints are both tried.
//!
//! # What breaks
//!
//! - A target in a hole of the reach that limits make is found as *limits*; whether a pose within
//!   the limits exists is not proved, only not found.
//! - The work has a bound: of many missed targets only the farthest are examined, and none if one
//!   solve takes as long as a pose may.
//! - For three targets that conflict only all together, no pair is found.

mod evidence;

use glam::Vec3;

use self::evidence::{OutOfReach, Pulls, SettledPose, SolveInputs, opponent};
use super::{ChainTarget, SolveError, SolverOptions};
use crate::chain_ik::{Method, Root, Status};
use crate::diagnosis::{
    Angle, Cause, Diagnosis, Remedy, Start, TriedRemedy, in_turn, is_fixed, limited_angles,
    remove_limits, widen_to_contain,
};
use crate::skeleton::{Joint, JointId, RotationAxis, Skeleton};

/// The causes for which the tips of `skeleton`, which is in its FK pose, are not at their targets
/// after a solve, the most likely first; empty if all are reached.
///
/// Every remedy was tried: its residual is that of a solve with these options.
///
/// # Errors
///
/// See [`SolveError`].
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::chain_ik::{SolverOptions, ChainTarget, diagnose};
/// use ik_arm_kinematics::diagnosis::Cause;
/// use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton};
///
/// let mut skeleton = Skeleton::with_root("root");
/// let upper = skeleton.add(Joint::new("upper", Some(JointId::new(0)), Vec3::Y))?;
/// let lower = Joint { offset: Vec3::Y, ..Joint::new("lower", Some(upper), Vec3::Y) };
/// let lower = skeleton.add(lower)?;
///
/// let target = ChainTarget::at(lower, Vec3::new(3.0, 0.0, 0.0));
/// let found = diagnose(&skeleton, &[target], &SolverOptions::default())?;
/// assert!(matches!(found[0].cause, Cause::OutOfReach { .. }));
/// assert!(found[0].remedies[0].residual < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn diagnose(
    skeleton: &Skeleton,
    targets: &[ChainTarget],
    options: &SolverOptions,
) -> Result<Vec<Diagnosis>, SolveError> {
    let joints: Vec<_> = targets.iter().map(|target| target.joint).collect();
    diagnose_targets(skeleton, targets, options, &joints)
}

/// [`diagnose`] for the targets of some joints, which are solved together with all others.
///
/// # Errors
///
/// See [`SolveError`].
pub fn diagnose_targets(
    skeleton: &Skeleton,
    targets: &[ChainTarget],
    options: &SolverOptions,
    joints: &[JointId],
) -> Result<Vec<Diagnosis>, SolveError> {
    let inputs =
        SolveInputs { skeleton: skeleton.clone(), targets: targets.to_vec(), options: *options };
    let solved = inputs.solve()?;
    if solved.report.converged() {
        return Ok(Vec::new());
    }
    let residual = |joint: &JointId| (*joint, solved.residual(&inputs, *joint));
    let is_missed = |(_, residual): &(JointId, f32)| *residual > solved.tolerance;
    let mut missed: Vec<_> = joints.iter().map(residual).filter(is_missed).collect();
    missed.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    missed.truncate(most_examined(solved.work));
    let examination = Examination::new(inputs, solved);
    let found = missed.into_iter().map(|(joint, residual)| examination.examine(joint, residual));
    Ok(in_turn(found.collect()))
}

/// Number of targets that are examined if one solve takes `work`.
fn most_examined(work: u64) -> usize {
    /// Work of all solves, some seconds.
    const MOST_WORK: u64 = 1 << 26;
    /// Solves for one target, roughly.
    const SOLVES: u64 = 20;
    usize::try_from(MOST_WORK / work.saturating_mul(SOLVES).max(1)).unwrap_or(usize::MAX)
}

/// Residuals that a remedy brings below this fraction are worth a word.
const WORTH: f32 = 0.9;

/// A solve that missed targets, with what is needed to find out why.
struct Examination {
    inputs: SolveInputs,
    /// The inputs with so many iterations that the solver ends by itself.
    settled: SolveInputs,
    /// The pose to which the settled inputs come.
    pose: SettledPose,
    /// Number of iterations after which the solver of the inputs stopped; `None` if it ended by
    /// itself.
    stopped_at: Option<u32>,
}

impl Examination {
    pub fn new(inputs: SolveInputs, solved: SettledPose) -> Self {
        // Multiple of the iterations that a solver may take to end by itself.
        const PATIENCE: u32 = 10;
        let report = solved.report;
        if report.status != Status::OutOfIterations {
            return Self { settled: inputs.clone(), inputs, pose: solved, stopped_at: None };
        }
        let most = report.method.budget().max(report.iterations.saturating_mul(PATIENCE));
        let settled = inputs.with(&Remedy::AllowIterations(most)).unwrap_or_else(|| inputs.clone());
        let pose = settled.solve().unwrap_or(solved);
        Self { inputs, settled, pose, stopped_at: Some(report.iterations) }
    }

    /// The causes for which a tip is `residual` from its target, the most likely first.
    pub fn examine(&self, joint: JointId, residual: f32) -> Vec<Diagnosis> {
        let case = ChainCase::new(self, joint, residual);
        if let Some(found) = case.out_of_reach() {
            return vec![found];
        }
        let mut found: Vec<Diagnosis> = case.out_of_iterations().into_iter().collect();
        if found.iter().all(|it| !case.is_remedied(it)) {
            let conflict = case.conflict();
            // Where another target is known to pull, one other method shows that the solver has not
            // just stalled.
            let most = if conflict.is_some() { 1 } else { usize::MAX };
            found.extend(case.stalled(most).or(conflict));
        }
        if !found.iter().any(|it| case.is_remedied(it)) {
            found.extend(case.limits());
            found.extend(case.locked());
        }
        if found.is_empty() {
            found.push(case.unexplained());
        }
        // Stable: of remedies that reach the target, the first one tried stays first.
        found.sort_by(|one, other| {
            let left =
                |it: &Diagnosis| if case.is_remedied(it) { 0.0 } else { it.residual_with_remedy() };
            left(one).total_cmp(&left(other))
        });
        found
    }
}

/// One target that is not reached.
struct ChainCase<'a> {
    examination: &'a Examination,
    joint: JointId,
    residual: f32,
    /// Moments with which the target pulls at the joints in the settled pose.
    pulls: Pulls,
}

impl<'a> ChainCase<'a> {
    fn new(examination: &'a Examination, joint: JointId, residual: f32) -> Self {
        let target = examination.inputs.target_of(joint).copied();
        let pulls = target.map(|target| Pulls::new(&examination.pose.skeleton, &target));
        Self { examination, joint, residual, pulls: pulls.unwrap_or_default() }
    }

    fn out_of_reach(&self) -> Option<Diagnosis> {
        let Examination { inputs, pose, .. } = self.examination;
        let out = OutOfReach::of(inputs, inputs.target_of(self.joint)?, self.tolerance())?;
        let mut tried: Vec<_> =
            out.remedies().filter_map(|remedy| self.try_remedy(remedy)).collect();
        if !tried.iter().any(|tried| self.is_reached(tried.residual)) {
            let point = pose.skeleton.tip(self.joint);
            tried.extend(self.try_remedy(Remedy::MoveTarget { joint: self.joint, point }));
        }
        Some(self.diagnosis(out.cause, self.path(), tried))
    }

    fn out_of_iterations(&self) -> Option<Diagnosis> {
        let Examination { pose, stopped_at, .. } = self.examination;
        let iterations = (*stopped_at)?;
        let residual = self.settled_residual();
        if residual > WORTH * self.residual {
            return None;
        }
        let remedy = Remedy::AllowIterations(pose.report.iterations);
        let tried = vec![TriedRemedy { remedy, residual, rotation_residual: 0.0 }];
        Some(self.diagnosis(Cause::OutOfIterations { iterations }, self.path(), tried))
    }

    /// Tries other methods and starts, at most `most` of them, until one reaches the target.
    fn stalled(&self, most: usize) -> Option<Diagnosis> {
        // Speeds towards the target below this fraction are as good as none.
        const SINGULAR: f32 = 0.02;
        const OTHERS: [Method; 3] = [Method::DampedLeastSquares, Method::Fabrik, Method::Ccd];
        let settled = &self.examination.settled;
        let present = settled.options.method;
        let others = OTHERS.into_iter().filter(|method| *method != present).take(2);
        let others = others.map(Remedy::UseMethod);
        let bent = Remedy::StartFrom(bent_start(&settled.skeleton, self.joint));
        let middle = Remedy::StartFrom(middle_start(&settled.skeleton, self.joint));
        let is_singular = self.pulls.mobility < SINGULAR;
        // A bend is what helps at a singular pose; elsewhere a method is easier to change.
        let [first, last] =
            if is_singular { [vec![bent], Vec::new()] } else { [Vec::new(), vec![bent]] };
        let all = first.into_iter().chain(others).chain(last).chain([middle]);
        let found = all.take(most).find_map(|remedy| {
            let residual = self.residual_unless_others_suffer(&remedy)?;
            self.is_reached(residual).then(|| self.tell(remedy, residual))
        })?;
        let mobility = self.pulls.mobility;
        let cause = if mobility < SINGULAR { Cause::Singular { mobility } } else { Cause::Stalled };
        Some(self.diagnosis(cause, self.path(), vec![found]))
    }

    /// Tries to reach the target without the one that pulls against it.
    fn conflict(&self) -> Option<Diagnosis> {
        const HEAVIER: f32 = 10.0;
        let Examination { settled, pose, .. } = self.examination;
        let with = opponent(settled, &pose.skeleton, self.joint)?;
        let off = self.try_remedy(Remedy::SwitchOff(with))?;
        if !self.is_reached(off.residual) {
            return None;
        }
        let weight = settled.target_of(self.joint)?.weight * HEAVIER;
        let heavier = self.try_remedy(Remedy::SetWeight { joint: self.joint, weight });
        let tried = [off].into_iter().chain(heavier).collect();
        Some(self.diagnosis(Cause::Conflict { with }, vec![self.joint, with], tried))
    }

    /// Tries to reach the target without limits: the one against which it pushes most, all against
    /// which it pushes, all of the chain.
    fn limits(&self) -> Option<Diagnosis> {
        let Examination { settled, pose, .. } = self.examination;
        let pushed = self.pulls.against_limits(&pose.skeleton);
        let mut pushed: Vec<Angle> = pushed.map(|pull| (pull.joint, pull.axis)).collect();
        // A hinge would rather turn farther than become a ball joint.
        pushed.sort_by_key(|angle| is_fixed(&settled.skeleton, *angle));
        let free = |joint: &JointId| !settled.skeleton[*joint].locked;
        let all = limited_angles(&settled.skeleton, self.path().into_iter().filter(free));
        let sets = [&pushed[..pushed.len().min(1)], &pushed[..], &all[..]];
        let mut best: Option<TriedRemedy> = None;
        let mut last: &[Angle] = &[];
        for angles in sets {
            if angles.len() <= last.len()
                || best.as_ref().is_some_and(|it| self.is_reached(it.residual))
            {
                continue;
            }
            last = angles;
            let Some(tried) = self.try_without_limits(angles) else { continue };
            if best.as_ref().is_none_or(|best| tried.residual < WORTH * best.residual) {
                best = Some(tried);
            }
        }
        let best = best?;
        let Remedy::WidenLimits(widened) = &best.remedy else { return None };
        let mut joints: Vec<_> = widened.iter().map(|it| it.joint).collect();
        joints.dedup();
        Some(self.diagnosis(Cause::Limits, joints, vec![best]))
    }

    fn try_without_limits(&self, angles: &[Angle]) -> Option<TriedRemedy> {
        let settled = &self.examination.settled;
        let mut free = settled.clone();
        remove_limits(&mut free.skeleton, angles);
        let pose = free.solve().ok()?;
        if pose.residual(&free, self.joint) > WORTH * self.residual {
            return None;
        }
        self.try_remedy(widen_to_contain(&settled.skeleton, &pose.skeleton, angles)?)
    }

    /// Tries to reach the target with the most strongly pulled locked joint unlocked, then with
    /// all.
    fn locked(&self) -> Option<Diagnosis> {
        let inputs = &self.examination.inputs;
        let keeps_roots = inputs.options.root == Root::Locked;
        let is_root = |joint: JointId| inputs.skeleton[joint].parent.is_none();
        let is_locked = |joint: JointId| inputs.skeleton[joint].locked;
        let is_kept = |joint: &JointId| is_locked(*joint) || (keeps_roots && is_root(*joint));
        let joints: Vec<JointId> = self.pulls.joints().into_iter().filter(is_kept).collect();
        let unlock = |joints: &[JointId]| match joints {
            [root] if !is_locked(*root) => Remedy::SetRoot(Root::Turns),
            joints => Remedy::Unlock(joints.to_vec()),
        };
        let first = self.try_remedy(unlock(joints.get(..1)?));
        let tried = match first {
            Some(tried) if self.is_reached(tried.residual) || joints.len() == 1 => tried,
            first => self.try_remedy(unlock(&joints)).or(first)?,
        };
        let joints = match &tried.remedy {
            Remedy::Unlock(joints) => joints.clone(),
            _ => joints,
        };
        Some(self.diagnosis(Cause::Locked, joints, vec![tried]))
    }

    /// The cause by the evidence alone, where nothing that was tried helps.
    fn unexplained(&self) -> Diagnosis {
        let pose = &self.examination.pose.skeleton;
        let mut pushed: Vec<_> = self.pulls.against_limits(pose).map(|pull| pull.joint).collect();
        pushed.dedup();
        let cause = if pushed.is_empty() { Cause::Stalled } else { Cause::Limits };
        let joints = if pushed.is_empty() { self.path() } else { pushed };
        self.diagnosis(cause, joints, Vec::new())
    }

    /// Tries a remedy; `None` if it does not bring the tip nearer.
    fn try_remedy(&self, remedy: Remedy) -> Option<TriedRemedy> {
        let residual = self.examination.settled.with(&remedy)?.residual_of(self.joint);
        let tried = self.tell(remedy, residual);
        (tried.residual <= WORTH * self.residual).then_some(tried)
    }

    /// A remedy with the residual that it leaves: `settled`, unless the iterations are limited.
    fn tell(&self, remedy: Remedy, settled: f32) -> TriedRemedy {
        let Examination { inputs, stopped_at, .. } = self.examination;
        let residual = match stopped_at {
            None => settled,
            Some(_) => inputs.with(&remedy).map_or(settled, |with| with.residual_of(self.joint)),
        };
        TriedRemedy { remedy, residual, rotation_residual: 0.0 }
    }

    /// The residual with a remedy; `None` if another tip that is at its target leaves it.
    fn residual_unless_others_suffer(&self, remedy: &Remedy) -> Option<f32> {
        let Examination { settled, pose, .. } = self.examination;
        let changed = settled.with(remedy)?;
        let solved = changed.solve().ok()?;
        let suffers = changed.targets.iter().any(|target| {
            let before = pose.residual(settled, target.joint);
            target.joint != self.joint
                && solved.residual(&changed, target.joint) > before.max(self.tolerance())
        });
        (!suffers).then(|| solved.residual(&changed, self.joint))
    }

    fn diagnosis(
        &self,
        cause: Cause,
        joints: Vec<JointId>,
        mut remedies: Vec<TriedRemedy>,
    ) -> Diagnosis {
        remedies.sort_by_key(|tried| !self.is_reached(tried.residual));
        Diagnosis { target: self.joint, residual: self.residual, cause, joints, remedies }
    }

    fn settled_residual(&self) -> f32 {
        let Examination { settled, pose, .. } = self.examination;
        pose.residual(settled, self.joint)
    }

    fn is_remedied(&self, diagnosis: &Diagnosis) -> bool {
        self.is_reached(diagnosis.residual_with_remedy())
    }

    fn is_reached(&self, residual: f32) -> bool {
        // A residual that is computed again differs by rounding.
        const ROUNDING: f32 = 1.01;
        residual <= ROUNDING * self.tolerance()
    }

    fn tolerance(&self) -> f32 {
        self.examination.pose.tolerance
    }

    /// The joints from the tip's joint to its root.
    fn path(&self) -> Vec<JointId> {
        self.examination.inputs.skeleton.ancestors(self.joint).collect()
    }
}

/// The present angles of all joints above a tip, each changed a little and within its limits. The
/// signs alternate along the chain, so that a straight chain bends and folds back.
fn bent_start(skeleton: &Skeleton, joint: JointId) -> Start {
    /// Change of each angle, in radians.
    const BEND: f32 = 0.2;
    let turn = |index: usize, joint: &Joint| {
        let side = if index.is_multiple_of(2) { BEND } else { -BEND };
        let mut angles = joint.rotation;
        for axis in RotationAxis::ALL {
            let angle = &mut angles[axis.index()];
            let (to, back) = (*angle + side, *angle - side);
            let is_free = |angle| joint.limits.allows(axis, angle);
            *angle = if is_free(to) || !is_free(back) { to } else { back };
        }
        joint.limits.project(angles)
    };
    Start { is_bend: true, angles: turned(skeleton, joint, turn) }
}

/// The middle of all limits, and the bind pose of angles without limits.
fn middle_start(skeleton: &Skeleton, joint: JointId) -> Start {
    let turn = |_, joint: &Joint| joint.limits.middle();
    Start { is_bend: false, angles: turned(skeleton, joint, turn) }
}

/// New angles of all joints above a tip that may turn.
fn turned(
    skeleton: &Skeleton,
    joint: JointId,
    turn: impl Fn(usize, &Joint) -> Vec3,
) -> Vec<(JointId, Vec3)> {
    let free = skeleton.ancestors(joint).filter(|joint| !skeleton[*joint].locked);
    free.enumerate().map(|(index, joint)| (joint, turn(index, &skeleton[joint]))).collect()
}
