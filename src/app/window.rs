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

use super::attributes::{TITLE, attributes, title};
use super::background::UserEvent;
use super::dynamic_resolution::{DynamicResolution, lap_timer};
use super::error::{AppError, GraphicsError};
use super::graphics::{DeviceRetries, Graphics, guarded};
use super::present::Presented;
use super::settings::{DebugOptions, Settings};
use crate::scene::{Scene, SceneBuilder};
use crate::session::{Actions, Effect, Overlays, Session, ShellAction};
use crate::ui::{self, FrameTime, Machine, style};

/// Time between frames while only counts of earlier frames are missing.
const COUNTS_INTERVAL: Duration = Duration::from_millis(50);

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
    retries: DeviceRetries,
    /// Time at which lost graphics are created again.
    retry_at: Instant,
    debug: DebugOptions,
    pub(super) window: Arc<Window>,
    pub(super) egui: egui_winit::State,
    machine: Machine,
    overlays: Overlays,
    builder: SceneBuilder,
    /// Scene to refill and draw in the next frame, to reuse its memory; `None` before the first
    /// frame.
    scene: Option<Scene>,
    /// Typed events since a file dialog was requested, held back for that dialog.
    held_keys: Vec<Event>,
    /// Start of the previous frame, if that frame requested another one at once.
    moving_since: Option<Instant>,
    frames: u64,
    title: String,
    /// Rectangle of the scene in points.
    pub(super) viewport: Rect,
    /// True if the program ends at the next frame.
    pub(super) ends: bool,
    pub(super) exporting: Option<JoinHandle<()>>,
    dynamic_resolution: DynamicResolution,
    /// True if counts of earlier frames will arrive from the device.
    awaits_counts: bool,
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
        let debug = DebugOptions::from_env();
        let machine = Machine {
            adapter: graphics.gpu.name(),
            has_clock: graphics.has_clock(),
            ..Machine::default()
        };
        Ok(Self {
            graphics: Some(graphics),
            retries: DeviceRetries::default(),
            retry_at: Instant::now(),
            debug,
            window,
            egui,
            machine,
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
        })
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

    /// Runs one frame: takes the input, applies the actions of the panels, and draws.
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
        self.update_title(session);
        let platform = std::mem::take(&mut output.platform_output);
        self.egui.handle_platform_output(&self.window, platform);
        let delay = output.viewport_output.get(&ViewportId::ROOT).map(|root| root.repaint_delay);
        let delay = match self.draw(session, output, &mut frame) {
            Ok(Presented::Shown { has_changed }) => {
                self.machine.crowd = self.graphics.as_ref().and_then(Graphics::crowd_times);
                if has_changed {
                    self.machine.times.push(frame);
                }
                if !self.graphics.as_ref().is_some_and(|graphics| graphics.has_own_time) {
                    let budget = session.preferences().frame_budget.time();
                    self.dynamic_resolution.measure(frame.resolution_scale, frame.total(), budget);
                }
                self.moving_since = delay.filter(Duration::is_zero).map(|_| started);
                self.frames += 1;
                log::trace!("frame {}: {frame}", self.frames);
                self.retries.reset();
                let counts = self.awaits_counts.then_some(COUNTS_INTERVAL);
                delay
                    .into_iter()
                    .chain(self.dynamic_resolution.rests_in(started))
                    .chain(counts)
                    .min()
            }
            // Motion that is not visible needs few frames.
            Ok(Presented::Later(again)) => {
                let delay = delay.map(|delay| delay.max(Graphics::HIDDEN_FRAME_INTERVAL));
                delay.into_iter().chain(again).min()
            }
            Err(error) => return self.lose(error),
        };
        delay.and_then(|delay| started.checked_add(delay)).map_or(Repaint::OnInput, Repaint::At)
    }

    /// Creates lost graphics again. Returns `None` if a frame can be drawn, otherwise when to try
    /// again or why the program must end.
    fn restore(
        &mut self,
        event_loop: &ActiveEventLoop,
        session: &mut Session,
        proxy: &EventLoopProxy<UserEvent>,
    ) -> Option<Repaint> {
        if let Some(graphics) = &self.graphics {
            return graphics.check().err().map(|error| self.lose(error));
        }
        if Instant::now() < self.retry_at {
            return Some(Repaint::At(self.retry_at));
        }
        let display = event_loop.owned_display_handle();
        let created = guarded(|| {
            if self.debug.fails_device() {
                Err(GraphicsError::Requested)
            } else {
                Graphics::new(display, &self.window, self.egui.egui_ctx(), proxy.clone())
            }
        });
        let graphics = match created {
            Ok(graphics) => self.graphics.insert(graphics),
            Err(error) => return Some(self.lose(error)),
        };
        self.machine.adapter = graphics.gpu.name();
        self.machine.has_clock = graphics.has_clock();
        self.egui.set_max_texture_side(graphics.gpu.longest_side() as usize);
        session.apply(ShellAction::Report(
            "The graphics device was lost and created again; the document is unchanged".to_owned(),
        ));
        None
    }

    /// Drops failed graphics and schedules the next attempt to create them; returns
    /// [`Repaint::Failed`] if no attempt is left.
    fn lose(&mut self, error: GraphicsError) -> Repaint {
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

    /// Runs the panels once for each key press or mouse button, so that each press sees the effects
    /// of the previous one.
    fn run(
        &mut self,
        mut input: RawInput,
        session: &mut Session,
        frame: &mut FrameTime,
    ) -> (FullOutput, Rect, Vec<Effect>) {
        let mut events = std::mem::take(&mut self.held_keys);
        if !session.shell().is_asking() {
            // These events were typed while the system's dialog had the focus.
            events.clear();
        }
        events.append(&mut input.events);
        let strokes = ui::strokes(events);
        let mut output = FullOutput::default();
        let mut viewport = Rect::ZERO;
        let mut effects = Vec::new();
        for events in strokes {
            let events = if session.shell().is_choosing() {
                ui::hold_typed(events, &mut self.held_keys)
            } else {
                events
            };
            let dropped_files = std::mem::take(&mut input.dropped_files);
            let stroke = RawInput { events, dropped_files, ..input.clone() };
            let (run, rect, new_effects) = self.run_stroke(stroke, session, frame);
            output.append(run);
            viewport = rect;
            effects.extend(new_effects);
        }
        (output, viewport, effects)
    }

    /// Runs the panels and applies their actions. If there were any actions, runs the panels again,
    /// so that no panel shows an outdated state.
    fn run_stroke(
        &mut self,
        input: RawInput,
        session: &mut Session,
        frame: &mut FrameTime,
    ) -> (FullOutput, Rect, Vec<Effect>) {
        let mut lap = lap_timer();
        let again = RawInput { events: Vec::new(), dropped_files: Vec::new(), ..input.clone() };
        let (machine, ctx) = (&self.machine, self.egui.egui_ctx());
        let mut viewport = Rect::ZERO;
        let mut actions = Actions::new();
        let mut output = ctx.run_ui(input, |ui| {
            viewport = ui::show(ui, session, machine, &mut actions);
        });
        frame.panels += lap();
        if actions.is_empty() {
            return (output, viewport, Vec::new());
        }
        let effects = actions.drain().filter_map(|action| session.apply(action)).collect();
        frame.solve += lap();
        style::apply(ctx, session.preferences().theme);
        output.append(ctx.run_ui(again, |ui| {
            viewport = ui::show(ui, session, machine, &mut actions);
        }));
        frame.panels += lap();
        (output, viewport, effects)
    }

    fn update_title(&mut self, session: &Session) {
        let title = title(session);
        if title != self.title {
            self.window.set_title(&title);
            self.title = title;
        }
    }

    /// Draws the scene and the panels.
    fn draw(
        &mut self,
        session: &Session,
        output: FullOutput,
        frame: &mut FrameTime,
    ) -> Result<Presented, GraphicsError> {
        let FullOutput { shapes, textures_delta: mut textures, pixels_per_point: scale, .. } =
            output;
        // Taken out first: egui panics if texture changes are dropped with the output.
        let changed = std::mem::take(&mut textures.set);
        let freed = std::mem::take(&mut textures.free);
        let pixels = self.viewport_pixels(scale);
        let Some(graphics) = &mut self.graphics else {
            return Ok(Presented::Later(None));
        };
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return guarded(|| {
                graphics.panels.update_textures(&graphics.gpu, changed);
                graphics.panels.free_textures(freed);
                Ok(Presented::Later(None))
            });
        }
        let mut lap = lap_timer();
        let (posed, theme) = (session.posed(), session.preferences().theme);
        session.write_overlays(&mut self.overlays);
        self.overlays.has_handles = true;
        match &mut self.scene {
            Some(scene) => self.builder.refill(scene, posed, &self.overlays, theme),
            None => self.scene = Some(self.builder.build(posed, &self.overlays, theme)),
        }
        let budget = session.preferences().frame_budget.time();
        let held = self.egui.egui_ctx().input(|input| input.pointer.any_down());
        let is_driven = held || session.playback().is_playing();
        let is_moving = moves(graphics.drawn_scene(), self.scene.as_ref(), is_driven);
        frame.resolution_scale = self.dynamic_resolution.next(is_moving, budget, Instant::now());
        frame.scene += lap();
        let panels = self.egui.egui_ctx().tessellate(shapes, scale);
        frame.panels += lap();
        let (machine, dynamic_resolution) = (&mut self.machine, &mut self.dynamic_resolution);
        guarded(|| {
            // The times are those of earlier frames.
            while let Some((earlier, time)) = graphics.read_clock() {
                if let Some(earlier) = machine.times.set_gpu(earlier, time)
                    && graphics.has_own_time
                {
                    dynamic_resolution.measure(
                        earlier.resolution_scale,
                        earlier.work() + time,
                        budget,
                    );
                }
            }
            graphics.panels.update_textures(&graphics.gpu, changed);
            if let Some(scene) = &mut self.scene {
                machine.counts =
                    Some(graphics.draw_scene(scene, pixels, scale, frame.resolution_scale));
                self.awaits_counts = graphics.awaits_counts();
            }
            frame.encode += lap();
            let drawn = machine.times.drawn();
            let (presented, waited) =
                graphics.present(&panels, self.viewport, scale, &self.window, drawn)?;
            frame.wait += waited;
            frame.encode += lap().saturating_sub(waited);
            graphics.panels.free_textures(freed);
            if self.retries.is_retrying() && matches!(presented, Presented::Shown { .. }) {
                graphics.finish()?;
            }
            Ok(presented)
        })
    }

    /// Width and height of the viewport in pixels; `scale` is in pixels per point.
    pub(super) fn viewport_pixels(&self, scale: f32) -> (u32, u32) {
        let side = |length: f32| (length * scale).round().max(1.0) as u32;
        (side(self.viewport.width()), side(self.viewport.height()))
    }
}

/// True if a scene that differs from the one drawn before is a moment of a motion: the camera
/// moves, or `is_driven` by a held mouse button or playback.
fn moves(before: Option<&Scene>, now: Option<&Scene>, is_driven: bool) -> bool {
    let (Some(before), Some(now)) = (before, now) else {
        return false;
    };
    before.camera != now.camera || (is_driven && before != now)
}
