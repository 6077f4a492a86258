//! Nothing is lost: the document is kept every half minute and at a crash, and what another run of
//! the program kept and never came back for is found at the next start.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime};

use serde::{Deserialize, Serialize};
use thiserror::Error;
use winit::event_loop::EventLoopProxy;

use super::UserEvent;
use crate::document::Document;
use crate::io::{self as files, SaveError};
use crate::session::Session;

/// How old what is kept can be.
const PERIOD: Duration = Duration::from_secs(30);

/// A document that is kept, and where it is saved.
#[derive(Clone)]
pub(super) struct Kept {
    pub document: Document,
    pub file: Option<PathBuf>,
}

/// As it stands on the disk.
#[derive(Serialize, Deserialize)]
struct KeptFile {
    file: Option<PathBuf>,
    /// In the program's own format.
    document: String,
}

/// What another run left.
pub(super) struct Found {
    pub kept: Kept,
    /// Where it is.
    pub path: PathBuf,
}

/// Why what is not saved is not kept.
#[derive(Debug, Error)]
pub(super) enum LeaveError {
    #[error("there is no folder for it")]
    NoPlace,
    #[error(transparent)]
    Save(#[from] SaveError),
}

/// The place of this run, which no other takes for left behind while its lock is held.
struct Place {
    path: PathBuf,
    lock: PathBuf,
    _held: File,
}

/// Keeps the document of this run.
pub(super) struct Recovery {
    place: Option<Arc<Place>>,
    /// What a crash writes; nothing where all is saved.
    newest: Arc<Mutex<Option<Kept>>>,
    /// Which document `newest` is.
    noted: Option<u64>,
    /// Which document is on the disk.
    written: Option<u64>,
    /// When the document began to differ from what is on the disk.
    since: Option<Instant>,
    /// Which document is being written, and whether that worked.
    writing: Option<(u64, JoinHandle<bool>)>,
}

impl Recovery {
    /// Begins to keep; where there is no place for it, nothing is kept and the reason is logged.
    pub fn start() -> Self {
        let place = folder().and_then(|folder| match Place::take(&folder) {
            Ok(place) => Some(Arc::new(place)),
            Err(error) => {
                log::warn!("nothing can be kept in {}: {error}", folder.display());
                None
            }
        });
        let newest = Arc::new(Mutex::new(None));
        if let Some(place) = &place {
            write_at_crash(Arc::clone(place), Arc::clone(&newest));
        }
        Self { place, newest, noted: None, written: None, since: None, writing: None }
    }

    /// What another run left, the newest first.
    pub fn find(&self) -> Option<Found> {
        let mut left: Vec<(SystemTime, PathBuf)> = fs::read_dir(folder()?)
            .ok()?
            .filter_map(|entry| {
                let entry = entry.ok()?;
                let path = entry.path();
                forget_empty(&path);
                let is_kept = path.extension().is_some_and(|extension| extension == "json");
                let modified = entry.metadata().ok()?.modified().ok()?;
                (is_kept && !is_held(&path.with_extension("lock"))).then_some((modified, path))
            })
            .collect();
        left.sort();
        let read = |path: PathBuf| match Kept::read(&path) {
            Ok(kept) => Some(Found { kept, path }),
            Err(error) => {
                log::warn!("what {} keeps cannot be opened: {error}", path.display());
                None
            }
        };
        left.into_iter().rev().find_map(|(_, path)| read(path))
    }

    /// Follows the session. When to look again, if something waits to be written.
    pub fn follow(
        &mut self,
        session: &Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Option<Instant> {
        let place = Arc::clone(self.place.as_ref()?);
        if !session.is_unsaved() {
            self.forget();
            return None;
        }
        self.follow_writing();
        let revision = session.revision();
        // A change under way goes on without another number.
        let is_changing = session.is_changing();
        if self.noted != Some(revision) {
            self.note(session);
        }
        if self.written == Some(revision) && !is_changing {
            self.since = None;
            return None;
        }
        let due = *self.since.get_or_insert_with(Instant::now) + PERIOD;
        if Instant::now() < due || self.writing.is_some() {
            return Some(due.max(Instant::now() + Duration::from_millis(100)));
        }
        if is_changing {
            self.note(session);
        }
        self.since = None;
        let kept = self.newest.lock().unwrap_or_else(PoisonError::into_inner).clone()?;
        let proxy = proxy.clone();
        let writing = thread::spawn(move || {
            let written = kept.write(&place.path);
            let is_written = written.is_ok();
            // Nobody hears it once the window is closed.
            let _ = proxy.send_event(match written {
                Ok(()) => UserEvent::Kept,
                Err(error) => UserEvent::Report(Err(format!("Not kept safe: {error}"))),
            });
            is_written
        });
        self.writing = Some((revision, writing));
        None
    }

    /// What a crash writes is the document as it is now.
    fn note(&mut self, session: &Session) {
        self.noted = Some(session.revision());
        let file = session.file().map(Path::to_owned);
        let kept = Kept { document: session.document().clone(), file };
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Some(kept);
    }

    /// What could not be written is tried again after a while.
    fn follow_writing(&mut self) {
        if self.writing.as_ref().is_some_and(|(_, writing)| writing.is_finished())
            && let Some((revision, writing)) = self.writing.take()
            && writing.join().is_ok_and(|is_written| is_written)
        {
            self.written = Some(revision);
        }
    }

    /// Whether a document is on the disk.
    pub fn has(&self, revision: u64) -> bool {
        self.written == Some(revision)
    }

    /// Lets go of what is saved, or not wanted.
    fn forget(&mut self) {
        if let Some((_, writing)) = self.writing.take() {
            let _ = writing.join();
        }
        self.since = None;
        self.written = None;
        if self.noted.take().is_none() {
            return;
        }
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = None;
        if let Some(place) = &self.place {
            let _ = fs::remove_file(&place.path);
        }
    }

    /// Writes what is not saved, for the next start to find when this run has ended. Where, if
    /// there is anything.
    pub fn leave(&mut self, session: &Session) -> Result<Option<PathBuf>, LeaveError> {
        if !session.is_unsaved() {
            return Ok(None);
        }
        if let Some((_, writing)) = self.writing.take() {
            let _ = writing.join();
        }
        self.note(session);
        // Not kept in a place any more, it is not taken away at the end.
        let place = self.place.take().ok_or(LeaveError::NoPlace)?;
        if let Some(kept) = self.newest.lock().unwrap_or_else(PoisonError::into_inner).as_ref() {
            kept.write(&place.path)?;
        }
        Ok(Some(place.path.clone()))
    }

    /// The program ends as it should.
    pub fn end(&mut self) {
        self.forget();
        if let Some(place) = self.place.take() {
            let _ = fs::remove_file(&place.lock);
        }
    }
}

impl Place {
    fn take(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        // Numbers of processes come again; times do not.
        let started = SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default().as_millis();
        let path = folder.join(format!("{started}-{}.json", std::process::id()));
        let lock = path.with_extension("lock");
        let held = File::create(&lock)?;
        held.try_lock()?;
        Ok(Self { path, lock, _held: held })
    }
}

impl Kept {
    fn read(path: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        let KeptFile { file, document } = serde_json::from_str(&fs::read_to_string(path)?)?;
        let name = path.display().to_string();
        Ok(Self { document: files::parse(&name, &document, None)?.document, file })
    }

    fn write(&self, path: &Path) -> Result<(), SaveError> {
        let document = files::to_json(&self.document)?;
        let json = serde_json::to_string(&KeptFile { file: self.file.clone(), document })?;
        Ok(files::write(path, json.as_bytes())?)
    }
}

/// Whether a run of the program holds a lock.
fn is_held(lock: &Path) -> bool {
    File::open(lock).is_ok_and(|lock| matches!(lock.try_lock(), Err(fs::TryLockError::WouldBlock)))
}

/// A run that was ended with nothing to keep left its lock alone.
fn forget_empty(lock: &Path) {
    let is_lock = lock.extension().is_some_and(|extension| extension == "lock");
    if is_lock && !lock.with_extension("json").exists() && !is_held(lock) {
        let _ = fs::remove_file(lock);
    }
}

/// Takes away what another run left, once it is open or not wanted.
pub(super) fn remove(path: &Path) {
    let _ = fs::remove_file(path);
    let _ = fs::remove_file(path.with_extension("lock"));
}

/// A panic, and a signal to end, write what is newest.
fn write_at_crash(place: Arc<Place>, newest: Arc<Mutex<Option<Kept>>>) {
    let write = move || {
        // Not lock, which would wait for ever if the panic is where it is held.
        if let Ok(kept) = newest.try_lock()
            && let Some(kept) = kept.as_ref()
        {
            match kept.write(&place.path) {
                Ok(()) => log::error!("the document is kept in {}", place.path.display()),
                Err(error) => log::error!("the document could not be kept: {error}"),
            }
        }
    };
    let write = Arc::new(write);
    let at_signal = Arc::clone(&write);
    let handled = ctrlc::set_handler(move || {
        at_signal();
        std::process::exit(130);
    });
    if let Err(error) = handled {
        log::warn!("signals to end are not heeded: {error}");
    }
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        write();
        report(panic);
    }));
}

fn folder() -> Option<PathBuf> {
    let folders = directories::ProjectDirs::from("", "", "ik-arm")?;
    Some(folders.data_local_dir().join("recovery"))
}
