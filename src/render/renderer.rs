use super::backdrop::Backdrop;
use super::crowd::Crowds;
use super::label::LabelPainter;
use super::line::Lines;
use super::planes::PlanePainter;
use super::shadow::Shadows;
use super::skin::Skins;
use super::solid::Solids;
use super::spheres::Spheres;
use super::texture::TexturePainter;
use super::view::ViewUniforms;
use super::{Canvas, CrowdError, Gpu};
use crate::rig::CrowdTimes;
use crate::scene::Scene;

/// Draws scenes. A renderer is created once per device; its pipelines never change.
#[derive(Debug)]
pub struct Renderer {
    view: ViewUniforms,
    solids: Solids,
    backdrop: Backdrop,
    planes: PlanePainter,
    shadows: Shadows,
    spheres: Spheres,
    lines: Lines,
    labels: LabelPainter,
    scaler: TexturePainter,
    crowds: Crowds,
    skins: Skins,
    counts: Counts,
}

/// Numbers of parts in the last scene, and of bytes sent for that scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Number of cones and balls.
    pub solids: u32,
    /// Number of lines.
    pub lines: u32,
    /// Number of labels.
    pub labels: u32,
    /// Number of triangles. Those of a crowd are known some frames later.
    pub triangles: u32,
    /// Number of bytes sent to the device. Only changes are sent.
    pub uploaded: u64,
}

impl Renderer {
    /// Number of lists, uniform blocks and textures on the device, without those of a crowd.
    pub const LISTS: usize = 7 + Solids::LISTS;

    /// Creates the pipelines for pictures.
    pub fn new(gpu: &Gpu) -> Self {
        Self::with_labels(gpu, Canvas::FORMAT)
    }

    /// Creates the pipelines, with those of the labels for passes of this format; see
    /// [`Self::draw_labels`].
    pub fn with_labels(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let view = ViewUniforms::new(gpu);
        Self {
            solids: Solids::new(gpu, view.layout()),
            backdrop: Backdrop::new(gpu, view.layout()),
            planes: PlanePainter::new(gpu, view.layout()),
            shadows: Shadows::new(gpu, view.layout()),
            spheres: Spheres::new(gpu, view.layout()),
            lines: Lines::new(gpu, view.layout()),
            labels: LabelPainter::new(gpu, format),
            scaler: TexturePainter::new(gpu, Canvas::FORMAT),
            crowds: Crowds::default(),
            skins: Skins::default(),
            view,
            counts: Counts::default(),
        }
    }

    /// Counts of the last uploaded scene.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Number of arms and solver time of the crowd in the last uploaded scene; `None` if that scene
    /// has no crowd.
    ///
    /// # Errors
    ///
    /// If the crowd could not be drawn.
    pub fn crowd_times(&self) -> Result<Option<CrowdTimes>, CrowdError> {
        self.crowds.times()
    }

    /// Draws a scene with its labels, and submits the commands to the device. `scale` is the number
    /// of pixels per point, the unit for the sizes of lines and letters. The renderer must be made
    /// by [`Self::new`].
    pub fn draw(&mut self, gpu: &Gpu, scene: &Scene, canvas: &Canvas, scale: f32) {
        self.upload(gpu, scene, canvas, scale);
        let scene = self.encode(gpu, canvas, None);
        gpu.queue.submit([scene, self.encode_labels(gpu, canvas)]);
    }

    /// Sends the changes since the last scene, for a canvas with `scale` pixels per point. Once all
    /// lists are large enough, the renderer allocates nothing itself unless a label's text changes;
    /// `wgpu` allocates a constant amount for each list that has changed, of which there are at
    /// most [`Renderer::LISTS`].
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, canvas: &Canvas, scale: f32) {
        let size = canvas.drawn_size();
        self.planes.show(&scene.planes);
        let uploaded = self.view.upload(gpu, scene, size, scale * canvas.resolution_scale())
            + self.solids.upload(gpu, scene, size)
            + self.shadows.upload(gpu, scene)
            + self.spheres.upload(gpu, scene, size)
            + self.lines.upload(gpu, scene)
            + self.labels.upload(gpu, scene, canvas.size(), scale)
            + self.crowds.upload(gpu, self.view.layout(), scene, canvas)
            + self.skins.upload(gpu, self.view.layout(), scene);
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
            + self.planes.triangles()
            + self.solids.triangles()
            + self.shadows.triangles()
            + self.spheres.triangles()
            + self.lines.triangles()
            + self.skins.triangles()
            + self.labels.triangles()
            + self.crowds.triangles()
    }

    /// Reads counts of earlier frames back from the device, if they have arrived. The device must
    /// be polled for this.
    pub fn read_counts(&mut self) {
        self.crowds.read_triangles();
        self.counts.triangles = self.triangles();
    }

    /// True if counts of earlier frames have not arrived yet.
    pub fn awaits_counts(&self) -> bool {
        self.crowds.awaits_triangles()
    }

    /// Encodes the commands that draw the last uploaded scene, but for its labels, at the size that
    /// the canvas has for this. `wgpu` allocates memory for them; its amount does not depend on the
    /// scene.
    pub fn encode(
        &self,
        gpu: &Gpu,
        canvas: &Canvas,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::CommandBuffer {
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("scene") });
        self.crowds.cull(&mut encoder, self.view.group());
        let samples = canvas.samples();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &samples.colour,
                depth_slice: None,
                resolve_target: Some(canvas.drawn()),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &samples.depth,
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
        self.skins.draw_opaque(&mut pass);
        self.planes.draw(&mut pass);
        self.crowds.draw_far(&mut pass);
        self.shadows.draw(&mut pass);
        self.solids.draw_hidden(&mut pass);
        self.spheres.draw(&mut pass);
        self.lines.draw(&mut pass);
        self.skins.draw_see_through(&mut pass, canvas.drawn_size());
        drop(pass);
        encoder.finish()
    }

    /// Draws the labels of the last uploaded scene over a finished picture of it, which fills the
    /// viewport of the pass. The pass has no depth and one sample per pixel.
    pub fn draw_labels(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.labels.draw(pass);
    }

    /// Scales a smaller or larger picture to the size of the image, and draws the labels in full.
    fn encode_labels(&self, gpu: &Gpu, canvas: &Canvas) -> wgpu::CommandBuffer {
        let is_scaled = canvas.resolution_scale() != 1.0;
        let load =
            if is_scaled { wgpu::LoadOp::Clear(wgpu::Color::BLACK) } else { wgpu::LoadOp::Load };
        let mut encoder = gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("labels") });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("labels"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &canvas.colour,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        if is_scaled {
            self.scaler.draw(gpu, &mut pass, canvas.drawn());
        }
        self.draw_labels(&mut pass);
        drop(pass);
        encoder.finish()
    }
}
