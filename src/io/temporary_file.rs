//! Temporary files beside the files that they become. Each is locked while its program runs; the
//! files of programs that were killed are not, and are removed by the next write to their folder.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;

use tempfile::{NamedTempFile, TempDir};

/// Start of the names of temporary files and folders.
const PREFIX: &str = ".ik-arm-";
/// Name of the file in a temporary folder that is locked.
const LOCK: &str = ".lock";
/// Name of the subfolder of a temporary folder that holds replaced files.
pub const REPLACED: &str = "before";

/// Creates a temporary file with the permissions of an ordinary new file. By default, only the
/// owner can read a temporary file.
pub fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
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

/// A temporary folder with the subfolder [`REPLACED`].
#[derive(Debug)]
pub struct TemporaryFolder {
    pub folder: TempDir,
    /// Locked as long as the folder is used; `None` if the system cannot lock it.
    _lock: File,
}

impl TemporaryFolder {
    pub fn new(folder: &Path) -> io::Result<Self> {
        remove_stale(folder);
        loop {
            let new = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder)?;
            let lock_path = new.path().join(LOCK);
            let Ok(lock) = File::create(&lock_path) else { continue };
            if is_ours(&lock, &lock_path) {
                fs::create_dir(new.path().join(REPLACED))?;
                return Ok(Self { folder: new, _lock: lock });
            }
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
