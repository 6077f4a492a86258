use winit::event_loop::{ActiveEventLoop, EventLoopProxy};

use super::event::PlatformEvent;
use crate::app::event::UserEvent;
use crate::app::window::AppWindow;
use crate::session::Session;

impl From<PlatformEvent> for UserEvent {
    fn from(event: PlatformEvent) -> Self {
        Self::Platform(event)
    }
}

impl AppWindow {
    /// Lets screen readers read the window.
    pub(in crate::app) fn connect(
        &mut self,
        event_loop: &ActiveEventLoop,
        proxy: EventLoopProxy<UserEvent>,
    ) {
        self.egui.init_accesskit(event_loop, &self.window, proxy);
    }

    pub(in crate::app) fn on_platform_event(
        &mut self,
        event: PlatformEvent,
        _: &mut Session,
        _: &EventLoopProxy<UserEvent>,
    ) {
        use egui_winit::accesskit_winit::WindowEvent;
        match event.window_event {
            WindowEvent::InitialTreeRequested => self.egui.egui_ctx().enable_accesskit(),
            WindowEvent::ActionRequested(request) => self.egui.on_accesskit_action_request(request),
            WindowEvent::AccessibilityDeactivated => self.egui.egui_ctx().disable_accesskit(),
        }
    }
}
