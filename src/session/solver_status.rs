use core::fmt;

use super::session::Session;
use crate::kinematics::chain_ik::{Report, Status};

/// State and residual of the shown pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverStatus {
    /// State of the pose in relation to its targets.
    pub state: SolverState,
    /// Residual of the shown pose, with the number of iterations of the run that made it; 0 if no
    /// run did.
    pub report: Report,
}

/// State of the shown pose in relation to its targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverState {
    /// No solver run made the pose, or the pose was edited since.
    NotSolved,
    /// The solver runs.
    Running,
    /// The run is paused.
    Paused,
    /// The run has ended, or all tips are within the tolerance without a run.
    Ended(Status),
}

/// Writes the state in words, such as "running" or "converged".
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
    /// State and residual of the shown pose; `None` without an enabled target, for a skeleton that
    /// follows a path, or if the solver cannot solve for the targets.
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
