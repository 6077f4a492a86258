use super::backdrop::Backdrop;
use super::crowd::Crowds;
use super::label::Labels;
use super::line::Lines;
use super::shadow::Shadows;
use super::solid::Solids;
use super::spheres::Spheres;
use super::view::View;
use super::{Canvas, Gpu};
use crate::rig::CrowdTimes;
use crate::scene::Scene;

/// Draws scenes. Made once for a device; its pipelines never change.
#[derive(Debug)]
pub struct Renderer {
    view: View,
    solids: Solids,
    backdrop: Backdrop,
    shadows: Shadows,
    spheres: Spheres,
    lines: Lines,
    labels: Labels,
    crowds: Crowds,
    counts: Counts,
}

/// What a renderer drew last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Cones and balls.
    pub solids: u32,
    pub lines: u32,
    pub labels: u32,
    pub triangles: u32,
    /// How many bytes were sent to the device, which keeps what does not change.
    pub uploaded: u64,
}

impl Renderer {
    /// How many lists, blocks of values and textures are kept on the device.
    pub const LISTS: usize = 7 + Solids::LISTS;

    pub fn new(gpu: &Gpu) -> Self {
        let view = View::new(gpu);
        Self {
            solids: Solids::new(gpu, view.layout()),
            backdrop: Backdrop::new(gpu, view.layout()),
            shadows: Shadows::new(gpu, view.layout()),
            spheres: Spheres::new(gpu, view.layout()),
            lines: Lines::new(gpu, view.layout()),
            labels: Labels::new(gpu, view.layout()),
            crowds: Crowds::default(),
            view,
            counts: Counts::default(),
        }
    }

    /// What was drawn last.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// How long the crowd took that was drawn last, if there was one.
    pub fn crowd_times(&self) -> Option<CrowdTimes> {
        self.crowds.times()
    }

    /// Draws a scene and hands it to the device. `scale` is how many pixels a point has: lines and
    /// letters are so many times as large.
    pub fn draw(&mut self, gpu: &Gpu, scene: &Scene, canvas: &Canvas, scale: f32) {
        self.upload(gpu, scene, canvas.size(), scale);
        gpu.queue.submit([self.encode(gpu, canvas, None)]);
    }

    /// Sends what the device does not have of a scene already, for a picture of some size. Once the
    /// lists are as long as they get it takes no memory of its own; `wgpu` takes some for every list
    /// of which anything is sent, however long it is, and there are never more than
    /// [`Renderer::LISTS`].
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32), scale: f32) {
        let uploaded = self.view.upload(gpu, scene, size, scale)
            + self.solids.upload(gpu, scene, size)
            + self.shadows.upload(gpu, scene)
            + self.spheres.upload(gpu, scene, size)
            + self.lines.upload(gpu, scene)
            + self.labels.upload(gpu, scene, size, scale)
            + self.crowds.upload(gpu, self.view.layout(), scene, size);
        let count = |lengths: &[usize]| lengths.iter().sum::<usize>() as u32;
        let guides = [scene.guide_solids.len(), scene.guide_balls.len()];
        self.counts = Counts {
            solids: count(&[scene.solids.len(), scene.balls.len()]) + count(&guides),
            lines: count(&[scene.lines.len()]),
            labels: count(&[scene.labels.len()]),
            triangles: self.triangles(),
            uploaded,
        };
    }

    fn triangles(&self) -> u32 {
        Backdrop::TRIANGLES
            + self.solids.triangles()
            + self.shadows.triangles()
            + self.spheres.triangles()
            + self.lines.triangles()
            + self.labels.triangles()
    }

    /// The orders to draw what was uploaded last. `wgpu` takes the memory that it needs for them:
    /// as much for every picture, whatever is in it.
    pub fn encode(
        &self,
        gpu: &Gpu,
        canvas: &Canvas,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::CommandBuffer {
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("scene") });
        self.crowds.cull(&mut encoder);
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
            timestamp_writes: timestamps,
            ..Default::default()
        });
        pass.set_bind_group(0, self.view.group(), &[]);
        self.backdrop.draw(&mut pass);
        self.crowds.draw(&mut pass);
        self.solids.draw(&mut pass);
        self.shadows.draw(&mut pass);
        self.solids.draw_hidden(&mut pass);
        self.spheres.draw(&mut pass);
        self.lines.draw(&mut pass);
        self.labels.draw(&mut pass);
        drop(pass);
        encoder.finish()
    }
}
