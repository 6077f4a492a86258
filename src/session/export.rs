use std::path::PathBuf;
use std::sync::Arc;

use crate::io::Progress;

/// Settings of an export; the file extension chooses the format.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    /// The file to write.
    pub path: PathBuf,
    /// Frames per second.
    pub frame_rate: f64,
    /// Width and height of pictures, in pixels.
    pub size: (u32, u32),
}

/// An export that runs on a thread of its own.
#[derive(Clone, Debug)]
pub struct ExportJob {
    /// The file to write.
    pub path: PathBuf,
    /// Progress of the export, and the flag that cancels the export.
    pub progress: Arc<Progress>,
}

/// Equal for clones of the same job, whatever its progress.
impl PartialEq for ExportJob {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.progress, &other.progress)
    }
}
