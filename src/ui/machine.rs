//! The machine that the panels run on.

use super::frame_times::FrameTimes;
use crate::render::Counts;
use crate::rig::CrowdTimes;

/// What the panels show of the machine they run on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Machine {
    /// The graphics adapter.
    pub adapter: String,
    /// Whether it measures its own time.
    pub has_clock: bool,
    /// How long the last drawn frames took.
    pub times: FrameTimes,
    /// What is in the scene that was drawn last.
    pub counts: Option<Counts>,
    /// How long the crowd took that is shown.
    pub crowd: Option<CrowdTimes>,
}
