use std::path::PathBuf;
use std::sync::Arc;

use crate::io::Progress;

/// What is asked for of an export; its path's ending says the format.
#[derive(Clone, Debug, PartialEq)]
pub struct Export {
    pub path: PathBuf,
    pub frame_rate: u32,
    /// Of pictures, in pixels.
    pub size: (u32, u32),
}

/// An export under way, on a thread of its own.
#[derive(Clone, Debug)]
pub struct ExportJob {
    /// Where it goes.
    pub path: PathBuf,
    pub progress: Arc<Progress>,
}

/// The same job, not one that is as far.
impl PartialEq for ExportJob {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.progress, &other.progress)
    }
}
