use super::texture_sampler::TextureSampler;
use super::{Gpu, pipeline};

pub(super) const SHADER: &str = include_str!("../../shaders/texture.wgsl");

/// Draws a texture over the whole viewport of a pass, stretched to its size. The pass has no depth
/// and one sample per pixel.
#[derive(Debug)]
pub struct TexturePainter {
    pipeline: wgpu::RenderPipeline,
    sampler: TextureSampler,
}

impl TexturePainter {
    /// Creates the pipeline for passes with a colour attachment of this format.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let sampler = TextureSampler::new(gpu, "texture");
        let pipeline = pipeline::build(
            gpu,
            &pipeline::PipelineDescriptor {
                label: "texture",
                shader: SHADER,
                fragment: "fragment",
                constants: &[],
                layouts: &[&sampler.layout],
                buffers: &[],
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull: None,
                depth: wgpu::CompareFunction::Always,
                output: pipeline::Output::Overlay(format),
            },
        );
        Self { pipeline, sampler }
    }

    /// Draws `texture`, which must be filterable and of two dimensions. Leaves its own pipeline and
    /// bind group 0 set.
    pub fn draw(&self, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>, texture: &wgpu::TextureView) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.sampler.group(gpu, texture), &[]);
        pass.draw(0..3, 0..1);
    }
}
