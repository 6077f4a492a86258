use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::WriteError;

/// Writes a file whole or not at all: writes a temporary file in the same folder and renames it. An
/// existing file keeps its permissions, and a link stays a link. A pipe or a device is written to
/// directly.
///
/// # Errors
///
/// Fails if the folder or the file cannot be written.
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
    // Replaces the file that a link points to, so that the link stays a link.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let permissions = existing.map(|existing| existing.permissions());
    let mut file = temporary_file(&folder_of(path)?).map_err(failed)?;
    let mut buffered = BufWriter::new(&mut file);
    write(&mut buffered)?;
    buffered.flush().map_err(failed)?;
    drop(buffered);
    persist(file, path, permissions).map_err(failed)?;
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
    permissions: Option<fs::Permissions>,
) -> io::Result<()> {
    if let Some(permissions) = permissions {
        file.as_file().set_permissions(permissions)?;
    }
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Creates a temporary file with the permissions of an ordinary new file. By default, only the
/// owner can read a temporary file.
fn temporary_file(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".ik-arm-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
