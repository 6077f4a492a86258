//! The program in a page of a browser: one canvas, no threads, files that the user gives to the page,
//! downloads, and the browser's storage.

mod canvas;
mod clipboard;
mod connect;
mod console;
mod event;
mod files;
mod link;
mod message;
mod page;
mod recovery;
mod run;
mod storage;
mod task;

pub(super) use canvas::{attributes, graphics};
pub(super) use clipboard::copy;
pub(super) use event::PlatformEvent;
pub(super) use files::choose_path;
pub(super) use link::address;
pub(super) use page::{on_failure, on_first_frame, show_title};
pub(super) use recovery::{RecoveredFile, Recovery, remove};
pub use run::run;
pub(super) use storage::{save_settings, saved_settings, settings_place};
pub(super) use task::{Task, spawn};
