use winit::event_loop::EventLoop;

use crate::app::error::AppError;
use crate::app::event::UserEvent;
use crate::app::event_loop::App;
use crate::session::Action;

/// Opens the window after the actions `start`, and returns when the window is closed.
///
/// # Errors
///
/// If there is no display or no graphics device, or the device is lost for good.
pub fn run(start: Vec<Action>) -> Result<(), AppError> {
    let event_loop =
        EventLoop::<UserEvent>::with_user_event().build().map_err(AppError::NoDisplay)?;
    let mut app = App::new(event_loop.create_proxy(), start);
    if let Err(source) = event_loop.run_app(&mut app) {
        let recovery = app.keep_changes();
        return Err(AppError::EventLoop { source, recovery });
    }
    app.result()
}
