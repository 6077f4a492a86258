use std::mem;

use super::residual_history::ResidualHistory;
use crate::document::SkeletonRig;
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{ChainSolver, Report, SolveError, SolverOptions, TipTarget};
use crate::kinematics::skeleton::Skeleton;

/// A solver run on the document's skeleton, which makes some iterations in every frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverRun {
    /// The skeleton before the first iteration.
    start: Shared<Skeleton>,
    solver: ChainSolver,
    options: SolverOptions,
    targets: Vec<TipTarget>,
    /// The skeleton after the latest iteration.
    written: Shared<Skeleton>,
    /// Number of iterations before the solver's latest restart, which follows a moved target or an
    /// edited joint.
    before: u32,
    history: ResidualHistory,
    pub(super) running: bool,
}

impl SolverRun {
    pub(super) fn new(rig: &SkeletonRig, time: f64) -> Result<Self, SolveError> {
        let targets = rig.targets_at(time);
        let solver = ChainSolver::new(&rig.skeleton, &targets, &rig.solver)?;
        let mut history = ResidualHistory::default();
        history.push(solver.report().error);
        Ok(Self {
            start: rig.skeleton.clone(),
            written: rig.skeleton.clone(),
            solver,
            options: rig.solver,
            targets,
            before: 0,
            history,
            running: false,
        })
    }

    /// Whether the run is not paused.
    pub fn is_running(&self) -> bool {
        self.running
    }

    /// Status and residual after the latest iteration, with the number of all iterations of the
    /// run.
    pub fn report(&self) -> Report {
        let report = self.solver.report();
        Report { iterations: self.before + report.iterations, ..report }
    }

    /// Residual before the first and after every iteration.
    pub fn history(&self) -> &ResidualHistory {
        &self.history
    }

    /// The skeleton before the first iteration.
    pub fn start(&self) -> &Skeleton {
        &self.start
    }

    /// Makes at most `iterations` iterations, fewer if the solver is done, and writes the pose into
    /// `rig`. `time` is the playhead in seconds.
    pub(super) fn advance(
        &mut self,
        rig: &mut SkeletonRig,
        time: f64,
        iterations: u32,
    ) -> Result<(), SolveError> {
        self.follow(rig, time)?;
        for _ in 0..iterations {
            if self.solver.is_over() {
                break;
            }
            let report = self.solver.step();
            self.history.push(report.error);
        }
        self.solver.write(rig.skeleton_mut());
        self.written = rig.skeleton.clone();
        Ok(())
    }

    /// Whether the solver makes no further iterations.
    pub(super) fn is_done(&self) -> bool {
        self.solver.is_over()
    }

    /// Whether the pose of `rig` is the result of the run's latest iteration, and its targets at
    /// `time` and the solver options have not changed since.
    pub(super) fn made(&self, rig: &SkeletonRig, time: f64) -> bool {
        rig.skeleton == self.written
            && rig.solver == self.options
            && rig.targets_at(time) == self.targets
    }

    /// Adopts changes of `rig` since the latest iteration: moves the targets, or restarts the
    /// solver if anything else has changed.
    fn follow(&mut self, rig: &SkeletonRig, time: f64) -> Result<(), SolveError> {
        let targets = rig.targets_at(time);
        let is_same = rig.solver == self.options && rig.skeleton == self.written;
        if !is_same || !only_points_differ(&targets, &self.targets) {
            let before = self.report().iterations;
            let restarted = Self::new(rig, time)?;
            let old = mem::replace(self, restarted);
            self.start = old.start;
            self.history = old.history;
            self.before = before;
            self.running = old.running;
        } else if targets != self.targets {
            self.before = self.report().iterations;
            self.solver.retarget(&targets)?;
            self.targets = targets;
        }
        Ok(())
    }
}

/// Whether the targets differ in nothing but their points, so that the solver can be retargeted.
fn only_points_differ(targets: &[TipTarget], others: &[TipTarget]) -> bool {
    let same = |(target, other): (&TipTarget, &TipTarget)| {
        target.joint == other.joint && target.weight.to_bits() == other.weight.to_bits()
    };
    targets.len() == others.len() && targets.iter().zip(others).all(same)
}
