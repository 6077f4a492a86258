use std::time::{Duration, Instant};

use super::residual_history::ResidualHistory;
use crate::document::SkeletonRig;
use crate::kinematics::chain_ik::{ChainSolver, Method, Report, SolveError, SolverOptions};
use crate::kinematics::skeleton::Skeleton;

/// A comparison of all solvers, run side by side from the same pose to the same targets.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    solvers: Vec<ComparedSolver>,
}

/// One solver of a [`Comparison`].
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedSolver {
    /// The solver.
    pub method: Method,
    /// The skeleton after the latest iteration.
    pub skeleton: Skeleton,
    /// Residual error before the first and after every iteration.
    pub history: ResidualHistory,
    /// Total duration of all iterations.
    pub elapsed: Duration,
    solver: Result<ChainSolver, SolveError>,
}

impl Comparison {
    pub(super) fn new(rig: &SkeletonRig, time: f64) -> Self {
        let targets = rig.targets_at(time);
        let solvers = Method::ALL.into_iter().map(|method| {
            let options = SolverOptions { method, iterations: None, ..rig.solver };
            let solver = ChainSolver::new(&rig.skeleton, &targets, &options);
            let mut history = ResidualHistory::default();
            if let Ok(solver) = &solver {
                history.push(solver.report().error);
            }
            ComparedSolver {
                method,
                skeleton: Skeleton::clone(&rig.skeleton),
                history,
                elapsed: Duration::ZERO,
                solver,
            }
        });
        Self { solvers: solvers.collect() }
    }

    /// The solvers, in the order of [`Method::ALL`].
    pub fn solvers(&self) -> &[ComparedSolver] {
        &self.solvers
    }

    /// Whether any solver makes further iterations.
    pub fn is_running(&self) -> bool {
        self.solvers.iter().any(ComparedSolver::is_running)
    }

    /// Whether `skeleton` has the hierarchy with which the comparison began, in any pose.
    pub(super) fn is_of(&self, skeleton: &Skeleton) -> bool {
        let is_like = |solver: &ComparedSolver| {
            let parents = |skeleton: &Skeleton| -> Vec<_> {
                skeleton.joints().iter().map(|joint| joint.parent).collect()
            };
            parents(&solver.skeleton) == parents(skeleton)
        };
        self.solvers.first().is_none_or(is_like)
    }

    /// Makes one frame's iterations with every solver: at first one iteration, later an eighth of
    /// the number made before.
    pub(super) fn advance(&mut self) {
        self.solvers.iter_mut().for_each(ComparedSolver::advance);
    }
}

impl ComparedSolver {
    /// A frame makes one iteration for every `PACE` iterations made before, and at least one.
    const PACE: u32 = 8;

    /// Progress after the latest iteration.
    ///
    /// # Errors
    ///
    /// If the solver cannot solve for these targets.
    pub fn report(&self) -> Result<Report, &SolveError> {
        self.solver.as_ref().map(ChainSolver::report)
    }

    /// Whether the solver makes further iterations.
    pub fn is_running(&self) -> bool {
        self.solver.as_ref().is_ok_and(|solver| !solver.is_over())
    }

    fn advance(&mut self) {
        let done = self.report().map_or(0, |report| report.iterations);
        let started = Instant::now();
        for _ in 0..(done / Self::PACE).max(1) {
            if !self.is_running() {
                break;
            }
            if let Ok(solver) = &mut self.solver {
                self.history.push(solver.step().error);
            }
        }
        self.elapsed += started.elapsed();
        if let Ok(solver) = &self.solver {
            solver.write(&mut self.skeleton);
        }
    }
}
