use bytemuck::{Pod, Zeroable};
use glam::Vec2;

use super::font::{Font, Rectangle};
use super::quads::{self, Quads};
use super::{Gpu, SystemFace};
use crate::scene::{Label, Scene, Side};

pub(super) const SHADER: &str =
    concat!(include_str!("../../shaders/view.wgsl"), include_str!("../../shaders/label.wgsl"),);

/// The height of a line, in points.
const SIZE: f32 = 15.0;

/// Between a label and what it is beside, in points.
const GAP: f32 = 3.0;

/// How far right and up a ball's edge is on its diagonal, in radii.
const DIAGONAL: f32 = core::f32::consts::FRAC_1_SQRT_2;

/// Around each letter, so that it reads on any ground.
const HALO: [Vec2; 8] = [
    Vec2::new(-1.0, -1.0),
    Vec2::new(0.0, -1.3),
    Vec2::new(1.0, -1.0),
    Vec2::new(1.3, 0.0),
    Vec2::new(1.0, 1.0),
    Vec2::new(0.0, 1.3),
    Vec2::new(-1.0, 1.0),
    Vec2::new(-1.3, 0.0),
];

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Pod, Zeroable, Debug)]
struct Instance {
    place: [f32; 4],
    source: [f32; 4],
    colour: [f32; 4],
}

const _: () = assert!(size_of::<Instance>() == 48);

/// Draws words over everything.
#[derive(Debug)]
pub(super) struct Labels {
    letters: Quads<Instance>,
    sheet_layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    sheet: Option<Sheet>,
}

/// The letters at one scale, and those of them that the device has.
#[derive(Debug)]
struct Sheet {
    scale: f32,
    font: Font,
    texture: wgpu::Texture,
    group: wgpu::BindGroup,
}

impl Labels {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let sheet_layout = sheet_layout(gpu);
        let letters = Quads::new(
            gpu,
            &quads::Kind {
                label: "label",
                shader: SHADER,
                layouts: &[view, &sheet_layout],
                attributes: &wgpu::vertex_attr_array![
                    0 => Float32x4, 1 => Float32x4, 2 => Float32x4
                ],
                depth: wgpu::CompareFunction::Always,
            },
        );
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("letters"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { letters, sheet_layout, sampler, sheet: None }
    }

    /// How many bytes were sent.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32), scale: f32) -> u64 {
        let (layout, sampler) = (&self.sheet_layout, &self.sampler);
        let mut sheet = match self.sheet.take() {
            Some(sheet) if sheet.scale == scale => sheet,
            _ => Sheet::new(gpu, layout, sampler, scale),
        };
        sheet.font.prepare(scene.labels.iter().map(|label| scene.text(label)));
        let sent = sheet.upload(gpu, layout, sampler);
        let size = Vec2::new(size.0 as f32, size.1 as f32);
        let letters = scene.labels.iter().flat_map(|label| sheet.write(scene, label, size));
        let sent = sent + self.letters.upload(gpu, letters);
        self.sheet = Some(sheet);
        sent
    }

    pub fn triangles(&self) -> u32 {
        self.letters.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(sheet) = &self.sheet {
            pass.set_bind_group(1, &sheet.group, &[]);
            self.letters.draw(pass);
        }
    }
}

impl Sheet {
    fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, sampler: &wgpu::Sampler, scale: f32) -> Self {
        let font = Font::new(SIZE * scale, gpu.longest_side(), SystemFace::find);
        let (texture, group) = texture(gpu, layout, sampler, font.atlas.size());
        Self { scale, font, texture, group }
    }

    /// Sends the letters that are new: how many bytes.
    fn upload(
        &mut self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        sampler: &wgpu::Sampler,
    ) -> u64 {
        let (width, height) = self.font.atlas.size();
        let mut changed = self.font.atlas.take_changed();
        if changed.is_empty() {
            return 0;
        }
        if self.texture.height() != height {
            (self.texture, self.group) = texture(gpu, layout, sampler, (width, height));
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

    /// The letters of a label and of the halo under them; none if its point is not in the picture.
    fn write<'a>(
        &'a self,
        scene: &'a Scene,
        label: &Label,
        size: Vec2,
    ) -> impl Iterator<Item = Instance> + use<'a> {
        let (text, colour) = (scene.text(label), label.colour.channels());
        let halo = scene.palette.sky_bottom.with_opacity(0.55).channels();
        let around = HALO.into_iter().map(move |offset| (offset * self.scale, halo));
        let laid = self.pen(scene, label, size).into_iter().flat_map(move |pen| {
            around.clone().chain([(Vec2::ZERO, colour)]).map(move |layer| (pen, layer))
        });
        laid.flat_map(move |(pen, (offset, colour))| {
            let letters = self.font.lay_out(text, pen);
            letters.map(move |letter| self.letter(letter, offset, colour))
        })
    }

    /// Where a label begins, in pixels, unless its point is not in the picture.
    fn pen(&self, scene: &Scene, label: &Label, size: Vec2) -> Option<Vec2> {
        let projection = scene.camera.projection(size.x / size.y);
        let at = projection.project(label.at)?;
        let point = (at * Vec2::new(0.5, -0.5) + 0.5) * size;
        let ball = label.clearance / projection.half_height_at(label.at) * size.y / 2.0;
        let away = ball * DIAGONAL + GAP * self.scale;
        let drop = match label.side {
            Side::Above => -away,
            Side::Below => away + 0.6 * SIZE * self.scale,
        };
        Some(point + Vec2::new(away, drop))
    }

    fn letter(
        &self,
        (stands, source): (Rectangle, Rectangle),
        offset: Vec2,
        colour: [f32; 4],
    ) -> Instance {
        let at = stands.at + offset;
        let (width, height) = self.font.atlas.size();
        let atlas = Vec2::new(width as f32, height as f32);
        let (from, size) = (source.at / atlas, source.size / atlas);
        Instance {
            place: [at.x, at.y, stands.size.x, stands.size.y],
            source: [from.x, from.y, size.x, size.y],
            colour,
        }
    }
}

fn texture(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    sampler: &wgpu::Sampler,
    (width, height): (u32, u32),
) -> (wgpu::Texture, wgpu::BindGroup) {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("letters"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let view = texture.create_view(&Default::default());
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("letters"),
        layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(sampler) },
        ],
    });
    (texture, group)
}

fn sheet_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("letters"),
        entries: &[
            entry(
                0,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
            entry(1, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
        ],
    })
}
