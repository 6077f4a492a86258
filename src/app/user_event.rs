use std::path::PathBuf;

use winit::event_loop::EventLoopProxy;

use crate::document::Baked;
use crate::io::{OpenError, OpenOptions, Opened};
use crate::rig::{MeshSkin, SkinFile, SkinFileError};
use crate::session::{BakeJob, PathDialog};

/// Events that do not come from the window.
#[derive(Debug)]
pub enum UserEvent {
    /// Request of a screen reader.
    Accesskit(egui_winit::accesskit_winit::Event),
    /// Message or error of a finished background job.
    Report(Result<String, String>),
    /// Result or error of a finished bake.
    Baked(BakeJob, Result<Box<Baked>, String>),
    /// Message or error of a finished export.
    Exported(Result<String, String>),
    /// The backup of unsaved changes was written.
    BackedUp,
    /// The graphics device failed.
    GraphicsFailed,
    /// Answer of the system's file dialog.
    Chosen(PathDialog, PathChoice),
    /// A file was read.
    Opened { path: PathBuf, options: OpenOptions, read: Box<Result<Opened, OpenError>> },
    /// The file of a skin was read.
    SkinLocated {
        path: PathBuf,
        before: Option<SkinFile>,
        read: Box<Result<MeshSkin, SkinFileError>>,
    },
}

/// Answer to a request for a path.
#[derive(Debug)]
pub enum PathChoice {
    Path(PathBuf),
    Cancelled,
    /// The system has no file dialog.
    NoDialog,
}

impl From<egui_winit::accesskit_winit::Event> for UserEvent {
    fn from(event: egui_winit::accesskit_winit::Event) -> Self {
        Self::Accesskit(event)
    }
}

/// Sends an event to the window, which may have been closed.
pub fn send(proxy: &EventLoopProxy<UserEvent>, event: UserEvent) {
    if proxy.send_event(event).is_err() {
        log::info!("the window was closed before a background job ended");
    }
}
