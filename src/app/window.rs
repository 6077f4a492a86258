use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use egui::{FullOutput, RawInput, Rect, TextureId, ViewportId};
use egui_winit::WindowSettings;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Icon, Window, WindowAttributes};

use super::settings::Settings;
use super::{AppError, UserEvent};
use crate::render::{Canvas, Gpu, Renderer};
use crate::scene::Scene;
use crate::session::{Effect, Session};
use crate::ui::{self, Machine, style};

const TITLE: &str = "ik-arm";
const APP_ID: &str = "ik-arm";
const SIZE: LogicalSize<f64> = LogicalSize::new(1280.0, 800.0);
const SMALLEST: LogicalSize<f64> = LogicalSize::new(640.0, 400.0);
const ICON: &[u8] = include_bytes!("../../assets/icon-64.png");

/// When the next frame is due.
pub(super) enum Repaint {
    OnInput,
    At(Instant),
    Quit,
}

/// The window with all that draws in it.
pub(super) struct AppWindow {
    pub(super) window: Arc<Window>,
    pub(super) gpu: Gpu,
    pub(super) surface: wgpu::Surface<'static>,
    pub(super) config: wgpu::SurfaceConfiguration,
    /// Whether the surface still works but should be configured anew.
    pub(super) stale: bool,
    pub(super) egui: egui_winit::State,
    pub(super) egui_renderer: egui_wgpu::Renderer,
    renderer: Renderer,
    pub(super) picture: Shown,
    pub(super) machine: Machine,
    pub(super) frames: u64,
    title: String,
    /// Where the scene is, in points.
    pub(super) viewport: Rect,
    /// Whether the program is to end at the next frame.
    pub(super) ends: bool,
    pub(super) exporting: Option<JoinHandle<()>>,
}

/// The scene as it was last drawn, for the panels to show.
pub(super) struct Shown {
    pub canvas: Canvas,
    pub texture: TextureId,
    scene: Option<Scene>,
}

impl AppWindow {
    pub fn open(
        event_loop: &ActiveEventLoop,
        settings: Settings,
        proxy: EventLoopProxy<UserEvent>,
    ) -> Result<Self, AppError> {
        let window = Arc::new(event_loop.create_window(attributes(event_loop, settings.window))?);
        let display = event_loop.owned_display_handle();
        let descriptor =
            wgpu::InstanceDescriptor::new_with_display_handle_from_env(Box::new(display));
        let instance = wgpu::Instance::new(descriptor);
        let surface = instance.create_surface(window.clone())?;
        let gpu = Gpu::new(instance, Some(&surface))?;
        let config = configuration(&gpu, &surface, &window)?;

        let ctx = egui::Context::default();
        style::install(&ctx);
        ctx.data_mut(|data| *data = settings.layout);
        let mut egui = egui_winit::State::new(
            ctx,
            ViewportId::ROOT,
            event_loop,
            Some(window.scale_factor() as f32),
            None,
            Some(gpu.longest_side() as usize),
        );
        egui.init_accesskit(event_loop, &window, proxy);
        window.set_visible(true);
        window.request_redraw();
        let mut egui_renderer =
            egui_wgpu::Renderer::new(&gpu.device, config.format, Default::default());
        let canvas = Canvas::new(&gpu, 1, 1);
        let texture = egui_renderer.register_native_texture(
            &gpu.device,
            canvas.view(),
            wgpu::FilterMode::Nearest,
        );
        Ok(Self {
            egui_renderer,
            renderer: Renderer::new(&gpu),
            machine: Machine { adapter: gpu.name(), frame_ms: None },
            window,
            gpu,
            surface,
            config,
            egui,
            stale: false,
            picture: Shown { canvas, texture, scene: None },
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

    /// A window of no size, as a minimised one is, keeps what it has.
    pub fn resize(&mut self, width: u32, height: u32) {
        if width > 0 && height > 0 {
            let longest = self.gpu.longest_side();
            self.config.width = width.min(longest);
            self.config.height = height.min(longest);
            self.surface.configure(&self.gpu.device, &self.config);
        }
    }

    /// What to keep for the next start.
    pub fn settings(&self, session: &Session) -> Settings {
        let ctx = self.egui.egui_ctx();
        Settings {
            preferences: *session.preferences(),
            recent: session.recent().to_vec(),
            window: Some(WindowSettings::from_window(ctx.zoom_factor(), &self.window, None)),
            layout: ctx.data(Clone::clone),
        }
    }

    /// Takes the input, lets the session follow, and draws what it is then: all in one frame.
    pub fn redraw(&mut self, session: &mut Session, proxy: &EventLoopProxy<UserEvent>) -> Repaint {
        let started = Instant::now();
        let size = self.window.inner_size();
        let input = self.egui.take_egui_input(&self.window);
        style::apply(self.egui.egui_ctx(), session.preferences().theme);
        let (mut output, viewport, effects) = self.run(input, session);
        self.viewport = viewport;
        if self.ends || effects.into_iter().any(|effect| self.carry_out(effect, session, proxy)) {
            return Repaint::Quit;
        }
        self.entitle(session);
        let platform = std::mem::take(&mut output.platform_output);
        self.egui.handle_platform_output(&self.window, platform);
        self.update_textures(&mut output);
        let freed = std::mem::take(&mut output.textures_delta.free);
        let delay = output.viewport_output.get(&ViewportId::ROOT).map(|root| root.repaint_delay);
        if size.width > 0 && size.height > 0 {
            self.draw_scene(session, viewport, output.pixels_per_point);
            self.present(output, started);
        }
        self.free_textures(freed);
        delay.and_then(|delay| started.checked_add(delay)).map_or(Repaint::OnInput, Repaint::At)
    }

    /// Runs the panels, applies what they ask for, and if that was anything, runs them once more,
    /// so that none shows the state before.
    fn run(&mut self, input: RawInput, session: &mut Session) -> (FullOutput, Rect, Vec<Effect>) {
        let again = RawInput { events: Vec::new(), dropped_files: Vec::new(), ..input.clone() };
        let picture = Some(self.picture.texture);
        let (machine, ctx) = (&self.machine, self.egui.egui_ctx());
        let mut viewport = Rect::ZERO;
        let mut actions = Vec::new();
        let mut output = ctx.run_ui(input, |ui| {
            viewport = ui::show(ui, session, machine, picture, &mut actions);
        });
        if actions.is_empty() {
            return (output, viewport, Vec::new());
        }
        let effects = actions.drain(..).filter_map(|action| session.apply(action)).collect();
        style::apply(ctx, session.preferences().theme);
        output.append(ctx.run_ui(again, |ui| {
            viewport = ui::show(ui, session, machine, picture, &mut actions);
        }));
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

    /// Draws the scene for the panels to show, if it is not what they show already.
    fn draw_scene(&mut self, session: &Session, viewport: Rect, scale: f32) {
        let (width, height) = pixels(viewport, scale);
        let scene = Scene::new(session.shown(), &session.staging(), session.preferences().theme);
        if self.picture.canvas.size() != (width, height) {
            self.picture.canvas = Canvas::new(&self.gpu, width, height);
            self.picture.scene = None;
            self.show_canvas();
        }
        if self.picture.scene.as_ref() != Some(&scene) {
            self.renderer.draw(&self.gpu, &scene, &self.picture.canvas, scale);
            self.picture.scene = Some(scene);
        }
    }
}

/// As large as it was last, as far as the screen goes.
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
        f64::from(points.x).max(SMALLEST.width),
        f64::from(points.y).max(SMALLEST.height),
    )
}

fn attributes(event_loop: &ActiveEventLoop, last: Option<WindowSettings>) -> WindowAttributes {
    let attributes = Window::default_attributes()
        .with_title(TITLE)
        .with_inner_size(size(event_loop, last))
        .with_min_inner_size(SMALLEST)
        .with_window_icon(icon())
        // Shown once a screen reader can read it.
        .with_visible(false);
    named(attributes)
}

#[cfg(target_os = "linux")]
fn named(attributes: WindowAttributes) -> WindowAttributes {
    use winit::platform::{wayland, x11};
    let attributes = x11::WindowAttributesExtX11::with_name(attributes, APP_ID, APP_ID);
    wayland::WindowAttributesExtWayland::with_name(attributes, APP_ID, APP_ID)
}

#[cfg(not(target_os = "linux"))]
fn named(attributes: WindowAttributes) -> WindowAttributes {
    attributes
}

fn icon() -> Option<Icon> {
    let image = image::load_from_memory(ICON).ok()?.into_rgba8();
    let (width, height) = image.dimensions();
    Icon::from_rgba(image.into_raw(), width, height).ok()
}

/// egui blends in what is stored, so the format does not convert.
fn configuration(
    gpu: &Gpu,
    surface: &wgpu::Surface<'_>,
    window: &Window,
) -> Result<wgpu::SurfaceConfiguration, AppError> {
    let size = window.inner_size();
    let longest = gpu.longest_side();
    let side = |length: u32| length.clamp(1, longest);
    let unsupported = || AppError::Unsupported(gpu.name());
    let mut config = surface
        .get_default_config(&gpu.adapter, side(size.width), side(size.height))
        .ok_or_else(unsupported)?;
    let formats = surface.get_capabilities(&gpu.adapter).formats;
    config.format = egui_wgpu::preferred_framebuffer_format(&formats).map_err(|_| unsupported())?;
    config.present_mode = wgpu::PresentMode::AutoVsync;
    config.desired_maximum_frame_latency = 1;
    surface.configure(&gpu.device, &config);
    Ok(config)
}

pub(super) fn pixels(viewport: Rect, scale: f32) -> (u32, u32) {
    let side = |length: f32| (length * scale).round().max(1.0) as u32;
    (side(viewport.width()), side(viewport.height()))
}
