use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use thiserror::Error;

/// How far a long job is, and whether it is to go on: shared by who does it and who waits for it.
#[derive(Debug, Default)]
pub struct Progress {
    done: AtomicUsize,
    of: AtomicUsize,
    cancelled: AtomicBool,
}

/// The job was to stop, and did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Progress {
    /// Said by the job, often: so many steps are done, of so many.
    ///
    /// # Errors
    ///
    /// If the job is to stop.
    pub fn step(&self, done: usize, of: usize) -> Result<(), Cancelled> {
        self.done.store(done, Ordering::Relaxed);
        self.of.store(of, Ordering::Relaxed);
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Asks the job to stop.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// What part of the job is done, from 0 to 1.
    pub fn part(&self) -> f32 {
        let (done, of) = (self.done.load(Ordering::Relaxed), self.of.load(Ordering::Relaxed));
        if of == 0 { 0.0 } else { (done as f32 / of as f32).min(1.0) }
    }
}
