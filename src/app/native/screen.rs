use std::sync::Arc;
use std::time::Duration;

use egui::{Context, OutputCommand};
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Window, WindowAttributes};

use crate::app::error::{AppError, GraphicsError};
use crate::app::event::UserEvent;
use crate::app::graphics::Graphics;
use crate::render::Gpu;

/// Name of the program for the system.
const APP_ID: &str = "ik-arm";

/// Does nothing: the process ends with the error.
pub(in crate::app) fn on_failure(_: &AppError) {}

/// Does nothing: the window shows itself.
pub(in crate::app) fn on_first_frame(_: Duration) {}

/// Where links lead: `ik-arm LINK` opens them, and so does a page whose address is put in its place.
pub(in crate::app) fn address() -> String {
    "ik-arm:".to_owned()
}

/// Shows the title of the window.
pub(in crate::app) fn show_title(window: &Window, title: &str) {
    window.set_title(title);
}

/// Does nothing: egui copies by itself.
pub(in crate::app) fn copy(_: &[OutputCommand]) {}

/// Creates the graphics of a window.
pub(in crate::app) fn graphics(
    event_loop: &ActiveEventLoop,
    window: &Arc<Window>,
    panels: &Context,
    proxy: EventLoopProxy<UserEvent>,
) -> Option<Result<Graphics, GraphicsError>> {
    let display = event_loop.owned_display_handle();
    let wake = move |gpu: &Gpu| {
        // Sending fails only after the window is closed.
        gpu.on_failure(move || drop(proxy.send_event(UserEvent::Changed)));
    };
    Some(pollster::block_on(Graphics::new(display, window, panels, wake)))
}

#[cfg(target_os = "linux")]
pub(in crate::app) fn attributes(attributes: WindowAttributes) -> WindowAttributes {
    use winit::platform::{wayland, x11};
    let attributes = x11::WindowAttributesExtX11::with_name(attributes, APP_ID, APP_ID);
    wayland::WindowAttributesExtWayland::with_name(attributes, APP_ID, APP_ID)
}

#[cfg(not(target_os = "linux"))]
pub(in crate::app) fn attributes(attributes: WindowAttributes) -> WindowAttributes {
    attributes
}
