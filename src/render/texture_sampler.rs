use super::Gpu;

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
