use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

use super::WriteError;

/// Writes a file whole or not at all: to a new file beside it first. One that is there keeps its
/// rights, and a link stays a link. What is no file, such as a pipe or a device, is written to as it
/// is.
///
/// # Errors
///
/// If the folder or the file cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let failed = |source| WriteError::Write { path: path.display().to_string(), source };
    let there = fs::metadata(path).ok();
    match &there {
        Some(there) if there.is_dir() => return Err(failed(io::ErrorKind::IsADirectory.into())),
        Some(there) if !there.is_file() => {
            let opened = fs::OpenOptions::new().write(true).open(path);
            return opened.and_then(|mut file| file.write_all(bytes)).map_err(failed);
        }
        _ => {}
    }
    // Where a link leads, so that it stays a link.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
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
    let rights = there.map(|there| there.permissions());
    replace(path, folder, rights, bytes).map_err(failed)
}

fn replace(
    path: &Path,
    folder: &Path,
    rights: Option<fs::Permissions>,
    bytes: &[u8],
) -> io::Result<()> {
    let mut file = temporary_file(folder)?;
    file.write_all(bytes)?;
    if let Some(rights) = rights {
        file.as_file().set_permissions(rights)?;
    }
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// With the rights that a new file has here, not the private ones of a temporary file.
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
