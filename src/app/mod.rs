//! The window: winit's event loop, the surface, and the frames drawn on it.

mod attributes;
mod background;
mod dynamic_resolution;
mod effects;
mod error;
mod event_loop;
mod graphics;
mod panel_painter;
mod present;
mod recovery;
mod settings;
mod window;

pub use error::{AppError, GraphicsError};
pub use event_loop::run;
