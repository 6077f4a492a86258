use super::Gpu;
use super::pipeline::{PipelineDescriptor, PipelineOutput};

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/backdrop.wgsl"),);

/// Draws the sky behind everything else.
#[derive(Debug)]
pub(super) struct Backdrop {
    pipeline: wgpu::RenderPipeline,
}

impl Backdrop {
    /// Number of triangles: one that covers the picture.
    pub const TRIANGLES: u32 = 1;

    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let pipeline = PipelineDescriptor {
            depth: wgpu::CompareFunction::Always,
            ..PipelineDescriptor::new("backdrop", SHADER, &[view], PipelineOutput::Opaque)
        }
        .build(gpu);
        Self { pipeline }
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..3, 0..1);
    }
}
