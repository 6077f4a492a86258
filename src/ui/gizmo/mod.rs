//! Handles in the viewport: their positions on screen, hit tests and painting.

mod handles;
mod limit_marks;
pub(in crate::ui) mod screen;
mod skeleton;
mod twist_ring;

pub(in crate::ui) use screen::{aims, freedom, limb_of_page, locked_axis};
pub(in crate::ui) use skeleton::Gizmo;
