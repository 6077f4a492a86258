use core::fmt;

use super::session::Session;
use crate::kinematics::chain_ik::{Report, Status};

/// State and residual of the shown pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverStatus {
    /// The state.
    pub state: SolverState,
    /// The residual of the shown pose. Iterations are those of the run that made it, else 0.
    pub report: Report,
}

/// State of the shown pose in relation to its targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverState {
    /// No run made this pose, or it was edited since.
    NotSolved,
    /// The solver runs.
    Running,
    /// The run is paused.
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
    /// State and residual of the shown pose; `None` without an enabled target or for a skeleton on a
    /// path.
    pub fn solver_status(&self) -> Option<SolverStatus> {
        let rig = self.skeleton_rig();
        if rig.follow_path.is_some() || rig.targets_at(self.time()).is_empty() {
            return None;
        }
        let run = self.solver_run().filter(|run| run.made(rig, self.time()));
        let report = match run {
            Some(run) => run.report(),
            None => self.evaluated.unsolved_report(rig, self.time())?,
        };
        let state = match run {
            _ if self.is_running() => SolverState::Running,
            _ if report.converged() => SolverState::Ended(report.status),
            Some(_) if report.status != Status::Iterating => SolverState::Ended(report.status),
            Some(_) if report.iterations > 0 => SolverState::Paused,
            _ => SolverState::NotSolved,
        };
        Some(SolverStatus { state, report })
    }
}
