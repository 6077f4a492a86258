/// Moves through time. The document does not change.
#[derive(Clone, Debug, PartialEq)]
pub enum PlaybackAction {
    /// Plays or pauses.
    Play(bool),
    /// Moves the playhead, in seconds.
    SetTime(f64),
    /// Loops at the end of the timeline, or stops there.
    SetLooping(bool),
    /// Sets the speed, 1 for real time.
    SetSpeed(f64),
    /// Keys every edit, or only on request.
    SetAutoKey(bool),
    /// Advances playback, solver runs and camera moves to a time of the window, in seconds.
    Advance(f64),
}
