use core::fmt;

use super::session::Session;
use super::solver_run::SolverRun;
use crate::kinematics::chain_ik::{Report, SolveError, Status};

/// How the pose that is shown stands to its targets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverStatus {
    pub state: SolverState,
    /// Of the pose that is shown; its iterations are those of the run that led to it, else 0.
    pub report: Report,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverState {
    /// No run led to this pose: there was none, or something was changed since.
    NotSolved,
    Running,
    Paused,
    /// The run has ended, or all tips are within the tolerance without a run.
    Ended(Status),
}

/// In words, such as "running" or "converged".
impl fmt::Display for SolverState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotSolved => f.pad("not solved yet"),
            Self::Running => f.pad("running"),
            Self::Paused => f.pad("paused"),
            Self::Ended(status) => status.fmt(f),
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
            _ if report.converged() => SolverState::Ended(report.status),
            Some(_) if report.status != Status::Iterating => SolverState::Ended(report.status),
            Some(_) if report.iterations > 0 => SolverState::Paused,
            _ => SolverState::NotSolved,
        };
        Some(SolverStatus { state, report })
    }
}
