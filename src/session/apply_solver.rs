use super::comparison::Comparison;
use super::panel_tab::PanelTab;
use super::session::Session;
use super::shown_iteration::ShownIteration;
use super::solver_action::SolverAction;
use super::solver_inputs::SolverInputs;
use super::solver_run::SolverRun;
use super::solvers::Solvers;
use crate::kinematics::chain_ik::SolveError;

/// Solver runs.
impl Session {
    /// The solver run, running or paused; `None` if none is looked at.
    pub fn solver_run(&self) -> Option<&SolverRun> {
        self.solvers.run()
    }

    /// Whether a solver run is in progress and not paused.
    pub fn is_running(&self) -> bool {
        self.solvers.is_running()
    }

    /// The comparison of all solvers; `None` if none is looked at.
    pub fn comparison(&self) -> Option<&Comparison> {
        self.solvers.comparison()
    }

    /// The solver run, or the runs of the comparison.
    pub fn solver_runs(&self) -> impl Iterator<Item = &SolverRun> + Clone {
        self.solvers.runs()
    }

    /// The shown iteration of the solver run or of the comparison; `None` without either.
    pub fn shown_iteration(&self) -> Option<ShownIteration> {
        self.solvers.shown_iteration()
    }

    /// Applies an action. The page on the right that shows what was started comes to the front.
    pub(super) fn apply_solver(&mut self, action: SolverAction) {
        match action {
            SolverAction::Run(true) | SolverAction::Step => self.show_tab(PanelTab::Solver),
            SolverAction::Compare => self.show_tab(PanelTab::Race),
            SolverAction::Run(false)
            | SolverAction::Reset
            | SolverAction::Show(_)
            | SolverAction::ShowPart { .. }
            | SolverAction::Walk(_) => {}
        }
        match action {
            SolverAction::Run(true) => self.solve(Solvers::start),
            SolverAction::Run(false) => self.solvers.pause(),
            SolverAction::Step => self.solve(Solvers::step),
            SolverAction::Compare => self.solve(|solvers, inputs| {
                solvers.compare(inputs);
                Ok(())
            }),
            SolverAction::Reset => self.solvers.end(),
            SolverAction::Show(iteration) => self.solvers.show(iteration),
            SolverAction::ShowPart { iteration, part } => self.solvers.show_part(iteration, part),
            SolverAction::Walk(walks) => self.solvers.walk(walks),
        }
    }

    /// Passes the present inputs to the solvers; reports why if there is nothing to solve.
    fn solve(&mut self, solve: impl FnOnce(&mut Solvers, SolverInputs) -> Result<(), SolveError>) {
        match SolverInputs::of(self.shown(), self.time()) {
            Ok(inputs) => match solve(&mut self.solvers, inputs) {
                Ok(()) => self.shell.clear_message(),
                Err(error) => self.fail(error.to_string()),
            },
            Err(reason) => self.say(reason),
        }
    }

    /// Makes one frame's iterations of the solver run or of the comparison, `passed` seconds after the
    /// last frame.
    pub(super) fn advance_solvers(&mut self, passed: f64) {
        self.solvers.advance_walk(passed);
        let plays = self.is_playing() && self.has_motion();
        let is_dragged = self.drag().is_some();
        self.solvers.advance(self.skeleton_rig().iterations_per_frame, plays || is_dragged);
    }

    /// Makes the solver run and the comparison anew if what they solve has changed.
    pub(super) fn update_solvers(&mut self) {
        if self.solvers.is_idle() {
            return;
        }
        let inputs = SolverInputs::of(self.shown(), self.time()).ok();
        if let Err(error) = self.solvers.follow(inputs) {
            self.fail(error.to_string());
        }
    }

    /// Writes the shown iterate of the solver run to the joints' own angles and offsets, and ends the
    /// run.
    pub(super) fn apply_pose(&mut self) {
        let Some(posed) = self.solver_run().map(|run| run.skeleton().clone()) else {
            self.say("Run or step the solver first");
            return;
        };
        self.solvers.end();
        self.edit_skeleton(|rig| {
            for (joint, posed) in posed.iter() {
                let present = &rig.skeleton[joint];
                if (present.rotation, present.offset) != (posed.rotation, posed.offset) {
                    rig.skeleton_mut().change(joint, |joint| {
                        (joint.rotation, joint.offset) = (posed.rotation, posed.offset);
                    })?;
                }
            }
            Ok(())
        });
    }
}
