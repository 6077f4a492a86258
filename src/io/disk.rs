//! Regular files.

use std::fs::{self, FileType};
use std::io::{self, Read, Take};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Opens a file for reading, up to its present length. Reading a pipe or a device may never end,
/// and neither may reading a file of the system that has no length, like `/proc/kmsg`.
///
/// # Errors
///
/// Fails if there is no such file, it is no regular file, or the system refuses to open it.
pub fn open_regular(path: &Path) -> io::Result<Take<fs::File>> {
    // Before it is opened, because opening a pipe waits for a writer.
    check_regular(fs::metadata(path)?.file_type())?;
    let file = fs::File::open(path)?;
    let metadata = file.metadata()?;
    check_regular(metadata.file_type())?;
    Ok(file.take(metadata.len()))
}

fn check_regular(kind: FileType) -> io::Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    let reason = format!("it must be a regular file, got {}", kind_name(kind));
    Err(io::Error::new(io::ErrorKind::InvalidInput, reason))
}

/// Name of a kind of file that is not regular.
fn kind_name(kind: FileType) -> &'static str {
    if kind.is_dir() {
        return "a folder";
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        if kind.is_fifo() {
            return "a pipe (standard input is read with -)";
        }
        if kind.is_char_device() || kind.is_block_device() {
            return "a device";
        }
        if kind.is_socket() {
            return "a socket";
        }
    }
    "something else"
}

/// The size of a file and the time of its last change, by which a change of its content by another
/// program is recognized.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileStamp {
    length: u64,
    /// `None` if the system does not know it.
    modified: Option<SystemTime>,
}

impl FileStamp {
    /// The stamp of a file as it is now; `None` if there is no such file.
    pub fn of(path: &Path) -> Option<Self> {
        let file = fs::metadata(path).ok()?;
        Some(Self { length: file.len(), modified: file.modified().ok() })
    }
}

/// The absolute path of a file; `None` without a working folder.
pub fn absolute(path: &Path) -> Option<PathBuf> {
    std::path::absolute(path).ok()
}

/// Follows the links in a path.
///
/// # Errors
///
/// Fails if there is no such file.
pub fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    fs::canonicalize(path)
}
