use std::fs::{self, FileType};
use std::io::{self, Read as _, Take};
use std::path::Path;
use std::time::SystemTime;

/// Opens a file for reading, up to its present length. Reading a pipe or a device may never end,
/// and neither may reading a file of the system that has no length, like `/proc/kmsg`.
///
/// # Errors
///
/// Fails if there is no such file, it is no regular file, or the system refuses to open it.
pub fn open_regular(path: &Path) -> io::Result<Take<fs::File>> {
    // Before it is opened, because opening a pipe waits for a writer.
    check(fs::metadata(path)?.file_type())?;
    let file = fs::File::open(path)?;
    let metadata = file.metadata()?;
    check(metadata.file_type())?;
    Ok(file.take(metadata.len()))
}

/// Reads the text of a regular file.
///
/// # Errors
///
/// As for [`open_regular`], and if the text is not UTF-8.
#[cfg(feature = "app")]
pub fn read_text(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    open_regular(path)?.read_to_string(&mut text)?;
    Ok(text)
}

fn check(kind: FileType) -> io::Result<()> {
    match kind_name(kind) {
        None => Ok(()),
        Some(name) => {
            let reason = format!("it must be a regular file, got {name}");
            Err(io::Error::new(io::ErrorKind::InvalidInput, reason))
        }
    }
}

/// Name of a kind of file that is not regular; `None` for a regular file.
fn kind_name(kind: FileType) -> Option<&'static str> {
    if kind.is_file() {
        return None;
    }
    if kind.is_dir() {
        return Some("a folder");
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        if kind.is_fifo() {
            return Some("a pipe (standard input is read with -)");
        }
        if kind.is_char_device() || kind.is_block_device() {
            return Some("a device");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
    }
    Some("something else")
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
