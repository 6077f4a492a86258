use std::sync::Arc;

use egui::Context;
use wasm_bindgen::JsCast as _;
use wasm_bindgen_futures::spawn_local;
use web_sys::HtmlCanvasElement;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::platform::web::WindowAttributesExtWebSys as _;
use winit::window::{Window, WindowAttributes};

use super::event::PlatformEvent;
use super::link;
use super::page::{document, show_failure};
use crate::app::error::GraphicsError;
use crate::app::event::{UserEvent, send};
use crate::app::graphics::Graphics;

/// Id of the page's canvas.
const CANVAS: &str = "ik-arm";

/// Creates the graphics of the canvas, which arrive by an event.
pub(in crate::app) fn graphics(
    event_loop: &ActiveEventLoop,
    window: &Arc<Window>,
    panels: &Context,
    proxy: EventLoopProxy<UserEvent>,
) -> Option<Result<Graphics, GraphicsError>> {
    let (display, window, panels) =
        (event_loop.owned_display_handle(), Arc::clone(window), panels.clone());
    spawn_local(async move {
        let created = Graphics::new(display, &window, &panels, |_| {}).await;
        if let Err(error) = &created {
            show_failure(&error.to_string());
        }
        let event = PlatformEvent::Graphics(created.map(Box::new));
        send(&proxy, UserEvent::Platform(event));
    });
    None
}

/// Attributes of the window that is the page's canvas, as large as the page makes it.
pub(in crate::app) fn attributes(mut attributes: WindowAttributes) -> WindowAttributes {
    (attributes.inner_size, attributes.min_inner_size) = (None, None);
    // A part of another page takes the keyboard when it is clicked: the other page would scroll to it.
    attributes.active = link::parts().is_none();
    let canvas = document().and_then(|document| document.get_element_by_id(CANVAS));
    attributes.with_canvas(canvas.and_then(|it| it.dyn_into::<HtmlCanvasElement>().ok()))
}
