//! Attributes and title of the window.

use egui_winit::WindowSettings;
use winit::dpi::LogicalSize;
use winit::event_loop::ActiveEventLoop;
use winit::window::{Icon, Window, WindowAttributes};

use crate::session::Session;

const APP_ID: &str = "ik-arm";
const SIZE: LogicalSize<f64> = LogicalSize::new(1280.0, 800.0);
const MIN_SIZE: LogicalSize<f64> = LogicalSize::new(640.0, 400.0);
const ICON: &[u8] = include_bytes!("../../assets/icon-64.png");

/// Attributes of the window: title, icon, minimum size, and the size from the previous run.
pub(super) fn attributes(
    event_loop: &ActiveEventLoop,
    last: Option<WindowSettings>,
) -> WindowAttributes {
    let attributes = Window::default_attributes()
        .with_title(TITLE)
        .with_inner_size(size(event_loop, last))
        .with_min_inner_size(MIN_SIZE)
        .with_window_icon(icon())
        // Shown after AccessKit is initialized, which needs a hidden window.
        .with_visible(false);
    named(attributes)
}

/// Size of the window in the previous run, limited to the screens; `SIZE` if it is unknown.
fn size(event_loop: &ActiveEventLoop, last: Option<WindowSettings>) -> LogicalSize<f64> {
    let Some(mut last) = last else {
        return SIZE;
    };
    let screens = event_loop.available_monitors().map(|screen| {
        let size = screen.size().to_logical::<f32>(screen.scale_factor());
        egui::vec2(size.width, size.height)
    });
    let largest = screens.filter(|size| size.min_elem() > 0.0).reduce(egui::Vec2::max);
    last.clamp_size_to_sane_values(largest.unwrap_or(egui::Vec2::INFINITY));
    let points = last.inner_size_points();
    LogicalSize::new(
        f64::from(points.x).max(MIN_SIZE.width),
        f64::from(points.y).max(MIN_SIZE.height),
    )
}

#[cfg(target_os = "linux")]
fn named(attributes: WindowAttributes) -> WindowAttributes {
    use winit::platform::{wayland, x11};
    let attributes = x11::WindowAttributesExtX11::with_name(attributes, APP_ID, APP_ID);
    wayland::WindowAttributesExtWayland::with_name(attributes, APP_ID, APP_ID)
}

#[cfg(not(target_os = "linux"))]
fn named(attributes: WindowAttributes) -> WindowAttributes {
    attributes
}

fn icon() -> Option<Icon> {
    let image = image::load_from_memory(ICON).ok()?.into_rgba8();
    let (width, height) = image.dimensions();
    Icon::from_rgba(image.into_raw(), width, height).ok()
}

/// Name of the program, as in the window's title.
pub const TITLE: &str = "ik-arm";

/// Title of the window: the document's name, an asterisk for unsaved changes, and the program;
/// during the tour, the step or the title of the last card.
pub fn title(session: &Session) -> String {
    if let Some(tour) = session.tour() {
        return match tour.step() {
            Some(_) => format!("Tour, step {} – {TITLE}", tour.number() + 1),
            None => format!("Tour, {} – {TITLE}", tour.title()),
        };
    }
    let unsaved = if session.history().is_unsaved() { "*" } else { "" };
    match session.files().name() {
        Some(name) => format!("{name}{unsaved} – {TITLE}"),
        None if session.history().is_unsaved() => format!("untitled* – {TITLE}"),
        None => TITLE.to_owned(),
    }
}
