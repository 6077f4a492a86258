use super::{Comparison, Session, SolverRun, edit_label};

/// Solvers at work.
impl Session {
    /// The solver that is under way, or a new one at its start.
    fn solving_or_new(&mut self) -> Option<SolverRun> {
        if self.skeleton_rig().follow_path.is_some() {
            self.fail("This skeleton follows its head; it has nothing to solve");
            return None;
        }
        if self.skeleton_rig().goals(self.playback.time).is_empty() {
            self.say("There is no target to solve for; add one to a joint");
            return None;
        }
        if let Some(solver_run) = self.solver_run.take() {
            return Some(solver_run);
        }
        match SolverRun::new(self.skeleton_rig(), self.playback.time) {
            Ok(solver_run) => Some(solver_run),
            Err(error) => {
                self.fail(error.to_string());
                None
            }
        }
    }

    pub(super) fn run(&mut self, running: bool) {
        self.comparison = None;
        if !running {
            return self.stop_run();
        }
        if let Some(mut solver_run) = self.solving_or_new() {
            solver_run.running = true;
            self.solver_run = Some(solver_run);
            self.begin_run();
        }
    }

    /// A running solver is one change, until it stops or something else is changed meanwhile.
    pub(super) fn begin_run(&mut self) {
        if self.is_running() && self.run_before.is_none() && self.edit.is_none() {
            self.run_before = Some(self.state());
        }
    }

    /// Makes a step of what a running solver has done by now.
    pub(super) fn end_run(&mut self) {
        if let Some(before) = self.run_before.take() {
            self.remember(edit_label::SOLVE, before);
        }
    }

    pub(super) fn stop_run(&mut self) {
        if let Some(solver_run) = &mut self.solver_run {
            solver_run.running = false;
        }
        self.end_run();
    }

    /// Stops, and takes back what has been done since the solver was started.
    pub(super) fn cancel_run(&mut self) {
        self.comparison = None;
        self.solver_run = None;
        if let Some(before) = self.run_before.take() {
            self.restore(&before);
        }
        self.say("Cancelled");
    }

    /// One iteration, after which the solver waits.
    pub(super) fn step(&mut self) {
        self.comparison = None;
        self.stop_run();
        if let Some(solver_run) = self.solving_or_new() {
            self.solver_run = Some(solver_run);
            self.iterate(1);
        }
    }

    /// Back to where the skeleton was before the first iteration.
    pub(super) fn reset_solver(&mut self) {
        self.comparison = None;
        self.stop_run();
        let Some(solver_run) = self.solver_run.take() else { return };
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
        self.say("The skeleton is as it was before the solver ran");
    }

    pub(super) fn start_comparison(&mut self) {
        self.stop_run();
        if let Some(solver_run) = self.solving_or_new() {
            self.solver_run = Some(solver_run);
            self.comparison = Some(Comparison::new(self.skeleton_rig(), self.playback.time));
        }
    }

    /// Lets the solver and the race go on.
    pub(super) fn advance_solvers(&mut self) {
        if self.is_running() {
            self.iterate(self.skeleton_rig().iterations_per_frame);
            self.rest();
        }
        if let Some(comparison) = &mut self.comparison {
            comparison.advance();
        }
    }

    fn iterate(&mut self, iterations: u32) {
        let Some(mut solver_run) = self.solver_run.take() else { return };
        let mut after = self.shown.clone();
        match solver_run.advance(&mut after.skeleton_rig, self.playback.time, iterations) {
            Ok(()) => {
                self.solver_run = Some(solver_run);
                self.commit(after);
            }
            Err(error) => {
                self.end_run();
                self.fail(error.to_string());
            }
        }
    }

    /// A solver that is done waits, unless its targets move by themselves.
    fn rest(&mut self) {
        let goes_on = self.playback.playing && self.has_motion();
        let is_held = self.drag().is_some();
        let is_done = self.solver_run.as_ref().is_some_and(SolverRun::is_done);
        if is_done && !goes_on && !is_held {
            self.stop_run();
        }
    }
}
