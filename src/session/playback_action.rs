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
