use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Event, Rect, ViewportId};
use egui_winit::WindowSettings;
use web_time::Instant;
use winit::dpi::{LogicalSize, PhysicalSize};
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Icon, Window, WindowAttributes};

use super::background::{self, ViewportPicture};
use super::dynamic_resolution::DynamicResolution;
use super::error::{AppError, GraphicsError};
use super::event::UserEvent;
use super::graphics::{DeviceRetries, Graphics, guarded};
use super::platform::{self, Task};
use super::settings::{DebugOptions, Settings};
use crate::io;
use crate::scene::{Scene, SceneBuilder};
use crate::session::{Action, BakeAction, Effect, FileAction, Overlays, Session, ShellAction};
use crate::ui::{Machine, style};

/// Name of the program, as in the window's title.
const TITLE: &str = "ik-arm";
const SIZE: LogicalSize<f64> = LogicalSize::new(1280.0, 800.0);
const MIN_SIZE: LogicalSize<f64> = LogicalSize::new(640.0, 400.0);
const ICON: &[u8] = include_bytes!("../../assets/icon-64.png");

/// Time of the next frame, or the reason why there is none.
pub(super) enum Repaint {
    OnInput,
    At(Instant),
    Quit,
    /// The graphics are lost for good.
    Failed(GraphicsError),
}

/// The window with everything that draws in it.
pub(super) struct AppWindow {
    /// `None` while the graphics are lost.
    pub(super) graphics: Option<Graphics>,
    pub(super) retries: DeviceRetries,
    /// Time at which lost graphics are created again.
    retry_at: Instant,
    debug: DebugOptions,
    pub(super) window: Arc<Window>,
    pub(super) egui: egui_winit::State,
    pub(super) machine: Machine,
    pub(super) overlays: Overlays,
    pub(super) builder: SceneBuilder,
    /// Scene to refill and draw in the next frame, to reuse its memory; `None` before the first
    /// frame.
    pub(super) scene: Option<Scene>,
    /// Typed events since a file dialog was requested, held back for that dialog.
    pub(super) held_keys: Vec<Event>,
    /// Start of the previous frame, if that frame requested another one at once.
    pub(super) moving_since: Option<Instant>,
    pub(super) frames: u64,
    title: String,
    /// Rectangle of the scene in points.
    pub(super) viewport: Rect,
    /// True if the program ends at the next frame.
    pub(super) ends: bool,
    pub(super) exporting: Option<Task>,
    /// True if graphics are being created, which arrive by an event.
    pub(super) awaits_graphics: bool,
    pub(super) dynamic_resolution: DynamicResolution,
    /// True if counts of earlier frames will arrive from the device.
    pub(super) awaits_counts: bool,
}

impl AppWindow {
    pub fn open(
        event_loop: &ActiveEventLoop,
        settings: Settings,
        proxy: EventLoopProxy<UserEvent>,
    ) -> Result<Self, AppError> {
        let window = Arc::new(event_loop.create_window(attributes(event_loop, settings.window))?);
        let ctx = egui::Context::default();
        style::install(&ctx);
        ctx.data_mut(|data| {
            *data = settings.layout;
            // A start must not open scrolled away.
            data.remove_by_type::<egui::containers::scroll_area::State>();
        });
        let graphics = platform::graphics(event_loop, &window, &ctx, proxy.clone()).transpose()?;
        let longest = graphics.as_ref().map(|graphics| graphics.gpu.longest_side() as usize);
        let scale = Some(window.scale_factor() as f32);
        let egui = egui_winit::State::new(ctx, ViewportId::ROOT, event_loop, scale, None, longest);
        let mut opened = Self {
            awaits_graphics: graphics.is_none(),
            graphics: None,
            retries: DeviceRetries::default(),
            retry_at: Instant::now(),
            debug: DebugOptions::from_env(),
            window,
            egui,
            machine: Machine::default(),
            overlays: Overlays::default(),
            builder: SceneBuilder::default(),
            scene: None,
            held_keys: Vec::new(),
            moving_since: None,
            frames: 0,
            title: TITLE.to_owned(),
            viewport: Rect::ZERO,
            ends: false,
            exporting: None,
            dynamic_resolution: DynamicResolution::default(),
            awaits_counts: false,
        };
        opened.connect(event_loop, proxy);
        if let Some(graphics) = graphics {
            opened.set_graphics(graphics);
        }
        opened.window.set_visible(true);
        opened.window.request_redraw();
        Ok(opened)
    }

    /// Draws with these graphics from now on.
    pub(super) fn set_graphics(&mut self, graphics: Graphics) {
        self.awaits_graphics = false;
        self.machine.adapter = graphics.gpu.name();
        self.machine.has_clock = graphics.has_clock();
        self.egui.set_max_texture_side(graphics.gpu.longest_side() as usize);
        self.graphics = Some(graphics);
        // Frames of another device tell nothing about this one.
        self.dynamic_resolution = DynamicResolution::default();
    }

    pub fn request_redraw(&self) {
        self.window.request_redraw();
    }

    /// Number of frames drawn.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Passes an event to egui and returns whether egui needs a new frame.
    pub fn on_event(&mut self, event: &WindowEvent) -> bool {
        if self.debug.destroys_device(event)
            && let Some(graphics) = &self.graphics
        {
            graphics.gpu.device.destroy();
        }
        self.egui.on_window_event(&self.window, event).repaint
    }

    pub fn resize(&mut self, size: PhysicalSize<u32>) {
        let Some(graphics) = &mut self.graphics else {
            return;
        };
        let resized = guarded(|| {
            graphics.resize(size);
            Ok(())
        });
        if let Err(error) = resized {
            self.lose(error);
        }
    }

    /// Settings to save for the next start.
    pub fn settings(&self, session: &Session) -> Settings {
        let ctx = self.egui.egui_ctx();
        Settings {
            preferences: *session.preferences(),
            recent: session.files().recent().to_vec(),
            export_folder: session.files().export_folder().map(Path::to_owned),
            window: Some(WindowSettings::from_window(ctx.zoom_factor(), &self.window, None)),
            layout: ctx.data(Clone::clone),
        }
    }

    /// Creates lost graphics again. Returns `None` if a frame can be drawn, otherwise when to try
    /// again or why the program must end.
    pub(super) fn restore(
        &mut self,
        event_loop: &ActiveEventLoop,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Option<Repaint> {
        if let Some(graphics) = &self.graphics {
            return graphics.check().err().map(|error| self.lose(error));
        }
        if self.awaits_graphics {
            return Some(Repaint::OnInput);
        }
        if Instant::now() < self.retry_at {
            return Some(Repaint::At(self.retry_at));
        }
        let created = guarded(|| {
            if self.debug.fails_device() {
                return Err(GraphicsError::Requested);
            }
            let panels = self.egui.egui_ctx();
            platform::graphics(event_loop, &self.window, panels, proxy.clone()).transpose()
        });
        match created {
            Ok(Some(graphics)) => self.set_graphics(graphics),
            Ok(None) => {
                self.awaits_graphics = true;
                return Some(Repaint::OnInput);
            }
            Err(error) => return Some(self.lose(error)),
        }
        session.apply(ShellAction::Report(
            "The graphics device was lost and created again; the document is unchanged".to_owned(),
        ));
        None
    }

    /// Drops failed graphics and schedules the next attempt to create them; returns
    /// [`Repaint::Failed`] if no attempt is left.
    pub(super) fn lose(&mut self, error: GraphicsError) -> Repaint {
        self.drop_graphics();
        let Some(pause) = self.retries.next_pause() else {
            return Repaint::Failed(error);
        };
        log::error!("{error}");
        self.retry_at = Instant::now() + pause;
        Repaint::At(self.retry_at)
    }

    /// Drops the graphics. Dropping them may panic after the device is lost; the panic is logged.
    pub fn drop_graphics(&mut self) {
        let graphics = self.graphics.take();
        let dropped = guarded(|| {
            drop(graphics);
            Ok(())
        });
        if let Err(error) = dropped {
            log::warn!("{error}");
        }
    }

    /// Shows the title that the window has now.
    pub(super) fn update_title(&mut self, session: &Session) {
        let title = title(session);
        if title != self.title {
            platform::show_title(&self.window, &title);
            self.title = title;
        }
    }

    /// Applies an action that does not come from the panels, and carries out its effect.
    pub fn act(
        &mut self,
        action: Action,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) {
        if let Some(effect) = session.apply(action)
            && self.carry_out(effect, session, proxy)
        {
            self.ends = true;
        }
    }

    fn viewport_picture(&self, session: &Session) -> ViewportPicture {
        let scale = self.egui.egui_ctx().pixels_per_point();
        ViewportPicture {
            posed: session.posed().clone(),
            overlays: session.overlays(),
            theme: session.preferences().theme,
            size: self.viewport_pixels(scale),
            scale,
        }
    }

    /// Waits until the export's thread, if there is one, has ended: a cancelled export removes its
    /// files first.
    pub fn await_export(&mut self) {
        if let Some(thread) = self.exporting.take()
            && thread.join().is_err()
        {
            log::error!("an export panicked");
        }
    }

    /// Carries out an effect and returns whether the program is to end.
    pub(super) fn carry_out(
        &mut self,
        effect: Effect,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> bool {
        match effect {
            Effect::CopyText(text) => self.egui.egui_ctx().copy_text(text),
            Effect::CopyLink(parts) => {
                self.egui.egui_ctx().copy_text(format!("{}#{parts}", platform::address()));
            }
            Effect::SavePicture(path) => {
                let picture = self.viewport_picture(session);
                background::save_picture(picture, PathBuf::from(path), proxy.clone());
            }
            Effect::Bake(settings) => {
                let job = background::bake(settings, session.document().clone(), proxy.clone());
                session.apply(BakeAction::Started(job));
            }
            Effect::Export(export) => {
                let document = session.document().clone();
                let picture = self.viewport_picture(session);
                let (job, thread) = background::export(export, document, &picture, proxy.clone());
                self.exporting = Some(thread);
                session.apply(FileAction::ExportStarted(job));
            }
            Effect::ChoosePath(dialog) => {
                let path = session.files().full_path(&dialog, dialog.path());
                platform::choose_path(dialog, &path, proxy.clone());
            }
            Effect::Open { path, options } => background::open(path, options, proxy.clone()),
            Effect::LocateSkin(path) => {
                background::locate_skin(path, session.rig(), proxy.clone());
            }
            Effect::Save(path) => {
                let saved = match io::save(session.document(), &path) {
                    Ok(()) => FileAction::Saved(path),
                    Err(error) => FileAction::NotSaved { path, why: error.to_string() },
                };
                let next = session.apply(saved);
                return next.is_some_and(|effect| self.carry_out(effect, session, proxy));
            }
            Effect::Quit => return true,
        }
        false
    }

    /// Width and height of the viewport in pixels; `scale` is in pixels per point.
    pub(super) fn viewport_pixels(&self, scale: f32) -> (u32, u32) {
        let side = |length: f32| (length * scale).round().max(1.0) as u32;
        (side(self.viewport.width()), side(self.viewport.height()))
    }
}

/// Attributes of the window: title, icon, minimum size, and the size from the previous run.
fn attributes(event_loop: &ActiveEventLoop, last: Option<WindowSettings>) -> WindowAttributes {
    let attributes = Window::default_attributes()
        .with_title(TITLE)
        .with_inner_size(size(event_loop, last))
        .with_min_inner_size(MIN_SIZE)
        .with_window_icon(icon())
        // Shown after AccessKit is initialized, which needs a hidden window.
        .with_visible(false);
    platform::attributes(attributes)
}

/// Size of the window in the previous run, limited to the screens; `SIZE` if it is unknown.
fn size(event_loop: &ActiveEventLoop, last: Option<WindowSettings>) -> LogicalSize<f64> {
    let Some(mut last) = last else {
        return SIZE;
    };
    let screens = event_loop.available_monitors().map(|screen| {
        let size = screen.size().to_logical::<f32>(screen.scale_factor());
        egui::vec2(size.width, size.height)
    });
    let largest = screens.filter(|size| size.min_elem() > 0.0).reduce(egui::Vec2::max);
    last.clamp_size_to_sane_values(largest.unwrap_or(egui::Vec2::INFINITY));
    let points = last.inner_size_points();
    LogicalSize::new(
        f64::from(points.x).max(MIN_SIZE.width),
        f64::from(points.y).max(MIN_SIZE.height),
    )
}

fn icon() -> Option<Icon> {
    let image = image::load_from_memory(ICON).ok()?.into_rgba8();
    let (width, height) = image.dimensions();
    Icon::from_rgba(image.into_raw(), width, height).ok()
}

/// Title of the window: the document's name, an asterisk for unsaved changes, and the program;
/// during the tour, the step or the title of the last card.
fn title(session: &Session) -> String {
    if let Some(tour) = session.tour() {
        return match tour.step() {
            Some(_) => format!("Tour, step {} – {TITLE}", tour.number() + 1),
            None => format!("Tour, {} – {TITLE}", tour.title()),
        };
    }
    let unsaved = if session.history().is_unsaved() { "*" } else { "" };
    match session.files().name() {
        Some(name) => format!("{name}{unsaved} – {TITLE}"),
        None if session.history().is_unsaved() => format!("untitled* – {TITLE}"),
        None => TITLE.to_owned(),
    }
}
