use std::thread::{self, JoinHandle};

/// A job on a thread of its own.
pub(in crate::app) type Task = JoinHandle<()>;

/// Runs a job on a thread of its own.
pub(in crate::app) fn spawn(job: impl FnOnce() + Send + 'static) -> Task {
    thread::spawn(job)
}
