//! The window: winit's event loop, the surface, and the frames drawn on it. On a computer it is a window
//! of the system, in a browser the page.

mod background;
mod dynamic_resolution;
mod error;
mod event;
mod event_loop;
mod frame;
mod graphics;
#[cfg(not(target_arch = "wasm32"))]
mod native;
mod panel_painter;
mod present;
mod settings;
#[cfg(target_arch = "wasm32")]
mod web;
mod window;

pub use error::{AppError, GraphicsError};
#[cfg(not(target_arch = "wasm32"))]
pub use native::run;
#[cfg(target_arch = "wasm32")]
pub use web::run;

/// What differs between a computer and a browser: [`native`] and [`web`] have the same items.
#[cfg(not(target_arch = "wasm32"))]
use native as platform;
#[cfg(target_arch = "wasm32")]
use web as platform;
