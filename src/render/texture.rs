use egui::epaint::{ImageData, ImageDelta};

use super::Gpu;
use super::pipeline::{self, BindingKind, PipelineDescriptor, PipelineOutput};

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
        let output = PipelineOutput::Overlay(format);
        let pipeline =
            PipelineDescriptor::new("texture", SHADER, &[&sampler.layout], output).build(gpu);
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
        let kinds = [BindingKind::Texture, BindingKind::Sampler];
        let layout = pipeline::layout(gpu, label, wgpu::ShaderStages::FRAGMENT, &kinds);
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some(label),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { label, layout, sampler }
    }

    pub fn group(&self, gpu: &Gpu, texture: &wgpu::TextureView) -> wgpu::BindGroup {
        let resources = [
            wgpu::BindingResource::TextureView(texture),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        pipeline::group(gpu, self.label, &self.layout, resources)
    }
}

/// A texture that epaint describes, such as an atlas of glyphs, on the device.
#[derive(Debug)]
pub struct PaintTexture {
    texture: wgpu::Texture,
    pub(super) group: wgpu::BindGroup,
}

impl PaintTexture {
    /// Creates the texture of an image that is its whole, without its pixels.
    pub(super) fn new(gpu: &Gpu, sampler: &TextureSampler, whole: &ImageDelta) -> Self {
        let size = whole.image.size().map(|side| side as u32);
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let texture = gpu.texture(sampler.label, wgpu::TextureFormat::Rgba8Unorm, size, usage);
        let group = sampler.group(gpu, &texture.create_view(&Default::default()));
        Self { texture, group }
    }

    /// Sends the pixels of the whole or of a part to the device, and returns the number of bytes
    /// sent.
    pub fn write(&self, gpu: &Gpu, delta: &ImageDelta) -> u64 {
        let ImageData::Color(image) = &delta.image;
        let [width, height] = image.size.map(|side| side as u32);
        let [x, y] = delta.pos.unwrap_or_default().map(|side| side as u32);
        let to = wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d { x, y, z: 0 },
            ..self.texture.as_image_copy()
        };
        let rows = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * width),
            rows_per_image: None,
        };
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        gpu.queue.write_texture(to, image.as_raw(), rows, size);
        image.as_raw().len() as u64
    }
}
