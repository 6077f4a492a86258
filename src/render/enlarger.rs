use super::texture_sampler::TextureSampler;
use super::{Gpu, pipeline};

pub(super) const SHADER: &str = include_str!("../../shaders/enlarge.wgsl");

/// Stretches a smaller picture over a whole one.
#[derive(Debug)]
pub(super) struct Enlarger {
    pipeline: wgpu::RenderPipeline,
    sampler: TextureSampler,
}

impl Enlarger {
    pub fn new(gpu: &Gpu) -> Self {
        let sampler = TextureSampler::new(gpu, "enlarge");
        let pipeline = pipeline::build(
            gpu,
            &pipeline::PipelineDescriptor {
                label: "enlarge",
                shader: SHADER,
                fragment: "fragment",
                layouts: &[&sampler.layout],
                buffers: &[],
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull: None,
                depth: wgpu::CompareFunction::Always,
                output: pipeline::Output::Overlay,
            },
        );
        Self { pipeline, sampler }
    }

    pub fn draw(&self, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>, smaller: &wgpu::TextureView) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.sampler.group(gpu, smaller), &[]);
        pass.draw(0..3, 0..1);
    }
}
