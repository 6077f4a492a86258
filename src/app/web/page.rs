use std::time::Duration;

use wasm_bindgen::JsCast as _;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::convert::FromWasmAbi;
use web_sys::{Document, EventTarget, HtmlElement};
use winit::window::Window;

use crate::app::error::AppError;

/// The document of the page.
pub fn document() -> Option<Document> {
    web_sys::window()?.document()
}

/// Calls `react` with each event of this name, as long as the page is open.
pub fn on_each<E: FromWasmAbi + 'static>(
    target: Option<impl AsRef<EventTarget>>,
    name: &str,
    react: impl FnMut(E) + 'static,
) {
    let react = Closure::<dyn FnMut(E)>::new(react);
    let callback = react.as_ref().unchecked_ref();
    let added = target.map(|it| it.as_ref().add_event_listener_with_callback(name, callback));
    if added.is_none_or(|added| added.is_err()) {
        log::error!("the browser tells no {name}");
    }
    react.forget();
}

fn body() -> Option<HtmlElement> {
    document()?.body()
}

/// Shows the page's words for a program that cannot go on, with the reason.
pub(in crate::app) fn show_failure(reason: &str) {
    let Some(body) = body() else { return };
    let _ = body.set_attribute("data-failure", reason);
}

/// Shows the title in the tab of the browser.
pub(in crate::app) fn show_title(_: &Window, title: &str) {
    if let Some(document) = document() {
        document.set_title(title);
    }
}

/// Shows an error after which the program cannot go on.
pub(in crate::app) fn on_failure(error: &AppError) {
    show_failure(&error.to_string());
}

/// Takes the page's words away, and notes how long the start took, in milliseconds.
pub(in crate::app) fn on_first_frame(since_start: Duration) {
    let Some(body) = body() else { return };
    let _ = body.set_attribute("data-ready", &since_start.as_millis().to_string());
}
