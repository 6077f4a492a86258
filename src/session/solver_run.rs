use std::time::{Duration, Instant};

use super::iterates::{Iterate, Iterates};
use super::solver_inputs::SolverInputs;
use crate::kinematics::chain_ik::{ChainSolver, Method, Report, SolveError, TipTarget};
use crate::kinematics::skeleton::Skeleton;

/// A view on a solve: a solver runs on a copy of the FK pose, every iterate is kept, and one of them
/// is shown. The document does not change.
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
    /// The skeleton in the shown iterate.
    skeleton: Skeleton,
    running: bool,
    elapsed: Duration,
}

impl SolverRun {
    /// Maximum number of iterations that are made anew when the inputs change.
    const MOST_ANEW: u32 = 1000;

    pub(super) fn new(inputs: SolverInputs) -> Result<Self, SolveError> {
        let solver = ChainSolver::new(&inputs.fk, &inputs.targets, &inputs.options)?;
        let skeleton = Skeleton::clone(&inputs.fk);
        Ok(Self {
            inputs,
            wanted: Some(0),
            iterates: Iterates::new(Iterate::new(solver.report(), &skeleton)),
            solver,
            held: None,
            skeleton,
            running: false,
            elapsed: Duration::ZERO,
        })
    }

    /// The same run with other inputs: it makes as many iterations and shows the same one.
    pub(super) fn anew(&self, inputs: SolverInputs) -> Result<Self, SolveError> {
        let mut anew = Self::new(inputs)?;
        (anew.wanted, anew.held, anew.running) = (self.wanted, self.held, self.running);
        anew.make_wanted(Self::MOST_ANEW);
        Ok(anew)
    }

    pub(super) fn inputs(&self) -> &SolverInputs {
        &self.inputs
    }

    /// The method of the solver.
    pub fn method(&self) -> Method {
        self.inputs.options.method
    }

    /// The targets that are solved for.
    pub fn targets(&self) -> &[TipTarget] {
        &self.inputs.targets
    }

    /// Whether the run is not paused.
    pub fn is_running(&self) -> bool {
        self.running
    }

    /// Whether the solver makes no further iterations.
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

    /// The skeleton in the shown iterate.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Shows the latest kept iterate of at most `held` iterations; for `None`, each iterate as it is
    /// made.
    pub(super) fn hold(&mut self, held: Option<u32>) {
        self.held = held;
        self.iterates.at(held.unwrap_or(u32::MAX)).write(&mut self.skeleton);
    }

    /// Starts or pauses the run.
    pub(super) fn set_running(&mut self, running: bool) {
        self.running = running;
    }

    /// Pauses a run that is over. From now on, other inputs are solved until the solver ends.
    pub(super) fn finish(&mut self) {
        self.running = false;
        self.wanted = None;
    }

    /// Makes `iterations` further iterations, fewer if the solver ends.
    pub(super) fn advance(&mut self, iterations: u32) {
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
