/// Runs solvers. All changes of a run are one undo step.
#[derive(Clone, Debug, PartialEq)]
pub enum SolverAction {
    /// Starts or pauses the solver.
    Run(bool),
    /// Stops the solver and restores the pose from before the run.
    Cancel,
    /// Starts or ends a comparison of all solvers from the present pose.
    Compare(bool),
    /// Sets whether the skeleton is solved while a target is dragged.
    SetFollow(bool),
}
