use super::Session;
use super::view_drag::Glide;
use crate::rig::{Crowd, SolvedBy};

/// Many arms in the rig's place: neither saved nor undone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crowding {
    arms: u32,
    solved_by: SolvedBy,
    /// In seconds.
    time: f64,
    moving: bool,
    shown: bool,
}

impl Default for Crowding {
    fn default() -> Self {
        Self { arms: 1_000, solved_by: SolvedBy::Cpu, time: 0.0, moving: true, shown: false }
    }
}

impl Crowding {
    /// Whether the next picture is another one by itself.
    pub fn is_going_on(&self) -> bool {
        self.shown && self.moving
    }
}

impl Session {
    /// The crowd in the rig's place, if it is shown, of arms like the document's.
    pub fn crowd(&self) -> Option<Crowd> {
        let Crowding { arms, solved_by, time, shown, .. } = self.crowding;
        let bones = self.shown.arm.bones;
        shown.then_some(Crowd { arms, bones, time: time as f32, solved_by })
    }

    /// Whether the crowd follows its targets, or stands.
    pub fn is_crowd_moving(&self) -> bool {
        self.crowding.moving
    }

    pub(super) fn show_crowd(&mut self, shown: bool) {
        if shown != self.crowding.shown {
            self.crowding.shown = shown;
            self.forget_pause();
            self.glide = Some(Glide::new(self.document.camera, self.framing_all()));
        }
    }

    pub(super) fn set_crowd(&mut self, arms: u32) {
        self.crowding.arms = arms.clamp(1, Crowd::MOST);
    }

    pub(super) fn solve_crowd(&mut self, solved_by: SolvedBy) {
        self.crowding.solved_by = solved_by;
    }

    pub(super) fn move_crowd(&mut self, moving: bool) {
        self.crowding.moving = moving;
        self.forget_pause();
    }

    /// What passed while nothing went on is no time of the crowd.
    fn forget_pause(&mut self) {
        if !self.playback.playing {
            self.playback.last = None;
        }
    }

    pub(super) fn advance_crowd(&mut self, passed: f64) {
        if self.crowding.is_going_on() {
            let period = f64::from(Crowd::PERIOD);
            self.crowding.time = (self.crowding.time + passed).rem_euclid(period);
        }
    }
}
