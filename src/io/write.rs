//! Files that are written whole or not at all: one file, or all files of a batch.
//!
//! They are first written to temporary files beside those that they become. Each temporary file is
//! locked while its program runs; those of programs that were killed are not, and are removed by
//! the next write to their folder.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::{NamedTempFile, TempDir};

use super::error::WriteError;

/// Writes a file whole or not at all: writes a temporary file in the same folder and renames it. An
/// existing file keeps its owner and permissions, and a link stays a link, also one to a file that
/// is not there yet. A pipe or a device is written to directly.
///
/// # Errors
///
/// Fails if the folder or the file cannot be written, the file is write-protected, or its owner
/// cannot be kept.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let mut file = NewFile::at(path)?;
    file.write_all(bytes).map_err(|source| failed(path, source))?;
    file.finish()
}

/// A file that is written piece by piece, whole or not at all like that of [`write()`]: until it is
/// finished, no file is created or replaced.
#[derive(Debug)]
pub struct NewFile {
    /// Where it is written, at the end of links.
    path: PathBuf,
    /// The file that it replaces.
    existing: Option<fs::Metadata>,
    output: Output,
}

#[derive(Debug)]
enum Output {
    Temporary(BufWriter<NamedTempFile>),
    /// A pipe or a device.
    Direct(File),
}

impl NewFile {
    /// Begins a file, which becomes the one at `path`.
    ///
    /// # Errors
    ///
    /// Fails if the folder cannot be written to, or the file is write-protected.
    pub fn at(path: &Path) -> Result<Self, WriteError> {
        let failed = |source| failed(path, source);
        let existing = fs::metadata(path).ok();
        match &existing {
            Some(existing) if existing.is_dir() => {
                return Err(failed(io::ErrorKind::IsADirectory.into()));
            }
            Some(special) if !special.is_file() => {
                let file = fs::OpenOptions::new().write(true).open(path).map_err(failed)?;
                let (path, output) = (path.to_owned(), Output::Direct(file));
                return Ok(Self { path, existing, output });
            }
            Some(existing) => check_writable(path, existing).map_err(failed)?,
            None => {}
        }
        // Replaces the file that a link points to, so that the link stays a link.
        let path = end_of_links(path);
        let file = temporary_file(&folder_of(&path)?).map_err(failed)?;
        Ok(Self { path, existing, output: Output::Temporary(BufWriter::new(file)) })
    }

    /// Moves the file to its path.
    ///
    /// # Errors
    ///
    /// Fails if the rest cannot be written, or the owner of the file before cannot be kept.
    pub fn finish(self) -> Result<(), WriteError> {
        let Self { path, existing, output } = self;
        let persisted = match output {
            Output::Temporary(file) => file
                .into_inner()
                .map_err(io::IntoInnerError::into_error)
                .and_then(|file| persist(file, &path, existing.as_ref())),
            Output::Direct(mut file) => file.flush(),
        };
        persisted.map_err(|source| failed(&path, source))
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.output {
            Output::Temporary(file) => file.write(bytes),
            Output::Direct(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.output {
            Output::Temporary(file) => file.flush(),
            Output::Direct(file) => file.flush(),
        }
    }
}

/// Files of one folder that are written all together or not at all. They are first written to a
/// temporary folder inside that folder.
///
/// Only [`FileBatch::finish`] replaces existing files. It restores them if one of them cannot be
/// replaced.
#[derive(Debug)]
pub struct FileBatch {
    folder: PathBuf,
    /// Temporary folder of the new files, with the subfolder [`REPLACED`] for the files that they
    /// replace. Deleted when the batch is dropped.
    temporary: TempDir,
    /// Locked as long as the temporary folder is used.
    _lock: File,
    names: Mutex<Vec<OsString>>,
}

impl FileBatch {
    /// Returns a batch without files, for the folder that contains the file `path`.
    ///
    /// # Errors
    ///
    /// Fails if the folder cannot be written to.
    pub fn beside(path: &Path) -> Result<Self, WriteError> {
        let folder = folder_of(path)?;
        let (temporary, lock) = temporary_folder(&folder).map_err(|source| failed(path, source))?;
        Ok(Self { folder, temporary, _lock: lock, names: Mutex::default() })
    }

    /// Adds a file. Its name must differ from the names of the other files in the batch. Several
    /// threads can add files at once.
    ///
    /// # Errors
    ///
    /// Fails if the file cannot be written.
    pub fn add(&self, name: &OsStr, bytes: &[u8]) -> Result<(), WriteError> {
        let path = self.new_path(name);
        fs::write(path, bytes).map_err(|source| failed(&self.folder.join(name), source))?;
        self.names.lock().unwrap_or_else(PoisonError::into_inner).push(name.to_owned());
        Ok(())
    }

    /// Moves all files from the temporary folder to their final folder.
    ///
    /// # Errors
    ///
    /// Fails if a file cannot be moved. The final folder is then restored as far as possible.
    pub fn finish(self) -> Result<(), WriteError> {
        let names = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        for (index, name) in names.iter().enumerate() {
            if let Err(source) = self.install(name) {
                names[..index].iter().rev().for_each(|name| self.restore(name));
                return Err(failed(&self.folder.join(name), source));
            }
        }
        Ok(())
    }

    fn install(&self, name: &OsStr) -> io::Result<()> {
        let (path, backup) = (self.folder.join(name), self.backup_path(name));
        match fs::symlink_metadata(&path) {
            Ok(existing) if existing.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Ok(existing) => {
                if existing.is_file() {
                    check_writable(&path, &existing)?;
                    take_over(&File::open(self.new_path(name))?, &existing)?;
                }
                fs::rename(&path, &backup)?;
            }
            Err(_) => {}
        }
        fs::rename(self.new_path(name), &path).inspect_err(|_| {
            let _ = fs::rename(&backup, &path);
        })
    }

    fn restore(&self, name: &OsStr) {
        let path = self.folder.join(name);
        // Errors are ignored, because the caller already has an error to report.
        let _ = fs::remove_file(&path);
        let _ = fs::rename(self.backup_path(name), &path);
    }

    fn new_path(&self, name: &OsStr) -> PathBuf {
        self.temporary.path().join(name)
    }

    fn backup_path(&self, name: &OsStr) -> PathBuf {
        self.temporary.path().join(REPLACED).join(name)
    }
}

/// Returns the folder of a file. Fails if the folder does not exist.
fn folder_of(path: &Path) -> Result<PathBuf, WriteError> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(WriteError::NoFolder {
            path: path.display().to_string(),
            folder: folder.display().to_string(),
        });
    }
    Ok(folder.to_owned())
}

fn failed(path: &Path, source: io::Error) -> WriteError {
    WriteError::Write { path: path.display().to_string(), source }
}

fn persist(file: NamedTempFile, path: &Path, existing: Option<&fs::Metadata>) -> io::Result<()> {
    if let Some(existing) = existing {
        take_over(file.as_file(), existing)?;
    }
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Fails if an existing file is write-protected. Renaming would replace it all the same, because
/// that needs the permission of the folder only.
fn check_writable(path: &Path, existing: &fs::Metadata) -> io::Result<()> {
    // Root may write to any file, but does not mean to overwrite one that nobody may write to.
    if existing.permissions().readonly() {
        let reason = "the file is write-protected";
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, reason));
    }
    fs::OpenOptions::new().write(true).open(path)?;
    Ok(())
}

/// Gives a new file the owner, group and permissions of the file that it is to replace.
fn take_over(file: &File, existing: &fs::Metadata) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt as _, fchown};
        let new = file.metadata()?;
        if (new.uid(), new.gid()) != (existing.uid(), existing.gid()) {
            fchown(file, Some(existing.uid()), Some(existing.gid())).map_err(|_| {
                let reason = "it belongs to another user or group, which a new file cannot";
                io::Error::new(io::ErrorKind::PermissionDenied, reason)
            })?;
        }
    }
    // After the owner, whose change may reset permissions.
    file.set_permissions(existing.permissions())
}

/// The path at the end of a chain of links, also if there is no file yet.
fn end_of_links(path: &Path) -> PathBuf {
    /// Longest chain that is followed, as in the system.
    const MOST: usize = 40;
    if let Ok(path) = fs::canonicalize(path) {
        return path;
    }
    let mut path = path.to_owned();
    for _ in 0..MOST {
        let Ok(target) = fs::read_link(&path) else { break };
        path = path.parent().unwrap_or(Path::new("")).join(target);
    }
    path
}

/// Start of the names of temporary files and folders.
const PREFIX: &str = ".ik-arm-";
/// Name of the file in a temporary folder that is locked.
const LOCK: &str = ".lock";
/// Name of the subfolder of a temporary folder that holds replaced files.
const REPLACED: &str = "before";

/// Creates a temporary file with the permissions of an ordinary new file. By default, only the
/// owner can read a temporary file.
fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
    remove_stale(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    loop {
        let file = builder.tempfile_in(folder)?;
        if is_ours(file.as_file(), file.path()) {
            return Ok(file);
        }
    }
}

/// Creates a temporary folder with the subfolder [`REPLACED`], and the file in it that is locked as
/// long as the folder is used.
fn temporary_folder(folder: &Path) -> io::Result<(TempDir, File)> {
    remove_stale(folder);
    loop {
        let new = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder)?;
        let lock_path = new.path().join(LOCK);
        let Ok(lock) = File::create(&lock_path) else { continue };
        if is_ours(&lock, &lock_path) {
            fs::create_dir(new.path().join(REPLACED))?;
            return Ok((new, lock));
        }
    }
}

/// Locks a new file. Returns whether no other program has taken it for a stale one before that.
fn is_ours(file: &File, path: &Path) -> bool {
    !matches!(file.try_lock(), Err(TryLockError::WouldBlock)) && path.exists()
}

/// Removes the temporary files and folders of programs that no longer run.
fn remove_stale(folder: &Path) {
    // Errors are ignored: what is left does not keep new files from being written.
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if !entry.file_name().to_string_lossy().starts_with(PREFIX) {
            continue;
        }
        let (path, kind) = (entry.path(), entry.file_type());
        if kind.as_ref().is_ok_and(fs::FileType::is_file) {
            if let Some(_lock) = lock_of_dead(&path) {
                let _ = fs::remove_file(&path);
            }
        } else if kind.is_ok_and(|kind| kind.is_dir())
            && let Some(_lock) = lock_of_dead(&path.join(LOCK))
        {
            put_back(&path.join(REPLACED), folder);
            let _ = fs::remove_dir_all(&path);
        }
    }
}

/// Takes the lock of a file that no running program holds.
fn lock_of_dead(path: &Path) -> Option<File> {
    let file = File::open(path).ok()?;
    file.try_lock().is_ok().then_some(file)
}

/// Moves replaced files back that were not yet replaced when their program was killed.
fn put_back(replaced: &Path, folder: &Path) {
    for entry in fs::read_dir(replaced).into_iter().flatten().flatten() {
        let path = folder.join(entry.file_name());
        if fs::symlink_metadata(&path).is_err() {
            let _ = fs::rename(entry.path(), path);
        }
    }
}
