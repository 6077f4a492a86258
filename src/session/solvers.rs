use super::comparison::Comparison;
use super::solver_run::SolverRun;
use crate::kinematics::skeleton::Skeleton;

/// The solver run and the comparison of solvers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Solvers {
    run: Option<SolverRun>,
    comparison: Option<Comparison>,
}

impl Solvers {
    pub fn run(&self) -> Option<&SolverRun> {
        self.run.as_ref()
    }

    pub fn comparison(&self) -> Option<&Comparison> {
        self.comparison.as_ref()
    }

    pub fn is_running(&self) -> bool {
        self.run.as_ref().is_some_and(SolverRun::is_running)
    }

    /// Whether a run or the comparison makes iterations.
    pub fn is_busy(&self) -> bool {
        self.is_running() || self.comparison.as_ref().is_some_and(Comparison::is_running)
    }

    pub fn set_run(&mut self, run: SolverRun) {
        self.run = Some(run);
    }

    pub fn take_run(&mut self) -> Option<SolverRun> {
        self.run.take()
    }

    pub fn forget_run(&mut self) {
        self.run = None;
    }

    /// Pauses the run.
    pub fn pause(&mut self) {
        if let Some(run) = &mut self.run {
            run.running = false;
        }
    }

    pub fn compare(&mut self, comparison: Comparison) {
        self.comparison = Some(comparison);
    }

    pub fn end_comparison(&mut self) {
        self.comparison = None;
    }

    /// Ends the comparison unless it began with the hierarchy of `skeleton`.
    pub fn keep_comparison_of(&mut self, skeleton: &Skeleton) {
        self.comparison.take_if(|comparison| !comparison.is_of(skeleton));
    }

    pub fn advance_comparison(&mut self) {
        if let Some(comparison) = &mut self.comparison {
            comparison.advance();
        }
    }

    pub fn forget(&mut self) {
        *self = Self::default();
    }
}
