use std::sync::Arc;
use std::time::Duration;

use egui::Rect;
use egui::epaint::ClippedPrimitive;
use egui_wgpu::ScreenDescriptor;
use web_time::Instant;
use winit::dpi::PhysicalSize;
use winit::window::Window;

use super::error::GraphicsError;
use super::graphics::Graphics;
use super::panel_painter::PlacedScene;
use crate::render::TimedPass;
use crate::ui::FrameTimes;

/// Outcome of a frame.
pub(super) enum Presented {
    /// The window is up to date. `has_changed` tells whether this frame differs from the one
    /// before.
    Shown { has_changed: bool },
    /// The surface accepts no frame now. Retry after this time, or, for `None`, when the system
    /// requests a redraw.
    Later(Option<Duration>),
}

/// A surface texture, or the reason for [`Presented::Later`].
enum Acquired {
    Frame(wgpu::SurfaceTexture),
    Later(Option<Duration>),
}

/// Drawing the panels on the surface.
impl Graphics {
    /// Time between frames while the window is hidden.
    pub const HIDDEN_FRAME_INTERVAL: Duration = Duration::from_millis(100);

    /// Resizes the surface. A minimised window has no size and keeps its surface.
    pub fn resize(&mut self, size: PhysicalSize<u32>) {
        if size.width > 0 && size.height > 0 {
            let longest = self.gpu.longest_side();
            self.config.width = size.width.min(longest);
            self.config.height = size.height.min(longest);
            self.surface.configure(&self.gpu.device, &self.config);
        }
    }

    /// Draws the panels with the scene in the viewport (in points), and presents the window.
    /// Returns the outcome and the time spent waiting for the surface. `scale` is in pixels per
    /// point; `drawn` is the number of earlier frames.
    ///
    /// # Errors
    ///
    /// If the surface has failed, or if the device has reported a failure by now; see
    /// [`Self::finish`].
    pub fn present(
        &mut self,
        panels: &[ClippedPrimitive],
        viewport: Rect,
        scale: f32,
        window: &Arc<Window>,
        drawn: u64,
    ) -> Result<(Presented, Duration), GraphicsError> {
        if std::mem::take(&mut self.is_stale) {
            self.surface.configure(&self.gpu.device, &self.config);
        }
        let start = Instant::now();
        let frame = match self.acquire(window)? {
            Acquired::Frame(frame) => frame,
            Acquired::Later(again) => return Ok((Presented::Later(again), start.elapsed())),
        };
        let mut waited = start.elapsed();
        self.check()?;
        let screen = ScreenDescriptor {
            size_in_pixels: [self.config.width, self.config.height],
            pixels_per_point: scale,
        };
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("panels") });
        let scene = PlacedScene {
            picture: self.picture.canvas.drawn(),
            renderer: &self.renderer,
            viewport,
            has_changed: std::mem::take(&mut self.picture.is_new),
        };
        let timestamps = self.gpu_timer.as_mut().map(|timer| timer.pass(TimedPass::Panels));
        let panels = (panels, &screen);
        let has_changed = self.panels.draw(&self.gpu, &mut encoder, panels, &scene, timestamps);
        self.panels.copy_to(&self.gpu, &mut encoder, &frame.texture);
        if let Some(gpu_timer) = &mut self.gpu_timer {
            gpu_timer.stop(&mut encoder, if has_changed { drawn } else { FrameTimes::UNCOUNTED });
        }
        self.gpu.queue.submit([encoder.finish()]);
        if let Some(gpu_timer) = &self.gpu_timer {
            gpu_timer.fetch();
        }
        window.pre_present_notify();
        let presenting = Instant::now();
        self.gpu.queue.present(frame);
        waited += presenting.elapsed();
        self.check()?;
        Ok((Presented::Shown { has_changed }, waited))
    }

    /// Waits until the device has executed all commands.
    ///
    /// # Errors
    ///
    /// If the device fails or does not respond within ten seconds.
    pub fn finish(&self) -> Result<(), GraphicsError> {
        let timeout = Some(Duration::from_secs(10));
        self.gpu.device.poll(wgpu::PollType::Wait { submission_index: None, timeout })?;
        self.check()
    }

    /// Acquires a surface texture. An outdated or lost surface is renewed once.
    fn acquire(&mut self, window: &Arc<Window>) -> Result<Acquired, GraphicsError> {
        use wgpu::CurrentSurfaceTexture as Current;
        let mut current = self.surface.get_current_texture();
        match current {
            Current::Outdated => self.resize(window.inner_size()),
            Current::Lost => self.renew_surface(window)?,
            _ => {}
        }
        if matches!(current, Current::Outdated | Current::Lost) {
            current = self.surface.get_current_texture();
        }
        match current {
            Current::Success(frame) => Ok(Acquired::Frame(frame)),
            Current::Suboptimal(frame) => {
                self.is_stale = true;
                Ok(Acquired::Frame(frame))
            }
            Current::Outdated | Current::Timeout => {
                Ok(Acquired::Later(Some(Self::HIDDEN_FRAME_INTERVAL)))
            }
            // The system requests a redraw once the window is visible.
            Current::Occluded => Ok(Acquired::Later(None)),
            Current::Lost => Err(GraphicsError::SurfaceLost),
            Current::Validation => {
                // A lost device reports its loss when polled.
                let _ = self.gpu.device.poll(wgpu::PollType::Poll);
                self.check()?;
                Err(GraphicsError::NoFrame)
            }
        }
    }

    fn renew_surface(&mut self, window: &Arc<Window>) -> Result<(), GraphicsError> {
        log::warn!("the window's surface was lost and is created again");
        // Drops the old surface before the new one is configured, since a window has one at a time.
        self.surface = self.gpu.instance.create_surface(Arc::clone(window))?;
        self.resize(window.inner_size());
        Ok(())
    }
}
