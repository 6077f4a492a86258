//! Recovery of unsaved changes: the document is kept in the browser's storage after each change, and the
//! next visit finds it.

use std::path::{Path, PathBuf};

use web_time::Instant;
use winit::event_loop::EventLoopProxy;

use super::storage::storage;
use crate::app::event::UserEvent;
use crate::document::Document;
use crate::io::{self, OpenOptions};
use crate::session::Session;

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
    /// The latest revision that was to be kept, and whether the browser has kept it; `None` if all
    /// changes are saved.
    kept: Option<(u64, bool)>,
}

impl Recovery {
    pub fn start() -> Self {
        Self { kept: None }
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

    /// Keeps the document if it has changed. There is never a time to wait for.
    pub fn update(&mut self, session: &Session, _: &EventLoopProxy<UserEvent>) -> Option<Instant> {
        if !session.history().is_unsaved() {
            self.end();
            return None;
        }
        let revision = session.history().revision();
        if self.kept.is_none_or(|(kept, _)| kept != revision) {
            self.kept = Some((revision, keep(session)));
        }
        None
    }

    /// True if the document is kept with this revision.
    pub fn has(&self, revision: u64) -> bool {
        self.kept == Some((revision, true))
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

    /// Forgets the document, because its changes are saved or given up.
    pub fn end(&mut self) {
        if self.kept.take().is_some() {
            remove(Path::new(DOCUMENT));
        }
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
