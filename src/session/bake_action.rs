use std::sync::Arc;

use crate::document::{Bake, Baked};
use crate::io::Progress;

/// Starts and ends bakes, which run on a thread of their own.
#[derive(Clone, Debug, PartialEq)]
pub enum BakeAction {
    /// Starts a bake; the bake dialog shows its progress.
    Start(Bake),
    /// A bake has started.
    Started(BakeJob),
    /// A bake has ended, with its result or an error. The result of a bake whose dialog was closed is
    /// dropped.
    Ended(BakeJob, Result<Box<Baked>, String>),
}

/// A bake that runs on a thread of its own.
#[derive(Clone, Debug)]
pub struct BakeJob {
    /// Progress of the bake, and the flag that cancels it.
    pub progress: Arc<Progress>,
}

/// Equal for clones of the same job, whatever its progress.
impl PartialEq for BakeJob {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.progress, &other.progress)
    }
}
