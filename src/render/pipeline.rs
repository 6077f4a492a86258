use super::{Canvas, Gpu};

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
    pub output: Output,
}

/// Kind of output of a pipeline.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Output {
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

pub(super) fn build(gpu: &Gpu, descriptor: &PipelineDescriptor<'_>) -> wgpu::RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(descriptor.label),
        source: wgpu::ShaderSource::Wgsl(descriptor.shader.into()),
    });
    let layouts: Vec<_> = descriptor.layouts.iter().copied().map(Some).collect();
    let buffers: Vec<_> = descriptor.buffers.iter().cloned().map(Some).collect();
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(descriptor.label),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let (is_overlay, format) = match descriptor.output {
        Output::Overlay(format) | Output::Premultiplied(format) => (true, format),
        _ => (false, Canvas::FORMAT),
    };
    let blend = match descriptor.output {
        Output::Opaque | Output::Depth => None,
        Output::Blended | Output::Overlay(_) => Some(wgpu::BlendState::ALPHA_BLENDING),
        Output::Premultiplied(_) => Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
    };
    let compilation_options =
        wgpu::PipelineCompilationOptions { constants: descriptor.constants, ..Default::default() };
    let samples = if is_overlay { 1 } else { Canvas::SAMPLES };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(descriptor.label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: compilation_options.clone(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState {
            topology: descriptor.topology,
            cull_mode: descriptor.cull,
            ..Default::default()
        },
        depth_stencil: (!is_overlay).then(|| wgpu::DepthStencilState {
            format: Canvas::DEPTH,
            depth_write_enabled: Some(
                descriptor.output != Output::Blended
                    && descriptor.depth != wgpu::CompareFunction::Always,
            ),
            depth_compare: Some(descriptor.depth),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(descriptor.fragment),
            compilation_options,
            targets: &[Some(wgpu::ColorTargetState {
                format,
                blend,
                write_mask: match descriptor.output {
                    Output::Depth => wgpu::ColorWrites::empty(),
                    _ => wgpu::ColorWrites::ALL,
                },
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
