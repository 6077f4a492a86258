use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;
use std::time::Duration;

use egui::Context;
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

use super::error::GraphicsError;
use super::panel_painter::PanelPainter;
use crate::render::{Canvas, Counts, CrowdError, Gpu, GpuTimer, Renderer, TimedPass};
use crate::rig::CrowdTimes;
use crate::scene::Scene;

/// Everything that lives on the graphics device, and is lost and created again with it.
pub(super) struct Graphics {
    pub(super) panels: PanelPainter,
    pub(super) renderer: Renderer,
    pub(super) picture: ScenePicture,
    pub(super) gpu_timer: Option<GpuTimer>,
    /// True if the device works beside the CPU, for a known time. The time of a software adapter is
    /// part of the CPU's.
    pub(super) has_own_time: bool,
    pub(super) surface: wgpu::Surface<'static>,
    pub(super) config: wgpu::SurfaceConfiguration,
    /// True if the surface still works but should be configured again.
    pub(super) is_stale: bool,
    pub(super) gpu: Gpu,
    /// Error of the latest crowd that was drawn; `None` if there was no error.
    crowd_error: Option<CrowdError>,
}

/// The scene that was drawn most recently.
pub(super) struct ScenePicture {
    pub(super) canvas: Canvas,
    scene: Option<Scene>,
    /// True if the canvas shows the scene.
    is_drawn: bool,
    /// True if the window does not show the canvas yet.
    pub(super) is_new: bool,
}

impl Graphics {
    /// Creates the graphics of a window and uploads the panels' whole font atlas. Earlier graphics
    /// of the window must be dropped first, because a window has one surface at a time. `watch` is
    /// called with the device before it is used.
    pub async fn new(
        display: OwnedDisplayHandle,
        window: &Arc<Window>,
        panels: &Context,
        watch: impl FnOnce(&Gpu),
    ) -> Result<Self, GraphicsError> {
        let (gpu, surface) = Gpu::with_gl_as_fallback(async |backends| {
            let display = Box::new(display.clone());
            let descriptor = wgpu::InstanceDescriptor::new_with_display_handle_from_env(display);
            let descriptor = wgpu::InstanceDescriptor { backends, ..descriptor };
            let instance = wgpu::Instance::new(descriptor);
            let surface = instance.create_surface(Arc::clone(window))?;
            let gpu = Gpu::new(instance, Some(&surface)).await?;
            Ok::<_, GraphicsError>((gpu, surface))
        })
        .await?;
        watch(&gpu);
        let config = configuration(&gpu, &surface, window)?;
        let canvas = Canvas::new(&gpu, 1, 1);
        let format = composed_format(&config);
        let gpu_timer = GpuTimer::new(&gpu);
        let graphics = Self {
            panels: PanelPainter::new(&gpu, format, panels),
            renderer: Renderer::with_labels(&gpu, format),
            picture: ScenePicture { canvas, scene: None, is_drawn: false, is_new: true },
            has_own_time: gpu_timer.is_some() && !gpu.is_software(),
            gpu_timer,
            surface,
            config,
            is_stale: false,
            gpu,
            crowd_error: None,
        };
        graphics.check()?;
        Ok(graphics)
    }

    /// Checks that the device still works.
    ///
    /// # Errors
    ///
    /// If the device has reported a failure by now.
    pub fn check(&self) -> Result<(), GraphicsError> {
        Ok(self.gpu.check()?)
    }

    /// Time taken to solve the crowd; `None` if no crowd is shown or the crowd has failed.
    pub fn crowd_times(&self) -> Option<CrowdTimes> {
        self.renderer.crowd_times().ok().flatten()
    }

    /// True if the device can measure the time that it takes for a frame.
    pub fn has_clock(&self) -> bool {
        self.gpu_timer.is_some()
    }

    /// Number of an earlier frame and the device's time for it; `None` if no further time is known
    /// yet.
    pub fn read_clock(&mut self) -> Option<(u64, Duration)> {
        // A lost device reports its loss when polled, and its buffers cannot be read.
        let _ = self.gpu.device.poll(wgpu::PollType::Poll);
        self.check().ok()?;
        self.gpu_timer.as_mut()?.read(&self.gpu)
    }

    /// True if counts of drawn frames will arrive from the device.
    pub fn awaits_counts(&self) -> bool {
        self.renderer.awaits_counts()
    }

    /// The scene that was drawn most recently; `None` before the first.
    pub fn drawn_scene(&self) -> Option<&Scene> {
        self.picture.scene.as_ref()
    }

    /// Draws the scene, unless the canvas shows it already. Returns the numbers of things in the
    /// scene and of bytes uploaded by this call. Keeps the drawn scene and leaves the previous
    /// scene in `scene`, to be refilled. `scale` is in pixels per point; `resolution_scale` is the
    /// ratio of the size at which the scene is drawn to the size of the viewport.
    pub fn draw_scene(
        &mut self,
        scene: &mut Scene,
        (width, height): (u32, u32),
        scale: f32,
        resolution_scale: f32,
    ) -> Counts {
        if let Some(gpu_timer) = &mut self.gpu_timer {
            gpu_timer.start();
        }
        self.renderer.read_counts();
        if self.picture.canvas.size() != (width, height) {
            self.picture.canvas = Canvas::new(&self.gpu, width, height);
            self.picture.is_drawn = false;
        }
        let drawn_scale = self.picture.canvas.resolution_scale();
        self.picture.canvas.set_resolution_scale(&self.gpu, resolution_scale);
        let has_same_scale = self.picture.canvas.resolution_scale() == drawn_scale;
        if self.picture.is_drawn && has_same_scale && self.picture.scene.as_ref() == Some(scene) {
            return Counts { uploaded: 0, ..self.renderer.counts() };
        }
        let canvas = &self.picture.canvas;
        self.renderer.upload(&self.gpu, scene, canvas, scale);
        let crowd_error = self.renderer.crowd_times().err();
        if self.crowd_error != crowd_error {
            crowd_error.iter().for_each(|error| log::error!("{error}"));
            self.crowd_error = crowd_error;
        }
        let timestamps = self.gpu_timer.as_mut().map(|gpu_timer| gpu_timer.pass(TimedPass::Scene));
        self.gpu.queue.submit([self.renderer.encode(&self.gpu, canvas, timestamps)]);
        (self.picture.is_drawn, self.picture.is_new) = (true, true);
        match &mut self.picture.scene {
            Some(shown) => std::mem::swap(shown, scene),
            None => self.picture.scene = Some(scene.clone()),
        }
        self.renderer.counts()
    }
}

/// Format of the picture that is copied to the surface. A surface with an sRGB format shows a copy
/// as it is, but would encode drawn colours, which are encoded already.
fn composed_format(config: &wgpu::SurfaceConfiguration) -> wgpu::TextureFormat {
    if config.usage.contains(wgpu::TextureUsages::COPY_DST) {
        config.format.remove_srgb_suffix()
    } else {
        config.format
    }
}

/// Runs graphics code and turns panics into errors: `wgpu` panics in many places if the device is
/// lost while they run.
pub(super) fn guarded<T>(
    draw: impl FnOnce() -> Result<T, GraphicsError>,
) -> Result<T, GraphicsError> {
    panic::catch_unwind(AssertUnwindSafe(draw)).unwrap_or_else(|panic| {
        let message = panic.downcast_ref::<String>().map(String::as_str);
        let message = message.or_else(|| panic.downcast_ref().copied());
        Err(GraphicsError::Panic(message.unwrap_or("no message").to_owned()))
    })
}

/// Configuration of the surface. Its format does not convert to sRGB, since egui blends in sRGB.
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
    // Waits for vsync without tearing; every surface supports this mode.
    config.present_mode = wgpu::PresentMode::Fifo;
    config.desired_maximum_frame_latency = 1;
    // The picture that is kept is copied, if the surface allows that.
    config.usage |= surface.get_capabilities(&gpu.adapter).usages & wgpu::TextureUsages::COPY_DST;
    surface.configure(&gpu.device, &config);
    Ok(config)
}

/// Counter of attempts to create a lost graphics device again since the last presented frame.
#[derive(Debug, Default)]
pub(super) struct DeviceRetries {
    count: usize,
}

impl DeviceRetries {
    /// Pauses before the attempts: a driver that is reset or updated is back within seconds.
    const PAUSES: [Duration; 3] =
        [Duration::ZERO, Duration::from_millis(500), Duration::from_secs(2)];

    /// Counts an attempt and returns the pause before it; `None` if no attempt is left.
    pub fn next_pause(&mut self) -> Option<Duration> {
        let pause = Self::PAUSES.get(self.count).copied();
        self.count += 1;
        pause
    }

    /// True if the device was lost and no frame was presented since.
    pub fn is_retrying(&self) -> bool {
        self.count > 0
    }

    /// Forgets all attempts, after a frame was presented.
    pub fn reset(&mut self) {
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_retry_is_at_once_and_later_ones_after_longer_pauses() {
        let mut retries = DeviceRetries::default();
        assert!(!retries.is_retrying());
        assert_eq!(retries.next_pause(), Some(Duration::ZERO));
        assert!(retries.is_retrying());
        let (second, third) = (retries.next_pause(), retries.next_pause());
        assert!(Some(Duration::ZERO) < second && second < third, "{second:?}, {third:?}");
    }

    #[test]
    fn there_are_three_retries() {
        let mut retries = DeviceRetries::default();
        let pauses: Vec<_> = std::iter::repeat_with(|| retries.next_pause()).take(5).collect();
        assert_eq!(
            pauses.iter().map(Option::is_some).collect::<Vec<_>>(),
            [true, true, true, false, false]
        );
    }

    #[test]
    fn a_presented_frame_resets_the_retries() {
        let mut retries = DeviceRetries::default();
        for _ in 0..10 {
            for _ in 0..3 {
                assert!(retries.next_pause().is_some());
            }
            retries.reset();
            assert!(!retries.is_retrying());
        }
        assert_eq!(retries.next_pause(), Some(Duration::ZERO));
    }
}
