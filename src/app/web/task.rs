//! Jobs in the background. A page has no threads: a job runs in slices between the frames.

use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Wake, Waker};
use std::time::Duration;

use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use web_time::Instant;

/// A job, of which nobody can wait for the end.
pub(in crate::app) struct Task;

impl Task {
    /// Does nothing: a page cannot wait.
    pub fn join(self) -> Result<(), JsValue> {
        Ok(())
    }
}

/// Starts a job.
pub(in crate::app) fn spawn(job: impl AsyncFnOnce() + 'static) -> Task {
    run_later(Job { future: Box::pin(async move { job().await }), woken: Arc::default() });
    Task
}

struct Job {
    future: Pin<Box<dyn Future<Output = ()>>>,
    woken: Arc<Woken>,
}

/// True if a job can go on. A job that waits for the browser cannot until it is woken.
#[derive(Default)]
struct Woken(AtomicBool);

impl Wake for Woken {
    fn wake(self: Arc<Self>) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Runs a slice of a job, after the browser has drawn what there is to draw.
fn run_later(job: Job) {
    const PAUSE_MS: i32 = 4;
    let slice = Closure::once_into_js(move || run_slice(job));
    let asked = web_sys::window().map(|window| {
        window
            .set_timeout_with_callback_and_timeout_and_arguments_0(slice.unchecked_ref(), PAUSE_MS)
    });
    if asked.is_none_or(|asked| asked.is_err()) {
        log::error!("the browser runs no timer");
    }
}

/// Runs a job until it ends, waits, or the slice is over.
fn run_slice(mut job: Job) {
    /// Less than a frame at 60 frames per second, so that a drag stays smooth.
    const SLICE: Duration = Duration::from_millis(8);
    let started = Instant::now();
    let waker = Waker::from(Arc::clone(&job.woken));
    while job.future.as_mut().poll(&mut Context::from_waker(&waker)).is_pending() {
        let can_go_on = job.woken.0.swap(false, Ordering::Relaxed);
        if !can_go_on || started.elapsed() > SLICE {
            return run_later(job);
        }
    }
}
