use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use egui::{Event, FullOutput, RawInput, Rect, ViewportId};
use egui_winit::WindowSettings;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::Window;

use super::attributes::attributes;
use super::debug::Debug;
use super::failures::Failures;
use super::graphics::{Graphics, GraphicsError, guarded};
use super::laps::laps;
use super::present::Presented;
use super::settings::Settings;
use super::{AppError, UserEvent};
use crate::scene::Scene;
use crate::session::{Actions, Effect, Overlays, Session, ShellAction};
use crate::ui::{self, FrameTime, Machine, style};

pub(super) const TITLE: &str = "ik-arm";

/// When the next frame is due.
pub(super) enum Repaint {
    OnInput,
    At(Instant),
    Quit,
    /// There is nothing left to draw with.
    Failed(GraphicsError),
}

/// The window with all that draws in it.
pub(super) struct AppWindow {
    /// Nothing while they are lost.
    pub(super) graphics: Option<Graphics>,
    failures: Failures,
    /// When lost graphics are made anew.
    dark_until: Instant,
    debug: Debug,
    pub(super) window: Arc<Window>,
    pub(super) egui: egui_winit::State,
    machine: Machine,
    overlays: Overlays,
    /// The scene as it is to be drawn; the memory is that of the one before last.
    scene: Option<Scene>,
    /// What has been typed since a file dialog was asked for.
    held_keys: Vec<Event>,
    /// When the last frame began, if it asked for another one at once.
    moving_since: Option<Instant>,
    frames: u64,
    title: String,
    /// Where the scene is, in points.
    pub(super) viewport: Rect,
    /// Whether the program is to end at the next frame.
    pub(super) ends: bool,
    pub(super) exporting: Option<JoinHandle<()>>,
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
        ctx.data_mut(|data| *data = settings.layout);
        let display = event_loop.owned_display_handle();
        let graphics = Graphics::new(display, &window, &ctx, proxy.clone())?;
        let mut egui = egui_winit::State::new(
            ctx,
            ViewportId::ROOT,
            event_loop,
            Some(window.scale_factor() as f32),
            None,
            Some(graphics.gpu.longest_side() as usize),
        );
        egui.init_accesskit(event_loop, &window, proxy);
        window.set_visible(true);
        window.request_redraw();
        let debug = Debug::from_env();
        let machine = Machine {
            adapter: graphics.gpu.name(),
            has_clock: graphics.has_clock(),
            ..Machine::default()
        };
        Ok(Self {
            graphics: Some(graphics),
            failures: Failures::default(),
            dark_until: Instant::now(),
            debug,
            window,
            egui,
            machine,
            overlays: Overlays::default(),
            scene: None,
            held_keys: Vec::new(),
            moving_since: None,
            frames: 0,
            title: TITLE.to_owned(),
            viewport: Rect::ZERO,
            ends: false,
            exporting: None,
        })
    }

    pub fn request_redraw(&self) {
        self.window.request_redraw();
    }

    /// How many frames have been drawn.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Whether the event asks for a frame.
    pub fn on_event(&mut self, event: &WindowEvent) -> bool {
        if self.debug.destroys_device(event)
            && let Some(graphics) = &self.graphics
        {
            graphics.gpu.device.destroy();
        }
        self.egui.on_window_event(&self.window, event).repaint
    }

    pub fn on_accesskit(&mut self, event: egui_winit::accesskit_winit::Event) {
        use egui_winit::accesskit_winit::WindowEvent;
        match event.window_event {
            WindowEvent::InitialTreeRequested => self.egui.egui_ctx().enable_accesskit(),
            WindowEvent::ActionRequested(request) => self.egui.on_accesskit_action_request(request),
            WindowEvent::AccessibilityDeactivated => self.egui.egui_ctx().disable_accesskit(),
        }
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

    /// What to keep for the next start.
    pub fn settings(&self, session: &Session) -> Settings {
        let ctx = self.egui.egui_ctx();
        Settings {
            preferences: *session.preferences(),
            recent: session.recent().to_vec(),
            export_folder: session.export_folder().map(Path::to_owned),
            window: Some(WindowSettings::from_window(ctx.zoom_factor(), &self.window, None)),
            layout: ctx.data(Clone::clone),
        }
    }

    /// Takes the input, lets the session follow, and draws what it is then: all in one frame.
    pub fn redraw(
        &mut self,
        event_loop: &ActiveEventLoop,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Repaint {
        if let Some(later) = self.restore(event_loop, session, proxy) {
            return later;
        }
        let started = Instant::now();
        let input = self.egui.take_egui_input(&self.window);
        style::apply(self.egui.egui_ctx(), session.preferences().theme);
        let interval = self.moving_since.take().map(|last| started - last);
        let mut frame = FrameTime { interval, ..FrameTime::default() };
        let (mut output, viewport, effects) = self.run(input, session, &mut frame);
        self.viewport = viewport;
        if self.ends || effects.into_iter().any(|effect| self.carry_out(effect, session, proxy)) {
            output.textures_delta.clear();
            return Repaint::Quit;
        }
        self.entitle(session);
        let platform = std::mem::take(&mut output.platform_output);
        self.egui.handle_platform_output(&self.window, platform);
        let delay = output.viewport_output.get(&ViewportId::ROOT).map(|root| root.repaint_delay);
        let delay = match self.draw(session, output, &mut frame) {
            Ok(Presented::Shown) => {
                self.machine.crowd = self.graphics.as_ref().and_then(Graphics::crowd_times);
                self.machine.times.push(frame);
                self.moving_since = delay.filter(Duration::is_zero).map(|_| started);
                self.frames += 1;
                log::trace!("frame {} drawn", self.frames);
                self.failures.forget();
                delay
            }
            // What moves would go on as fast as it can, were it not seen.
            Ok(Presented::Later(again)) => {
                let delay = delay.map(|delay| delay.max(Graphics::PAUSE));
                delay.into_iter().chain(again).min()
            }
            Err(error) => return self.lose(error),
        };
        delay.and_then(|delay| started.checked_add(delay)).map_or(Repaint::OnInput, Repaint::At)
    }

    /// Makes graphics anew that were lost. What to do instead of a frame, if there are none.
    fn restore(
        &mut self,
        event_loop: &ActiveEventLoop,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Option<Repaint> {
        if let Some(graphics) = &self.graphics {
            return graphics.check().err().map(|error| self.lose(error));
        }
        if Instant::now() < self.dark_until {
            return Some(Repaint::At(self.dark_until));
        }
        let display = event_loop.owned_display_handle();
        let made = guarded(|| match self.debug.fails_device() {
            true => Err(GraphicsError::Asked),
            false => Graphics::new(display, &self.window, self.egui.egui_ctx(), proxy.clone()),
        });
        let graphics = match made {
            Ok(graphics) => self.graphics.insert(graphics),
            Err(error) => return Some(self.lose(error)),
        };
        self.machine.adapter = graphics.gpu.name();
        self.machine.has_clock = graphics.has_clock();
        self.egui.set_max_texture_side(graphics.gpu.longest_side() as usize);
        session.apply(ShellAction::Report(
            "The graphics device was lost and has been made anew; nothing is lost.".to_owned(),
        ));
        None
    }

    /// Lets go of graphics that have failed, to make them anew.
    fn lose(&mut self, error: GraphicsError) -> Repaint {
        log::error!("{error}");
        self.drop_graphics();
        let Some(pause) = self.failures.pause() else {
            return Repaint::Failed(error);
        };
        self.dark_until = Instant::now() + pause;
        Repaint::At(self.dark_until)
    }

    /// Not even to be dropped is safe for what was in use when the device was lost.
    pub fn drop_graphics(&mut self) {
        let lost = self.graphics.take();
        let dropped = guarded(|| {
            drop(lost);
            Ok(())
        });
        if let Err(error) = dropped {
            log::warn!("{error}");
        }
    }

    /// Runs the panels on one key press or mouse button after the other, so that each meets what the
    /// one before it has opened.
    fn run(
        &mut self,
        mut input: RawInput,
        session: &mut Session,
        frame: &mut FrameTime,
    ) -> (FullOutput, Rect, Vec<Effect>) {
        let mut events = std::mem::take(&mut self.held_keys);
        if !session.is_asking() {
            // The system's dialog had the keyboard.
            events.clear();
        }
        events.append(&mut input.events);
        let strokes = ui::strokes(events);
        let mut output = FullOutput::default();
        let mut viewport = Rect::ZERO;
        let mut effects = Vec::new();
        for events in strokes {
            let events = match session.is_choosing() {
                true => ui::hold_typed(events, &mut self.held_keys),
                false => events,
            };
            let dropped_files = std::mem::take(&mut input.dropped_files);
            let stroke = RawInput { events, dropped_files, ..input.clone() };
            let (shown, rect, asked) = self.run_stroke(stroke, session, frame);
            output.append(shown);
            viewport = rect;
            effects.extend(asked);
        }
        (output, viewport, effects)
    }

    /// Runs the panels, applies their actions, and if there were any, runs the panels once more, so
    /// that none shows the state before.
    fn run_stroke(
        &mut self,
        input: RawInput,
        session: &mut Session,
        frame: &mut FrameTime,
    ) -> (FullOutput, Rect, Vec<Effect>) {
        let mut lap = laps();
        let again = RawInput { events: Vec::new(), dropped_files: Vec::new(), ..input.clone() };
        let picture = self.graphics.as_ref().map(Graphics::picture);
        let (machine, ctx) = (&self.machine, self.egui.egui_ctx());
        let mut viewport = Rect::ZERO;
        let mut actions = Actions::new();
        let mut output = ctx.run_ui(input, |ui| {
            viewport = ui::show(ui, session, machine, picture, &mut actions);
        });
        frame.panels += lap();
        if actions.is_empty() {
            return (output, viewport, Vec::new());
        }
        let effects = actions.drain().filter_map(|action| session.apply(action)).collect();
        frame.solve += lap();
        style::apply(ctx, session.preferences().theme);
        output.append(ctx.run_ui(again, |ui| {
            viewport = ui::show(ui, session, machine, picture, &mut actions);
        }));
        frame.panels += lap();
        (output, viewport, effects)
    }

    /// Says what is open.
    fn entitle(&mut self, session: &Session) {
        let unsaved = if session.is_unsaved() { "*" } else { "" };
        let name = session.file().and_then(Path::file_name).map(OsStr::to_string_lossy);
        let title = match name {
            Some(name) => format!("{name}{unsaved} – {TITLE}"),
            None if session.is_unsaved() => format!("untitled* – {TITLE}"),
            None => TITLE.to_owned(),
        };
        if title != self.title {
            self.window.set_title(&title);
            self.title = title;
        }
    }

    /// Draws the scene, and the panels around it.
    fn draw(
        &mut self,
        session: &Session,
        output: FullOutput,
        frame: &mut FrameTime,
    ) -> Result<Presented, GraphicsError> {
        let FullOutput { shapes, textures_delta: mut textures, pixels_per_point: scale, .. } =
            output;
        // Taken out first: egui panics where they are dropped unheeded.
        let changed = std::mem::take(&mut textures.set);
        let freed = std::mem::take(&mut textures.free);
        let Some(graphics) = &mut self.graphics else {
            return Ok(Presented::Later(None));
        };
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return guarded(|| {
                graphics.update_textures(changed);
                graphics.free_textures(freed);
                Ok(Presented::Later(None))
            });
        }
        let mut lap = laps();
        let (document, theme) = (session.shown(), session.preferences().theme);
        session.write_overlays(&mut self.overlays);
        match &mut self.scene {
            Some(scene) => scene.refill(document, &self.overlays, theme),
            None => self.scene = Some(Scene::new(document, &self.overlays, theme)),
        }
        frame.scene += lap();
        let panels = self.egui.egui_ctx().tessellate(shapes, scale);
        frame.panels += lap();
        let machine = &mut self.machine;
        guarded(|| {
            // Of earlier frames.
            while let Some((frame, time)) = graphics.read_clock() {
                machine.times.set_gpu(frame, time);
            }
            graphics.update_textures(changed);
            if let Some(scene) = &mut self.scene {
                machine.counts =
                    Some(graphics.draw_scene(scene, pixels(self.viewport, scale), scale));
            }
            frame.encode += lap();
            let drawn = machine.times.drawn();
            let (presented, waited) = graphics.present(&panels, scale, &self.window, drawn)?;
            frame.wait += waited;
            frame.encode += lap().saturating_sub(waited);
            graphics.free_textures(freed);
            if self.failures.is_trying() && matches!(presented, Presented::Shown) {
                graphics.finish()?;
            }
            Ok(presented)
        })
    }
}

pub(super) fn pixels(viewport: Rect, scale: f32) -> (u32, u32) {
    let side = |length: f32| (length * scale).round().max(1.0) as u32;
    (side(viewport.width()), side(viewport.height()))
}
