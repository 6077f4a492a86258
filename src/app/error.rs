use thiserror::Error;
use winit::error::EventLoopError;

use super::graphics_error::GraphicsError;

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
