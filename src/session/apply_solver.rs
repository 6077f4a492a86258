use super::comparison::Comparison;
use super::session::Session;
use super::solver_action::SolverAction;
use super::solver_run::SolverRun;

/// Solver runs.
impl Session {
    /// The solver run, running or paused; `None` before the first run and after a reset.
    pub fn solver_run(&self) -> Option<&SolverRun> {
        self.solvers.run()
    }

    /// Whether a solver run is in progress and not paused.
    pub fn is_running(&self) -> bool {
        self.solvers.is_running()
    }

    /// The comparison of all solvers; `None` if none is shown.
    pub fn comparison(&self) -> Option<&Comparison> {
        self.solvers.comparison()
    }

    pub(super) fn apply_solver(&mut self, action: SolverAction) {
        match action {
            SolverAction::Run(running) => self.run(running),
            SolverAction::Cancel => self.cancel_run(),
            SolverAction::Compare(true) => self.start_comparison(),
            SolverAction::Compare(false) => self.solvers.end_comparison(),
            SolverAction::SetFollow(follow) => self.preferences.follow = follow,
        }
    }

    /// Takes the solver run, or makes a new one. Reports why and returns `None` if there is nothing
    /// to solve.
    fn take_or_new_run(&mut self) -> Option<SolverRun> {
        if self.skeleton_rig().follow_path.is_some() {
            self.fail("A skeleton that follows a path has nothing to solve");
            return None;
        }
        if self.skeleton_rig().targets_at(self.time()).is_empty() {
            self.say("There is no target to solve for; add one to a joint");
            return None;
        }
        if let Some(solver_run) = self.solvers.take_run() {
            return Some(solver_run);
        }
        match SolverRun::new(self.skeleton_rig(), self.time()) {
            Ok(solver_run) => Some(solver_run),
            Err(error) => {
                self.fail(error.to_string());
                None
            }
        }
    }

    pub(super) fn run(&mut self, running: bool) {
        self.solvers.end_comparison();
        if !running {
            return self.stop_run();
        }
        if let Some(mut solver_run) = self.take_or_new_run() {
            solver_run.running = true;
            self.solvers.set_run(solver_run);
            self.begin_run();
        }
    }

    pub(super) fn stop_run(&mut self) {
        self.solvers.pause();
        self.end_run();
    }

    /// Makes one iteration and pauses.
    pub(super) fn step_solver(&mut self) {
        self.solvers.end_comparison();
        self.stop_run();
        if let Some(solver_run) = self.take_or_new_run() {
            self.solvers.set_run(solver_run);
            self.iterate(1);
        }
    }

    /// Resets the skeleton to the pose before the first iteration of the solver run.
    pub(super) fn reset_solver(&mut self) {
        self.solvers.end_comparison();
        self.stop_run();
        let Some(solver_run) = self.solvers.take_run() else { return };
        let start = solver_run.start();
        self.edit_skeleton(|rig| {
            if start.joints().len() != rig.skeleton.joints().len() {
                return Ok(());
            }
            start.iter().try_for_each(|(joint, before)| {
                rig.skeleton_mut().change(joint, |joint| {
                    (joint.rotation, joint.offset) = (before.rotation, before.offset);
                })
            })
        });
        self.say("Reset to the pose before the solver run");
    }

    pub(super) fn start_comparison(&mut self) {
        self.stop_run();
        if let Some(solver_run) = self.take_or_new_run() {
            self.solvers.set_run(solver_run);
            self.solvers.compare(Comparison::new(self.skeleton_rig(), self.time()));
        }
    }

    /// Makes one frame's iterations of the solver run and of the comparison.
    pub(super) fn advance_solvers(&mut self) {
        if self.is_running() {
            self.iterate(self.skeleton_rig().iterations_per_frame);
            self.pause_if_done();
        }
        self.solvers.advance_comparison();
    }

    fn iterate(&mut self, iterations: u32) {
        let Some(mut solver_run) = self.solvers.take_run() else { return };
        let mut after = self.shown().clone();
        match solver_run.advance(&mut after.skeleton_rig, self.time(), iterations) {
            Ok(()) => {
                self.solvers.set_run(solver_run);
                self.commit(after);
            }
            Err(error) => {
                self.end_run();
                self.fail(error.to_string());
            }
        }
    }

    /// Pauses a run that is done, unless its targets move or are dragged.
    fn pause_if_done(&mut self) {
        let moves = self.is_playing() && self.has_motion();
        let is_dragged = self.drag().is_some();
        let is_done = self.solver_run().is_some_and(SolverRun::is_done);
        if is_done && !moves && !is_dragged {
            self.stop_run();
        }
    }
}
