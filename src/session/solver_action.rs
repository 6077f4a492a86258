/// Runs solvers. What a run changes is one undo step.
#[derive(Clone, Debug, PartialEq)]
pub enum SolverAction {
    /// Starts or pauses the solver.
    Run(bool),
    /// Stops the solver and restores the pose from before the run.
    Cancel,
    /// Runs all solvers beside each other from the present pose, or ends that.
    Compare(bool),
    /// Solves, or does not, while a target is dragged.
    SetFollow(bool),
}
