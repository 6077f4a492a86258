use super::solver_inputs::SolverInputs;
use super::solver_run::SolverRun;
use crate::kinematics::chain_ik::{Method, SolveError, SolverOptions};

/// A comparison of all solvers, run side by side from the FK pose to the same targets. Like a single
/// [`SolverRun`], it does not change the document.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    inputs: SolverInputs,
    solvers: Vec<ComparedSolver>,
}

/// One solver of a [`Comparison`].
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedSolver {
    /// The solver.
    pub method: Method,
    /// The solver's run, or the error if it cannot solve for the targets.
    pub run: Result<SolverRun, SolveError>,
}

impl Comparison {
    pub(super) fn new(inputs: SolverInputs) -> Self {
        let solver = |method| {
            let run = SolverRun::new(with_method(&inputs, method));
            ComparedSolver { method, run }
        };
        Self { solvers: Method::ALL.into_iter().map(solver).collect(), inputs }
    }

    /// The same comparison with other inputs: the solvers make as many iterations and show the same
    /// one.
    pub(super) fn anew(&self, inputs: SolverInputs) -> Self {
        let anew = |solver: &ComparedSolver| {
            let inputs = with_method(&inputs, solver.method);
            let run = match &solver.run {
                Ok(run) => run.anew(inputs),
                Err(_) => SolverRun::new(inputs),
            };
            ComparedSolver { method: solver.method, run }
        };
        Self { solvers: self.solvers.iter().map(anew).collect(), inputs }
    }

    pub(super) fn inputs(&self) -> &SolverInputs {
        &self.inputs
    }

    /// The solvers, in the order of [`Method::ALL`].
    pub fn solvers(&self) -> &[ComparedSolver] {
        &self.solvers
    }

    /// The runs of all solvers that can solve for the targets.
    pub fn runs(&self) -> impl Iterator<Item = &SolverRun> + Clone {
        self.solvers.iter().filter_map(|solver| solver.run.as_ref().ok())
    }

    fn runs_mut(&mut self) -> impl Iterator<Item = &mut SolverRun> {
        self.solvers.iter_mut().filter_map(|solver| solver.run.as_mut().ok())
    }

    /// Whether any solver makes further iterations.
    pub fn is_running(&self) -> bool {
        self.runs().any(|run| !run.is_over())
    }

    /// Shows the same iteration of all solvers, of a solver with fewer its latest; for `None`, each
    /// iterate as it is made.
    pub(super) fn hold(&mut self, held: Option<u32>) {
        self.runs_mut().for_each(|run| run.hold(held));
    }

    /// Makes one frame's iterations with every solver: at first one iteration, later an eighth of
    /// the number made before.
    pub(super) fn advance(&mut self) {
        const PACE: u32 = 8;
        for run in self.runs_mut() {
            run.advance((run.report().iterations / PACE).max(1));
            if run.is_over() {
                run.finish();
            }
        }
    }
}

/// The inputs with another method and its own maximum number of iterations.
fn with_method(inputs: &SolverInputs, method: Method) -> SolverInputs {
    let options = SolverOptions { method, iterations: None, ..inputs.options };
    SolverInputs { options, ..inputs.clone() }
}
