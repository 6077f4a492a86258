use super::font::Font;
use super::texture::TextureSampler;
use super::{Gpu, SystemFace};

/// Height of a line in points.
pub(super) const LINE_HEIGHT: f32 = 15.0;

/// A font at one scale, with its atlas as a texture.
#[derive(Debug)]
pub(super) struct GlyphSheet {
    /// Pixels per point.
    pub scale: f32,
    pub font: Font,
    texture: wgpu::Texture,
    group: wgpu::BindGroup,
}

impl GlyphSheet {
    pub fn new(gpu: &Gpu, sampler: &TextureSampler, scale: f32) -> Self {
        let font = Font::new(LINE_HEIGHT * scale, gpu.longest_side(), SystemFace::find);
        let (texture, group) = texture(gpu, sampler, font.atlas.size());
        Self { scale, font, texture, group }
    }

    /// Bind group of the texture and its sampler.
    pub fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    /// Sends the changed rows of the atlas to the device and returns the number of bytes sent.
    pub fn upload(&mut self, gpu: &Gpu, sampler: &TextureSampler) -> u64 {
        let (width, height) = self.font.atlas.size();
        let mut changed = self.font.atlas.take_changed();
        if changed.is_empty() {
            return 0;
        }
        if self.texture.height() != height {
            (self.texture, self.group) = texture(gpu, sampler, (width, height));
            changed = 0..height;
        }
        let pixels = self.font.atlas.rows(changed.clone());
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x: 0, y: changed.start, z: 0 },
                ..self.texture.as_image_copy()
            },
            pixels,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(width),
                rows_per_image: None,
            },
            wgpu::Extent3d { width, height: changed.end - changed.start, depth_or_array_layers: 1 },
        );
        pixels.len() as u64
    }
}

fn texture(
    gpu: &Gpu,
    sampler: &TextureSampler,
    (width, height): (u32, u32),
) -> (wgpu::Texture, wgpu::BindGroup) {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("glyphs"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let group = sampler.group(gpu, &texture.create_view(&Default::default()));
    (texture, group)
}
