use std::path::PathBuf;
use std::sync::Arc;

use super::{Dialog, Effect, FileAction, Session};
use crate::io::Progress;

/// What is asked for of an export; its path's ending says the format.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    pub path: PathBuf,
    pub frame_rate: u32,
    /// Of pictures, in pixels.
    pub size: (u32, u32),
}

/// An export under way, on a thread of its own.
#[derive(Clone, Debug)]
pub struct Job {
    /// Where it goes.
    pub path: PathBuf,
    pub progress: Arc<Progress>,
}

/// The same job, not one that is as far.
impl PartialEq for Job {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.progress, &other.progress)
    }
}

impl Session {
    /// What is being exported.
    pub fn job(&self) -> Option<&Job> {
        self.job.as_ref()
    }

    /// Asks how to export the document.
    pub fn export_dialog(&self) -> Dialog {
        const SIZE: (u32, u32) = (1280, 800);
        let stem = self.file.as_ref().and_then(|file| file.file_stem());
        let stem = stem.map_or("ik-arm".into(), |stem| stem.to_string_lossy());
        Dialog::Export(Export {
            path: format!("{stem}.glb").into(),
            frame_rate: self.document.timeline.frame_rate,
            size: SIZE,
        })
    }

    pub(super) fn export(&mut self, export: Export) -> Option<Effect> {
        if self.job.is_some() {
            self.say("Another export is under way; cancel it or wait");
            return None;
        }
        self.dialog = None;
        self.remember_export_folder(&export.path);
        Some(Effect::Export(export))
    }

    /// Whether an export runs that is not told to stop.
    pub(super) fn is_exporting(&self) -> bool {
        self.job.as_ref().is_some_and(|job| !job.progress.is_cancelled())
    }

    /// Quits as soon as the export has stopped and left no file.
    pub(super) fn stop_export_and_quit(&mut self) -> Option<Effect> {
        self.dialog = None;
        self.cancel_export();
        self.apply_file(FileAction::Quit)
    }

    pub(super) fn cancel_export(&mut self) {
        if let Some(job) = &self.job {
            job.progress.cancel();
            self.say("Cancelling the export …");
        }
    }
}
