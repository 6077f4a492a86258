use std::time::{Duration, Instant};

use super::solver_run::ResidualHistory;
use crate::document::SkeletonRig;
use crate::kinematics::chain_ik::{ChainSolver, Method, Report, SolveError, SolverOptions};
use crate::kinematics::skeleton::Skeleton;

/// Every solver from the same start to the same targets.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    solvers: Vec<ComparedSolver>,
}

/// One solver in a race.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedSolver {
    pub method: Method,
    /// The skeleton as this solver has it by now.
    pub skeleton: Skeleton,
    pub history: ResidualHistory,
    /// What the iterations took.
    pub time: Duration,
    solve: Result<ChainSolver, SolveError>,
}

impl Comparison {
    pub(super) fn new(rig: &SkeletonRig, time: f64) -> Self {
        let goals = rig.targets_at(time);
        let solvers = Method::ALL.into_iter().map(|method| {
            let options = SolverOptions { method, iterations: None, ..rig.solver };
            let solve = ChainSolver::new(&rig.skeleton, &goals, &options);
            let mut history = ResidualHistory::default();
            if let Ok(solve) = &solve {
                history.push(solve.report().error);
            }
            ComparedSolver {
                method,
                skeleton: Skeleton::clone(&rig.skeleton),
                history,
                time: Duration::ZERO,
                solve,
            }
        });
        Self { solvers: solvers.collect() }
    }

    pub fn solvers(&self) -> &[ComparedSolver] {
        &self.solvers
    }

    /// Whether any solver still runs.
    pub fn is_running(&self) -> bool {
        self.solvers.iter().any(ComparedSolver::is_running)
    }

    /// Whether the joints are still those that it began with, turned or not.
    pub(super) fn is_of(&self, skeleton: &Skeleton) -> bool {
        let is_like = |solver: &ComparedSolver| {
            let parents = |skeleton: &Skeleton| -> Vec<_> {
                skeleton.joints().iter().map(|joint| joint.parent).collect()
            };
            parents(&solver.skeleton) == parents(skeleton)
        };
        self.solvers.first().is_none_or(is_like)
    }

    /// Lets every solver run on: ever faster, so that the start can be watched and the end comes.
    pub(super) fn advance(&mut self) {
        self.solvers.iter_mut().for_each(ComparedSolver::advance);
    }
}

impl ComparedSolver {
    /// A running solver makes this part of the iterations that it has made, and at least one.
    const PACE: u32 = 8;

    /// How it stands, or why it does not run.
    pub fn report(&self) -> Result<Report, &SolveError> {
        self.solve.as_ref().map(ChainSolver::report)
    }

    pub fn is_running(&self) -> bool {
        self.solve.as_ref().is_ok_and(|solve| !solve.is_over())
    }

    fn advance(&mut self) {
        let done = self.report().map_or(0, |report| report.iterations);
        let started = Instant::now();
        for _ in 0..(done / Self::PACE).max(1) {
            if !self.is_running() {
                break;
            }
            if let Ok(solve) = &mut self.solve {
                self.history.push(solve.step().error);
            }
        }
        self.time += started.elapsed();
        if let Ok(solve) = &self.solve {
            solve.write(&mut self.skeleton);
        }
    }
}
