//! The window: winit's event loop, the surface, and the frames drawn on it.

mod attributes;
mod debug;
mod effects;
mod failures;
mod graphics;
mod jobs;
mod laps;
mod present;
mod recovery;
mod settings;
mod window;

use std::path::PathBuf;
use std::time::Instant;

use thiserror::Error;
use winit::application::ApplicationHandler;
use winit::error::EventLoopError;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

use crate::document::Document;
use crate::io::{OpenError, Opened};
use crate::session::{Dialog, FileAction, Session, ShellAction};
pub use graphics::GraphicsError;
use jobs::Choice;
use recovery::{Found, Recovery};
use settings::Settings;
use window::{AppWindow, Repaint};

/// Why there is no window.
#[derive(Debug, Error)]
pub enum AppError {
    #[error(
        "no window can be opened: {}\n\
         Without a display, `ik-arm render -o arm.png` draws a picture instead",
        why_no_display()
    )]
    NoDisplay(#[source] EventLoopError),
    #[error("the window was closed by its system: {0}")]
    EventLoop(EventLoopError),
    #[error("the system does not open a window: {0}")]
    Window(#[from] winit::error::OsError),
    #[error(transparent)]
    Graphics(#[from] GraphicsError),
    #[error(
        "the graphics device was lost, and three tries to make it anew failed: {source}\n{kept}"
    )]
    GraphicsLost { source: GraphicsError, kept: String },
}

fn why_no_display() -> String {
    let named = ["WAYLAND_DISPLAY", "DISPLAY"]
        .into_iter()
        .filter_map(|name| Some(format!("{name}={}", std::env::var(name).ok()?)))
        .collect::<Vec<_>>();
    if named.is_empty() {
        "there is no display (neither WAYLAND_DISPLAY nor DISPLAY is set)".to_owned()
    } else {
        format!("the display does not answer ({})", named.join(", "))
    }
}

/// What comes from elsewhere than the window.
#[derive(Debug)]
enum UserEvent {
    Accesskit(egui_winit::accesskit_winit::Event),
    /// Something that ran beside the window says how it ended.
    Report(Result<String, String>),
    /// An export says how it ended.
    Exported(Result<String, String>),
    /// The document is safe, as far as it was changed by then.
    Kept,
    /// The device is good for nothing more.
    GraphicsFailed,
    /// The path that a dialog asked the system for.
    Chosen(Dialog, Choice),
    /// A file was read, with one of its skeletons chosen or not.
    Opened {
        path: PathBuf,
        chosen: bool,
        read: Box<Result<Opened, OpenError>>,
    },
}

impl From<egui_winit::accesskit_winit::Event> for UserEvent {
    fn from(event: egui_winit::accesskit_winit::Event) -> Self {
        Self::Accesskit(event)
    }
}

/// Opens the window, with a document from a file if there is one, and returns when it is closed.
///
/// # Errors
///
/// If there is no display or nothing to draw with.
pub fn run(document: Option<(Document, Option<PathBuf>)>) -> Result<(), AppError> {
    let started = Instant::now();
    let event_loop =
        EventLoop::<UserEvent>::with_user_event().build().map_err(AppError::NoDisplay)?;
    let settings = Settings::load();
    let mut session = Session::new(settings.preferences);
    session.set_recent(settings.recent.clone());
    session.set_export_folder(settings.export_folder.clone());
    if let Some((document, file)) = document {
        session.apply(FileAction::Opened { document: Box::new(document), file });
    }
    let recovery = Recovery::start();
    let found = recovery.find();
    if let Some(Found { kept, .. }) = &found {
        let (document, file) = (Box::new(kept.document.clone()), kept.file.clone());
        session.apply(ShellAction::OpenDialog(Dialog::Recover { document, file }));
    }
    let mut app = App {
        started,
        proxy: event_loop.create_proxy(),
        session,
        settings,
        recovery,
        found,
        state: State::Suspended,
    };
    event_loop.run_app(&mut app).map_err(AppError::EventLoop)?;
    match app.state {
        State::Failed(error) => Err(error),
        State::Suspended | State::Active(_) => Ok(()),
    }
}

struct App {
    started: Instant,
    proxy: EventLoopProxy<UserEvent>,
    session: Session,
    settings: Settings,
    recovery: Recovery,
    /// What another run left.
    found: Option<Found>,
    state: State,
}

enum State {
    Suspended,
    Active(Box<AppWindow>),
    Failed(AppError),
}

impl App {
    fn redraw(&mut self, event_loop: &ActiveEventLoop) {
        let State::Active(window) = &mut self.state else {
            return;
        };
        let drawn = window.redraw(event_loop, &mut self.session, &self.proxy);
        if window.frames() == 1 {
            log::info!("first frame {} ms after start", self.started.elapsed().as_millis());
        }
        let keep = self.recovery.follow(&self.session, &self.proxy);
        self.leave_recovered();
        let again = match drawn {
            Repaint::Quit => return event_loop.exit(),
            Repaint::Failed(error) => return self.give_up(event_loop, error),
            Repaint::At(time) => Some(time),
            Repaint::OnInput => None,
        };
        event_loop.set_control_flow(match again.into_iter().chain(keep).min() {
            Some(time) => ControlFlow::WaitUntil(time),
            None => ControlFlow::Wait,
        });
    }

    /// Nothing more can be shown: ends with what is not saved kept for the next start.
    fn give_up(&mut self, event_loop: &ActiveEventLoop, source: GraphicsError) {
        let kept = match self.recovery.leave(&self.session) {
            Ok(None) => "All changes were saved".to_owned(),
            Ok(Some(path)) => format!(
                "What was not saved is kept in {}\nik-arm offers to open it when it starts again",
                path.display()
            ),
            Err(error) => format!("What was not saved could not be kept: {error}"),
        };
        self.close();
        self.state = State::Failed(AppError::GraphicsLost { source, kept });
        event_loop.exit();
    }

    /// What is done last in a window.
    fn close(&mut self) {
        self.session.apply(FileAction::CancelExport);
        if let State::Active(window) = &mut self.state {
            window.await_export();
            log::info!("{} frames drawn", window.frames());
            window.settings(&self.session).save();
            window.drop_graphics();
        }
    }

    /// What another run left goes once it was declined, or this run keeps it.
    fn leave_recovered(&mut self) {
        let is_settled = self.session.has_settled_recovery();
        let is_safe = !self.session.is_unsaved() || self.recovery.has(self.session.revision());
        if is_settled
            && is_safe
            && let Some(Found { path, .. }) = self.found.take()
        {
            recovery::remove(&path);
        }
    }
}

impl ApplicationHandler<UserEvent> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if matches!(self.state, State::Active(_)) {
            return;
        }
        let settings = std::mem::take(&mut self.settings);
        match AppWindow::open(event_loop, settings, self.proxy.clone()) {
            Ok(window) => self.state = State::Active(Box::new(window)),
            Err(error) => {
                self.state = State::Failed(error);
                event_loop.exit();
            }
        }
    }

    fn suspended(&mut self, _: &ActiveEventLoop) {
        self.state = State::Suspended;
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, State::Active(window)) = (cause, &self.state)
        {
            window.request_redraw();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        // Before egui sees it, whose answer to a redraw is to ask for another.
        if event == WindowEvent::RedrawRequested {
            self.redraw(event_loop);
            return;
        }
        let State::Active(window) = &mut self.state else {
            return;
        };
        match &event {
            WindowEvent::CloseRequested => {
                match self.session.apply(FileAction::Quit) {
                    Some(_) => event_loop.exit(),
                    None => window.request_redraw(),
                }
                return;
            }
            WindowEvent::Resized(size) => window.resize(*size),
            _ => {}
        }
        if window.on_event(&event) {
            window.request_redraw();
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, event: UserEvent) {
        let State::Active(window) = &mut self.state else {
            return;
        };
        match event {
            UserEvent::Accesskit(event) => window.on_accesskit(event),
            UserEvent::Kept | UserEvent::GraphicsFailed => {}
            UserEvent::Report(message) => {
                self.session.apply(match message {
                    Ok(done) => ShellAction::Report(done),
                    Err(why) => ShellAction::Fail(why),
                });
            }
            UserEvent::Exported(how) => {
                self.session.apply(FileAction::ExportEnded(how));
            }
            UserEvent::Opened { path, chosen, read } => {
                for action in jobs::opened(path, chosen, *read) {
                    self.session.apply(action);
                }
            }
            UserEvent::Chosen(dialog, choice) => {
                if let Some(action) = jobs::chosen(dialog, choice) {
                    window.act(action, &mut self.session, &self.proxy);
                }
            }
        }
        window.request_redraw();
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.recovery.end();
        self.close();
    }
}
