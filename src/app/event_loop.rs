use web_time::Instant;
use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::WindowId;

use super::background;
use super::error::{AppError, GraphicsError};
use super::event::UserEvent;
use super::platform::{self, RecoveredFile, Recovery};
use super::settings::{Settings, SettingsWriter};
use super::window::{AppWindow, Repaint};
use crate::session::{Action, BakeAction, Dialog, FileAction, Session, ShellAction, TourAction};

/// The program with its window.
pub(super) struct App {
    started: Instant,
    proxy: EventLoopProxy<UserEvent>,
    session: Session,
    /// Settings of the previous run, until the window is open.
    settings: Settings,
    settings_writer: SettingsWriter,
    /// Time of the next frame; `None` until there is input.
    next_frame: Option<Instant>,
    recovery: Recovery,
    /// Unsaved document of an earlier run that did not end cleanly.
    recovered: Option<RecoveredFile>,
    /// True if the user has quit: unsaved changes are to be dropped.
    has_quit: bool,
    state: AppState,
}

enum AppState {
    Suspended,
    Active(Box<AppWindow>),
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "the page tells it"))]
    Failed(AppError),
}

impl App {
    /// The program before its window opens, after the actions `start`.
    pub fn new(proxy: EventLoopProxy<UserEvent>, start: Vec<Action>) -> Self {
        let started = Instant::now();
        let (settings, problem) = Settings::load();
        let mut session = Session::new(settings.preferences);
        session.restore_files(settings.recent.clone(), settings.export_folder.clone());
        let (tours, others): (Vec<_>, Vec<_>) =
            start.into_iter().partition(|action| matches!(action, Action::Tour(_)));
        for action in others {
            session.apply(action);
        }
        if let Some(problem) = problem {
            session.apply(ShellAction::Fail(problem));
        }
        let recovery = Recovery::start();
        let recovered = recovery.find();
        if let Some(RecoveredFile { backup, .. }) = &recovered {
            let (document, file) = (Box::new(backup.document.clone()), backup.file.clone());
            session.apply(ShellAction::OpenDialog(Dialog::Recover { document, file }));
        }
        for action in tours {
            session.apply(action);
        }
        Self {
            started,
            proxy,
            session,
            settings_writer: SettingsWriter::default(),
            next_frame: None,
            settings,
            recovery,
            recovered,
            has_quit: false,
            state: AppState::Suspended,
        }
    }

    /// The reason why the program has ended, unless the user has closed the window.
    ///
    /// # Errors
    ///
    /// If no window could be opened, or its graphics were lost for good.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn result(self) -> Result<(), AppError> {
        match self.state {
            AppState::Failed(error) => Err(error),
            AppState::Suspended | AppState::Active(_) => Ok(()),
        }
    }

    fn redraw(&mut self, event_loop: &ActiveEventLoop) {
        let AppState::Active(window) = &mut self.state else {
            return;
        };
        let drawn = window.redraw(event_loop, &mut self.session, &self.proxy);
        if window.frames() == 1 {
            log::info!("first frame {} ms after start", self.started.elapsed().as_millis());
            platform::on_first_frame(self.started.elapsed());
        }
        let backup = self.recovery.update(self.session.own(), &self.proxy);
        self.remove_settled_recovery();
        let again = match drawn {
            Repaint::Quit => return self.quit(event_loop),
            Repaint::Failed(error) => return self.give_up(event_loop, error),
            Repaint::At(time) => Some(time),
            Repaint::OnInput => None,
        };
        self.next_frame = again.into_iter().chain(backup).min();
        self.settings_writer.note_change();
        self.sleep(event_loop);
    }

    /// Sleeps until the next frame or the next look at the settings is due, or there is input.
    fn sleep(&self, event_loop: &ActiveEventLoop) {
        let due = self.next_frame.into_iter().chain(self.settings_writer.due());
        event_loop.set_control_flow(due.min().map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    /// Draws a frame and writes the settings, as far as each is due.
    fn wake(&mut self, event_loop: &ActiveEventLoop) {
        let AppState::Active(window) = &self.state else { return };
        let now = Instant::now();
        // Taken, because a time that stays in the past would wake the program again at once.
        if self.next_frame.take_if(|due| *due <= now).is_some() {
            window.request_redraw();
        }
        // The tour changes settings while it lasts; the frame after it notes them.
        if self.settings_writer.is_due(now) && self.session.tour().is_none() {
            self.settings_writer.write(&window.settings(&self.session));
        }
        self.sleep(event_loop);
    }

    /// Ends the program after the graphics device is lost for good; unsaved changes are kept for
    /// the next start.
    fn give_up(&mut self, event_loop: &ActiveEventLoop, source: GraphicsError) {
        let recovery = self.keep_changes();
        self.close();
        self.fail(event_loop, AppError::GraphicsLost { source, recovery });
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: AppError) {
        platform::on_failure(&error);
        self.state = AppState::Failed(error);
        event_loop.exit();
    }

    fn quit(&mut self, event_loop: &ActiveEventLoop) {
        self.has_quit = true;
        event_loop.exit();
    }

    /// Backs up unsaved changes for the next start. Returns a sentence that tells where they are.
    pub fn keep_changes(&mut self) -> String {
        match self.recovery.leave(self.session.own()) {
            Ok(None) => "All changes are saved".to_owned(),
            Ok(Some(path)) => format!(
                "Unsaved changes are in {}\nik-arm offers to open them at its next start",
                path.display()
            ),
            Err(error) => format!("Unsaved changes are lost: {error}"),
        }
    }

    /// Cancels an export, saves the settings and drops the graphics.
    fn close(&mut self) {
        self.session.apply(FileAction::CancelExport);
        self.session.apply(TourAction::Leave);
        if let AppState::Active(window) = &mut self.state {
            window.await_export();
            log::info!("{} frames drawn", window.frames());
            window.settings(&self.session).save();
            window.drop_graphics();
        }
    }

    /// Removes the recovered file once the user has opened or declined its document, and this run
    /// has no unsaved changes without a backup.
    fn remove_settled_recovery(&mut self) {
        let own = self.session.own();
        let is_safe = !own.history().is_unsaved() || self.recovery.has(own.history().revision());
        self.remove_recovered_if(self.session.files().has_settled_recovery() && is_safe);
    }

    fn remove_recovered_if(&mut self, is_settled: bool) {
        if is_settled && let Some(RecoveredFile { path, .. }) = self.recovered.take() {
            platform::remove(&path);
        }
    }
}

impl ApplicationHandler<UserEvent> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if matches!(self.state, AppState::Active(_)) {
            return;
        }
        let settings = std::mem::take(&mut self.settings);
        match AppWindow::open(event_loop, settings, self.proxy.clone()) {
            Ok(window) => self.state = AppState::Active(Box::new(window)),
            Err(error) => self.fail(event_loop, error),
        }
    }

    fn suspended(&mut self, _: &ActiveEventLoop) {
        self.state = AppState::Suspended;
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            self.wake(event_loop);
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        // Not passed to egui, which would answer a redraw by requesting another.
        if event == WindowEvent::RedrawRequested {
            self.redraw(event_loop);
            return;
        }
        let AppState::Active(window) = &mut self.state else {
            return;
        };
        match &event {
            WindowEvent::CloseRequested => {
                match self.session.apply(FileAction::Quit) {
                    Some(_) => self.quit(event_loop),
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
        let AppState::Active(window) = &mut self.state else {
            return;
        };
        match event {
            UserEvent::Platform(event) => {
                window.on_platform_event(event, &mut self.session, &self.proxy);
            }
            UserEvent::Changed => {}
            UserEvent::Report(message) => {
                self.session.apply(match message {
                    Ok(message) => ShellAction::Report(message),
                    Err(error) => ShellAction::Fail(error),
                });
            }
            UserEvent::Baked(job, result) => {
                self.session.apply(BakeAction::Ended(job, result));
            }
            UserEvent::Inspected(ended) => {
                self.session.apply(*ended);
            }
            UserEvent::FoundReach(ended) => {
                self.session.apply(*ended);
            }
            UserEvent::Exported(result) => {
                self.session.apply(FileAction::ExportEnded(result));
            }
            UserEvent::Opened { path, options, read } => {
                let (remark, action) = background::opened(path, options, *read);
                self.session.remark_when_opened(remark);
                self.session.apply(action);
            }
            UserEvent::SkinLocated { path, before, read } => {
                self.session.apply(FileAction::SkinLocated { path, before, read });
            }
            UserEvent::Chosen(dialog, choice) => {
                let action = background::path_action(dialog, choice);
                window.act(action, &mut self.session, &self.proxy);
            }
        }
        window.request_redraw();
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // The event loop also ends when the connection to the display server breaks.
        if self.has_quit || !self.session.own().history().is_unsaved() {
            if !matches!(self.state, AppState::Failed(_)) {
                // What was recovered is saved now, or the user gave it up.
                self.remove_recovered_if(self.session.files().has_settled_recovery());
            }
            self.recovery.end();
        }
        self.close();
    }
}
