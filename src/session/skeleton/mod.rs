//! Edits of joints, targets and paths, each with its label.

pub mod joints;
pub mod targets;
