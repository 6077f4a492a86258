//! The panels: functions that read a session and push actions. They use neither a window nor a GPU.

mod commands;
mod dialogs;
mod frame_times;
mod gizmo;
mod glossary;
mod input_parts;
mod keyboard;
mod labels;
mod layout;
mod machine;
mod menu_bar;
mod mouse_hints;
mod panels;
mod pose_summary;
mod status_bar;
pub mod style;
mod timeline;
mod tour;
mod viewport;
mod why;
mod widgets;

pub use frame_times::{FrameTime, FrameTimes, TimeSpread};
pub use input_parts::{hold_typed, strokes};
pub use layout::show;
pub use machine::Machine;
