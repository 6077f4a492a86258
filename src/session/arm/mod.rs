//! The arm's own edits, drags and measurements.

pub mod drag;
pub mod edits;
pub mod pose_line;
