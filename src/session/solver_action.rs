/// Runs and compares solvers on copies of the FK pose; the document does not change.
#[derive(Clone, Debug, PartialEq)]
pub enum SolverAction {
    /// Starts or pauses the solver.
    Run(bool),
    /// Makes one iteration and pauses.
    Step,
    /// Starts a comparison of all solvers.
    Compare,
    /// Ends the run or the comparison.
    Reset,
    /// Shows the latest kept iterate of at most this number of iterations: 0 is the FK pose. From the
    /// number of the latest on, each iterate is shown as it is made.
    Show(u32),
}
