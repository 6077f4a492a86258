use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};

/// A job that has ended.
pub(in crate::app) struct Task;

impl Task {
    /// Does nothing: the job has ended.
    pub fn join(self) -> Result<(), JsValue> {
        Ok(())
    }
}

/// Runs a job after the present frame. A page has no threads: the job holds it up.
pub(in crate::app) fn spawn(job: impl FnOnce() + 'static) -> Task {
    /// Longer than a frame takes, so that the browser draws before.
    const MILLISECONDS: i32 = 30;
    let job = Closure::once_into_js(job);
    let asked = web_sys::window().map(|window| {
        window.set_timeout_with_callback_and_timeout_and_arguments_0(
            job.unchecked_ref(),
            MILLISECONDS,
        )
    });
    if asked.is_none_or(|asked| asked.is_err()) {
        log::error!("the browser runs no timer");
    }
    Task
}
