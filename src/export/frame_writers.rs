use std::num::NonZero;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Scope, ScopedJoinHandle};

use super::error::ExportError;

/// The pixels of a frame, with its number.
pub type Frame = (usize, Vec<u8>);

/// Threads that encode and write frames while the next ones are drawn, one on each core.
pub struct FrameWriters<'scope> {
    frames: SyncSender<Frame>,
    writers: Vec<ScopedJoinHandle<'scope, Result<(), ExportError>>>,
}

impl<'scope> FrameWriters<'scope> {
    /// Starts the threads. Each calls `write` with the next frame until there are no more, or until
    /// it fails.
    pub fn new<'env>(
        scope: &'scope Scope<'scope, 'env>,
        write: &'env (impl Fn(Frame) -> Result<(), ExportError> + Sync),
    ) -> Self {
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        // As many frames wait as are written, so that memory stays small.
        let (frames, receiver) = sync_channel(cores);
        let waiting = Arc::new(Mutex::new(Some(receiver)));
        let work = || {
            let waiting = waiting.clone();
            scope.spawn(move || {
                while let Some(frame) = next(&waiting) {
                    // After an error nobody receives any more, so that drawing stops, too.
                    write(frame).inspect_err(|_| drop(lock(&waiting).take()))?;
                }
                Ok(())
            })
        };
        Self { frames, writers: (0..cores).map(|_| work()).collect() }
    }

    /// Hands a frame over; waits while too many wait. Returns whether it will be written: not if
    /// another one has failed.
    pub fn add(&self, frame: Frame) -> bool {
        self.frames.send(frame).is_ok()
    }

    /// Waits until all frames are written.
    ///
    /// # Errors
    ///
    /// The first error of a thread.
    pub fn finish(self) -> Result<(), ExportError> {
        let Self { frames, writers } = self;
        drop(frames);
        let end = |writer: ScopedJoinHandle<'_, _>| {
            writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        // All are joined, also after an error.
        let ends: Vec<Result<(), ExportError>> = writers.into_iter().map(end).collect();
        ends.into_iter().collect()
    }
}

/// Frames that wait; `None` after an error.
type Waiting = Mutex<Option<Receiver<Frame>>>;

fn lock(waiting: &Waiting) -> MutexGuard<'_, Option<Receiver<Frame>>> {
    waiting.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The next frame; `None` if there are no more.
fn next(waiting: &Waiting) -> Option<Frame> {
    lock(waiting).as_ref()?.recv().ok()
}
