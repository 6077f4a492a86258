use super::playback::Playback;
use super::playback_action::PlaybackAction;
use super::session::Session;

/// Playback.
impl Session {
    /// Minimum and maximum playback speed; 1 is real time.
    pub const SPEEDS: (f64, f64) = Playback::SPEEDS;

    /// Time of the playhead, in seconds.
    pub fn time(&self) -> f64 {
        self.playback.time()
    }

    /// Whether the timeline plays.
    pub fn is_playing(&self) -> bool {
        self.playback.is_playing()
    }

    /// Whether playback continues from the start of the timeline when it reaches the end.
    pub fn is_looping(&self) -> bool {
        self.playback.is_looping()
    }

    /// The playback speed; 1 is real time.
    pub fn speed(&self) -> f64 {
        self.playback.speed()
    }

    /// Whether auto-key is on, so that every edit sets keys.
    pub fn is_auto_key(&self) -> bool {
        self.playback.is_auto_key()
    }

    /// Whether the document's first key has turned auto-key on and no edit has set a key since.
    pub fn is_auto_key_news(&self) -> bool {
        self.playback.is_auto_key_news()
    }

    /// Whether the document has keys, or a target or the shown skeleton moves without keys.
    pub fn has_motion(&self) -> bool {
        self.document().is_moving()
    }

    pub(super) fn apply_playback(&mut self, action: PlaybackAction) {
        match action {
            PlaybackAction::Play(playing) => self.play(playing),
            PlaybackAction::SetTime(time) => self.set_time(time),
            PlaybackAction::SetLooping(looping) => self.playback.set_looping(looping),
            PlaybackAction::SetSpeed(speed) => self.playback.set_speed(speed),
            PlaybackAction::SetAutoKey(auto_key) => self.playback.set_auto_key(auto_key),
            PlaybackAction::Advance(seconds) => self.advance(seconds),
        }
    }

    /// Plays or pauses. Playing starts over if the playhead is at the end of the timeline; pausing
    /// moves the playhead to the nearest frame.
    pub(super) fn play(&mut self, playing: bool) {
        let timeline = self.document().timeline;
        let (time, was_playing) = (self.time(), self.is_playing());
        if playing && !was_playing && time >= timeline.end {
            self.set_time(timeline.start);
        } else if !playing && was_playing {
            self.set_time(timeline.snapped(time));
        }
        self.playback.set_playing(playing);
        self.playback.forget_last_frame();
    }

    pub(super) fn set_time(&mut self, time: f64) {
        let before = self.time();
        if self.playback.set_time(time) {
            self.shell.leave_moment();
            self.with_camera_following(|session| {
                if session.editing.discard_overrides(before, session.time()) {
                    session.say(format!(
                        "The unkeyed change at {before:.2} s is discarded: Ctrl+Z brings it back"
                    ));
                }
                session.refresh();
            });
        }
    }

    /// Pauses at a time in seconds, without an update of what depends on it.
    pub(super) fn pause_at(&mut self, time: f64) {
        if self.playback.set_time(time) {
            self.playback.set_playing(false);
            self.playback.forget_last_frame();
        }
    }

    fn advance(&mut self, seconds: f64) {
        if !seconds.is_finite() {
            return;
        }
        if let Some(camera) = self.view.advance_glide(seconds) {
            self.set_camera(camera);
        }
        if !self.playback.has_frame_at(seconds) {
            let passed = self.playback.advance_frame(seconds);
            self.view.advance_crowd(passed);
            self.advance_playhead(passed);
            self.advance_solvers(passed);
            if let Some(wiggle) = &mut self.wiggle {
                wiggle.advance(passed);
            }
        }
    }

    fn advance_playhead(&mut self, passed: f64) {
        if !self.is_playing() || passed == 0.0 {
            return;
        }
        if self.follows_mouse() {
            return self.advance_following(passed);
        }
        let (time, goes_on) = self.playback.played(passed, &self.document().timeline);
        self.set_time(time);
        self.playback.set_playing(goes_on);
    }
}
