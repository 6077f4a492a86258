use super::session::Session;
use super::solver_run::SolverRun;
use crate::kinematics::chain_ik::{Report, SolveError};

/// How the pose that is shown stands to its targets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverStatus {
    pub state: SolverState,
    /// Of the pose that is shown; its iterations are those of the run that led to it, else 0.
    pub report: Report,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverState {
    /// Every tip is within the tolerance of its target, whoever brought it there.
    Converged,
    Running,
    /// Further iterations would change nothing.
    Stalled,
    /// The iterations are used up.
    OutOfIterations,
    Paused,
    /// No run led to this pose: there was none, or something was changed since.
    NotSolved,
}

impl SolverState {
    pub fn describe(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Running => "running",
            Self::Stalled => "stalled",
            Self::OutOfIterations => "out of iterations",
            Self::Paused => "paused",
            Self::NotSolved => "not solved yet",
        }
    }
}

impl Session {
    /// State and residual of the pose that is shown; `None` without an enabled target.
    pub fn solver_status(&self) -> Option<SolverStatus> {
        let rig = self.skeleton_rig();
        if rig.follow_path.is_some() || rig.targets_at(self.time()).is_empty() {
            return None;
        }
        let run = self.solver_run();
        let current = run.filter(|run| run.led_to(rig, self.time()));
        let fresh =
            || -> Result<Report, SolveError> { Ok(SolverRun::new(rig, self.time())?.report()) };
        let report = current.map_or_else(fresh, |run| Ok(run.report())).ok()?;
        let state = match current {
            _ if self.is_running() => SolverState::Running,
            _ if report.converged => SolverState::Converged,
            Some(_) if report.resting => SolverState::Stalled,
            Some(run) if run.is_spent() => SolverState::OutOfIterations,
            Some(_) if report.iterations > 0 => SolverState::Paused,
            _ => SolverState::NotSolved,
        };
        Some(SolverStatus { state, report })
    }
}
