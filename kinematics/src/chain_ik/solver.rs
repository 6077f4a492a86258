mod track;

use glam::Vec3;

use super::configuration::Configuration;
use super::inside::{Event, Recorder, SubStep, sub_steps};
use super::method::{MethodInputs, MethodState};
use super::problem::{self, Builder, HeldLimb, Problem};
use super::report::{Report, Status};
use super::stall::{Escape, StallDetector};
use super::tracker::Tracker;
use super::{ChainTarget, Method, OrientRefusal, SolveError, SolverOptions, method, perturb};
use crate::skeleton::{JointId, Skeleton};
use crate::vector::saturate;

pub use self::track::TrackStep;

/// An iterative solver that moves the bone tips of a skeleton to targets.
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton};
/// use ik_arm_kinematics::chain_ik::{SolverOptions, ChainSolver, ChainTarget};
///
/// let mut skeleton = Skeleton::with_root("root");
/// let upper = skeleton.add(Joint::new("upper", Some(JointId::new(0)), Vec3::Y))?;
/// let lower = Joint { offset: Vec3::Y, ..Joint::new("lower", Some(upper), Vec3::Y) };
/// let lower = skeleton.add(lower)?;
///
/// let target = ChainTarget::at(lower, Vec3::new(1.0, 0.5, 0.0));
/// let mut solver = ChainSolver::new(&skeleton, &[target], &SolverOptions::default())?;
/// assert!(solver.run().converged());
/// solver.write(&mut skeleton);
/// assert!(skeleton.tip(lower).distance(target.point) < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ChainSolver {
    report: Report,
    options: SolverOptions,
    /// Number of iterations after which a bounded solver stops; `None` for others.
    bound: Option<u32>,
    /// In world units.
    tolerance: f64,
    builder: Builder,
    problem: Problem,
    config: Configuration,
    /// The configuration before the first iteration.
    start: Configuration,
    state: MethodState,
    stall: StallDetector,
    escape: Escape,
    /// `None` before the first call of [`ChainSolver::track`].
    tracker: Option<Box<Tracker>>,
}

impl ChainSolver {
    /// Maximum work for one pose of a rig, in the units of [`ChainSolver::bounded`]: less than
    /// about a third of a second.
    pub const POSE_WORK: u64 = 1 << 23;

    /// Prepares a solver without making an iteration.
    ///
    /// # Errors
    ///
    /// See [`SolveError`].
    pub fn new(
        skeleton: &Skeleton,
        targets: &[ChainTarget],
        options: &SolverOptions,
    ) -> Result<Self, SolveError> {
        let (builder, problem) = Self::problem(skeleton, targets, &[], options)?;
        Self::of_problem(builder, problem, skeleton, targets, options)
    }

    /// Prepares a solver that stops with [`Status::Bounded`] after at most `work`, so that the time
    /// of [`ChainSolver::run`] has a bound. The unit of work is a joint, or a pair of a joint and a
    /// target, in one iteration: some 10 to 50 ns.
    ///
    /// # Errors
    ///
    /// [`SolveError::TooMuchWork`] if not even one iteration is allowed; see also [`SolveError`].
    pub fn bounded(
        skeleton: &Skeleton,
        targets: &[ChainTarget],
        options: &SolverOptions,
        work: u64,
    ) -> Result<Self, SolveError> {
        Self::bounded_with_limbs(skeleton, targets, &[], options, work)
    }

    /// [`ChainSolver::bounded`] for a centre of mass of a body with limbs whose tips are held.
    pub(crate) fn bounded_with_limbs(
        skeleton: &Skeleton,
        targets: &[ChainTarget],
        limbs: &[HeldLimb],
        options: &SolverOptions,
        work: u64,
    ) -> Result<Self, SolveError> {
        let (builder, problem) = Self::problem(skeleton, targets, limbs, options)?;
        let (method, of_iteration) = (options.method, (options.method.row().work)(&problem));
        if of_iteration > work {
            let (targets, links) = (targets.len(), problem.links.len());
            return Err(SolveError::TooMuchWork { method, targets, links });
        }
        let bound = u32::try_from(work / of_iteration.max(1)).unwrap_or(u32::MAX);
        let solver = Self::of_problem(builder, problem, skeleton, targets, options)?;
        Ok(Self { bound: Some(bound), ..solver })
    }

    fn problem(
        skeleton: &Skeleton,
        targets: &[ChainTarget],
        limbs: &[HeldLimb],
        options: &SolverOptions,
    ) -> Result<(Builder, Problem), SolveError> {
        options.check()?;
        check_method(options.method, targets)?;
        let mut builder = Builder::new(skeleton, targets, options)?;
        builder.held_limbs.extend_from_slice(limbs);
        let mut problem = Problem::default();
        builder.fill(&mut problem, skeleton, targets)?;
        check_stiffness(options.method, &problem)?;
        check_hinges(options.method, &problem, targets)?;
        Ok((builder, problem))
    }

    fn of_problem(
        builder: Builder,
        problem: Problem,
        skeleton: &Skeleton,
        targets: &[ChainTarget],
        options: &SolverOptions,
    ) -> Result<Self, SolveError> {
        let tolerance = options.tolerance_of(&problem);
        let SolverOptions { method, damping, step, .. } = *options;
        let inputs = MethodInputs { problem: &problem, skeleton, damping, step };
        let state = MethodState::new(method, &inputs)?;
        let mut config = Configuration::new(&problem);
        if method.row().uses_orientations {
            config.set_orientations();
        }
        let least = problem.length_from_world(tolerance);
        let stall = StallDetector::new(method.row().patience, least, &config);
        let report = Report {
            method,
            iterations: 0,
            error: 0.0,
            orientation_error: 0.0,
            status: Status::Iterating,
        };
        let (start, escape) = (config.clone(), Escape::new(&config));
        let mut solver = Self {
            report,
            options: *options,
            bound: None,
            tolerance,
            builder,
            problem,
            config,
            start,
            state,
            stall,
            escape,
            tracker: None,
        };
        solver.set_targets(targets);
        Ok(solver)
    }

    /// Work of the iterations so far, in the units of [`ChainSolver::bounded`].
    pub(crate) fn work(&self) -> u64 {
        let of_iteration = (self.report.method.row().work)(&self.problem);
        of_iteration.saturating_mul(u64::from(self.report.iterations.max(1)))
    }

    /// Progress so far.
    #[must_use]
    pub fn report(&self) -> Report {
        self.report
    }

    /// Distance in world units: the solver has converged if no tip is farther from its target, and no
    /// missing turn times a quarter of the chain's length is longer.
    #[must_use]
    pub fn tolerance(&self) -> f32 {
        saturate(self.tolerance)
    }

    /// Makes one iteration, unless the solver has converged or stalled. The maximum number of
    /// iterations is ignored.
    pub fn step(&mut self) -> Report {
        self.step_with(&mut Recorder::off())
    }

    /// Makes one iteration like [`ChainSolver::step`], with the same bits, and returns what the
    /// method computed in it, in the order in which it did; the last sub-step has the pose after
    /// the iteration, as [`ChainSolver::write`] writes it to `skeleton`: the skeleton for which the
    /// solver was made, in the FK pose.
    pub fn step_inside(&mut self, skeleton: &Skeleton) -> (Report, Vec<SubStep>) {
        let mut recorder = Recorder::on();
        let report = self.step_with(&mut recorder);
        let pose = |config: &Configuration| {
            let mut pose = skeleton.clone();
            self.write_configuration(config, &mut pose);
            pose
        };
        (report, sub_steps(recorder.into_records(), &self.problem, skeleton.transform(), pose))
    }

    fn step_with(&mut self, recorder: &mut Recorder) -> Report {
        if self.is_settled() {
            return self.report;
        }
        if self.report.iterations == 0 {
            self.start(recorder);
        }
        let can_go_on = self.state.iterate(&self.problem, &mut self.config, recorder);
        self.report.iterations += 1;
        self.measure();
        if !self.report.converged()
            && (!can_go_on || self.stall.observe(&self.problem, &self.config))
        {
            self.escape_or_stall();
            recorder.record_change(&self.config, Event::Restart);
        }
        if matches!(self.report.status, Status::OutOfIterations | Status::Bounded) {
            self.escape.restore_best(&self.problem, &mut self.config);
            recorder.record_change(&self.config, Event::Restart);
            self.measure();
        }
        self.report
    }

    /// Iterates until the solver has converged, has stalled, is out of iterations or has come to
    /// its bound.
    pub fn run(&mut self) -> Report {
        while !self.is_over() {
            self.step();
        }
        self.report
    }

    /// True if the solver has converged, has stalled, is out of iterations or has come to its
    /// bound.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.report.status != Status::Iterating
    }

    /// True if further iterations would change nothing.
    fn is_settled(&self) -> bool {
        matches!(self.report.status, Status::Converged | Status::Stalled)
    }

    /// Moves the targets and restarts from the current pose with no iterations made. The targets
    /// must be for the same joints, in the same order; their weights stay as they were.
    ///
    /// # Errors
    ///
    /// [`SolveError::NoJoint`] for other joints or another order; [`SolveError::Point`];
    /// [`SolveError::Weight`].
    pub fn retarget(&mut self, targets: &[ChainTarget]) -> Result<(), SolveError> {
        self.check_targets(targets)?;
        self.set_targets(targets);
        Ok(())
    }

    /// Checks targets that must be for the joints of the present targets, in the same order.
    fn check_targets(&self, targets: &[ChainTarget]) -> Result<(), SolveError> {
        let effectors = &self.problem.effectors;
        for (index, effector) in effectors.iter().enumerate() {
            let joint = targets.get(index).map(|target| target.joint);
            if joint != Some(effector.joint) {
                return Err(SolveError::NoJoint(joint.unwrap_or(effector.joint)));
            }
        }
        if let Some(more) = targets.get(effectors.len()) {
            return Err(SolveError::NoJoint(more.joint));
        }
        for target in targets {
            problem::check_target(target)?;
        }
        check_method(self.options.method, targets)?;
        check_hinges(self.options.method, &self.problem, targets)
    }

    /// Begins anew with the angles of a pose, and with the offsets of its free roots, in place of
    /// the FK pose; angles beyond limits are clamped. `pose` must be a pose of the skeleton for
    /// which the solver was made.
    pub fn begin_from(&mut self, pose: &Skeleton) {
        for (link, angles) in self.problem.links.iter().zip(&mut self.config.angles) {
            if let Some(joint) = pose.joint(link.joint) {
                *angles = link.limits.project(joint.rotation);
            }
        }
        if self.problem.free_roots {
            for (index, shift) in self.config.shifts.iter_mut().enumerate() {
                if let Some(root) = pose.joint(self.problem.trees[index].root) {
                    *shift = self.problem.shift_to(index, root.offset);
                }
            }
        }
        self.config.forward(&self.problem);
        self.config.renew_orientations();
        self.begin();
    }

    /// [Begins from](ChainSolver::begin_from) a pose that is a solution: as long as nothing
    /// changes, [`ChainSolver::track`] keeps it, also if it misses targets.
    pub fn rest_at(&mut self, pose: &Skeleton) {
        self.begin_from(pose);
        if self.report.status == Status::Iterating {
            self.report.status = Status::Stalled;
        }
    }

    /// The options with which the solver was made.
    pub fn options(&self) -> &SolverOptions {
        &self.options
    }

    /// The joints of the targets, in their order.
    pub fn target_joints(&self) -> impl Iterator<Item = JointId> {
        self.problem.effectors.iter().map(|effector| effector.joint)
    }

    /// The joints of the targets, in their order, and whether the centre of mass goes to each.
    pub(crate) fn targets(&self) -> impl Iterator<Item = (JointId, bool)> {
        self.problem.effectors.iter().map(|it| (it.joint, it.is_of_mass()))
    }

    /// Euler angles in radians of the joints that the solver turns, within their limits.
    pub fn angles(&self) -> impl Iterator<Item = (JointId, Vec3)> {
        let mut config = self.config.clone();
        self.state.update_orientations(&mut config);
        config.update_angles(&self.problem);
        self.problem.links.iter().zip(config.angles).map(|(link, angles)| (link.joint, angles))
    }

    /// Offsets of the roots that the solver moves: see [`Root::Free`](super::Root::Free).
    pub fn offsets(&self) -> impl Iterator<Item = (JointId, Vec3)> {
        let trees = self.problem.trees.iter().filter(|_| self.problem.free_roots).enumerate();
        trees.map(|(index, tree)| {
            (tree.root, self.problem.root_offset(index, self.config.shifts[index]))
        })
    }

    /// Writes the solved Euler angles and the offsets of free roots into `skeleton`, which must be
    /// the skeleton for which the solver was made. Of all equivalent angles of a joint, it writes
    /// those nearest to the joint's present angles.
    pub fn write(&self, skeleton: &mut Skeleton) {
        self.write_configuration(&self.config, skeleton);
    }

    fn write_configuration(&self, config: &Configuration, skeleton: &mut Skeleton) {
        if self.problem.free_roots {
            for (index, tree) in self.problem.trees.iter().enumerate() {
                let offset = self.problem.root_offset(index, config.shifts[index]);
                skeleton.write_local(tree.root, |root| root.offset = offset);
            }
        }
        if self.tracker.is_none() && config.is_same(&self.start) {
            // Nothing has moved: writes the angles from before the run, bit for bit, also if other
            // angles have been written since.
            for link in &self.problem.links {
                skeleton.write_local(link.joint, |joint| joint.rotation = link.start);
            }
            return;
        }
        let mut config = config.clone();
        self.state.update_orientations(&mut config);
        for (index, link) in self.problem.links.iter().enumerate() {
            skeleton.write_local(link.joint, |joint| {
                joint.rotation = config.angles_near(&self.problem, index, joint.rotation);
            });
        }
    }

    fn set_targets(&mut self, targets: &[ChainTarget]) {
        if self.problem.free_roots {
            self.problem.approach(targets, &self.config.tips);
        } else {
            self.problem.set_targets(targets);
        }
        self.begin();
    }

    /// Begins to count iterations, and forgets earlier ones.
    fn begin(&mut self) {
        self.report.iterations = 0;
        self.measure();
        self.state.restart();
        self.escape.reset();
        self.stall.set_reference(&self.problem, &self.config);
    }

    /// Updates the error and the status of the report.
    fn measure(&mut self) {
        let error = self.config.error(&self.problem);
        let turn = self.config.orientation_error(&self.problem);
        (self.report.error, self.report.orientation_error) = (saturate(error), saturate(turn));
        let turned = if turn > 0.0 { turn * self.problem.turn_length_in_world() } else { 0.0 };
        self.report.status = if error.max(turned) <= self.tolerance {
            Status::Converged
        } else {
            self.used_up().unwrap_or(Status::Iterating)
        };
    }

    /// The status if no iterations are left.
    fn used_up(&self) -> Option<Status> {
        let is_over = |most: u32| self.report.iterations >= most;
        if is_over(self.options.max_iterations()) {
            Some(Status::OutOfIterations)
        } else {
            self.bound.is_some_and(is_over).then_some(Status::Bounded)
        }
    }

    /// Bends straight chains that no method can bend. Without any, the configuration keeps its
    /// bits.
    fn start(&mut self, recorder: &mut Recorder) {
        self.escape.best.copy_from(&self.config);
        if self.bend() {
            recorder.record(&self.config, || Event::Bend);
        } else {
            self.config.copy_from(&self.escape.best);
        }
    }

    /// Bends straight chains that no method can bend. Returns whether there was one.
    fn bend(&mut self) -> bool {
        let mut scratch = std::mem::take(&mut self.escape.scratch);
        let any =
            self.change_angles(|problem, config| perturb::bend(problem, config, &mut scratch));
        self.escape.scratch = scratch;
        any
    }

    /// True if the method may start from another pose than it has come to.
    fn can_escape(&self) -> bool {
        !self.report.method.is_closed_form() && !self.problem.free_roots
    }

    /// Changes the configuration's angles. If `change` returns `false`, nothing has changed but for
    /// rounding.
    fn change_angles(&mut self, change: impl FnOnce(&Problem, &mut Configuration) -> bool) -> bool {
        if !self.can_escape() {
            return false;
        }
        self.update_angles();
        let config = &mut self.config;
        if !config.orientations.is_empty() {
            config.forward(&self.problem);
        }
        let any = change(&self.problem, config);
        if any {
            config.renew_orientations();
        }
        any
    }

    /// Brings angles and orientations up to date with the points that the method moves.
    fn update_angles(&mut self) {
        self.state.update_orientations(&mut self.config);
        self.config.update_angles(&self.problem);
    }

    /// Returns to the best configuration so far and starts again from there in another way. If all
    /// ways have failed, the solver has stalled: another run from there would change nothing.
    fn escape_or_stall(&mut self) {
        if self.report.method.is_closed_form() {
            self.report.status = Status::Stalled;
            return;
        }
        self.escape.observe(&self.problem, &self.stall.reference);
        let can_go_on = self.escape();
        self.measure();
        self.stall.set_reference(&self.problem, &self.config);
        if !can_go_on && !self.report.converged() {
            self.report.status = Status::Stalled;
        }
    }

    /// Changes the best configuration so far in the next way that changes anything. Returns whether
    /// there was one.
    fn escape(&mut self) -> bool {
        loop {
            self.config.copy_from(&self.escape.best);
            let attempt = self.escape.attempts;
            self.escape.attempts += 1;
            let forgets = self.state.restart();
            let goes_on = match attempt {
                0 => self.bend() || forgets,
                _ if attempt <= perturb::starts_inside(&self.problem) => {
                    self.change_angles(|problem, config| {
                        perturb::leave_limits(problem, config, attempt - 1)
                    })
                }
                _ => return false,
            };
            if goes_on {
                return true;
            }
        }
    }
}

/// Checks that a method can move a centre of mass, and turn joints to orientations, if targets ask
/// for them.
fn check_method(method: Method, targets: &[ChainTarget]) -> Result<(), SolveError> {
    if !method.can_balance() && targets.iter().any(ChainTarget::is_of_mass) {
        return Err(SolveError::CannotBalance { method });
    }
    let refused = |target: &ChainTarget| {
        let reason = method.refusal_of(target)?;
        Some(SolveError::CannotOrient { method, joint: target.joint, reason })
    };
    targets.iter().find_map(refused).map_or(Ok(()), Err)
}

/// Checks that a method can turn joints to their orientations by the links above them.
fn check_hinges(
    method: Method,
    problem: &Problem,
    targets: &[ChainTarget],
) -> Result<(), SolveError> {
    let refused = |joint| SolveError::CannotOrient { method, joint, reason: OrientRefusal::Hinges };
    method::turned_by_hinges(method, problem, targets).map_or(Ok(()), |joint| Err(refused(joint)))
}

/// Checks that a method can give joints their stiffness.
fn check_stiffness(method: Method, problem: &Problem) -> Result<(), SolveError> {
    match method::too_stiff(method, problem) {
        Some(link) => Err(SolveError::CannotStiffen {
            method,
            joint: link.joint,
            per_angle: link.uniform_compliance().is_none() && method.row().respects_joints(),
        }),
        None => Ok(()),
    }
}

/// Solves a skeleton in place with a new [`ChainSolver`].
///
/// # Errors
///
/// See [`SolveError`].
pub fn solve(
    skeleton: &mut Skeleton,
    targets: &[ChainTarget],
    options: &SolverOptions,
) -> Result<Report, SolveError> {
    let mut solver = ChainSolver::new(skeleton, targets, options)?;
    let report = solver.run();
    solver.write(skeleton);
    Ok(report)
}
