use bytemuck::{Pod, Zeroable};
use glam::Vec2;

use super::Gpu;
use super::font::Rectangle;
use super::glyph_sheet::GlyphSheet;
use super::instances::{QuadDescriptor, Quads};
use super::label_places::LabelPlaces;
use super::pipeline::Output;
use super::texture::TextureSampler;
use crate::scene::{Label, Scene};

pub(super) const SHADER: &str = include_str!("../../shaders/label.wgsl");

/// Offsets in points of the copies of each glyph that form a halo, which keeps letters readable on
/// any background.
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
struct GlyphInstance {
    target: [f32; 4],
    source: [f32; 4],
    colour: [f32; 4],
}

const _: () = assert!(size_of::<GlyphInstance>() == 48);

/// Draws labels over everything else.
#[derive(Debug)]
pub(super) struct Labels {
    glyphs: Quads<GlyphInstance>,
    sampler: TextureSampler,
    sheet: Option<GlyphSheet>,
    places: LabelPlaces,
}

impl Labels {
    /// Creates the pipeline for passes of this format.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let sampler = TextureSampler::new(gpu, "glyphs");
        let glyphs = Quads::new(
            gpu,
            &QuadDescriptor {
                label: "label",
                shader: SHADER,
                layouts: &[&sampler.layout],
                attributes: &wgpu::vertex_attr_array![
                    0 => Float32x4, 1 => Float32x4, 2 => Float32x4
                ],
                depth: wgpu::CompareFunction::Always,
                output: Output::Overlay(format),
            },
        );
        Self { glyphs, sampler, sheet: None, places: LabelPlaces::default() }
    }

    /// Sends the changes to the device and returns the number of bytes sent. `size` is the
    /// picture's in pixels, `scale` the number of pixels per point.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32), scale: f32) -> u64 {
        let mut sheet = match self.sheet.take() {
            Some(sheet) if sheet.scale == scale => sheet,
            _ => GlyphSheet::new(gpu, &self.sampler, scale),
        };
        sheet.font.prepare(scene.labels.iter().map(|label| scene.text(label)));
        let sent = sheet.upload(gpu, &self.sampler);
        let size = Vec2::new(size.0 as f32, size.1 as f32);
        let width = |label: &Label| sheet.font.width(scene.text(label));
        self.places.place(&scene.labels, &scene.camera, size, sheet.scale, width);
        let placed = scene.labels.iter().zip(self.places.pens());
        let glyphs = placed.flat_map(|(label, pen)| glyphs(&sheet, scene, label, *pen, size));
        let sent = sent + self.glyphs.upload(gpu, glyphs);
        self.sheet = Some(sheet);
        sent
    }

    pub fn triangles(&self) -> u32 {
        self.glyphs.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(sheet) = &self.sheet {
            pass.set_bind_group(0, sheet.group(), &[]);
            self.glyphs.draw(pass);
        }
    }
}

/// Glyphs of a label's halo, then of the label itself, from the start of its baseline in pixels on;
/// empty without one.
fn glyphs<'a>(
    sheet: &'a GlyphSheet,
    scene: &'a Scene,
    label: &Label,
    pen: Option<Vec2>,
    size: Vec2,
) -> impl Iterator<Item = GlyphInstance> + use<'a> {
    let (text, colour) = (scene.text(label), label.colour.channels());
    let halo = scene.palette.sky_bottom.with_opacity(0.55).channels();
    let around = HALO.into_iter().map(move |offset| (offset * sheet.scale, halo));
    let laid = pen.into_iter().flat_map(move |pen| {
        around.clone().chain([(Vec2::ZERO, colour)]).map(move |layer| (pen, layer))
    });
    laid.flat_map(move |(pen, (offset, colour))| {
        let letters = sheet.font.lay_out(text, pen);
        letters.map(move |letter| glyph_instance(sheet, size, letter, offset, colour))
    })
}

fn glyph_instance(
    sheet: &GlyphSheet,
    size: Vec2,
    (target, source): (Rectangle, Rectangle),
    offset: Vec2,
    colour: [f32; 4],
) -> GlyphInstance {
    let corner = (target.at + offset) * Vec2::new(2.0, -2.0) / size + Vec2::new(-1.0, 1.0);
    let extent = target.size * Vec2::new(2.0, -2.0) / size;
    let (width, height) = sheet.font.atlas.size();
    let atlas = Vec2::new(width as f32, height as f32);
    let (from, part) = (source.at / atlas, source.size / atlas);
    GlyphInstance {
        target: [corner.x, corner.y, extent.x, extent.y],
        source: [from.x, from.y, part.x, part.y],
        colour,
    }
}
