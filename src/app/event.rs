//! Events that reach the window from elsewhere: from jobs in the background, and from the system.

use std::path::PathBuf;

use winit::event_loop::EventLoopProxy;

use super::platform::PlatformEvent;
use crate::document::Baked;
use crate::io::{OpenError, OpenOptions, Opened};
use crate::rig::{MeshSkin, SkinFile, SkinFileError};
use crate::session::{BakeJob, InspectAction, PathDialog, ReachAction};

/// Events that do not come from the window.
#[derive(Debug)]
pub enum UserEvent {
    /// An event of the computer's or the browser's own.
    Platform(PlatformEvent),
    /// Message or error of a finished background job.
    Report(Result<String, String>),
    /// Result or error of a finished bake.
    Baked(BakeJob, Result<Box<Baked>, String>),
    /// End of an inspection of the motion.
    Inspected(Box<InspectAction>),
    /// A search for a reach region has ended.
    FoundReach(Box<ReachAction>),
    /// Message or error of a finished export.
    Exported(Result<String, String>),
    /// The backup of unsaved changes was written, or the graphics device failed: the next frame sees
    /// to it.
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "nothing waits for it"))]
    Changed,
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
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "every browser has one"))]
    NoDialog,
}

/// Sends an event to the window, which may have been closed.
pub fn send(proxy: &EventLoopProxy<UserEvent>, event: UserEvent) {
    if proxy.send_event(event).is_err() {
        log::info!("the window was closed before a background job ended");
    }
}
