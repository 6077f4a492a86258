use std::sync::Arc;
use std::time::Instant;

use egui::{FullOutput, TextureId};
use egui_wgpu::ScreenDescriptor;

use super::window::AppWindow;

/// The panels' way to the screen.
impl AppWindow {
    /// Lets the panels show a new canvas under the same name.
    pub(super) fn show_canvas(&mut self) {
        self.egui_renderer.update_egui_texture_from_wgpu_texture(
            &self.gpu.device,
            self.picture.canvas.view(),
            wgpu::FilterMode::Nearest,
            self.picture.texture,
        );
    }

    pub(super) fn update_textures(&mut self, output: &mut FullOutput) {
        for (id, deltas) in output.textures_delta.set.drain() {
            for delta in deltas {
                self.egui_renderer.update_texture(&self.gpu.device, &self.gpu.queue, id, &delta);
            }
        }
    }

    pub(super) fn free_textures(&mut self, freed: impl IntoIterator<Item = TextureId>) {
        for id in freed {
            self.egui_renderer.free_texture(&id);
        }
    }

    /// Draws the panels on the surface and shows it. A surface that is not there now is drawn on
    /// at the next frame.
    pub(super) fn present(&mut self, output: FullOutput, started: Instant) {
        if std::mem::take(&mut self.stale) {
            self.surface.configure(&self.gpu.device, &self.config);
        }
        let Some(frame) = self.acquire() else {
            return;
        };
        let screen = ScreenDescriptor {
            size_in_pixels: [self.config.width, self.config.height],
            pixels_per_point: output.pixels_per_point,
        };
        let primitives = self.egui.egui_ctx().tessellate(output.shapes, output.pixels_per_point);
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("panels") });
        let mut commands = self.egui_renderer.update_buffers(
            &self.gpu.device,
            &self.gpu.queue,
            &mut encoder,
            &primitives,
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
            ..Default::default()
        });
        self.egui_renderer.render(&mut pass.forget_lifetime(), &primitives, &screen);
        commands.push(encoder.finish());
        self.gpu.queue.submit(commands);
        self.window.pre_present_notify();
        self.gpu.queue.present(frame);

        self.machine.frame_ms = Some(started.elapsed().as_secs_f32() * 1000.0);
        self.frames += 1;
    }

    fn acquire(&mut self) -> Option<wgpu::SurfaceTexture> {
        use wgpu::CurrentSurfaceTexture as Current;
        match self.surface.get_current_texture() {
            Current::Success(frame) => Some(frame),
            Current::Suboptimal(frame) => {
                self.stale = true;
                Some(frame)
            }
            Current::Outdated => {
                self.surface.configure(&self.gpu.device, &self.config);
                self.window.request_redraw();
                None
            }
            Current::Lost => {
                self.recreate_surface();
                self.window.request_redraw();
                None
            }
            Current::Timeout => {
                self.window.request_redraw();
                None
            }
            // Nobody sees it; the system says when somebody does.
            Current::Occluded => None,
            Current::Validation => {
                log::error!("the surface gives no frame");
                None
            }
        }
    }

    fn recreate_surface(&mut self) {
        match self.gpu.instance.create_surface(Arc::clone(&self.window)) {
            Ok(surface) => {
                surface.configure(&self.gpu.device, &self.config);
                self.surface = surface;
            }
            Err(error) => log::error!("the surface was lost, and no other is given: {error}"),
        }
    }
}
