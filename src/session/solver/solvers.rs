use crate::document::Posed;
use crate::kinematics::chain_ik::SolveError;
use crate::session::outcome::{Consequence, Outcome};
use crate::session::preferences::PanelTab;
use crate::session::solver::run::{Comparison, ShownIteration, SolverInputs, SolverRun};

/// Runs and compares solvers on copies of the pose; the document does not change.
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
    /// Shows the latest kept iterate of at most this number of iterations: 0 is the start. From
    /// the number of the latest on, each iterate is shown as it is made.
    Show(u32),
}

/// The solver run or the comparison of solvers that is looked at. Both are views: they read the
/// document and never change it.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Solvers {
    #[default]
    /// Nothing.
    Idle,
    /// A run.
    Run(Box<SolverRun>),
    /// A comparison.
    Comparison(Comparison),
}

impl Solvers {
    /// Applies an action on a pose; `from_fk`: see [`SolverInputs::of`]. The page on the right that
    /// shows what was started comes to the front.
    pub(in crate::session) fn apply(
        &mut self,
        action: SolverAction,
        posed: &Posed,
        from_fk: bool,
    ) -> Outcome {
        let inputs = || SolverInputs::of(posed, from_fk).map_err(Outcome::say);
        match action {
            SolverAction::Run(true) => {
                let started = inputs().map(|inputs| self.start(inputs));
                Outcome::from(Consequence::ShowTab(PanelTab::Solver)).and(report(started))
            }
            SolverAction::Step => {
                let stepped = inputs().map(|inputs| self.step(inputs));
                Outcome::from(Consequence::ShowTab(PanelTab::Solver)).and(report(stepped))
            }
            SolverAction::Compare => {
                let compared = inputs().map(|inputs| {
                    self.compare(inputs);
                    Ok(())
                });
                Outcome::from(Consequence::ShowTab(PanelTab::Race)).and(report(compared))
            }
            SolverAction::Run(false) => {
                self.pause();
                Outcome::default()
            }
            SolverAction::Reset => {
                self.end();
                Outcome::default()
            }
            SolverAction::Show(iteration) => {
                self.show(iteration);
                Outcome::default()
            }
            SolverAction::ShowPart { iteration, part } => {
                self.show_part(iteration, part);
                Outcome::default()
            }
            SolverAction::Walk(walks) => {
                self.walk(walks);
                Outcome::default()
            }
        }
    }

    /// True if neither a run nor a comparison is looked at.
    pub fn is_idle(&self) -> bool {
        matches!(self, Self::Idle)
    }

    /// The solver run, running or paused; `None` if none is looked at.
    pub fn run(&self) -> Option<&SolverRun> {
        match self {
            Self::Run(run) => Some(run),
            Self::Idle | Self::Comparison(_) => None,
        }
    }

    /// The comparison of all solvers; `None` if none is looked at.
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

    /// The shown iteration of the solver run or of the comparison; `None` without either.
    pub fn shown_iteration(&self) -> Option<ShownIteration> {
        ShownIteration::of(self.runs())
    }

    /// True if a solver run is in progress and not paused.
    pub fn is_running(&self) -> bool {
        self.run().is_some_and(SolverRun::is_running)
    }

    /// True if the run or the comparison makes iterations.
    pub fn is_busy(&self) -> bool {
        self.is_running()
            || self.run().is_some_and(SolverRun::is_walking)
            || self.comparison().is_some_and(Comparison::is_running)
    }

    /// Runs the solver for `inputs`, or continues the run if there is one.
    pub(in crate::session) fn start(&mut self, inputs: SolverInputs) -> Result<(), SolveError> {
        self.with_run(inputs, |run| {
            run.set_running(true);
            run.hold(None);
        })
    }

    pub(in crate::session) fn pause(&mut self) {
        if let Self::Run(run) = self {
            run.set_running(false);
        }
    }

    /// Makes one iteration and pauses; begins a run for `inputs` unless there is one.
    pub(in crate::session) fn step(&mut self, inputs: SolverInputs) -> Result<(), SolveError> {
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

    pub(in crate::session) fn compare(&mut self, inputs: SolverInputs) {
        *self = Self::Comparison(Comparison::new(inputs));
    }

    pub(in crate::session) fn end(&mut self) {
        *self = Self::Idle;
    }

    /// Shows the latest kept iterates of at most `iteration` iterations. From the number of the
    /// latest on, each iterate is shown as it is made.
    pub(in crate::session) fn show(&mut self, iteration: u32) {
        let Some(ShownIteration { latest, .. }) = self.shown_iteration() else { return };
        let held = (iteration < latest).then_some(iteration);
        match self {
            Self::Idle => {}
            Self::Run(run) => run.hold(held),
            Self::Comparison(comparison) => comparison.hold(held),
        }
    }

    /// Shows a part of an iteration of the run.
    pub(in crate::session) fn show_part(&mut self, iteration: u32, part: Option<usize>) {
        self.show(iteration);
        if let Self::Run(run) = self {
            run.show_part(part);
        }
    }

    /// Shows the parts of the iterations of the run one after the other, or stops that.
    pub(in crate::session) fn walk(&mut self, walks: bool) {
        if let Self::Run(run) = self {
            run.walk(walks);
        }
    }

    /// Lets time pass, in seconds, while the parts of iterations are shown one after the other.
    pub(in crate::session) fn advance_walk(&mut self, passed: f64) {
        if let Self::Run(run) = self {
            run.advance_walk(passed);
        }
    }

    /// Makes one frame's iterations: `iterations` of the run. A run that is over is paused, unless
    /// its inputs are about to change, as `has_moving_inputs` says.
    pub(in crate::session) fn advance(&mut self, iterations: u32, has_moving_inputs: bool) {
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
    /// its start, with as many iterations. It ends if there are no inputs, or if the solver
    /// refuses them.
    pub(in crate::session) fn follow(
        &mut self,
        inputs: Option<SolverInputs>,
    ) -> Result<(), SolveError> {
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

/// Removes the message if a solve has begun; reports why if not.
fn report(begun: Result<Result<(), SolveError>, Outcome>) -> Outcome {
    match begun {
        Ok(Ok(())) => Consequence::Message(None).into(),
        Ok(Err(error)) => Outcome::fail(error.to_string()),
        Err(reason) => reason,
    }
}
