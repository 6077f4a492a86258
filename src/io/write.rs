use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::WriteError;
use super::temporary_file::temporary_file;

/// Writes a file whole or not at all: writes a temporary file in the same folder and renames it. An
/// existing file keeps its owner and permissions, and a link stays a link, also one to a file that
/// is not there yet. A pipe or a device is written to directly.
///
/// # Errors
///
/// Fails if the folder or the file cannot be written, the file is write-protected, or its owner
/// cannot be kept.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    write_with(path, |file| file.write_all(bytes).map_err(|source| failed(path, source)))
}

/// Like [`write()`], for content that the closure `write` writes piece by piece. If the closure
/// fails, no file is created or replaced.
///
/// # Errors
///
/// Fails if the folder or the file cannot be written, or `write` fails.
pub fn write_with<E: From<WriteError>>(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<(), E>,
) -> Result<(), E> {
    let failed = |source| failed(path, source);
    let existing = fs::metadata(path).ok();
    match &existing {
        Some(existing) if existing.is_dir() => {
            return Err(failed(io::ErrorKind::IsADirectory.into()).into());
        }
        Some(existing) if !existing.is_file() => {
            let mut file = fs::OpenOptions::new().write(true).open(path).map_err(failed)?;
            return write(&mut file);
        }
        _ => {}
    }
    if let Some(existing) = &existing {
        check_writable(path, existing).map_err(failed)?;
    }
    // Replaces the file that a link points to, so that the link stays a link.
    let path = &end_of_links(path);
    let mut file = temporary_file(&folder_of(path)?).map_err(failed)?;
    let mut buffered = BufWriter::new(&mut file);
    write(&mut buffered)?;
    buffered.flush().map_err(failed)?;
    drop(buffered);
    persist(file, path, existing.as_ref()).map_err(failed)?;
    Ok(())
}

/// Returns the folder of a file. Fails if the folder does not exist.
pub(super) fn folder_of(path: &Path) -> Result<PathBuf, WriteError> {
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

pub(super) fn failed(path: &Path, source: io::Error) -> WriteError {
    WriteError::Write { path: path.display().to_string(), source }
}

fn persist(
    file: tempfile::NamedTempFile,
    path: &Path,
    existing: Option<&fs::Metadata>,
) -> io::Result<()> {
    if let Some(existing) = existing {
        take_over(file.as_file(), existing)?;
    }
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Fails if an existing file is write-protected. Renaming would replace it all the same, because
/// that needs the permission of the folder only.
pub(super) fn check_writable(path: &Path, existing: &fs::Metadata) -> io::Result<()> {
    // Root may write to any file, but does not mean to overwrite one that nobody may write to.
    if existing.permissions().readonly() {
        let reason = "the file is write-protected";
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, reason));
    }
    fs::OpenOptions::new().write(true).open(path)?;
    Ok(())
}

/// Gives a new file the owner, group and permissions of the file that it is to replace.
pub(super) fn take_over(file: &fs::File, existing: &fs::Metadata) -> io::Result<()> {
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
