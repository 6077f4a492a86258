use std::thread::{self, JoinHandle};

/// A job on a thread of its own.
pub(in crate::app) type Task = JoinHandle<()>;

/// Runs a job on a thread of its own.
pub(in crate::app) fn spawn(job: impl AsyncFnOnce() + Send + 'static) -> Task {
    thread::spawn(move || pollster::block_on(job()))
}
