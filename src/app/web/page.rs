use std::time::Duration;

use web_sys::{Document, HtmlElement};

use crate::app::error::AppError;

/// The document of the page.
pub fn document() -> Option<Document> {
    web_sys::window()?.document()
}

fn body() -> Option<HtmlElement> {
    document()?.body()
}

/// Shows the page's words for a program that cannot go on, with the reason.
pub(in crate::app) fn show_failure(reason: &str) {
    let Some(body) = body() else { return };
    let _ = body.set_attribute("data-failure", reason);
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
