use thiserror::Error;
use winit::error::EventLoopError;

use crate::render::{DeviceError, GpuError};

/// Reasons why the window does not open or closes by itself.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AppError {
    /// There is no display server.
    #[error(
        "no window can be opened: {}\n\
         Without a display, `ik-arm render -o arm.png` draws a picture instead",
        display_problem()
    )]
    NoDisplay(#[source] EventLoopError),
    /// The connection to the display server broke.
    #[error("the display server closed the window: {source}\n{recovery}")]
    EventLoop {
        /// Error of the event loop.
        source: EventLoopError,
        /// Sentence that tells whether unsaved changes are kept, and in which file.
        recovery: String,
    },
    /// The display server refused to open a window.
    #[error("the window could not be opened: {0}")]
    Window(#[from] winit::error::OsError),
    /// There is no graphics device that can draw in the window.
    #[error(transparent)]
    Graphics(#[from] GraphicsError),
    /// The graphics device was lost and could not be created again.
    #[error(
        "the graphics device was lost and could not be created again in three attempts: {source}\n\
         {recovery}"
    )]
    GraphicsLost {
        /// Error of the last attempt.
        source: GraphicsError,
        /// Sentence that tells whether unsaved changes are kept, and in which file.
        recovery: String,
    },
}

fn display_problem() -> String {
    let variables = ["WAYLAND_DISPLAY", "DISPLAY"]
        .into_iter()
        .filter_map(|name| Some(format!("{name}={}", std::env::var(name).ok()?)))
        .collect::<Vec<_>>();
    if variables.is_empty() {
        "there is no display (neither WAYLAND_DISPLAY nor DISPLAY is set)".to_owned()
    } else {
        format!("the display does not answer ({})", variables.join(", "))
    }
}

/// Reasons why nothing can be drawn in the window.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GraphicsError {
    /// No surface could be created.
    #[error("the window has no surface to draw on: {0}")]
    Surface(#[from] wgpu::CreateSurfaceError),
    /// The adapter supports no format of the surface.
    #[error("the graphics adapter {0} cannot draw in this window")]
    Unsupported(String),
    /// There is no graphics device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The surface was lost twice in a row.
    #[error("the window's surface was lost twice")]
    SurfaceLost,
    /// The surface is invalid.
    #[error("the window's surface provides no frame")]
    NoFrame,
    /// The device was lost or is out of memory.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The device did not finish its work in time.
    #[error("the graphics device does not respond: {0}")]
    Poll(#[from] wgpu::PollError),
    /// A graphics library panicked.
    #[error("a graphics library panicked: {0}")]
    Panic(String),
    /// `IK_ARM_DEBUG` requested that the device fails.
    #[error("the graphics device failed as requested by IK_ARM_DEBUG")]
    Requested,
}
