//! The window: winit's event loop, the surface, and the frames drawn on it.

mod background;
mod dynamic_resolution;
mod error;
mod event_loop;
mod frame;
mod graphics;
mod panel_painter;
mod present;
mod recovery;
mod settings;
mod window;

pub use error::{AppError, GraphicsError};
pub use event_loop::run;
