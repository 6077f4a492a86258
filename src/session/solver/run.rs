use std::time::Duration;

use crate::document::Posed;
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{
    ChainSolver, ChainTarget, Method, Report, SolveError, SolverOptions, SubStep,
};
use crate::kinematics::skeleton::{Skeleton, SkeletonPose};
use crate::session::solver::iterates::{Inside, Iterate, Iterates};
use web_time::Instant;

/// Inputs of a solver run: the FK pose, the start, the targets and the options of a document at a
/// time.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::session) struct SolverInputs {
    pub fk: Shared<Skeleton>,
    /// The pose with which the run starts: the FK pose, or that of the motion's step before.
    pub start: Shared<Skeleton>,
    pub targets: Vec<ChainTarget>,
    pub options: SolverOptions,
}

impl SolverInputs {
    /// The inputs of a pose. The run starts from the pose from which the motion continues; from the
    /// FK pose if there is none, or if `from_fk`.
    ///
    /// # Errors
    ///
    /// The reason why there is nothing to solve.
    pub fn of(posed: &Posed, from_fk: bool) -> Result<Self, &'static str> {
        let (rig, time) = (&posed.document().rig, posed.time());
        let targets = rig.targets_at(time);
        if targets.iter().any(|target| rig.is_joint_on_path(target.joint, time)) {
            return Err("A chain that follows a path has nothing to solve");
        }
        if targets.is_empty() {
            return Err("There is no target to solve for; add one to a joint");
        }
        let fk = rig.fk_at(time);
        let carried = posed.carried().filter(|_| !from_fk);
        let start = carried.and_then(|carried| carried.body_pose(&fk)).map(Shared::from);
        Ok(Self { start: start.unwrap_or_else(|| fk.clone()), fk, targets, options: rig.solver })
    }

    /// A solver with the bound of a pose, so that the window stays responsive.
    pub fn solver(&self) -> Result<ChainSolver, SolveError> {
        let Self { fk, start, targets, options } = self;
        let mut solver = ChainSolver::bounded(fk, targets, options, ChainSolver::POSE_WORK)?;
        if start != fk {
            solver.begin_from(start);
        }
        Ok(solver)
    }
}

/// A view on a solve: a solver runs on a copy of the pose, every iterate is kept, and one of
/// them is shown. The document does not change.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverRun {
    inputs: SolverInputs,
    solver: ChainSolver,
    /// Number of iterations to make, unless the solver ends before; `None` for as many as until the
    /// solver ends.
    wanted: Option<u32>,
    iterates: Iterates,
    /// Number of the iteration to show; `None` for the latest.
    held: Option<u32>,
    inside: Inside,
    /// The skeleton in the shown iterate, or in the shown part of its iteration.
    skeleton: Skeleton,
    /// The pose before the shown part, in world space.
    before: Shared<SkeletonPose>,
    running: bool,
    elapsed: Duration,
}

impl SolverRun {
    /// Maximum number of iterations that are made anew when the inputs change.
    const MOST_ANEW: u32 = 1000;

    pub(in crate::session) fn new(inputs: SolverInputs) -> Result<Self, SolveError> {
        let solver = inputs.solver()?;
        let skeleton = Skeleton::clone(&inputs.start);
        Ok(Self {
            inputs,
            wanted: Some(0),
            iterates: Iterates::new(Iterate::new(solver.report(), &skeleton)),
            solver,
            held: None,
            inside: Inside::default(),
            before: Shared::from(skeleton.pose()),
            skeleton,
            running: false,
            elapsed: Duration::ZERO,
        })
    }

    /// The same run with other inputs: it makes as many iterations and shows the same one.
    pub(in crate::session) fn anew(&self, inputs: SolverInputs) -> Result<Self, SolveError> {
        let mut anew = Self::new(inputs)?;
        (anew.wanted, anew.held, anew.running) = (self.wanted, self.held, self.running);
        anew.make_wanted(Self::MOST_ANEW);
        anew.inside.walk(self.inside.is_walking());
        anew.show_part(self.inside.part());
        Ok(anew)
    }

    pub(in crate::session) fn inputs(&self) -> &SolverInputs {
        &self.inputs
    }

    /// The method of the solver.
    pub fn method(&self) -> Method {
        self.inputs.options.method
    }

    /// The targets that are solved for.
    pub fn targets(&self) -> &[ChainTarget] {
        &self.inputs.targets
    }

    /// True if the run is not paused.
    pub fn is_running(&self) -> bool {
        self.running
    }

    /// True if the solver makes no further iterations.
    pub fn is_over(&self) -> bool {
        self.solver.is_over()
    }

    /// Status and residual after the latest iteration.
    pub fn report(&self) -> Report {
        self.solver.report()
    }

    /// Total duration of all iterations.
    pub fn elapsed(&self) -> Duration {
        self.elapsed
    }

    /// The kept iterates.
    pub fn iterates(&self) -> &Iterates {
        &self.iterates
    }

    /// The shown iterate.
    pub fn shown(&self) -> &Iterate {
        self.iterates.at(self.held.unwrap_or(u32::MAX))
    }

    /// The skeleton in the shown iterate, or in the shown part of its iteration.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Shows the latest kept iterate of at most `held` iterations; for `None`, each iterate as it
    /// is made.
    pub(in crate::session) fn hold(&mut self, held: Option<u32>) {
        self.held = held;
        self.inside.clear();
        self.write_shown();
    }

    /// The parts of the shown iteration, in the order in which the method computes them; empty for
    /// iteration 0.
    pub fn parts(&self) -> &[Shared<SubStep>] {
        self.inside.parts(|| self.replay(self.shown().iteration))
    }

    /// Index of the part of the shown iteration that is looked at; `None` if the whole iteration is
    /// shown, or while the run goes on.
    pub fn shown_part(&self) -> Option<usize> {
        let part = self.inside.part().filter(|_| !self.running)?;
        Some(part.min(self.parts().len().checked_sub(1)?))
    }

    /// The pose before the shown part, in world space; of no meaning without one.
    pub(in crate::session) fn before_part(&self) -> &Shared<SkeletonPose> {
        &self.before
    }

    /// True if the parts of all iterations are shown one after the other.
    pub fn is_walking(&self) -> bool {
        self.inside.is_walking()
    }

    /// Makes an iteration again and returns its parts.
    fn replay(&self, iteration: u32) -> Vec<SubStep> {
        let solver = self.inputs.solver();
        let (Ok(mut solver), Some(before)) = (solver, iteration.checked_sub(1)) else {
            return Vec::new();
        };
        for _ in 0..before {
            solver.step();
        }
        solver.step_inside(&self.inputs.start).1
    }

    /// Looks at a part of the shown iteration, or at its last one if it has fewer; for `None`, at
    /// the whole iteration.
    pub(in crate::session) fn show_part(&mut self, part: Option<usize>) {
        self.inside.show(part);
        self.write_shown();
    }

    /// Shows the parts of all iterations one after the other, from the shown one on, or stops that.
    pub(in crate::session) fn walk(&mut self, walks: bool) {
        if walks {
            self.running = false;
            self.show_part(self.inside.part().or(Some(0)));
        }
        self.inside.walk(walks);
    }

    /// Lets time pass, in seconds, while the parts are shown one after the other.
    pub(in crate::session) fn advance_walk(&mut self, passed: f64) {
        if self.is_walking() && self.inside.advance(passed, self.parts().len()) {
            self.next_part();
        }
    }

    /// Shows the next part; after the last part of an iteration, the first one of the next, which
    /// is made if need be. At the end of the run, the parts no longer follow each other.
    fn next_part(&mut self) {
        let next = self.shown_part().map_or(0, |part| part + 1);
        if next < self.parts().len() {
            return self.show_part(Some(next));
        }
        let iteration = self.shown().iteration;
        if self.iterates.after(iteration).is_none() {
            self.advance(1);
        }
        match self.iterates.after(iteration).map(|after| after.iteration) {
            Some(after) => {
                self.hold(Some(after));
                self.show_part(Some(0));
            }
            None => self.inside.walk(false),
        }
    }

    /// Writes the shown iterate, or the shown part of its iteration, to the skeleton.
    fn write_shown(&mut self) {
        match self.shown_part() {
            Some(part) => {
                self.before = Shared::from(self.pose_before(part));
                self.skeleton = self.parts()[part].pose.clone();
            }
            None => self.iterates.at(self.held.unwrap_or(u32::MAX)).write(&mut self.skeleton),
        }
    }

    fn pose_before(&self, part: usize) -> SkeletonPose {
        let Some(previous) = part.checked_sub(1) else {
            let mut skeleton = Skeleton::clone(&self.inputs.start);
            self.iterates.at(self.shown().iteration.saturating_sub(1)).write(&mut skeleton);
            return skeleton.pose();
        };
        self.parts()[previous].pose.pose()
    }

    /// Starts or pauses the run.
    pub(in crate::session) fn set_running(&mut self, running: bool) {
        self.running = running;
        if running {
            self.inside.walk(false);
        }
        self.write_shown();
    }

    /// Pauses a run that is over. From now on, other inputs are solved until the solver ends.
    pub(in crate::session) fn finish(&mut self) {
        self.running = false;
        self.wanted = None;
        self.write_shown();
    }

    /// Makes `iterations` further iterations, fewer if the solver ends.
    pub(in crate::session) fn advance(&mut self, iterations: u32) {
        if !self.is_over() {
            self.wanted = Some(self.report().iterations.saturating_add(iterations));
            self.make_wanted(iterations);
        }
    }

    /// Makes the wanted iterations that are left, at most `most` of them.
    fn make_wanted(&mut self, most: u32) {
        let end =
            self.report().iterations.saturating_add(most).min(self.wanted.unwrap_or(u32::MAX));
        while !self.solver.is_over() && self.report().iterations < end {
            self.make_one();
        }
        self.hold(self.held);
    }

    /// Makes one iteration and keeps it, with the angles nearest to those of the FK pose.
    fn make_one(&mut self) {
        let started = Instant::now();
        let report = self.solver.step();
        self.elapsed += started.elapsed();
        self.iterates.at(0).write(&mut self.skeleton);
        self.solver.write(&mut self.skeleton);
        self.iterates.push(Iterate::new(report, &self.skeleton));
    }
}

/// A comparison of all solvers, run side by side from one start to the same targets. Like a
/// single [`SolverRun`], it does not change the document.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    inputs: SolverInputs,
    solvers: Vec<ComparedSolver>,
}

/// One solver of a [`Comparison`].
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedSolver {
    /// The solver.
    pub method: Method,
    /// The solver's run, or the error if it cannot solve for the targets.
    pub run: Result<SolverRun, SolveError>,
}

impl Comparison {
    pub(in crate::session) fn new(inputs: SolverInputs) -> Self {
        let solver = |method| {
            let run = SolverRun::new(with_method(&inputs, method));
            ComparedSolver { method, run }
        };
        Self { solvers: Method::ALL.into_iter().map(solver).collect(), inputs }
    }

    /// The same comparison with other inputs: the solvers make as many iterations and show the same
    /// one.
    pub(in crate::session) fn anew(&self, inputs: SolverInputs) -> Self {
        let anew = |solver: &ComparedSolver| {
            let inputs = with_method(&inputs, solver.method);
            let run = match &solver.run {
                Ok(run) => run.anew(inputs),
                Err(_) => SolverRun::new(inputs),
            };
            ComparedSolver { method: solver.method, run }
        };
        Self { solvers: self.solvers.iter().map(anew).collect(), inputs }
    }

    pub(in crate::session) fn inputs(&self) -> &SolverInputs {
        &self.inputs
    }

    /// The solvers, in the order of [`Method::ALL`].
    pub fn solvers(&self) -> &[ComparedSolver] {
        &self.solvers
    }

    /// The runs of all solvers that can solve for the targets.
    pub fn runs(&self) -> impl Iterator<Item = &SolverRun> + Clone {
        self.solvers.iter().filter_map(|solver| solver.run.as_ref().ok())
    }

    fn runs_mut(&mut self) -> impl Iterator<Item = &mut SolverRun> {
        self.solvers.iter_mut().filter_map(|solver| solver.run.as_mut().ok())
    }

    /// True if any solver makes further iterations.
    pub fn is_running(&self) -> bool {
        self.runs().any(|run| !run.is_over())
    }

    /// Shows the same iteration of all solvers, of a solver with fewer its latest; for `None`, each
    /// iterate as it is made.
    pub(in crate::session) fn hold(&mut self, held: Option<u32>) {
        self.runs_mut().for_each(|run| run.hold(held));
    }

    /// Makes one frame's iterations with every solver: at first one iteration, later an eighth of
    /// the number made before.
    pub(in crate::session) fn advance(&mut self) {
        const PACE: u32 = 8;
        for run in self.runs_mut() {
            run.advance((run.report().iterations / PACE).max(1));
            if run.is_over() {
                run.finish();
            }
        }
    }
}

/// The inputs with another method and its own maximum number of iterations.
fn with_method(inputs: &SolverInputs, method: Method) -> SolverInputs {
    let options = SolverOptions { method, iterations: None, ..inputs.options };
    SolverInputs { options, ..inputs.clone() }
}

/// The shown iteration of a solver run or of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownIteration {
    /// Number of the shown iteration: 0 is the start.
    pub number: u32,
    /// Number of the latest iteration.
    pub latest: u32,
    /// Number of the iteration that is kept before the shown one; `None` at the first.
    pub previous: Option<u32>,
    /// Number of the iteration that is kept after the shown one; `None` at the latest.
    pub next: Option<u32>,
}

impl ShownIteration {
    /// The greatest iteration that any of the runs shows; `None` without runs.
    pub(in crate::session) fn of<'a>(
        runs: impl Iterator<Item = &'a SolverRun> + Clone,
    ) -> Option<Self> {
        let number = runs.clone().map(|run| run.shown().iteration).max()?;
        let all = runs.map(SolverRun::iterates);
        let before = |before| all.clone().map(|iterates| iterates.at(before).iteration).max();
        Some(Self {
            number,
            latest: before(u32::MAX)?,
            previous: number.checked_sub(1).and_then(before),
            next: all.filter_map(|iterates| Some(iterates.after(number)?.iteration)).min(),
        })
    }
}
