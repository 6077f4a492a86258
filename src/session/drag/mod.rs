//! Drags in the viewport: which part is dragged, how the mouse moves it, and what that edits.

pub mod body;
pub mod follow_mouse;
pub mod grip;
pub mod joints;
pub mod limit_fan;
pub mod point;
pub mod turn;
