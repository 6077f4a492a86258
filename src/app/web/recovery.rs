//! Recovery of unsaved changes: the document is kept in the browser's storage a second after a change,
//! and the next visit finds it.

use std::path::{Path, PathBuf};
use std::time::Duration;

use web_time::Instant;
use winit::event_loop::EventLoopProxy;

use super::storage::storage;
use crate::app::event::UserEvent;
use crate::document::Document;
use crate::io::{self, OpenOptions};
use crate::session::Session;

/// Time from a change of the document to its backup.
const INTERVAL: Duration = Duration::from_secs(1);
const DOCUMENT: &str = "ik-arm unsaved document";
const FILE: &str = "ik-arm unsaved file";

/// A document and its file.
pub struct Backup {
    pub document: Document,
    pub file: Option<PathBuf>,
}

/// The document of a visit that ended with unsaved changes.
pub struct RecoveredFile {
    pub backup: Backup,
    /// Key of the storage.
    pub path: PathBuf,
}

/// Keeps the document of this visit.
pub struct Recovery {
    /// Revision that is kept; `None` if there is none.
    kept: Option<u64>,
    /// Time since which the document differs from the one that is kept.
    since: Option<Instant>,
}

impl Recovery {
    pub fn start() -> Self {
        Self { kept: None, since: None }
    }

    /// The document of the last visit; `None` if all of its changes were saved.
    pub fn find(&self) -> Option<RecoveredFile> {
        let storage = storage()?;
        let text = storage.get_item(DOCUMENT).ok().flatten()?;
        let file = storage.get_item(FILE).ok().flatten().map(PathBuf::from);
        let opened = io::parse("the last visit", &text, &OpenOptions::default()).ok()?;
        let backup = Backup { document: opened.document, file };
        Some(RecoveredFile { backup, path: PathBuf::from(DOCUMENT) })
    }

    /// Keeps the document if that is due. Returns the time of the next call if a change is not kept
    /// yet.
    pub fn update(&mut self, session: &Session, _: &EventLoopProxy<UserEvent>) -> Option<Instant> {
        if !session.history().is_unsaved() {
            self.discard();
            return None;
        }
        let revision = session.history().revision();
        if self.kept == Some(revision) {
            self.since = None;
            return None;
        }
        let due = *self.since.get_or_insert_with(Instant::now) + INTERVAL;
        if Instant::now() < due {
            return Some(due);
        }
        self.since = None;
        self.kept = keep(session).then_some(revision);
        None
    }

    /// True if the document is kept with this revision.
    pub fn has(&self, revision: u64) -> bool {
        self.kept == Some(revision)
    }

    fn discard(&mut self) {
        self.since = None;
        if self.kept.take().is_some() {
            remove(Path::new(DOCUMENT));
        }
    }

    /// Keeps unsaved changes for the next visit.
    pub fn leave(&mut self, session: &Session) -> Result<Option<PathBuf>, String> {
        if !session.history().is_unsaved() {
            return Ok(None);
        }
        if keep(session) {
            Ok(Some(PathBuf::from("the browser's storage")))
        } else {
            Err("the browser stores nothing for this page".to_owned())
        }
    }

    /// Forgets the document when the program ends cleanly.
    pub fn end(&mut self) {
        self.discard();
    }
}

/// Keeps a document in the storage, and returns whether that has succeeded.
fn keep(session: &Session) -> bool {
    let (Some(storage), Ok(json)) = (storage(), io::to_json(session.document())) else {
        return false;
    };
    let file = session.files().file().map(|file| file.display().to_string());
    let is_kept = storage.set_item(DOCUMENT, &json).is_ok();
    let _ = match file {
        Some(file) => storage.set_item(FILE, &file),
        None => storage.remove_item(FILE),
    };
    is_kept
}

/// Removes the document of another visit.
pub fn remove(_: &Path) {
    if let Some(storage) = storage() {
        let _ = storage.remove_item(DOCUMENT);
        let _ = storage.remove_item(FILE);
    }
}
