//! Recovery of unsaved changes: the document is backed up a few seconds after a change and at a
//! crash, and a later start of the program finds the backups of runs that did not end cleanly.

use std::cell::RefCell;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime};

use serde::{Deserialize, Serialize};
use thiserror::Error;
use winit::event_loop::EventLoopProxy;

use crate::app::event::UserEvent;
use crate::document::Document;
use crate::io as files;
use crate::io::{OpenOptions, SaveError};
use crate::session::Session;

/// Time from a change of the document to its backup.
const INTERVAL: Duration = Duration::from_secs(5);

/// A document and its file.
#[derive(Clone)]
pub(in crate::app) struct Backup {
    pub document: Document,
    pub file: Option<PathBuf>,
}

/// Contents of a backup file.
#[derive(Serialize, Deserialize)]
struct BackupFile {
    file: Option<PathBuf>,
    /// The document as JSON.
    document: String,
}

/// The backup of a run that did not end cleanly.
pub(in crate::app) struct RecoveredFile {
    pub backup: Backup,
    /// Path of the backup file.
    pub path: PathBuf,
    /// Lock file of the ended run, held so that no other window offers this backup.
    _claim: File,
}

/// Reasons why a backup cannot be written.
#[derive(Debug, Error)]
pub(in crate::app) enum BackupError {
    #[error("there is no folder for backups")]
    NoFolder,
    #[error(transparent)]
    Save(#[from] SaveError),
}

/// Backup file of this run. Other runs ignore the backup while this run holds the lock file.
struct BackupSlot {
    path: PathBuf,
    lock: PathBuf,
    _lock_file: File,
}

/// Backs up the document of this run.
pub(in crate::app) struct Recovery {
    slot: Option<Arc<BackupSlot>>,
    /// Backup to write at a crash; `None` if there are no unsaved changes, or they are written.
    newest: Arc<Mutex<Option<Backup>>>,
    /// Revision of the document in `newest`.
    newest_revision: Option<u64>,
    /// Revision of the backup on disk; `None` if there is no backup.
    written_revision: Option<u64>,
    /// Time since which the document differs from the latest backup; `None` if it does not.
    since: Option<Instant>,
    /// Revision that is being written, and the writing thread, which returns whether it has
    /// succeeded.
    writing: Option<(u64, JoinHandle<bool>)>,
}

impl Recovery {
    /// Takes a backup slot. If that fails, logs the reason and makes no backups.
    pub fn start() -> Self {
        let slot = folder().and_then(|folder| match BackupSlot::take(&folder) {
            Ok(slot) => Some(Arc::new(slot)),
            Err(error) => {
                log::warn!("no backups can be written to {}: {error}", folder.display());
                None
            }
        });
        let newest = Arc::new(Mutex::new(None));
        if let Some(slot) = &slot {
            write_at_crash(Arc::clone(slot), Arc::clone(&newest));
        }
        Self {
            slot,
            newest,
            newest_revision: None,
            written_revision: None,
            since: None,
            writing: None,
        }
    }

    /// Finds the newest readable backup of the runs that did not end cleanly.
    pub fn find(&self) -> Option<RecoveredFile> {
        let mut backups: Vec<(SystemTime, PathBuf)> = fs::read_dir(folder()?)
            .ok()?
            .filter_map(|entry| {
                let entry = entry.ok()?;
                // Reading a pipe or a device would never end.
                let metadata = entry.metadata().ok().filter(fs::Metadata::is_file)?;
                let path = entry.path();
                remove_stale_lock(&path);
                let is_backup = path.extension().is_some_and(|extension| extension == "json");
                is_backup.then_some((metadata.modified().ok()?, path))
            })
            .collect();
        backups.sort();
        let read = |path: PathBuf| {
            let claim = claim(&path.with_extension("lock"))?;
            match Backup::read(&path) {
                Ok(backup) => Some(RecoveredFile { backup, path, _claim: claim }),
                Err(error) => {
                    log::warn!("the backup {} cannot be opened: {error}", path.display());
                    None
                }
            }
        };
        backups.into_iter().rev().find_map(|(_, path)| read(path))
    }

    /// Writes a backup if one is due. Returns the time of the next call if a backup is pending,
    /// else `None`.
    pub fn update(
        &mut self,
        session: &Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Option<Instant> {
        let slot = Arc::clone(self.slot.as_ref()?);
        if !session.history().is_unsaved() {
            self.discard();
            return None;
        }
        self.finish_writing();
        let revision = session.history().revision();
        // An open transaction changes the document but not its revision.
        let is_editing = session.history().is_editing();
        if self.newest_revision != Some(revision) {
            self.set_newest(session);
        }
        if self.written_revision == Some(revision) && !is_editing {
            self.since = None;
            return None;
        }
        let due = *self.since.get_or_insert_with(Instant::now) + INTERVAL;
        if Instant::now() < due || self.writing.is_some() {
            return Some(due.max(Instant::now() + Duration::from_millis(100)));
        }
        if is_editing {
            self.set_newest(session);
        }
        self.since = None;
        let newest = self.newest.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let backup = newest.unwrap_or_else(|| Backup::of(session));
        let proxy = proxy.clone();
        let writing = thread::spawn(move || {
            let written = backup.write(&slot.path);
            let is_written = written.is_ok();
            // Sending fails only after the window is closed.
            let _ = proxy.send_event(match written {
                Ok(()) => UserEvent::Changed,
                Err(error) => UserEvent::Report(Err(format!("Not backed up: {error}"))),
            });
            is_written
        });
        self.writing = Some((revision, writing));
        None
    }

    /// Makes the current document the backup to write at a crash.
    fn set_newest(&mut self, session: &Session) {
        self.newest_revision = Some(session.history().revision());
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Some(Backup::of(session));
    }

    /// Records the revision as written if the writing thread has succeeded; after a failure, the
    /// next backup is due as usual.
    fn finish_writing(&mut self) {
        if self.writing.as_ref().is_some_and(|(_, writing)| writing.is_finished())
            && let Some((revision, writing)) = self.writing.take()
            && writing.join().is_ok_and(|is_written| is_written)
        {
            self.written_revision = Some(revision);
        }
    }

    /// True if the backup on disk has this revision.
    pub fn has(&self, revision: u64) -> bool {
        self.written_revision == Some(revision)
    }

    /// Removes the backup from memory and from disk.
    fn discard(&mut self) {
        if let Some((_, writing)) = self.writing.take() {
            let _ = writing.join();
        }
        self.since = None;
        self.written_revision = None;
        if self.newest_revision.take().is_none() {
            return;
        }
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = None;
        if let Some(slot) = &self.slot {
            let _ = fs::remove_file(&slot.path);
        }
    }

    /// Writes unsaved changes to the backup file, which the next start finds, and returns its path;
    /// `None` if there are no unsaved changes.
    pub fn leave(&mut self, session: &Session) -> Result<Option<PathBuf>, BackupError> {
        if !session.history().is_unsaved() {
            return Ok(None);
        }
        if let Some((_, writing)) = self.writing.take() {
            let _ = writing.join();
        }
        self.set_newest(session);
        // Without a slot, `end` does not remove the backup.
        let slot = self.slot.take().ok_or(BackupError::NoFolder)?;
        let mut newest = self.newest.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(backup) = newest.as_ref() {
            backup.write(&slot.path)?;
            *newest = None;
        }
        Ok(Some(slot.path.clone()))
    }

    /// Removes the backup and its lock file when the program ends cleanly.
    pub fn end(&mut self) {
        self.discard();
        if let Some(slot) = self.slot.take() {
            let _ = fs::remove_file(&slot.lock);
        }
    }
}

impl BackupSlot {
    fn take(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        // Process ids are reused; times are not.
        let started = SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default().as_millis();
        let path = folder.join(format!("{started}-{}.json", std::process::id()));
        let lock = path.with_extension("lock");
        let lock_file = File::create(&lock)?;
        lock_file.try_lock()?;
        Ok(Self { path, lock, _lock_file: lock_file })
    }
}

impl Backup {
    fn of(session: &Session) -> Self {
        let file = session.files().file().map(Path::to_owned);
        Self { document: session.document().clone(), file }
    }

    fn read(path: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        let BackupFile { file, document } = serde_json::from_str(&files::read_text(path)?)?;
        let name = path.display().to_string();
        Ok(Self {
            document: files::parse(&name, &document, &OpenOptions::default())?.document,
            file,
        })
    }

    fn write(&self, path: &Path) -> Result<(), SaveError> {
        let document = files::to_json(&self.document)?;
        let json = serde_json::to_string(&BackupFile { file: self.file.clone(), document })?;
        Ok(files::write(path, json.as_bytes())?)
    }
}

/// Takes the lock file of an ended run; `None` if a running program holds it.
fn claim(lock: &Path) -> Option<File> {
    let is_regular = fs::metadata(lock).map_or(true, |lock| lock.is_file());
    let file = is_regular.then(|| File::options().append(true).create(true).open(lock))?.ok()?;
    file.try_lock().is_ok().then_some(file)
}

/// Removes `lock` if it is the lock file of a run that ended without a backup.
fn remove_stale_lock(lock: &Path) {
    let is_lock = lock.extension().is_some_and(|extension| extension == "lock");
    if is_lock
        && !lock.with_extension("json").exists()
        && let Some(_claim) = claim(lock)
    {
        let _ = fs::remove_file(lock);
    }
}

/// Removes the backup of another run, with its lock file.
pub(in crate::app) fn remove(path: &Path) {
    let _ = fs::remove_file(path);
    let _ = fs::remove_file(path.with_extension("lock"));
}

thread_local! {
    static AT_EXIT: RefCell<Option<WriteAtExit>> = const { RefCell::new(None) };
}

/// Writes the newest backup at a panic, at a termination signal, and when the calling thread ends
/// the process.
fn write_at_crash(slot: Arc<BackupSlot>, newest: Arc<Mutex<Option<Backup>>>) {
    let write = Arc::new(move || write_newest(&slot, &newest));
    let at_signal = Arc::clone(&write);
    let handled = ctrlc::set_handler(move || {
        at_signal();
        std::process::exit(130);
    });
    if let Err(error) = handled {
        log::warn!("termination signals cannot be handled: {error}");
    }
    let at_panic = Arc::clone(&write);
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        at_panic();
        report(panic);
    }));
    AT_EXIT.set(Some(WriteAtExit(Box::new(move || write()))));
}

/// Writes the newest backup when it is dropped with its thread. Xlib calls `exit` on this thread
/// when the display server is gone: nothing returns to the event loop then, but thread-local values
/// are still dropped.
struct WriteAtExit(Box<dyn Fn()>);

impl Drop for WriteAtExit {
    fn drop(&mut self) {
        (self.0)();
    }
}

/// Writes the newest backup, unless it is written already.
fn write_newest(slot: &BackupSlot, newest: &Mutex<Option<Backup>>) {
    // Not `lock`, which would deadlock if this thread panicked while it held the mutex.
    let Ok(mut newest) = newest.try_lock() else { return };
    let Some(backup) = newest.as_ref() else { return };
    match backup.write(&slot.path) {
        Ok(()) => {
            *newest = None;
            log::error!("unsaved changes are in {}", slot.path.display());
        }
        Err(error) => log::error!("unsaved changes are lost: {error}"),
    }
}

fn folder() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "ik-arm")?;
    Some(folders.data_local_dir().join("recovery"))
}
