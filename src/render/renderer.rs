use super::backdrop::Backdrop;
use super::globe::Globes;
use super::label::Labels;
use super::line::Lines;
use super::shadow::Shadows;
use super::solid::Solids;
use super::view::View;
use super::{Canvas, Gpu};
use crate::scene::Scene;

/// Draws scenes. Made once for a device; its pipelines never change.
#[derive(Debug)]
pub struct Renderer {
    view: View,
    solids: Solids,
    backdrop: Backdrop,
    shadows: Shadows,
    globes: Globes,
    lines: Lines,
    labels: Labels,
}

impl Renderer {
    pub fn new(gpu: &Gpu) -> Self {
        let view = View::new(gpu);
        Self {
            solids: Solids::new(gpu, view.layout()),
            backdrop: Backdrop::new(gpu, view.layout()),
            shadows: Shadows::new(gpu, view.layout()),
            globes: Globes::new(gpu, view.layout()),
            lines: Lines::new(gpu, view.layout()),
            labels: Labels::new(gpu, view.layout()),
            view,
        }
    }

    /// Draws a scene and hands it to the device. `scale` is how many pixels a point has: lines and
    /// letters are so many times as large.
    pub fn draw(&mut self, gpu: &Gpu, scene: &Scene, canvas: &Canvas, scale: f32) {
        self.view.upload(gpu, scene, canvas.size(), scale);
        self.solids.upload(gpu, scene, canvas.size());
        self.shadows.upload(gpu, scene);
        self.globes.upload(gpu, scene);
        self.lines.upload(gpu, scene);
        self.labels.upload(gpu, scene, canvas.size(), scale);

        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("scene") });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &canvas.samples,
                depth_slice: None,
                resolve_target: Some(&canvas.colour),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &canvas.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, self.view.group(), &[]);
        self.backdrop.draw(&mut pass);
        self.solids.draw(&mut pass);
        self.shadows.draw(&mut pass);
        self.solids.draw_hidden(&mut pass);
        self.globes.draw(&mut pass);
        self.lines.draw(&mut pass);
        self.labels.draw(&mut pass);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    }
}
