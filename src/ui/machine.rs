//! The graphics adapter and measurements of speed.

use super::frame_times::FrameTimes;
use crate::render::Counts;
use crate::rig::CrowdTimes;

/// The graphics adapter, and measurements of frames, scene and crowd, for the panels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Machine {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// True if the adapter has timestamp queries.
    pub has_clock: bool,
    /// Durations of the most recent frames.
    pub times: FrameTimes,
    /// Numbers of shapes, labels, triangles and uploaded bytes of the scene that was drawn last;
    /// `None` before the first scene.
    pub counts: Option<Counts>,
    /// Time taken to solve the shown crowd; `None` without a crowd.
    pub crowd: Option<CrowdTimes>,
}
