use bytemuck::{Pod, Zeroable};
use glam::Vec2;
use wgpu::util::DeviceExt as _;

use super::Gpu;
use super::font::{Font, Rectangle};
use super::quads::{self, Quads};
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
    atlas_layout: wgpu::BindGroupLayout,
    atlas: Option<Atlas>,
}

/// The letters at one scale.
#[derive(Debug)]
struct Atlas {
    scale: f32,
    font: Font,
    group: wgpu::BindGroup,
}

impl Labels {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        let atlas_layout = atlas_layout(gpu);
        let letters = Quads::new(
            gpu,
            &quads::Kind {
                label: "label",
                shader: SHADER,
                layouts: &[view, &atlas_layout],
                attributes: &wgpu::vertex_attr_array![
                    0 => Float32x4, 1 => Float32x4, 2 => Float32x4
                ],
                depth: wgpu::CompareFunction::Always,
            },
        );
        Self { letters, atlas_layout, atlas: None }
    }

    /// How many bytes were sent, the letters at a new scale aside.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32), scale: f32) -> u64 {
        let atlas = match self.atlas.take() {
            Some(atlas) if atlas.scale == scale => atlas,
            _ => Atlas::new(gpu, &self.atlas_layout, scale),
        };
        let size = Vec2::new(size.0 as f32, size.1 as f32);
        let letters = scene.labels.iter().flat_map(|label| atlas.write(scene, label, size));
        let sent = self.letters.upload(gpu, letters);
        self.atlas = Some(atlas);
        sent
    }

    pub fn triangles(&self) -> u32 {
        self.letters.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(atlas) = &self.atlas {
            pass.set_bind_group(1, &atlas.group, &[]);
            self.letters.draw(pass);
        }
    }
}

impl Atlas {
    fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, scale: f32) -> Self {
        let font = Font::new(SIZE * scale);
        let texture = gpu.device.create_texture_with_data(
            &gpu.queue,
            &wgpu::TextureDescriptor {
                label: Some("letters"),
                size: wgpu::Extent3d {
                    width: Font::WIDTH,
                    height: font.height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::R8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::default(),
            &font.pixels,
        );
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("letters"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("letters"),
            layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(
                        &texture.create_view(&Default::default()),
                    ),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Sampler(&sampler),
                },
            ],
        });
        Self { scale, font, group }
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
        let atlas = Vec2::new(Font::WIDTH as f32, self.font.height as f32);
        let (from, size) = (source.at / atlas, source.size / atlas);
        Instance {
            place: [at.x, at.y, stands.size.x, stands.size.y],
            source: [from.x, from.y, size.x, size.y],
            colour,
        }
    }
}

fn atlas_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
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
