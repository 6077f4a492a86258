use super::comparison::Comparison;
use super::shown_iteration::ShownIteration;
use super::solver_inputs::SolverInputs;
use super::solver_run::SolverRun;
use crate::kinematics::chain_ik::SolveError;

/// The solver run or the comparison of solvers that is looked at. Both are views: they read the
/// document and never change it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Solvers {
    #[default]
    Idle,
    Run(Box<SolverRun>),
    Comparison(Comparison),
}

impl Solvers {
    pub fn is_idle(&self) -> bool {
        matches!(self, Self::Idle)
    }

    pub fn run(&self) -> Option<&SolverRun> {
        match self {
            Self::Run(run) => Some(run),
            Self::Idle | Self::Comparison(_) => None,
        }
    }

    pub fn comparison(&self) -> Option<&Comparison> {
        match self {
            Self::Comparison(comparison) => Some(comparison),
            Self::Idle | Self::Run(_) => None,
        }
    }

    /// The run, or the runs of the comparison.
    pub fn runs(&self) -> impl Iterator<Item = &SolverRun> + Clone {
        let compared = self.comparison().into_iter().flat_map(Comparison::runs);
        self.run().into_iter().chain(compared)
    }

    pub fn shown_iteration(&self) -> Option<ShownIteration> {
        ShownIteration::of(self.runs())
    }

    pub fn is_running(&self) -> bool {
        self.run().is_some_and(SolverRun::is_running)
    }

    /// Whether the run or the comparison makes iterations.
    pub fn is_busy(&self) -> bool {
        self.is_running()
            || self.run().is_some_and(SolverRun::is_walking)
            || self.comparison().is_some_and(Comparison::is_running)
    }

    /// Runs the solver for `inputs`, or continues the run if there is one.
    pub fn start(&mut self, inputs: SolverInputs) -> Result<(), SolveError> {
        self.with_run(inputs, |run| {
            run.set_running(true);
            run.hold(None);
        })
    }

    pub fn pause(&mut self) {
        if let Self::Run(run) = self {
            run.set_running(false);
        }
    }

    /// Makes one iteration and pauses; begins a run for `inputs` unless there is one.
    pub fn step(&mut self, inputs: SolverInputs) -> Result<(), SolveError> {
        self.with_run(inputs, |run| {
            run.set_running(false);
            run.advance(1);
            run.hold(None);
        })
    }

    fn with_run(
        &mut self,
        inputs: SolverInputs,
        change: impl FnOnce(&mut SolverRun),
    ) -> Result<(), SolveError> {
        if self.run().is_none() {
            *self = Self::Run(Box::new(SolverRun::new(inputs)?));
        }
        if let Self::Run(run) = self {
            change(run);
        }
        Ok(())
    }

    pub fn compare(&mut self, inputs: SolverInputs) {
        *self = Self::Comparison(Comparison::new(inputs));
    }

    pub fn end(&mut self) {
        *self = Self::Idle;
    }

    /// Shows the latest kept iterates of at most `iteration` iterations. From the number of the
    /// latest on, each iterate is shown as it is made.
    pub fn show(&mut self, iteration: u32) {
        let Some(ShownIteration { latest, .. }) = self.shown_iteration() else { return };
        let held = (iteration < latest).then_some(iteration);
        match self {
            Self::Idle => {}
            Self::Run(run) => run.hold(held),
            Self::Comparison(comparison) => comparison.hold(held),
        }
    }

    /// Shows a part of an iteration of the run.
    pub fn show_part(&mut self, iteration: u32, part: Option<usize>) {
        self.show(iteration);
        if let Self::Run(run) = self {
            run.show_part(part);
        }
    }

    /// Shows the parts of the iterations of the run one after the other, or stops that.
    pub fn walk(&mut self, walks: bool) {
        if let Self::Run(run) = self {
            run.walk(walks);
        }
    }

    /// Lets time pass, in seconds, while the parts of iterations are shown one after the other.
    pub fn advance_walk(&mut self, passed: f64) {
        if let Self::Run(run) = self {
            run.advance_walk(passed);
        }
    }

    /// Makes one frame's iterations: `iterations` of the run. A run that is over is paused, unless
    /// its inputs are about to change, as `has_moving_inputs` says.
    pub fn advance(&mut self, iterations: u32, has_moving_inputs: bool) {
        match self {
            Self::Run(run) if run.is_running() => {
                run.advance(iterations);
                if run.is_over() && !has_moving_inputs {
                    run.finish();
                }
            }
            Self::Comparison(comparison) => comparison.advance(),
            Self::Idle | Self::Run(_) => {}
        }
    }

    /// Adopts the present inputs: if they have changed, the run or the comparison is made anew from
    /// the FK pose, with as many iterations. It ends if there are no inputs, or if the solver refuses
    /// them.
    pub fn follow(&mut self, inputs: Option<SolverInputs>) -> Result<(), SolveError> {
        let (anew, outcome) = match (&*self, inputs) {
            (Self::Run(run), Some(inputs)) if *run.inputs() != inputs => match run.anew(inputs) {
                Ok(run) => (Self::Run(Box::new(run)), Ok(())),
                Err(error) => (Self::Idle, Err(error)),
            },
            (Self::Comparison(comparison), Some(inputs)) if *comparison.inputs() != inputs => {
                (Self::Comparison(comparison.anew(inputs)), Ok(()))
            }
            (_, None) => (Self::Idle, Ok(())),
            (_, Some(_)) => return Ok(()),
        };
        *self = anew;
        outcome
    }
}
