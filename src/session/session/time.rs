use glam::Vec3;

use super::{ASPECT, Session};
use crate::document::{Camera, Timeline};
use crate::session::outcome::{Effect, Outcome};

/// Time.
impl Session {
    pub(super) fn play(&mut self) -> Option<Effect> {
        let played = self.playback.play(true, &self.document().timeline);
        self.act(played)
    }

    pub(super) fn set_time(&mut self, time: f64) {
        let before = self.playback.time();
        if self.playback.set_time(time) {
            self.shell.leave_moment();
            self.with_camera_following(|session| {
                if session.editing.discard_overrides(before, session.playback().time()) {
                    session.act(Outcome::say(format!(
                        "The unkeyed change at {before:.2} s is discarded: Ctrl+Z brings it back"
                    )));
                }
                session.refresh();
            });
        }
    }

    pub(super) fn advance(&mut self, seconds: f64) {
        if !seconds.is_finite() {
            return;
        }
        if let Some(camera) = self.view.advance_glide(seconds) {
            self.set_camera(camera);
        }
        if !self.playback.has_frame_at(seconds) {
            let passed = self.playback.advance_frame(seconds);
            self.view.advance(passed);
            self.advance_playhead(passed);
            self.advance_solvers(passed);
        }
    }

    fn advance_playhead(&mut self, passed: f64) {
        if !self.playback.is_playing() || passed == 0.0 {
            return;
        }
        if self.editing.follows_mouse() {
            return self.advance_following(passed);
        }
        let (time, goes_on) = self.playback.played(passed, &self.document().timeline);
        self.set_time(time);
        self.playback.set_playing(goes_on);
    }

    /// Makes one frame's iterations of the solver run or of the comparison, `passed` seconds after
    /// the last frame.
    fn advance_solvers(&mut self, passed: f64) {
        self.solvers.advance_walk(passed);
        let plays = self.playback.is_playing() && self.document().is_moving();
        let is_dragged = self.editing.drag().is_some();
        self.solvers.advance(self.rig().iterations_per_frame, plays || is_dragged);
    }

    /// Opens a transaction in which the heads follow the mouse, and plays; or commits it.
    pub(super) fn follow_mouse(&mut self, follows: bool) {
        if !follows && self.editing.follows_mouse() {
            return self.commit();
        }
        if !follows || self.editing.is_editing() || !self.can_follow_mouse() {
            return;
        }
        self.begin(None);
        self.editing.follow_mouse();
        self.record_heads(self.playback.time(), 0.0);
        self.play();
        self.act(Outcome::say("Move the mouse over the view; a click ends it, Esc undoes it"));
    }

    /// Plays on while heads follow the mouse: the timeline becomes longer instead of repeating. A
    /// dialog ends it.
    fn advance_following(&mut self, passed: f64) {
        if self.shell.dialog().is_some() {
            return self.commit();
        }
        let before = self.playback.time();
        let time = (before + passed * self.playback.speed()).min(Timeline::MAX_TIME);
        self.set_time(time);
        self.record_heads(before, time - before);
    }

    /// Keys the homes at the playhead, `passed` seconds after `before`, nearer to the mouse.
    fn record_heads(&mut self, before: f64, passed: f64) {
        let Some(after) = self.editing.recorded(before, passed) else { return };
        self.write(after);
        // The user sees keys being set.
        self.playback.has_auto_keyed();
    }
}

/// The camera.
impl Session {
    /// Sets the camera; ignores an invalid one.
    pub(super) fn set_camera(&mut self, camera: Camera) {
        if camera.is_valid() {
            self.editing.set_camera(camera);
        }
    }

    pub(super) fn glide_to(&mut self, camera: Camera) {
        self.view.glide(*self.camera(), camera);
    }

    /// Moves the camera to the end of its glide.
    pub(super) fn end_glide(&mut self) {
        if let Some(camera) = self.view.take_glide_target() {
            self.set_camera(camera);
        }
    }

    /// Frames the whole rig if the tip of the selected joint is near the edge of the picture or
    /// outside.
    pub(super) fn keep_in_view(&mut self) {
        const EDGE: f32 = 0.9;
        let Some(joint) = self.selection.active() else { return };
        let projection = self.settled_camera().projection(ASPECT);
        let tip = projection.project(self.skeleton_pose().tip(joint));
        if tip.is_none_or(|tip| tip.abs().max_element() > EDGE) {
            let camera = self.framing_all();
            if camera.is_valid() {
                self.glide_to(camera);
            }
        }
    }

    pub(super) fn centre_followed(&mut self) {
        let camera = Camera { target: self.followed_point(), ..self.settled_camera() };
        if camera.is_valid() {
            self.glide_to(camera);
        }
    }

    /// Changes the pose by `change`. If the camera follows the selection, it moves as far as that
    /// does.
    fn with_camera_following(&mut self, change: impl FnOnce(&mut Self)) {
        if !self.view.follows_selection() || self.crowd().is_some() {
            return change(self);
        }
        let before = self.followed_point();
        change(self);
        let by: Vec3 = self.followed_point() - before;
        let moved = Camera { target: self.camera().target + by, ..*self.camera() };
        if moved.is_valid() {
            self.view.translate(by);
            self.set_camera(moved);
        }
    }
}
