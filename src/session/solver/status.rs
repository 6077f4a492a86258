use core::fmt;

use super::run::SolverRun;
use super::solvers::Solvers;
use crate::document::Posed;
use crate::kinematics::chain_ik::Status;

/// State and residual of the pose that is looked at: the shown iterate of the solver run, or
/// without a run the evaluated pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverStatus {
    /// State of the run or of the evaluated pose.
    pub state: SolverState,
    /// Largest distance from a tip to its enabled target, in world units.
    pub error: f32,
    /// Number of the shown iteration of the run; `None` without a run.
    pub iteration: Option<u32>,
}

/// State of a solver run, or of the evaluated pose in relation to its targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverState {
    /// All tips of the evaluated pose are within the tolerance of their targets, and all hands are
    /// turned as these ask.
    Reached,
    /// A tip of the evaluated pose is farther from its target, or a hand is turned otherwise.
    NotReached,
    /// The solver runs.
    Running,
    /// The run is paused.
    Paused,
    /// The shown iterate is not the latest of the run.
    Earlier,
    /// The run has ended.
    Ended(Status),
}

/// Writes the state in words, such as "running" or "converged".
impl fmt::Display for SolverState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reached => f.pad("reached"),
            Self::NotReached => f.pad("not reached"),
            Self::Running => f.pad("running"),
            Self::Paused => f.pad("paused"),
            Self::Earlier => f.pad("not converged yet"),
            Self::Ended(status) => status.fmt(f),
        }
    }
}

impl SolverStatus {
    fn of_run(run: &SolverRun) -> Self {
        let report = run.report();
        let state = match report.status {
            _ if run.is_running() => SolverState::Running,
            _ if run.shown().iteration < report.iterations => SolverState::Earlier,
            Status::Iterating => SolverState::Paused,
            status => SolverState::Ended(status),
        };
        let part = run.shown_part().and_then(|part| run.parts().get(part));
        let error = part.map_or(run.shown().error, |part| part.error);
        Self { state, error, iteration: Some(run.shown().iteration) }
    }
}

impl Solvers {
    /// State and residual of the shown iterate of the solver run, or without a run of a pose;
    /// `None` without an enabled target.
    pub fn status(&self, posed: &Posed) -> Option<SolverStatus> {
        if let Some(run) = self.run() {
            return Some(SolverStatus::of_run(run));
        }
        let (_, error) = farthest_target(posed)?;
        let rig = &posed.document().rig;
        let mut targets = rig.targets.iter().zip(posed.targets());
        let are_reached = targets.all(|(target, it)| !target.enabled || rig.is_reached(it));
        let state = if are_reached { SolverState::Reached } else { SolverState::NotReached };
        Some(SolverStatus { state, error, iteration: None })
    }
}

/// The enabled target of a pose that is farthest from its tip: its index in
/// [`SkeletonRig::targets`](crate::rig::SkeletonRig::targets), and the distance in world units.
pub(in crate::session) fn farthest_target(posed: &Posed) -> Option<(usize, f32)> {
    let targets = posed.document().rig.targets.iter().zip(posed.targets());
    let enabled = targets.enumerate().filter(|(_, (target, _))| target.enabled);
    let distances = enabled.map(|(index, (_, report))| (index, report.error));
    distances.max_by(|(_, one), (_, other)| one.total_cmp(other))
}
