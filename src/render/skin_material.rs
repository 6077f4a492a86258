use core::ops::Range;

use glam::Vec3;

use super::Gpu;
use super::pipeline::{self, BindingKind};
use super::skin_order::PartCentre;
use crate::io::texture_pixels;
use crate::kinematics::Shared;
use crate::rig::{AttachedMesh, SkinPart, SkinTexture};

/// Resources that the materials of skins share on the device.
#[derive(Debug)]
pub(super) struct SkinMaterials {
    pub layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// One white pixel, for parts without a texture.
    white: wgpu::TextureView,
}

/// The textures of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PartTextures {
    None,
    /// Of the colour alone.
    Colour,
    /// Of the emission, and of the colour if it has one.
    Emission,
}

/// The triangles of a part of a skin, with its material on the device.
#[derive(Debug)]
pub(super) struct SkinMaterial {
    /// Indices of the corners.
    pub corners: Range<u32>,
    pub group: wgpu::BindGroup,
    pub textures: PartTextures,
    pub is_double_sided: bool,
    /// The centre, for a part that is see-through.
    pub centre: Option<PartCentre>,
}

impl SkinMaterials {
    pub fn new(gpu: &Gpu) -> Self {
        let kinds = [
            BindingKind::Uniform,
            BindingKind::Texture,
            BindingKind::Sampler,
            BindingKind::Texture,
        ];
        let stages = wgpu::ShaderStages::FRAGMENT;
        let layout = pipeline::layout(gpu, "skin material", stages, &kinds);
        Self {
            layout,
            sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("skin texture"),
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            }),
            white: texture_view(gpu, [1, 1], &[[255; 4]]),
        }
    }

    /// The materials of the parts of a mesh.
    pub fn of_parts(
        &self,
        gpu: &Gpu,
        AttachedMesh { mesh, parts, .. }: &AttachedMesh,
    ) -> Vec<SkinMaterial> {
        let triangles = mesh.mesh().triangles.len();
        let mut end = 0;
        let mut views: Vec<(&Shared<SkinTexture>, wgpu::TextureView)> = Vec::new();
        let mut materials = Vec::with_capacity(parts.len());
        for part in parts {
            let start = end;
            end = (start + part.triangles).min(triangles);
            let [colour, emission] = [&part.texture, &part.emission_texture].map(|texture| {
                let texture = texture.as_ref()?;
                let known = views.iter().position(|(other, _)| other.is_same(texture));
                known.or_else(|| {
                    // Where a file is opened to be drawn, broken images were told.
                    let pixels = texture_pixels(texture).ok()?;
                    views.push((texture, texture_view(gpu, texture.size, pixels)));
                    Some(views.len() - 1)
                })
            });
            let textures = match (colour, emission) {
                (_, Some(_)) => PartTextures::Emission,
                (Some(_), None) => PartTextures::Colour,
                (None, None) => PartTextures::None,
            };
            let drawn =
                [colour, emission].map(|view| view.map_or(&self.white, |view| &views[view].1));
            let corners = 3 * start as u32..3 * end as u32;
            // A part that shines where its texture tells does not shine all over without it.
            let is_dark = part.emission_texture.is_some() && emission.is_none();
            let group = self.group(gpu, part, drawn, is_dark);
            let is_blended = part.look.opacity.is_some();
            materials.push(SkinMaterial {
                centre: is_blended.then(|| PartCentre::new(mesh, corners.clone())),
                corners,
                group,
                textures,
                is_double_sided: part.look.is_double_sided,
            });
        }
        materials
    }

    fn group(
        &self,
        gpu: &Gpu,
        part: &SkinPart,
        [colour, emission]: [&wgpu::TextureView; 2],
        is_dark: bool,
    ) -> wgpu::BindGroup {
        let shine = if is_dark { Vec3::ZERO } else { Vec3::from(part.look.emission) };
        let look = [
            Vec3::from(part.colour).extend(part.look.alpha_cutoff),
            shine.extend(part.look.opacity.unwrap_or(1.0)),
        ];
        let look = gpu.filled_buffer("skin part", &look, wgpu::BufferUsages::UNIFORM);
        let resources = [
            look.as_entire_binding(),
            wgpu::BindingResource::TextureView(colour),
            wgpu::BindingResource::Sampler(&self.sampler),
            wgpu::BindingResource::TextureView(emission),
        ];
        pipeline::group(gpu, "skin material", &self.layout, resources)
    }
}

impl SkinMaterial {
    /// Draws the part with a pipeline, after its skin's vertices and triangles are set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(2, &self.group, &[]);
        pass.draw_indexed(self.corners.clone(), 0, 0..1);
    }
}

/// A texture with all its smaller levels. An image that is too large for the device is halved until
/// it fits.
fn texture_view(gpu: &Gpu, size: [u32; 2], pixels: &[[u8; 4]]) -> wgpu::TextureView {
    let most = gpu.device.limits().max_texture_dimension_2d;
    let mut level = Level { size, pixels: pixels.to_vec() };
    while level.size.iter().any(|side| *side > most) {
        level = level.half();
    }
    let [width, height] = level.size;
    let levels = width.max(height).ilog2() + 1;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("skin texture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        // Not decoded to linear light: the shader multiplies colours as sRGB.
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for mip_level in 0..levels {
        if mip_level > 0 {
            level = level.half();
        }
        let [width, height] = level.size;
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level,
                origin: wgpu::Origin3d::ZERO,
                aspect: wgpu::TextureAspect::All,
            },
            level.pixels.as_flattened(),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * width),
                rows_per_image: None,
            },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// An image at some resolution.
struct Level {
    size: [u32; 2],
    pixels: Vec<[u8; 4]>,
}

impl Level {
    /// The image at half the resolution: each pixel is the mean of four.
    fn half(&self) -> Self {
        let [width, height] = self.size;
        let size = self.size.map(|side| (side / 2).max(1));
        let pixel = |x: u32, y: u32| {
            let at = y.min(height - 1) as usize * width as usize + x.min(width - 1) as usize;
            self.pixels.get(at).copied().unwrap_or([255; 4])
        };
        let mean = |x: u32, y: u32| -> [u8; 4] {
            let four = [pixel(x, y), pixel(x + 1, y), pixel(x, y + 1), pixel(x + 1, y + 1)];
            core::array::from_fn(|channel| {
                let sum: u32 = four.iter().map(|pixel| u32::from(pixel[channel])).sum();
                ((sum + 2) / 4) as u8
            })
        };
        let rows = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (2 * x, 2 * y)));
        Self { size, pixels: rows.map(|(x, y)| mean(x, y)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_has_the_means_of_four_pixels_and_at_least_one_pixel() {
        let pixels: Vec<[u8; 4]> = (0..6).map(|at| [10 * at; 4]).collect();
        let half = Level { size: [3, 2], pixels }.half();
        assert_eq!((half.size, &half.pixels[..]), ([1, 1], &[[20; 4]][..]));
        let last = half.half();
        assert_eq!((last.size, &last.pixels[..]), ([1, 1], &[[20; 4]][..]));
    }
}
