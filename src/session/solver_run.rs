use std::mem;

use crate::document::SkeletonRig;
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{ChainSolver, Report, SolveError, SolverOptions, TipTarget};
use crate::kinematics::skeleton::Skeleton;

/// A solver at work on the document's skeleton, one or some iterations at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverRun {
    /// The skeleton before the first iteration.
    start: Shared<Skeleton>,
    solve: ChainSolver,
    options: SolverOptions,
    goals: Vec<TipTarget>,
    /// The skeleton as the last iteration left it.
    written: Shared<Skeleton>,
    /// Iterations before the targets moved last, or somebody else turned a joint.
    before: u32,
    history: ResidualHistory,
    pub(super) running: bool,
}

/// The error after every iteration, the first ones forgotten when there are too many.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResidualHistory {
    forgotten: usize,
    errors: Vec<f32>,
}

impl ResidualHistory {
    const MOST: usize = 4096;

    pub(super) fn push(&mut self, error: f32) {
        if self.errors.len() >= Self::MOST {
            let half = Self::MOST / 2;
            self.errors.drain(..half);
            self.forgotten += half;
        }
        self.errors.push(error);
    }

    /// Iteration and error.
    pub fn points(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.errors.iter().enumerate().map(|(index, error)| (self.forgotten + index, *error))
    }
}

impl SolverRun {
    pub(super) fn new(rig: &SkeletonRig, time: f64) -> Result<Self, SolveError> {
        let goals = rig.targets_at(time);
        let solve = ChainSolver::new(&rig.skeleton, &goals, &rig.solver)?;
        let mut history = ResidualHistory::default();
        history.push(solve.report().error);
        Ok(Self {
            start: rig.skeleton.clone(),
            written: rig.skeleton.clone(),
            solve,
            options: rig.solver,
            goals,
            before: 0,
            history,
            running: false,
        })
    }

    pub fn is_running(&self) -> bool {
        self.running
    }

    pub fn report(&self) -> Report {
        let report = self.solve.report();
        Report { iterations: self.before + report.iterations, ..report }
    }

    pub fn history(&self) -> &ResidualHistory {
        &self.history
    }

    /// The skeleton before the first iteration.
    pub fn start(&self) -> &Skeleton {
        &self.start
    }

    /// Makes up to `iterations`, and none when there is nothing left to do.
    pub(super) fn advance(
        &mut self,
        rig: &mut SkeletonRig,
        time: f64,
        iterations: u32,
    ) -> Result<(), SolveError> {
        self.keep_up(rig, time)?;
        for _ in 0..iterations {
            if self.solve.is_over() {
                break;
            }
            let report = self.solve.step();
            self.history.push(report.error);
        }
        self.solve.write(rig.skeleton_mut());
        self.written = rig.skeleton.clone();
        Ok(())
    }

    /// Whether another iteration would be in vain.
    pub(super) fn is_done(&self) -> bool {
        self.solve.is_over()
    }

    /// Whether its last iteration led to this pose, with the targets and options that it has now.
    pub(super) fn led_to(&self, rig: &SkeletonRig, time: f64) -> bool {
        rig.skeleton == self.written
            && rig.solver == self.options
            && rig.targets_at(time) == self.goals
    }

    /// Follows what has changed since the last iteration.
    fn keep_up(&mut self, rig: &SkeletonRig, time: f64) -> Result<(), SolveError> {
        let goals = rig.targets_at(time);
        let is_same = rig.solver == self.options && rig.skeleton == self.written;
        if !is_same || !only_points_differ(&goals, &self.goals) {
            let before = self.report().iterations;
            let anew = Self::new(rig, time)?;
            let old = mem::replace(self, anew);
            self.start = old.start;
            self.history = old.history;
            self.before = before;
            self.running = old.running;
        } else if goals != self.goals {
            self.before = self.report().iterations;
            self.solve.retarget(&goals)?;
            self.goals = goals;
        }
        Ok(())
    }
}

/// Whether a solve for some goals can be aimed at others.
fn only_points_differ(goals: &[TipTarget], others: &[TipTarget]) -> bool {
    let same = |(goal, other): (&TipTarget, &TipTarget)| {
        goal.joint == other.joint && goal.weight.to_bits() == other.weight.to_bits()
    };
    goals.len() == others.len() && goals.iter().zip(others).all(same)
}
