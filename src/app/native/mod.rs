//! The window on a computer: threads, files, the system's dialogs, screen readers.

mod access;
mod dialogs;
mod event;
mod recovery;
mod run;
mod screen;
mod storage;
mod task;

pub(super) use dialogs::choose_path;
pub(super) use event::PlatformEvent;
pub(super) use recovery::{RecoveredFile, Recovery, remove};
pub use run::run;
pub(super) use screen::{
    address, attributes, copy, graphics, on_failure, on_first_frame, show_title,
};
pub(super) use storage::{save_settings, saved_settings, settings_place};
pub(super) use task::{Task, spawn};
