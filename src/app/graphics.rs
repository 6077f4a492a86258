use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use egui::epaint::{ImageDelta, TextureAtlas};
use egui::{Context, TextureId};
use thiserror::Error;
use winit::event_loop::{EventLoopProxy, OwnedDisplayHandle};
use winit::window::Window;

use super::UserEvent;
use crate::render::{Canvas, Counts, Gpu, GpuError, GpuTimer, Lap, Renderer};
use crate::rig::CrowdTimes;
use crate::scene::Scene;

/// Why nothing can be drawn in the window.
#[derive(Debug, Error)]
pub enum GraphicsError {
    #[error("the window cannot be drawn in: {0}")]
    Surface(#[from] wgpu::CreateSurfaceError),
    #[error("the graphics adapter {0} cannot draw in this window")]
    Unsupported(String),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("the window's surface was lost, and so was the one after it")]
    SurfaceLost,
    #[error("the window's surface gives no frame")]
    NoFrame,
    #[error("the graphics device failed: {0}")]
    Device(String),
    #[error("the graphics failed by a fault: {0}")]
    Fault(String),
    #[error("the graphics device failed, as IK_ARM_DEBUG asks for")]
    Asked,
}

/// All that lives on the graphics device: lost with it, and made anew.
pub(super) struct Graphics {
    pub(super) egui_renderer: egui_wgpu::Renderer,
    renderer: Renderer,
    picture: Shown,
    pub(super) gpu_timer: Option<GpuTimer>,
    pub(super) surface: wgpu::Surface<'static>,
    pub(super) config: wgpu::SurfaceConfiguration,
    /// Whether the surface still works but should be configured anew.
    pub(super) stale: bool,
    pub(super) gpu: Gpu,
    /// Why the device is good for nothing more, from when it is.
    fault: Arc<OnceLock<String>>,
}

/// The scene as it was last drawn, for the panels to show.
struct Shown {
    canvas: Canvas,
    texture: TextureId,
    scene: Option<Scene>,
    /// Whether the scene is on the canvas.
    drawn: bool,
}

impl Graphics {
    /// The window must have no other: it has one surface at a time. The panels find their letters
    /// there, whatever they have drawn before.
    pub fn new(
        display: OwnedDisplayHandle,
        window: &Arc<Window>,
        panels: &Context,
        proxy: EventLoopProxy<UserEvent>,
    ) -> Result<Self, GraphicsError> {
        let (gpu, surface) = Gpu::with_gl_as_fallback(|backends| {
            let display = Box::new(display.clone());
            let descriptor = wgpu::InstanceDescriptor::new_with_display_handle_from_env(display);
            let descriptor = wgpu::InstanceDescriptor { backends, ..descriptor };
            let instance = wgpu::Instance::new(descriptor);
            let surface = instance.create_surface(Arc::clone(window))?;
            let gpu = Gpu::new(instance, Some(&surface))?;
            Ok::<_, GraphicsError>((gpu, surface))
        })?;
        let fault = Arc::new(OnceLock::new());
        let found = Arc::clone(&fault);
        gpu.on_fault(move |why| {
            if found.set(why).is_ok() {
                // Nobody hears it once the window is closed.
                let _ = proxy.send_event(UserEvent::GraphicsFailed);
            }
        });
        let config = configuration(&gpu, &surface, window)?;
        let mut egui_renderer =
            egui_wgpu::Renderer::new(&gpu.device, config.format, Default::default());
        upload_letters(&mut egui_renderer, &gpu, panels);
        let canvas = Canvas::new(&gpu, 1, 1);
        let texture = egui_renderer.register_native_texture(
            &gpu.device,
            canvas.view(),
            wgpu::FilterMode::Nearest,
        );
        let graphics = Self {
            egui_renderer,
            renderer: Renderer::new(&gpu),
            picture: Shown { canvas, texture, scene: None, drawn: false },
            gpu_timer: GpuTimer::new(&gpu),
            surface,
            config,
            stale: false,
            gpu,
            fault,
        };
        graphics.check()?;
        Ok(graphics)
    }

    /// # Errors
    ///
    /// If the device is good for nothing more, as far as it has said so.
    pub fn check(&self) -> Result<(), GraphicsError> {
        self.fault.get().map_or(Ok(()), |why| Err(GraphicsError::Device(why.clone())))
    }

    /// How long the crowd took that is shown, if there is one.
    pub fn crowd_times(&self) -> Option<CrowdTimes> {
        self.renderer.crowd_times()
    }

    /// The picture of the scene, among egui's.
    pub fn picture(&self) -> TextureId {
        self.picture.texture
    }

    /// Whether the device measures how long it works.
    pub fn has_clock(&self) -> bool {
        self.gpu_timer.is_some()
    }

    /// A frame and how long the device worked on it, if that is known by now.
    pub fn read_clock(&mut self) -> Option<(u64, Duration)> {
        // A device that is lost says so when it is asked, and has no buffers left to read.
        let _ = self.gpu.device.poll(wgpu::PollType::Poll);
        self.check().ok()?;
        self.gpu_timer.as_mut()?.read(&self.gpu)
    }

    /// Draws the scene for the panels to show, if it is not what they show already; leaves another
    /// one for it, to be refilled. What is in it, and what was uploaded for it now.
    pub fn draw_scene(
        &mut self,
        scene: &mut Scene,
        (width, height): (u32, u32),
        scale: f32,
    ) -> Counts {
        if let Some(gpu_timer) = &mut self.gpu_timer {
            gpu_timer.start();
        }
        if self.picture.canvas.size() != (width, height) {
            self.picture.canvas = Canvas::new(&self.gpu, width, height);
            self.picture.drawn = false;
            self.show_canvas();
        }
        if self.picture.drawn && self.picture.scene.as_ref() == Some(scene) {
            return Counts { uploaded: 0, ..self.renderer.counts() };
        }
        let canvas = &self.picture.canvas;
        self.renderer.upload(&self.gpu, scene, canvas.size(), scale);
        let lap = self.gpu_timer.as_mut().map(|gpu_timer| gpu_timer.lap(Lap::Scene));
        self.gpu.queue.submit([self.renderer.encode(&self.gpu, canvas, lap)]);
        self.picture.drawn = true;
        match &mut self.picture.scene {
            Some(shown) => std::mem::swap(shown, scene),
            None => self.picture.scene = Some(scene.clone()),
        }
        self.renderer.counts()
    }

    /// Lets the panels show a new canvas under the same name.
    fn show_canvas(&mut self) {
        self.egui_renderer.update_egui_texture_from_wgpu_texture(
            &self.gpu.device,
            self.picture.canvas.view(),
            wgpu::FilterMode::Nearest,
            self.picture.texture,
        );
    }
}

/// Draws, or makes what draws. A device that dies meanwhile lets `wgpu` and `egui_wgpu` panic here
/// and there, where they get no memory or no answer from it: one more way to fail.
pub(super) fn guarded<T>(
    draw: impl FnOnce() -> Result<T, GraphicsError>,
) -> Result<T, GraphicsError> {
    panic::catch_unwind(AssertUnwindSafe(draw)).unwrap_or_else(|fault| {
        let said = fault.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| fault.downcast_ref().copied());
        Err(GraphicsError::Fault(said.unwrap_or("it says nothing").to_owned()))
    })
}

/// egui tells what changes in its letters, and a new renderer has none to change.
fn upload_letters(renderer: &mut egui_wgpu::Renderer, gpu: &Gpu, panels: &Context) {
    // egui has fonts from its first frame on.
    if panels.cumulative_pass_nr() == 0 {
        return;
    }
    let all =
        panels.fonts(|fonts| ImageDelta::full(fonts.image(), TextureAtlas::texture_options()));
    renderer.update_texture(&gpu.device, &gpu.queue, TextureId::default(), &all);
}

/// egui blends in what is stored, so the format does not convert.
fn configuration(
    gpu: &Gpu,
    surface: &wgpu::Surface<'_>,
    window: &Window,
) -> Result<wgpu::SurfaceConfiguration, GraphicsError> {
    let size = window.inner_size();
    let longest = gpu.longest_side();
    let side = |length: u32| length.clamp(1, longest);
    let unsupported = || GraphicsError::Unsupported(gpu.name());
    let mut config = surface
        .get_default_config(&gpu.adapter, side(size.width), side(size.height))
        .ok_or_else(unsupported)?;
    let formats = surface.get_capabilities(&gpu.adapter).formats;
    config.format = egui_wgpu::preferred_framebuffer_format(&formats).map_err(|_| unsupported())?;
    // At the screen's own pace, and never torn; every surface has it.
    config.present_mode = wgpu::PresentMode::Fifo;
    config.desired_maximum_frame_latency = 1;
    surface.configure(&gpu.device, &config);
    Ok(config)
}
