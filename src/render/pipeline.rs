use super::{Canvas, Gpu};

/// Number of items per workgroup; the compute shaders have the same number.
const GROUP: u32 = 256;

/// Settings in which the pipelines of a scene differ.
pub(super) struct PipelineDescriptor<'a> {
    pub label: &'static str,
    pub shader: &'static str,
    pub fragment: &'static str,
    /// Values of the shader's overridable constants.
    pub constants: &'a [(&'static str, f64)],
    pub layouts: &'a [&'a wgpu::BindGroupLayout],
    pub buffers: &'a [wgpu::VertexBufferLayout<'a>],
    pub topology: wgpu::PrimitiveTopology,
    pub cull: Option<wgpu::Face>,
    /// Depth comparison; nearer depths are greater.
    pub depth: wgpu::CompareFunction,
    pub output: PipelineOutput,
}

/// Kind of output of a pipeline.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum PipelineOutput {
    /// Replaces the colours behind, and writes depth.
    Opaque,
    /// Blends with the colours behind, without depth.
    Blended,
    /// Depth without colours.
    Depth,
    /// Blends with a finished picture of this format, which has no depth and one sample per pixel.
    Overlay(wgpu::TextureFormat),
    /// The same with colours that are multiplied by their opacity.
    Premultiplied(wgpu::TextureFormat),
}

impl<'a> PipelineDescriptor<'a> {
    /// Triangles without vertex buffers, drawn where they are nearer than what is drawn already.
    pub fn new(
        label: &'static str,
        shader: &'static str,
        layouts: &'a [&'a wgpu::BindGroupLayout],
        output: PipelineOutput,
    ) -> Self {
        Self {
            label,
            shader,
            fragment: "fragment",
            constants: &[],
            layouts,
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: None,
            depth: wgpu::CompareFunction::Greater,
            output,
        }
    }

    pub fn build(&self, gpu: &Gpu) -> wgpu::RenderPipeline {
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.label),
            source: wgpu::ShaderSource::Wgsl(self.shader.into()),
        });
        let layouts: Vec<_> = self.layouts.iter().copied().map(Some).collect();
        let buffers: Vec<_> = self.buffers.iter().cloned().map(Some).collect();
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.label),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        let (is_overlay, format) = match self.output {
            PipelineOutput::Overlay(format) | PipelineOutput::Premultiplied(format) => {
                (true, format)
            }
            _ => (false, Canvas::FORMAT),
        };
        let blend = match self.output {
            PipelineOutput::Opaque | PipelineOutput::Depth => None,
            PipelineOutput::Blended | PipelineOutput::Overlay(_) => {
                Some(wgpu::BlendState::ALPHA_BLENDING)
            }
            PipelineOutput::Premultiplied(_) => {
                Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)
            }
        };
        let compilation_options =
            wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() };
        let samples = if is_overlay { 1 } else { Canvas::SAMPLES };
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: compilation_options.clone(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                cull_mode: self.cull,
                ..Default::default()
            },
            depth_stencil: (!is_overlay).then(|| wgpu::DepthStencilState {
                format: Canvas::DEPTH,
                depth_write_enabled: Some(
                    self.output != PipelineOutput::Blended
                        && self.depth != wgpu::CompareFunction::Always,
                ),
                depth_compare: Some(self.depth),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(self.fragment),
                compilation_options,
                targets: &[Some(wgpu::ColorTargetState {
                    format,
                    blend,
                    write_mask: match self.output {
                        PipelineOutput::Depth => wgpu::ColorWrites::empty(),
                        _ => wgpu::ColorWrites::ALL,
                    },
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Kind of a binding.
#[derive(Clone, Copy)]
pub(super) enum BindingKind {
    Uniform,
    Read,
    Write,
    Texture,
    Sampler,
}

/// Layout of a bind group, with a binding for each kind and in this order.
pub(super) fn layout(
    gpu: &Gpu,
    label: &str,
    stages: wgpu::ShaderStages,
    kinds: &[BindingKind],
) -> wgpu::BindGroupLayout {
    let buffer =
        |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let entry = |(binding, kind): (u32, &BindingKind)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: stages,
        ty: match kind {
            BindingKind::Uniform => buffer(wgpu::BufferBindingType::Uniform),
            BindingKind::Read => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
            BindingKind::Write => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
            BindingKind::Texture => wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: true },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            BindingKind::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        },
        count: None,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &(0..).zip(kinds).map(entry).collect::<Vec<_>>(),
    })
}

/// Bind group of these resources, in the order of the layout.
pub(super) fn group<const N: usize>(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: [wgpu::BindingResource<'_>; N],
) -> wgpu::BindGroup {
    let mut binding = 0..;
    let entries = resources.map(|resource| wgpu::BindGroupEntry {
        binding: binding.next().unwrap_or_default(),
        resource,
    });
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// Pipeline of a compute shader.
pub(super) fn compute(
    gpu: &Gpu,
    label: &str,
    shader: &'static str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::ComputePipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(shader.into()),
    });
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        module: &module,
        entry_point: Some("compute"),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// Encodes a compute pass with one invocation per item.
pub(super) fn run_for_each(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    pipeline: &wgpu::ComputePipeline,
    groups: &[&wgpu::BindGroup],
    items: u32,
) {
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some(label),
        timestamp_writes: None,
    });
    pass.set_pipeline(pipeline);
    for (index, group) in (0..).zip(groups) {
        pass.set_bind_group(index, *group, &[]);
    }
    pass.dispatch_workgroups(items.div_ceil(GROUP), 1, 1);
}
