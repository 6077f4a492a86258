use egui::OutputCommand;
use wasm_bindgen::JsCast as _;
use wasm_bindgen::closure::Closure;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::ClipboardEvent;
use winit::event_loop::EventLoopProxy;

use super::event::PlatformEvent;
use super::page::document;
use crate::app::event::{UserEvent, send};

/// Sends pasted text to the window.
pub fn take_pasted(proxy: &EventLoopProxy<UserEvent>) {
    let proxy = proxy.clone();
    let on_paste = Closure::<dyn FnMut(_)>::new(move |event: ClipboardEvent| {
        let text = event.clipboard_data().and_then(|data| data.get_data("text").ok());
        if let Some(text) = text.filter(|text| !text.is_empty()) {
            send(&proxy, UserEvent::Platform(PlatformEvent::Pasted(text)));
            event.prevent_default();
        }
    });
    if let Some(document) = document() {
        let _ =
            document.add_event_listener_with_callback("paste", on_paste.as_ref().unchecked_ref());
    }
    // The page listens as long as it is open.
    on_paste.forget();
}

/// Copies the texts that the panels have copied to the browser's clipboard.
pub fn copy(commands: &[OutputCommand]) {
    let Some(window) = web_sys::window() else { return };
    for command in commands {
        let OutputCommand::CopyText(text) = command else { continue };
        let written = window.navigator().clipboard().write_text(text);
        spawn_local(async move {
            if let Err(refused) = JsFuture::from(written).await {
                log::warn!("the browser does not copy: {refused:?}");
            }
        });
    }
}
