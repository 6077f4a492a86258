use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::TextureId;
use egui::epaint::{ClippedPrimitive, ImageDelta};
use egui_wgpu::ScreenDescriptor;
use winit::dpi::PhysicalSize;
use winit::window::Window;

use super::graphics::{Graphics, GraphicsError};
use crate::render::Lap;

/// What became of a frame.
pub(super) enum Presented {
    Shown,
    /// The surface has no place for it now. After how long to try again; without, the system says
    /// when.
    Later(Option<Duration>),
}

/// What the surface gives to draw on; [`Presented::Later`] if nothing.
enum Acquired {
    Frame(wgpu::SurfaceTexture),
    Later(Option<Duration>),
}

/// The panels' way to the screen.
impl Graphics {
    /// Frames that nobody sees come no faster.
    pub const PAUSE: Duration = Duration::from_millis(100);

    pub fn update_textures(
        &mut self,
        changed: impl IntoIterator<Item = (TextureId, impl IntoIterator<Item = ImageDelta>)>,
    ) {
        for (id, deltas) in changed {
            for delta in deltas {
                self.egui_renderer.update_texture(&self.gpu.device, &self.gpu.queue, id, &delta);
            }
        }
    }

    pub fn free_textures(&mut self, freed: impl IntoIterator<Item = TextureId>) {
        for id in freed {
            self.egui_renderer.free_texture(&id);
        }
    }

    /// A window of no size, as a minimised one is, keeps what it has.
    pub fn resize(&mut self, size: PhysicalSize<u32>) {
        if size.width > 0 && size.height > 0 {
            let longest = self.gpu.longest_side();
            self.config.width = size.width.min(longest);
            self.config.height = size.height.min(longest);
            self.surface.configure(&self.gpu.device, &self.config);
        }
    }

    /// Draws the panels on the surface and shows it; `drawn` is how many frames there have been. How
    /// much of the time went by in waiting, too.
    ///
    /// # Errors
    ///
    /// If nothing can be drawn any more, as far as the device says so; see [`Self::finish`].
    pub fn present(
        &mut self,
        panels: &[ClippedPrimitive],
        scale: f32,
        window: &Arc<Window>,
        drawn: u64,
    ) -> Result<(Presented, Duration), GraphicsError> {
        if std::mem::take(&mut self.stale) {
            self.surface.configure(&self.gpu.device, &self.config);
        }
        let asked = Instant::now();
        let frame = match self.acquire(window)? {
            Acquired::Frame(frame) => frame,
            Acquired::Later(again) => return Ok((Presented::Later(again), asked.elapsed())),
        };
        let mut waited = asked.elapsed();
        self.check()?;
        let screen = ScreenDescriptor {
            size_in_pixels: [self.config.width, self.config.height],
            pixels_per_point: scale,
        };
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("panels") });
        let mut commands = self.egui_renderer.update_buffers(
            &self.gpu.device,
            &self.gpu.queue,
            &mut encoder,
            panels,
            &screen,
        );
        let view = frame.texture.create_view(&Default::default());
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("panels"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            timestamp_writes: self.gpu_timer.as_mut().map(|gpu_timer| gpu_timer.lap(Lap::Panels)),
            ..Default::default()
        });
        self.egui_renderer.render(&mut pass.forget_lifetime(), panels, &screen);
        if let Some(gpu_timer) = &mut self.gpu_timer {
            gpu_timer.stop(&mut encoder, drawn);
        }
        commands.push(encoder.finish());
        self.gpu.queue.submit(commands);
        if let Some(gpu_timer) = &self.gpu_timer {
            gpu_timer.fetch();
        }
        window.pre_present_notify();
        let handed_over = Instant::now();
        self.gpu.queue.present(frame);
        waited += handed_over.elapsed();
        self.check()?;
        Ok((Presented::Shown, waited))
    }

    /// Waits until the device has done all that it was told.
    ///
    /// # Errors
    ///
    /// If it does not do it.
    pub fn finish(&self) -> Result<(), GraphicsError> {
        let timeout = Some(Duration::from_secs(10));
        self.gpu
            .device
            .poll(wgpu::PollType::Wait { submission_index: None, timeout })
            .map_err(|error| GraphicsError::Device(error.to_string()))?;
        self.check()
    }

    /// What the surface lacks is mended once.
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
                self.stale = true;
                Ok(Acquired::Frame(frame))
            }
            Current::Outdated | Current::Timeout => Ok(Acquired::Later(Some(Self::PAUSE))),
            // Nobody sees it; the system says when somebody does.
            Current::Occluded => Ok(Acquired::Later(None)),
            Current::Lost => Err(GraphicsError::SurfaceLost),
            Current::Validation => {
                // A lost device says so when it is asked.
                let _ = self.gpu.device.poll(wgpu::PollType::Poll);
                self.check()?;
                Err(GraphicsError::NoFrame)
            }
        }
    }

    fn renew_surface(&mut self, window: &Arc<Window>) -> Result<(), GraphicsError> {
        log::warn!("the window's surface was lost and is made anew");
        // The old one goes before the new one is configured: a window is shown one at a time.
        self.surface = self.gpu.instance.create_surface(Arc::clone(window))?;
        self.resize(window.inner_size());
        Ok(())
    }
}
