use std::path::{Path, PathBuf};

use super::{Action, Dialog, Effect, Session};
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
        self.saved_revision = self.revision - 1;
        self.recovery_settled = true;
        self.message = Some("The document that was kept is open; save it".to_owned());
    }

    /// Whether a file that took its time to open would now take the place of changes that were made
    /// meanwhile.
    pub(super) fn came_late(&self, action: &Action) -> bool {
        let is_other = self.opening.is_some_and(|revision| revision != self.revision);
        matches!(action, Action::Opened { .. }) && (is_other || self.is_changing())
    }

    /// Whether what an earlier run kept has been opened or declined.
    pub fn has_settled_recovery(&self) -> bool {
        self.recovery_settled
    }

    pub(super) fn replace_document(&mut self, document: Document, file: Option<PathBuf>) {
        let clock = super::Clock {
            looping: self.clock.looping,
            speed: self.clock.speed,
            time: document.timeline.start,
            ..super::Clock::default()
        };
        let recent = std::mem::take(&mut self.recent);
        let newest_revision = self.newest_revision + 1;
        *self = Self {
            file: file.clone(),
            recent,
            clock,
            revision: newest_revision,
            saved_revision: newest_revision,
            newest_revision,
            recovery_settled: self.recovery_settled,
            job: self.job.take(),
            ..Self::with_document(self.preferences, document)
        };
        self.refresh();
        self.pops = super::Pops::new(&self.shown.arm, self.pose, self.clock.time);
        self.forget_trail();
        if let Some(file) = file {
            self.remember_file(file);
        }
    }

    /// Writes to where the document is from, or asks for a place if it is from nowhere.
    pub(super) fn save(&self) -> Effect {
        match &self.file {
            Some(path) => Effect::Save(path.clone()),
            None => Effect::ChoosePath(Dialog::SaveAs { path: "ik-arm.json".to_owned() }),
        }
    }

    /// Goes on with what waited for it.
    pub(super) fn saved(&mut self, path: PathBuf) -> Option<Effect> {
        self.message = Some(format!("Saved {}", path.display()));
        self.commit_edit();
        self.end_run();
        self.begin_run();
        self.saved_revision = self.revision;
        self.remember_file(path.clone());
        self.file = Some(path);
        self.then.take().and_then(|then: Box<Action>| self.apply(*then))
    }

    pub(super) fn close_dialog(&mut self) {
        self.dialog = None;
        self.then = None;
    }

    fn remember_file(&mut self, path: PathBuf) {
        let path = std::path::absolute(&path).unwrap_or(path);
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(Self::MOST_RECENT);
    }
}
