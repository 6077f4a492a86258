use core::fmt;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use egui::epaint::text::{
    Fonts, Galley, Glyph, GlyphBitmap, GlyphRasterizer, GlyphRasterizerRequest, LayoutJob,
    RasterizedGlyph, TextFormat, TextOptions, ViewportKey,
};
use egui::epaint::{ColorImage, FontColorTransferFunction};
use egui::{Color32, FontDefinitions, FontFamily, FontId, vec2};
use glam::Vec2;
use unicode_segmentation::UnicodeSegmentation as _;

use super::Gpu;
use super::instances::{QuadDescriptor, Quads};
use super::label_places::{LINE_HEIGHT, LabelPlaces};
use super::pipeline::PipelineOutput;
use super::system_fonts::{FamilyFonts, family_of};
use super::texture::{PaintTexture, TextureSampler};
use crate::scene::Scene;

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
pub(super) struct LabelPainter {
    glyphs: Quads<GlyphInstance>,
    sampler: TextureSampler,
    text: LabelText,
    places: LabelPlaces,
    /// The glyphs on the device; `None` before the first upload.
    atlas: Option<PaintTexture>,
}

impl LabelPainter {
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
                output: PipelineOutput::Overlay(format),
            },
        );
        let fonts = LabelText::fonts().with_font_providers(vec![Arc::new(FamilyFonts)]);
        let (text, places) = (LabelText::new(fonts, family_of), LabelPlaces::default());
        Self { glyphs, sampler, text, places, atlas: None }
    }

    /// Sends the changes to the device and returns the number of bytes sent. `size` is the
    /// picture's in pixels, `scale` the number of pixels per point.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32), scale: f32) -> u64 {
        self.text.lay_out(scene.labels.iter().map(|label| scene.text(label)), scale);
        let mut sent = 0;
        if let Some(delta) = self.text.fonts.font_image_delta() {
            if delta.pos.is_none() {
                self.atlas = Some(PaintTexture::new(gpu, &self.sampler, &delta));
            }
            sent += self.atlas.as_ref().map_or(0, |atlas| atlas.write(gpu, &delta));
        }
        let (text, size) = (&self.text, Vec2::new(size.0 as f32, size.1 as f32));
        let labels = scene.labels.iter().zip(&text.galleys);
        let widths = text.galleys.iter().map(|galley| width(galley) * scale);
        self.places.place(scene, widths, size, scale);

        let halo = scene.palette.sky_bottom.with_opacity(0.55).channels();
        let around = HALO.map(|offset| (offset * scale, halo));
        let pens = labels.zip(self.places.pens());
        let placed = pens.filter_map(|((label, galley), pen)| Some((label, galley, (*pen)?)));
        let instances = placed.flat_map(|(label, galley, pen)| {
            let layers = around.into_iter().chain([(Vec2::ZERO, label.colour.channels())]);
            layers.flat_map(move |(offset, colour)| {
                glyphs(galley).map(move |glyph| {
                    let corner = pen.round() + (corner(glyph) * scale).round() + offset;
                    glyph_instance(glyph, corner, scale, size, colour)
                })
            })
        });
        sent + self.glyphs.upload(gpu, instances)
    }

    pub fn triangles(&self) -> u32 {
        self.glyphs.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(atlas) = &self.atlas {
            pass.set_bind_group(0, &atlas.group, &[]);
            self.glyphs.draw(pass);
        }
    }
}

fn glyph_instance(
    glyph: &Glyph,
    corner: Vec2,
    scale: f32,
    size: Vec2,
    colour: [f32; 4],
) -> GlyphInstance {
    let corner = corner * Vec2::new(2.0, -2.0) / size + Vec2::new(-1.0, 1.0);
    let extent = extent(glyph) * scale * Vec2::new(2.0, -2.0) / size;
    let [from, to] =
        [glyph.uv_rect.min, glyph.uv_rect.max].map(|corner| Vec2::from(corner.map(f32::from)));
    GlyphInstance {
        target: [corner.x, corner.y, extent.x, extent.y],
        source: [from.x, from.y, to.x - from.x, to.y - from.y],
        colour,
    }
}

/// Visible glyphs of a line of text.
fn glyphs(galley: &Galley) -> impl Iterator<Item = &Glyph> {
    let glyphs = galley.rows.iter().flat_map(|row| &row.glyphs);
    glyphs.filter(|glyph| !glyph.uv_rect.is_nothing())
}

/// Upper left corner of a glyph's image from the start of the baseline, in points. Fonts of all
/// scripts share the baseline.
fn corner(glyph: &Glyph) -> Vec2 {
    let offset = glyph.uv_rect.offset;
    Vec2::new(glyph.pos.x + offset.x, offset.y)
}

/// Size of a glyph's image in points.
fn extent(glyph: &Glyph) -> Vec2 {
    Vec2::new(glyph.uv_rect.size.x, glyph.uv_rect.size.y)
}

/// Width of a line of text in points.
fn width(galley: &Galley) -> f32 {
    glyphs(galley).map(|glyph| corner(glyph).x + extent(glyph).x).fold(0.0, f32::max)
}

/// The texts of labels, each laid out on one line by epaint, and the atlas of their glyphs.
struct LabelText {
    fonts: Fonts,
    /// The family of a letter that the built-in fonts lack.
    family_of: fn(char) -> Option<FontFamily>,
    /// Pixels per point that were asked for.
    scale: f32,
    galleys: Vec<Arc<Galley>>,
}

impl LabelText {
    /// Size of letters in points; lines of the first font are as high as [`LINE_HEIGHT`].
    const FONT_SIZE: f32 = LINE_HEIGHT / 1.121;
    /// Range of pixels per point in which a glyph is neither empty nor too large for the atlas.
    const SCALES: [f32; 2] = [0.1, 32.0];
    /// Letters look as their outlines do, at whole pixels.
    const OPTIONS: TextOptions = TextOptions {
        max_texture_side: 2048,
        color_transfer_function: FontColorTransferFunction::Off,
        font_hinting: false,
        subpixel_binning: false,
    };

    fn new(fonts: Fonts, family_of: fn(char) -> Option<FontFamily>) -> Self {
        Self { fonts, family_of, scale: 0.0, galleys: Vec::new() }
    }

    /// The built-in fonts, with a box for letters that no font has.
    fn fonts() -> Fonts {
        let mut definitions = FontDefinitions::default();
        definitions.families.entry(FontFamily::Proportional).or_default().push("Hack".to_owned());
        Fonts::new(Self::OPTIONS, definitions)
            .with_glyph_rasterizer(GlyphRasterizer::new("missing letter", missing_letter))
    }

    /// Lays out the texts, unless they are the same as before. If their glyphs do not fit the
    /// atlas, they are rasterized at half the scale, and so on. The look of the texts does not
    /// depend on what was laid out before.
    fn lay_out<'a>(&mut self, texts: impl Iterator<Item = &'a str> + Clone, scale: f32) {
        let visible = |text: &'a str| text.chars().filter(|letter| !letter.is_control());
        let same = |(galley, text): (&Arc<Galley>, _)| galley.text().chars().eq(visible(text));
        if self.scale == scale
            && self.galleys.len() == texts.clone().count()
            && self.galleys.iter().zip(texts.clone()).all(same)
        {
            return;
        }
        self.scale = scale;
        let [least, most] = Self::SCALES;
        let full = scale.clamp(least, most);
        let halved = |scale: &f32| Some(scale / 2.0).filter(|half| *half >= least);
        // Twice in full, since the first time glyphs of earlier texts may fill the atlas.
        for scale in core::iter::once(full).chain(core::iter::successors(Some(full), halved)) {
            // Empties an atlas that is nearly full.
            self.fonts.begin_pass(Self::OPTIONS, ViewportKey::default());
            self.galleys.clear();
            for text in texts.clone() {
                let job = self.job(&visible(text).collect::<String>());
                let mut fonts = self.fonts.with_pixels_per_point(scale);
                self.galleys.push(fonts.layout_job(job));
                if fonts.font_atlas_fill_ratio() >= 1.0 {
                    break;
                }
            }
            if self.fonts.font_atlas_fill_ratio() < 1.0 {
                break;
            }
        }
    }

    /// A line in which each letter is of the built-in fonts or, if these lack it, of its family.
    fn job(&mut self, text: &str) -> LayoutJob {
        let built_in = FontId::proportional(Self::FONT_SIZE);
        let mut job = LayoutJob { break_on_newline: false, ..LayoutJob::default() };
        // Marks stay with the letter that they are on.
        for cluster in text.graphemes(true) {
            let Some(letter) = cluster.chars().next() else { continue };
            let is_lacking = !self.fonts.has_glyph(&built_in, letter);
            let family = is_lacking.then(|| (self.family_of)(letter)).flatten();
            let font = FontId { family: family.unwrap_or_default(), ..built_in.clone() };
            let format = TextFormat::simple(font, Color32::WHITE);
            job.append(cluster, 0.0, format);
        }
        job
    }
}

impl fmt::Debug for LabelText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LabelText").field("galleys", &self.galleys).finish_non_exhaustive()
    }
}

/// A box for a letter that no font has: the outline of an upright rectangle as high as a capital
/// letter.
fn missing_letter(request: &GlyphRasterizerRequest<'_>) -> Option<RasterizedGlyph> {
    let pixels = |ems: f32, least: f32| (ems * request.font_size_px).round().max(least);
    let (width, height) = (pixels(0.5, 2.0), pixels(0.7, 2.0));
    let (bearing, stroke) = (pixels(0.08, 1.0), pixels(1.0 / 14.0, 1.0) as usize);
    let [columns, rows] = [width as usize, height as usize];
    let mut image = ColorImage::filled([columns, rows], Color32::WHITE);
    for (x, y) in (stroke..rows.saturating_sub(stroke))
        .flat_map(|y| (stroke..columns.saturating_sub(stroke)).map(move |x| (x, y)))
    {
        image[(x, y)] = Color32::TRANSPARENT;
    }
    let bitmap = GlyphBitmap { image, offset_px: vec2(bearing, -height), is_color: false };
    Some(RasterizedGlyph { bitmap, advance_px: width + 2.0 * bearing })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALES: [f32; 4] = [0.6, 1.0, 2.0, 4.5];
    /// A private-use code point, which no built-in font has.
    const NO_LETTER: &str = "\u{10fffd}";

    fn without_system_fonts() -> LabelText {
        LabelText::new(LabelText::fonts(), |_| None)
    }

    /// Corners and sizes of the glyphs of a text in points, and their places in the atlas.
    fn lay_out(labels: &mut LabelText, text: &str, scale: f32) -> Vec<(Vec2, Vec2, [u16; 2])> {
        labels.lay_out([text].into_iter(), scale);
        let laid = glyphs(&labels.galleys[0]);
        laid.map(|glyph| (corner(glyph), extent(glyph), glyph.uv_rect.min)).collect()
    }

    /// Total coverage of the glyphs of a text at scale 1, in pixels.
    fn ink(text: &str) -> f32 {
        let mut labels = without_system_fonts();
        let laid = lay_out(&mut labels, text, 1.0);
        let image = labels.fonts.image();
        let cover = |(_, size, [left, top]): (_, Vec2, [u16; 2])| {
            let [width, height] = size.to_array().map(|side| side as usize);
            let rows = image.pixels.chunks(image.width()).skip(top.into()).take(height);
            rows.flat_map(|row| &row[left.into()..][..width])
                .map(|pixel| f32::from(pixel.a()) / 255.0)
                .sum::<f32>()
        };
        laid.into_iter().map(cover).sum()
    }

    #[test]
    fn every_letter_of_a_label_is_drawn() {
        let text: String = ('!'..='~').chain(['°', '·', '−', 'ü', 'Ж', '→']).collect();
        for scale in SCALES {
            let laid = lay_out(&mut without_system_fonts(), &text, scale);
            assert_eq!(laid.len(), text.chars().count());
        }
    }

    #[test]
    fn a_letter_without_a_glyph_is_a_box() {
        for scale in SCALES {
            let mut labels = without_system_fonts();
            let laid = lay_out(&mut labels, NO_LETTER, scale);
            assert_eq!(laid.len(), 1);
            assert_eq!(laid[0].0.y, -laid[0].1.y, "it is on the baseline");
            assert_eq!(lay_out(&mut labels, "左手", scale).len(), 2);
            let mut end = |text| lay_out(&mut labels, text, scale).last().map(|it| it.0.x);
            assert!(end("a\u{10fffd}b") > end("ab"), "it takes room");
        }
        let outer = lay_out(&mut without_system_fonts(), NO_LETTER, 1.0)[0].1.element_product();
        let part = ink(NO_LETTER) / outer;
        assert!(0.3 < part && part < 0.95, "its edges are drawn, its inside is not: {part}");
    }

    #[test]
    fn a_letter_that_the_program_lacks_comes_from_a_font_that_is_found() {
        const SQUARE: &str = "\u{25a2}";
        const HACK: &str = "Hack";
        let mut definitions = FontDefinitions::default();
        let families = &mut definitions.families;
        families.insert(FontFamily::Proportional, vec!["Ubuntu-Light".to_owned()]);
        // Only the first font of the definitions has it.
        families.insert(FontFamily::Name(HACK.into()), vec![HACK.to_owned()]);
        let fonts = || Fonts::new(LabelText::OPTIONS, definitions.clone());
        let mut without = LabelText::new(fonts(), |_| None);
        let mut with = LabelText::new(fonts(), |letter| {
            SQUARE.contains(letter).then(|| FontFamily::Name(HACK.into()))
        });
        let sizes = |labels: &mut LabelText, text| lay_out(labels, text, 2.0)[0].1;
        assert_ne!(sizes(&mut without, SQUARE), sizes(&mut with, SQUARE));
        assert_eq!(sizes(&mut without, NO_LETTER), sizes(&mut with, NO_LETTER));
    }

    #[test]
    fn u_with_a_diaeresis_is_one_letter_however_it_is_written() {
        assert!(ink("ü") > ink("u") + 2.0);
        let mut labels = without_system_fonts();
        let composed = lay_out(&mut labels, "Hüfte", 2.0);
        assert_eq!(lay_out(&mut labels, "Hu\u{308}fte", 2.0), composed);
    }

    #[test]
    fn what_shows_nothing_takes_no_room() {
        let mut labels = without_system_fonts();
        let plain = lay_out(&mut labels, "ab", 1.0);
        for letter in
            "\0\n\r\t\u{7f}\u{ad}\u{200b}\u{200d}\u{202e}\u{fe0f}\u{feff}\u{e0100}".chars()
        {
            assert_eq!(lay_out(&mut labels, &format!("a{letter}b"), 1.0), plain, "{letter:?}");
        }
        for space in [' ', '\u{a0}', '\u{2003}', '\u{3000}'] {
            let laid = lay_out(&mut labels, &format!("a{space}b"), 1.0);
            assert!(laid.len() == 2 && laid[1].0.x > plain[1].0.x, "{space:?}");
        }
    }

    #[test]
    fn more_letters_than_an_atlas_holds_are_rasterized_smaller() {
        let letters = ('\u{a1}'..).filter(|letter| letter.is_alphabetic()).take(1000);
        let all: String = letters.collect();
        let mut labels = without_system_fonts();
        let laid = lay_out(&mut labels, &all, 20.0);
        assert!(labels.galleys[0].pixels_per_point < 20.0);
        let mut places: Vec<_> = laid.iter().map(|it| it.2).collect();
        places.sort_unstable();
        places.dedup();
        assert!(places.len() > 300, "{} places", places.len());
        lay_out(&mut labels, "Hand", 20.0);
        assert_eq!(labels.galleys[0].pixels_per_point, 20.0);
        assert_eq!(lay_out(&mut labels, &all, 20.0), laid, "whatever was drawn before");
    }

    #[test]
    fn any_scale_has_letters() {
        for scale in [1e-3, 0.1, 20.0, 1e3, f32::MAX] {
            assert_eq!(lay_out(&mut without_system_fonts(), "a左", scale).len(), 2, "{scale}");
        }
    }
}
