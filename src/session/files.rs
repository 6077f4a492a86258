use std::path::{Path, PathBuf};

use super::{Dialog, Effect, FileAction, Session};
use crate::document::Document;

/// The document's way to the disk and from there.
impl Session {
    /// How many files are remembered.
    const MOST_RECENT: usize = 10;

    /// Where the document was opened from or saved to.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// The same number, the same document: what is saved, not how it is looked at.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Files that were opened or saved, the last one first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.recent
    }

    /// Remembers files of an earlier session.
    pub fn set_recent(&mut self, recent: Vec<PathBuf>) {
        self.recent = recent;
        self.recent.truncate(Self::MOST_RECENT);
    }

    /// Opens what an earlier run of the program kept: it is not saved yet.
    pub(super) fn recover(&mut self, document: Document, file: Option<PathBuf>) {
        self.replace_document(document, file);
        self.saved_content = self.content - 1;
        self.recovery_settled = true;
        self.say("The document that was kept is open; save it");
    }

    /// Whether a file that took its time to open would now take the place of changes that were made
    /// meanwhile.
    pub(super) fn came_late(&self, action: &FileAction) -> bool {
        let is_other = self.opening.is_some_and(|revision| revision != self.revision);
        matches!(action, FileAction::Opened { .. }) && (is_other || self.is_changing())
    }

    /// Whether what an earlier run kept has been opened or declined.
    pub fn has_settled_recovery(&self) -> bool {
        self.recovery_settled
    }

    pub(super) fn replace_document(&mut self, document: Document, file: Option<PathBuf>) {
        let playback = super::Playback {
            looping: self.playback.looping,
            speed: self.playback.speed,
            time: document.timeline.start,
            ..super::Playback::default()
        };
        let recent = std::mem::take(&mut self.recent);
        let newest_revision = self.newest_revision + 1;
        *self = Self {
            file: file.clone(),
            recent,
            playback,
            export_folder: self.export_folder.take(),
            revision: newest_revision,
            newest_revision,
            content: newest_revision,
            saved_content: newest_revision,
            recovery_settled: self.recovery_settled,
            job: self.job.take(),
            ..Self::with_document(self.preferences, document)
        };
        self.refresh();
        self.pops = super::Pops::new(&self.shown.arm, self.pose, self.playback.time);
        self.forget_trail();
        if let Some(file) = file {
            self.remember_file(file);
        }
    }

    /// Writes to where the document is from, or asks for a place if it is from nowhere.
    pub(super) fn save(&mut self) -> Effect {
        self.end_glide();
        match &self.file {
            Some(path) => Effect::Save(path.clone()),
            None => Effect::ChoosePath(Dialog::save_as()),
        }
    }

    /// Goes on with what waited for it.
    pub(super) fn saved(&mut self, path: PathBuf) -> Option<Effect> {
        self.say(format!("Saved {}", path.display()));
        self.commit_edit();
        self.end_run();
        self.begin_run();
        self.saved_content = self.content;
        self.remember_file(path.clone());
        self.file = Some(path);
        self.then.take().and_then(|then: Box<FileAction>| self.apply_file(*then))
    }

    /// Asks for another place, and says why this one will not do.
    pub(super) fn not_saved(&mut self, path: &Path, why: &str) {
        self.fail(format!("not saved: {why}"));
        let (path, problem) = (path.display().to_string(), Some(why.to_owned()));
        self.open_dialog(Dialog::SaveAs { path, problem });
        self.then = None;
    }

    /// Keeps the dialog with the path that could not be opened.
    pub(super) fn not_opened(&mut self, path: &Path, why: &str) {
        self.fail(format!("not opened: {why}"));
        if self.dialog.as_ref().is_none_or(|dialog| matches!(dialog, Dialog::Open { .. })) {
            let (path, problem) = (path.display().to_string(), Some(why.to_owned()));
            self.open_dialog(Dialog::Open { path, problem });
        }
    }

    fn remember_file(&mut self, path: PathBuf) {
        let path = std::path::absolute(&path).unwrap_or(path);
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(Self::MOST_RECENT);
    }
}
