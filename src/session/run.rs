use super::{Race, Session, Solving};

/// Solvers at work.
impl Session {
    /// The solver that is under way, or a new one at its start.
    fn solving_or_new(&mut self) -> Option<Solving> {
        if self.skeleton().slither.is_some() {
            self.message =
                Some("This skeleton follows its head; it has nothing to solve".to_owned());
            return None;
        }
        if self.skeleton().goals(self.clock.time).is_empty() {
            self.message = Some("There is no target to solve for; add one to a joint".to_owned());
            return None;
        }
        if let Some(solving) = self.solving.take() {
            return Some(solving);
        }
        match Solving::new(self.skeleton(), self.clock.time) {
            Ok(solving) => Some(solving),
            Err(error) => {
                self.say_impossible(&error.to_string());
                None
            }
        }
    }

    pub(super) fn run(&mut self, running: bool) {
        self.race = None;
        if let Some(mut solving) = self.solving_or_new() {
            solving.running = running;
            self.solving = Some(solving);
        }
    }

    /// Stops, and takes back what has been done since the solver was started.
    pub(super) fn cancel_run(&mut self) {
        self.reset_solver();
        self.message = Some("Taken back".to_owned());
    }

    /// One iteration, after which the solver waits.
    pub(super) fn step(&mut self) {
        self.run(false);
        self.iterate(1);
    }

    /// Back to where the skeleton was before the first iteration.
    pub(super) fn reset_solver(&mut self) {
        self.race = None;
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
        self.message = Some("The skeleton is as it was before the solver ran".to_owned());
    }

    pub(super) fn start_race(&mut self) {
        if let Some(mut solving) = self.solving_or_new() {
            solving.running = false;
            self.solving = Some(solving);
            self.race = Some(Race::new(self.skeleton(), self.clock.time));
        }
    }

    /// Lets the time, the solver and the race go on.
    pub(super) fn advance_skeleton(&mut self, seconds: f64) {
        /// A window that slept does not leap.
        const LONGEST: f64 = 0.25;
        let passed = self.clock.last.map_or(0.0, |last| (seconds - last).clamp(0.0, LONGEST));
        if self.clock.last == Some(seconds) {
            return;
        }
        self.clock.last = Some(seconds);
        if self.clock.playing {
            self.clock.time += passed;
            self.refresh_skeleton();
        }
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
        match solving.advance(&mut self.document.skeleton, self.clock.time, iterations) {
            Ok(()) => {
                self.solving = Some(solving);
                self.refresh_skeleton();
            }
            Err(error) => self.say_impossible(&error.to_string()),
        }
    }

    /// A solver that is done waits, unless its targets move by themselves.
    fn rest(&mut self) {
        let goes_on = self.clock.playing && self.skeleton().is_moving();
        let is_held = self.drag().is_some();
        if let Some(solving) = &mut self.solving
            && solving.is_done()
            && !goes_on
            && !is_held
        {
            solving.running = false;
        }
    }
}
