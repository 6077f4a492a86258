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

/// Makes bind groups of one texture, which shaders read with linear interpolation: the texture at
/// binding 0, its sampler at 1.
#[derive(Debug)]
pub(super) struct TextureSampler {
    label: &'static str,
    pub layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl TextureSampler {
    pub fn new(gpu: &Gpu, label: &'static str) -> Self {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &[entry(0, texture), entry(1, sampler)],
        });
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some(label),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { label, layout, sampler }
    }

    pub fn group(&self, gpu: &Gpu, texture: &wgpu::TextureView) -> wgpu::BindGroup {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.label),
            layout: &self.layout,
            entries: &[
                entry(0, wgpu::BindingResource::TextureView(texture)),
                entry(1, wgpu::BindingResource::Sampler(&self.sampler)),
            ],
        })
    }
}
