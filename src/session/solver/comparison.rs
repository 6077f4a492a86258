use super::run::{SolverInputs, SolverRun};
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
    pub(in crate::session) fn new(inputs: SolverInputs) -> Self {
        let solver = |method| {
            let run = SolverRun::new(with_method(&inputs, method));
            ComparedSolver { method, run }
        };
        Self { solvers: Method::ALL.into_iter().map(solver).collect(), inputs }
    }

    /// The same comparison with other inputs: the solvers make as many iterations and show the same
    /// one.
    pub(in crate::session) fn anew(&self, inputs: SolverInputs) -> Self {
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

    pub(in crate::session) fn inputs(&self) -> &SolverInputs {
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

    /// True if any solver makes further iterations.
    pub fn is_running(&self) -> bool {
        self.runs().any(|run| !run.is_over())
    }

    /// Shows the same iteration of all solvers, of a solver with fewer its latest; for `None`, each
    /// iterate as it is made.
    pub(in crate::session) fn hold(&mut self, held: Option<u32>) {
        self.runs_mut().for_each(|run| run.hold(held));
    }

    /// Makes one frame's iterations with every solver: at first one iteration, later an eighth of
    /// the number made before.
    pub(in crate::session) fn advance(&mut self) {
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

/// The shown iteration of a solver run or of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownIteration {
    /// Number of the shown iteration: 0 is the FK pose.
    pub number: u32,
    /// Number of the latest iteration.
    pub latest: u32,
    /// Number of the iteration that is kept before the shown one; `None` at the first.
    pub previous: Option<u32>,
    /// Number of the iteration that is kept after the shown one; `None` at the latest.
    pub next: Option<u32>,
}

impl ShownIteration {
    /// The greatest iteration that any of the runs shows; `None` without runs.
    pub(in crate::session) fn of<'a>(
        runs: impl Iterator<Item = &'a SolverRun> + Clone,
    ) -> Option<Self> {
        let number = runs.clone().map(|run| run.shown().iteration).max()?;
        let all = runs.map(SolverRun::iterates);
        let before = |before| all.clone().map(|iterates| iterates.at(before).iteration).max();
        Some(Self {
            number,
            latest: before(u32::MAX)?,
            previous: number.checked_sub(1).and_then(before),
            next: all.filter_map(|iterates| Some(iterates.after(number)?.iteration)).min(),
        })
    }
}
