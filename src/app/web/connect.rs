use egui::Event;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};

use super::event::PlatformEvent;
use super::{link, message};
use crate::app::event::UserEvent;
use crate::app::window::AppWindow;
use crate::session::Session;

impl AppWindow {
    /// Gives the keyboard to the canvas.
    pub(in crate::app) fn connect(&mut self, _: &ActiveEventLoop, _: EventLoopProxy<UserEvent>) {
        self.machine.parts = link::parts();
        // A part of another page takes the keyboard when it is clicked.
        if self.machine.parts.is_none() {
            self.window.focus_window();
        }
    }

    pub(in crate::app) fn on_platform_event(
        &mut self,
        event: PlatformEvent,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) {
        match event {
            PlatformEvent::Graphics(Ok(mut graphics)) => {
                graphics.resize(self.window.inner_size());
                self.set_graphics(*graphics);
            }
            PlatformEvent::Graphics(Err(error)) => {
                self.awaits_graphics = false;
                self.lose(error);
            }
            PlatformEvent::Asked(asker) => message::answer(&asker, session),
            PlatformEvent::Linked(actions) => {
                for action in actions {
                    self.act(action, session, proxy);
                }
            }
            PlatformEvent::Pasted(text) => {
                self.egui.egui_input_mut().events.push(Event::Paste(text));
            }
        }
    }
}
