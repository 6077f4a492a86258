use std::fs;
use std::path::Path;
use std::time::SystemTime;

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
