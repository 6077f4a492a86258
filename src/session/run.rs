use super::{Race, Session, Solving};

/// Solvers at work.
impl Session {
    /// The solver that is under way, or a new one at its start.
    fn solving_or_new(&mut self) -> Option<Solving> {
        if self.skeleton().slither.is_some() {
            self.fail("This skeleton follows its head; it has nothing to solve");
            return None;
        }
        if self.skeleton().goals(self.clock.time).is_empty() {
            self.say("There is no target to solve for; add one to a joint");
            return None;
        }
        if let Some(solving) = self.solving.take() {
            return Some(solving);
        }
        match Solving::new(self.skeleton(), self.clock.time) {
            Ok(solving) => Some(solving),
            Err(error) => {
                self.fail(error.to_string());
                None
            }
        }
    }

    pub(super) fn run(&mut self, running: bool) {
        self.race = None;
        if !running {
            return self.stop_run();
        }
        if let Some(mut solving) = self.solving_or_new() {
            solving.running = true;
            self.solving = Some(solving);
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
            self.remember("solve", before);
        }
    }

    pub(super) fn stop_run(&mut self) {
        if let Some(solving) = &mut self.solving {
            solving.running = false;
        }
        self.end_run();
    }

    /// Stops, and takes back what has been done since the solver was started.
    pub(super) fn cancel_run(&mut self) {
        self.race = None;
        self.solving = None;
        if let Some(before) = self.run_before.take() {
            self.restore(&before);
        }
        self.say("Taken back");
    }

    /// One iteration, after which the solver waits.
    pub(super) fn step(&mut self) {
        self.race = None;
        self.stop_run();
        if let Some(solving) = self.solving_or_new() {
            self.solving = Some(solving);
            self.iterate(1);
        }
    }

    /// Back to where the skeleton was before the first iteration.
    pub(super) fn reset_solver(&mut self) {
        self.race = None;
        self.stop_run();
        let Some(solving) = self.solving.take() else { return };
        let start = solving.start().joints();
        self.edit_skeleton(|rig| {
            if start.len() != rig.skeleton.joints().len() {
                return Ok(());
            }
            start.iter().enumerate().try_for_each(|(joint, before)| {
                rig.skeleton.change(joint, |joint| {
                    (joint.rotation, joint.offset) = (before.rotation, before.offset);
                })
            })
        });
        self.say("The skeleton is as it was before the solver ran");
    }

    pub(super) fn start_race(&mut self) {
        self.stop_run();
        if let Some(solving) = self.solving_or_new() {
            self.solving = Some(solving);
            self.race = Some(Race::new(self.skeleton(), self.clock.time));
        }
    }

    /// Lets the solver and the race go on.
    pub(super) fn advance_solvers(&mut self) {
        if self.is_running() {
            self.iterate(self.skeleton().iterations_per_frame);
            self.rest();
        }
        if let Some(race) = &mut self.race {
            race.advance();
        }
    }

    fn iterate(&mut self, iterations: u32) {
        let Some(mut solving) = self.solving.take() else { return };
        let mut after = self.shown.clone();
        match solving.advance(&mut after.skeleton, self.clock.time, iterations) {
            Ok(()) => {
                self.solving = Some(solving);
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
        let goes_on = self.clock.playing && self.has_motion();
        let is_held = self.drag().is_some();
        let is_done = self.solving.as_ref().is_some_and(Solving::is_done);
        if is_done && !goes_on && !is_held {
            self.stop_run();
        }
    }
}
