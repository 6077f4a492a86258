//! Measurements of the machine.

use super::frame_times::FrameTimes;
use crate::render::Counts;
use crate::rig::CrowdTimes;

/// Measurements of the machine, for the panels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Machine {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// True if the adapter has timestamp queries.
    pub has_clock: bool,
    /// Durations of the last frames.
    pub times: FrameTimes,
    /// Contents of the scene that was drawn last.
    pub counts: Option<Counts>,
    /// Durations of the crowd that is shown.
    pub crowd: Option<CrowdTimes>,
}
