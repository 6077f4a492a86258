use egui::OutputCommand;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::ClipboardEvent;
use winit::event_loop::EventLoopProxy;

use super::event::PlatformEvent;
use super::page::{document, on_each};
use crate::app::event::{UserEvent, send};

/// Sends pasted text to the window.
pub fn take_pasted(proxy: &EventLoopProxy<UserEvent>) {
    let proxy = proxy.clone();
    on_each(document(), "paste", move |event: ClipboardEvent| {
        let text = event.clipboard_data().and_then(|data| data.get_data("text").ok());
        if let Some(text) = text.filter(|text| !text.is_empty()) {
            send(&proxy, UserEvent::Platform(PlatformEvent::Pasted(text)));
            event.prevent_default();
        }
    });
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
