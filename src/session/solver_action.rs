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
    /// Shows a part of an iteration of the solver run; `None` shows the whole iteration.
    ShowPart {
        /// Number of the iteration.
        iteration: u32,
        /// Index of the part.
        part: Option<usize>,
    },
    /// Shows the parts of the iterations one after the other, or stops that.
    Walk(bool),
    /// Shows the latest kept iterate of at most this number of iterations: 0 is the FK pose. From the
    /// number of the latest on, each iterate is shown as it is made.
    Show(u32),
}
