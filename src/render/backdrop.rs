use super::{Gpu, pipeline};

pub(super) const SHADER: &str = concat!(
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/planes.wgsl"),
    include_str!("../../shaders/backdrop.wgsl"),
);

/// Draws the sky, the ground and the grids behind everything else.
#[derive(Debug)]
pub(super) struct Backdrop {
    pipeline: wgpu::RenderPipeline,
}

impl Backdrop {
    /// Number of triangles: one that covers the picture.
    pub const TRIANGLES: u32 = 1;

    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let pipeline = pipeline::build(
            gpu,
            &pipeline::PipelineDescriptor {
                label: "backdrop",
                shader: SHADER,
                fragment: "fragment",
                constants: &[],
                layouts: &[view],
                buffers: &[],
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull: None,
                depth: wgpu::CompareFunction::Always,
                output: pipeline::Output::Opaque,
            },
        );
        Self { pipeline }
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..3, 0..1);
    }
}
