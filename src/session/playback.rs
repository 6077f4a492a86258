use super::outcome::{Consequence, Outcome};
use crate::document::Timeline;

/// Moves through time. The document does not change.
#[derive(Clone, Debug, PartialEq)]
pub enum PlaybackAction {
    /// Plays or pauses.
    Play(bool),
    /// Moves the playhead to a time in seconds.
    SetTime(f64),
    /// Sets whether playback loops at the end of the timeline or stops there.
    SetLooping(bool),
    /// Sets the speed; 1 is real time.
    SetSpeed(f64),
    /// Turns auto-key on or off. While it is on, every edit sets keys.
    SetAutoKey(bool),
    /// Advances playback, solver runs, the crowd and the camera's glide to a time in seconds on the
    /// window's clock.
    Advance(f64),
}

/// The playhead and the settings of the transport bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Time of the playhead, in seconds.
    time: f64,
    playing: bool,
    looping: bool,
    /// Speed; 1 is real time.
    speed: f64,
    auto_key: AutoKey,
    /// Time of the previous frame on the window's clock, in seconds; `None` before the first frame.
    last_frame: Option<f64>,
}

/// True if edits set keys.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum AutoKey {
    /// Off until the document has its first key.
    #[default]
    Waiting,
    /// On since the first key; `is_news` until the user knows.
    SinceFirstKey { is_news: bool },
    /// On or off, as the user chose.
    Chosen(bool),
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            time: 0.0,
            playing: false,
            looping: true,
            speed: 1.0,
            auto_key: AutoKey::default(),
            last_frame: None,
        }
    }
}

impl Playback {
    /// Minimum and maximum speed; 1 is real time.
    pub const SPEEDS: (f64, f64) = (0.1, 4.0);

    /// Applies an action on the open document's timeline.
    pub(super) fn apply(&mut self, action: PlaybackAction, timeline: &Timeline) -> Outcome {
        match action {
            PlaybackAction::Play(playing) => return self.play(playing, timeline),
            PlaybackAction::SetTime(time) => return Consequence::SetTime(time).into(),
            PlaybackAction::SetLooping(looping) => self.looping = looping,
            PlaybackAction::SetSpeed(speed) => self.set_speed(speed),
            PlaybackAction::SetAutoKey(auto_key) => self.auto_key = AutoKey::Chosen(auto_key),
            PlaybackAction::Advance(seconds) => return Consequence::Advance(seconds).into(),
        }
        Outcome::default()
    }

    /// Plays or pauses. Playing starts over if the playhead is at the end of the timeline; pausing
    /// moves the playhead to the nearest frame.
    pub(super) fn play(&self, playing: bool, timeline: &Timeline) -> Outcome {
        let moved_to = match (self.playing, playing) {
            (false, true) if self.time >= timeline.end => Some(timeline.start),
            (true, false) => Some(timeline.snapped(self.time)),
            _ => None,
        };
        Outcome::from(moved_to.map(Consequence::SetTime)).and(Consequence::SetPlaying(playing))
    }

    /// Sets whether it plays, and forgets the previous frame.
    pub(super) fn start(&mut self, playing: bool) {
        self.playing = playing;
        self.forget_last_frame();
    }

    /// Playback for another document: paused at the start of `timeline`, with the same speed and
    /// looping.
    pub(super) fn restarted(&self, timeline: &Timeline) -> Self {
        Self { time: timeline.start, looping: self.looping, speed: self.speed, ..Self::default() }
    }

    /// Time of the playhead, in seconds.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// True if the timeline plays.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// True if playback continues from the start of the timeline when it reaches the end.
    pub fn is_looping(&self) -> bool {
        self.looping
    }

    /// True if auto-key is on, so that every edit sets keys.
    pub fn is_auto_key(&self) -> bool {
        matches!(self.auto_key, AutoKey::SinceFirstKey { .. } | AutoKey::Chosen(true))
    }

    /// True if the user is to be told that the first key has turned auto-key on.
    pub fn is_auto_key_news(&self) -> bool {
        self.auto_key == AutoKey::SinceFirstKey { is_news: true }
    }

    /// The speed; 1 is real time.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// True if the previous frame was made at `seconds` on the window's clock.
    pub(super) fn has_frame_at(&self, seconds: f64) -> bool {
        self.last_frame == Some(seconds)
    }

    /// Moves the playhead to a time in seconds, or to 0 if `time` is not finite; returns whether
    /// the playhead has moved.
    pub(super) fn set_time(&mut self, time: f64) -> bool {
        let time = if time.is_finite() { time } else { 0.0 };
        std::mem::replace(&mut self.time, time) != time
    }

    pub(super) fn set_playing(&mut self, playing: bool) {
        self.playing = playing;
    }

    /// Turns auto-key on when a document gets its first key, and off again when it has none left,
    /// unless the user chose.
    pub(super) fn follow_keys(&mut self, had_keys: bool, has_keys: bool) {
        self.auto_key = match self.auto_key {
            AutoKey::Waiting if has_keys && !had_keys => AutoKey::SinceFirstKey { is_news: true },
            AutoKey::SinceFirstKey { .. } if !has_keys => AutoKey::Waiting,
            unchanged => unchanged,
        };
    }

    /// Takes note that auto-key has set a key, so that the user knows that it is on.
    pub(super) fn has_auto_keyed(&mut self) {
        if let AutoKey::SinceFirstKey { is_news } = &mut self.auto_key {
            *is_news = false;
        }
    }

    fn set_speed(&mut self, speed: f64) {
        let (slowest, fastest) = Self::SPEEDS;
        if speed.is_finite() {
            self.speed = speed.clamp(slowest, fastest);
        }
    }

    /// Forgets the previous frame, so that a pause before the next frame does not move the
    /// playhead.
    pub(super) fn forget_last_frame(&mut self) {
        self.last_frame = None;
    }

    /// Begins a frame at `seconds` on the window's clock; returns the seconds since the previous
    /// frame, or 0 for the first.
    pub(super) fn advance_frame(&mut self, seconds: f64) -> f64 {
        let passed = self.last_frame.map_or(0.0, |last| (seconds - last).max(0.0));
        self.last_frame = Some(seconds);
        passed
    }

    /// Time of the playhead after `passed` seconds of real time, and whether playback continues.
    pub(super) fn played(&self, passed: f64, timeline: &Timeline) -> (f64, bool) {
        let time = self.time + passed * self.speed;
        if time < timeline.end {
            (time, true)
        } else if self.looping {
            (timeline.start + (time - timeline.start).rem_euclid(timeline.duration()), true)
        } else {
            (timeline.end, false)
        }
    }
}
