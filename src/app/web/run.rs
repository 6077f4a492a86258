use winit::event_loop::EventLoop;
use winit::platform::web::EventLoopExtWebSys as _;

use super::{clipboard, console, files, link, message};
use crate::app::error::AppError;
use crate::app::event::UserEvent;
use crate::app::event_loop::App;

/// Draws the program in the page's canvas, and returns at once.
///
/// # Errors
///
/// If the browser has no event loop for it.
pub fn run() -> Result<(), AppError> {
    console::connect();
    let event_loop =
        EventLoop::<UserEvent>::with_user_event().build().map_err(AppError::NoDisplay)?;
    let proxy = event_loop.create_proxy();
    files::take_dropped(&proxy);
    clipboard::take_pasted(&proxy);
    link::take_changed(&proxy);
    message::take_sent(&proxy);
    event_loop.spawn_app(App::new(proxy, link::actions()));
    Ok(())
}
