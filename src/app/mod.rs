//! The window: winit's event loop, the surface, and the frames drawn on it.

mod attributes;
mod background;
mod debug_options;
mod device_retries;
mod dynamic_resolution;
mod effects;
mod error;
mod event_loop;
mod graphics;
mod graphics_error;
mod lap_timer;
mod panel_changes;
mod panel_painter;
mod panel_triangles;
mod pixel_area;
mod present;
mod recovery;
mod settings;
mod title;
mod user_event;
mod viewport_picture;
mod window;

pub use error::AppError;
pub use event_loop::run;
pub use graphics_error::GraphicsError;
