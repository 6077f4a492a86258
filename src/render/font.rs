use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use ab_glyph::{Font as _, FontRef, GlyphId, OutlinedGlyph, ScaleFont as _};
use glam::Vec2;
use unicode_normalization::UnicodeNormalization as _;
use unicode_normalization::char::is_combining_mark;

use super::SystemFace;
use super::atlas::Atlas;
use super::font_face::FontFace;
use super::ignored_letters::is_ignored;

/// Glyphs of labels at one size. Each glyph is rasterized when a text first contains its letter,
/// from a built-in font or else from the face that `find` returns. A letter that no font has is
/// drawn as a box.
///
/// Text is not shaped: glyphs run from left to right and are never joined.
#[derive(Debug)]
pub(super) struct Font {
    pub atlas: Atlas,
    faces: Vec<FontFace>,
    find: fn(char) -> Option<SystemFace>,
    pixels_per_em: f32,
    glyphs: HashMap<char, Glyph>,
    missing: Glyph,
    /// Hash of the last texts for which the atlas was emptied. The same texts do not empty it
    /// again.
    overflow: Option<u64>,
}

#[derive(Clone, Copy, Debug)]
struct Glyph {
    /// Face and glyph index, for kerning; `None` for a box.
    id: Option<(usize, GlyphId)>,
    advance: f32,
    image: Option<GlyphImage>,
    /// True if the letter is drawn as a box because its own image did not fit the atlas.
    is_left_out: bool,
}

/// Rectangle of a glyph in the atlas, and the offset from the pen at which it is drawn, in pixels.
#[derive(Clone, Copy, Debug)]
struct GlyphImage {
    source: Rectangle,
    from_pen: Vec2,
}

/// A rectangle in pixels, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub at: Vec2,
    pub size: Vec2,
}

impl Font {
    /// Built-in fonts in order of preference.
    const BUILT_IN: [&[u8]; 2] =
        [epaint_default_fonts::UBUNTU_LIGHT, epaint_default_fonts::HACK_REGULAR];
    /// Letters that are rasterized in advance, so that labels with changing numbers add no glyphs.
    const FIRST: core::ops::RangeInclusive<char> = ' '..='~';
    /// Maximum number of letters whose glyphs are kept.
    const MAX_GLYPHS: usize = 1 << 14;

    /// Creates a font with lines of height `size` and an atlas with sides of at most `longest`,
    /// both in pixels.
    pub fn new(size: f32, longest: u32, find: fn(char) -> Option<SystemFace>) -> Self {
        const MIN_WIDTH: u32 = 512;
        const MAX_HEIGHT: u32 = 4096;
        const GLYPHS_PER_ROW: f32 = 32.0;
        // Limits the size so that a box fits any atlas.
        let size = size.min(longest as f32 / 4.0);
        let row = (size * GLYPHS_PER_ROW) as u32;
        let width = row.checked_next_power_of_two().unwrap_or(longest).max(MIN_WIDTH).min(longest);
        let mut font = Self {
            atlas: Atlas::new(width, MAX_HEIGHT.min(longest)),
            faces: Vec::new(),
            find,
            pixels_per_em: size,
            glyphs: HashMap::new(),
            missing: Glyph { id: None, advance: 0.0, image: None, is_left_out: false },
            overflow: None,
        };
        for data in Self::BUILT_IN {
            let face = FontRef::try_from_slice(data)
                .unwrap_or_else(|_| unreachable!("the built-in fonts are valid"));
            if font.faces.is_empty() {
                let units = face.units_per_em().unwrap_or_else(|| face.height_unscaled());
                font.pixels_per_em = size * units / face.height_unscaled();
            }
            font.faces.push(FontFace::new(None, face, font.pixels_per_em));
        }
        font.fill();
        font
    }

    /// Rasterizes all glyphs of the texts that the atlas does not contain yet. If they do not fit,
    /// the atlas is emptied and the texts are rasterized again; glyphs that still do not fit become
    /// boxes. The look of the texts therefore does not depend on what was drawn before.
    pub fn prepare<'a>(&mut self, texts: impl Iterator<Item = &'a str> + Clone) {
        if self.rasterize_all(texts.clone()) {
            return;
        }
        let mut hasher = DefaultHasher::new();
        texts.clone().for_each(|text| text.hash(&mut hasher));
        let hash = hasher.finish();
        if self.overflow != Some(hash) {
            self.overflow = Some(hash);
            self.atlas.clear();
            self.glyphs.clear();
            self.fill();
            self.rasterize_all(texts);
        }
    }

    /// Glyphs of a text whose baseline starts at `pen`: for each glyph with an image its rectangle
    /// in the picture and its rectangle in the atlas, in pixels.
    pub fn lay_out<'a>(
        &'a self,
        text: &'a str,
        mut pen: Vec2,
    ) -> impl Iterator<Item = (Rectangle, Rectangle)> + use<'a> {
        let mut last = None;
        visible_letters(text).filter_map(move |letter| {
            let drawn = self.glyphs.get(&letter).unwrap_or(&self.missing);
            pen.x += self.kern(last, drawn.id);
            last = drawn.id;
            let start = pen.round();
            pen.x += drawn.advance;
            let image = drawn.image?;
            let target = Rectangle { at: start + image.from_pen, size: image.source.size };
            Some((target, image.source))
        })
    }

    /// Width of a text in pixels.
    pub fn width(&self, text: &str) -> f32 {
        let ends = self.lay_out(text, Vec2::ZERO).map(|(target, _)| target.at.x + target.size.x);
        ends.fold(0.0, f32::max)
    }

    /// Rasterizes the box and the letters in `FIRST` into an empty atlas.
    fn fill(&mut self) {
        self.missing = self.rasterize_box();
        for letter in Self::FIRST {
            let drawn = self.rasterize(letter);
            self.glyphs.insert(letter, drawn);
        }
    }

    /// Rasterizes the letters of the texts that have no glyph yet. Returns whether all glyphs fit.
    fn rasterize_all<'a>(&mut self, texts: impl Iterator<Item = &'a str>) -> bool {
        let mut all = true;
        for letter in texts.flat_map(visible_letters) {
            if let Some(drawn) = self.glyphs.get(&letter) {
                all &= !drawn.is_left_out;
            } else if self.glyphs.len() < Self::MAX_GLYPHS {
                let drawn = self.rasterize(letter);
                all &= !drawn.is_left_out;
                self.glyphs.insert(letter, drawn);
            } else {
                all = false;
            }
        }
        all
    }

    fn kern(&self, last: Option<(usize, GlyphId)>, next: Option<(usize, GlyphId)>) -> f32 {
        match (last, next) {
            (Some((face, last)), Some((same, next))) if face == same => {
                let face = &self.faces[face];
                face.font.as_scaled(face.scale).kern(last, next)
            }
            _ => 0.0,
        }
    }

    fn rasterize(&mut self, letter: char) -> Glyph {
        if letter.is_whitespace() {
            return self.space(letter);
        }
        let built_in = (0..Self::BUILT_IN.len())
            .find_map(|face| Some((face, self.faces[face].outline(letter)?)));
        let found = built_in.or_else(|| {
            let face = self.system_face(letter)?;
            Some((face, self.faces[face].outline(letter)?))
        });
        match found {
            Some((face, outline)) => self.rasterize_outline(letter, face, &outline),
            None => self.missing,
        }
    }

    fn rasterize_outline(&mut self, letter: char, face: usize, outline: &OutlinedGlyph) -> Glyph {
        let bounds = outline.px_bounds();
        let size = (bounds.width() as u32, bounds.height() as u32);
        let Some(at) = self.atlas.place(size) else {
            return Glyph { is_left_out: true, ..self.missing };
        };
        outline.draw(|x, y, cover| self.atlas.set((at.0 + x, at.1 + y), cover));
        let FontFace { font, scale, .. } = &self.faces[face];
        let id = font.glyph_id(letter);
        let advance = font.as_scaled(*scale).h_advance(id);
        // A combining mark is drawn over the letter before it, even in a monospaced font.
        let (back, advance) =
            if is_combining_mark(letter) { (advance, 0.0) } else { (0.0, advance) };
        Glyph {
            id: Some((face, id)),
            advance,
            image: Some(GlyphImage {
                source: rectangle(at, size),
                from_pen: Vec2::new(bounds.min.x - back, bounds.min.y),
            }),
            is_left_out: false,
        }
    }

    /// A glyph without an image for a white-space letter: as wide as in the first font, or one em
    /// for the ideographic space.
    fn space(&self, letter: char) -> Glyph {
        const IDEOGRAPHIC: char = '\u{3000}';
        let FontFace { font, scale, .. } = &self.faces[0];
        let has_letter = font.glyph_id(letter) != GlyphId(0);
        let id = font.glyph_id(if has_letter { letter } else { ' ' });
        let advance = match letter {
            IDEOGRAPHIC => self.pixels_per_em,
            _ => font.as_scaled(*scale).h_advance(id),
        };
        Glyph { id: Some((0, id)), advance, image: None, is_left_out: false }
    }

    /// Rasterizes the box for missing letters: the outline of an upright rectangle as high as a
    /// capital letter.
    fn rasterize_box(&mut self) -> Glyph {
        const SIZE: Vec2 = Vec2::new(0.5, 0.7);
        const SIDE_BEARING: f32 = 0.08;
        const STROKE: f32 = 1.0 / 14.0;
        let pixels = |ems: f32| (ems * self.pixels_per_em).round();
        let size = Vec2::new(pixels(SIZE.x), pixels(SIZE.y)).max(Vec2::splat(2.0));
        let (stroke, bearing) = (pixels(STROKE).max(1.0) as u32, pixels(SIDE_BEARING).max(1.0));
        let (width, height) = (size.x as u32, size.y as u32);
        let at = self.atlas.place((width, height));
        let image = at.map(|at| {
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let from_edge = x.min(y).min(width - 1 - x).min(height - 1 - y);
                let cover = if from_edge < stroke { 1.0 } else { 0.0 };
                self.atlas.set((at.0 + x, at.1 + y), cover);
            }
            let from_pen = Vec2::new(bearing, -size.y);
            GlyphImage { source: rectangle(at, (width, height)), from_pen }
        });
        let advance = size.x + 2.0 * bearing;
        Glyph { id: None, advance, image, is_left_out: false }
    }

    /// Index in `faces` of the system's face for a letter, which is added if it is new; `None` if
    /// there is no such face or it is invalid.
    fn system_face(&mut self, letter: char) -> Option<usize> {
        let SystemFace { number, data, index } = (self.find)(letter)?;
        let known = self.faces.iter().position(|face| face.number == Some(number));
        known.or_else(|| {
            let font = FontRef::try_from_slice_and_index(data, index).ok()?;
            self.faces.push(FontFace::new(Some(number), font, self.pixels_per_em));
            Some(self.faces.len() - 1)
        })
    }
}

fn rectangle((x, y): (u32, u32), (width, height): (u32, u32)) -> Rectangle {
    Rectangle { at: Vec2::new(x as f32, y as f32), size: Vec2::new(width as f32, height as f32) }
}

/// Visible letters of a text in normalization form C: "u" and a combining diaeresis become "ü".
fn visible_letters(text: &str) -> impl Iterator<Item = char> + Clone {
    text.nfc().filter(|letter| !is_ignored(*letter))
}

#[cfg(test)]
mod tests {
    use epaint_default_fonts::{EGUI_ICONS, special_emojis};

    use super::*;

    const SIZES: [f32; 4] = [9.0, 14.0, 28.0, 64.0];
    const LONGEST: u32 = 2048;
    /// A private-use code point, which no built-in font has.
    const NO_LETTER: char = '\u{10fffd}';

    fn without_system_fonts(size: f32) -> Font {
        Font::new(size, LONGEST, |_| None)
    }

    /// Finds one letter, in the icons that come with egui, instead of the system's fonts.
    fn icons(letter: char) -> Option<SystemFace> {
        let has_it = letter == special_emojis::GITHUB;
        has_it.then_some(SystemFace { number: 7, data: EGUI_ICONS, index: 0 })
    }

    fn lay_out(font: &mut Font, text: &str) -> Vec<(Rectangle, Rectangle)> {
        font.prepare([text].into_iter());
        let laid: Vec<_> = font.lay_out(text, Vec2::ZERO).collect();
        let (width, height) = font.atlas.size();
        for (target, source) in &laid {
            let end = source.at + source.size;
            assert!(end.x < width as f32 && end.y < height as f32, "{text}");
            assert_eq!(target.size, source.size);
        }
        laid
    }

    /// Total coverage of the glyphs of a text, in pixels.
    fn ink(font: &mut Font, text: &str) -> f32 {
        let laid = lay_out(font, text);
        let pixels = |source: Rectangle| {
            let (from, to) = (source.at.as_uvec2(), (source.at + source.size).as_uvec2());
            (from.y..to.y).flat_map(move |y| (from.x..to.x).map(move |x| (x, y)))
        };
        let covers = laid.into_iter().flat_map(|(_, source)| pixels(source));
        let sum: u32 = covers.map(|(x, y)| u32::from(font.atlas.rows(y..y + 1)[x as usize])).sum();
        sum as f32 / 255.0
    }

    /// Visible letters that the built-in fonts have.
    fn many_letters() -> Vec<char> {
        let letters = ('\u{a1}'..'\u{2fff}').filter(|letter| !letter.is_whitespace());
        let fonts = Font::BUILT_IN.map(|data| FontRef::try_from_slice(data).expect("a font"));
        let has_outline = |letter: &char| {
            fonts.iter().any(|font| {
                let id = font.glyph_id(*letter);
                id != GlyphId(0) && font.outline(id).is_some()
            })
        };
        let letters = letters.filter(|letter| letter.nfc().eq([*letter]) && !is_ignored(*letter));
        letters.filter(has_outline).collect()
    }

    #[test]
    fn every_letter_of_a_label_is_drawn_inside_the_atlas() {
        for size in SIZES {
            let mut font = without_system_fonts(size);
            let text: String = Font::FIRST.skip(1).chain(['°', '·', '−', 'ü', 'Ж', '→']).collect();
            assert_eq!(lay_out(&mut font, &text).len(), text.chars().count());
        }
    }

    #[test]
    fn a_letter_without_a_glyph_is_a_box() {
        for size in SIZES {
            let mut font = without_system_fonts(size);
            let [(target, source)] = lay_out(&mut font, &NO_LETTER.to_string())[..] else {
                panic!("one box")
            };
            let outer = source.size.element_product();
            assert!(ink(&mut font, "\u{10fffd}") > 0.3 * outer, "its edges are drawn");
            assert!(ink(&mut font, "\u{10fffd}") < 0.95 * outer, "it is empty inside");
            assert_eq!(target.at.y, -target.size.y, "it is on the baseline");
            assert_eq!(lay_out(&mut font, "左手").len(), 2);
            let end = |text, font: &mut Font| lay_out(font, text).last().map(|it| it.0.at.x);
            assert!(end("a\u{10fffd}b", &mut font) > end("ab", &mut font), "it takes room");
        }
    }

    #[test]
    fn a_letter_that_the_program_lacks_comes_from_a_font_of_the_system() {
        for size in SIZES {
            let mut font = Font::new(size, LONGEST, icons);
            let text = special_emojis::GITHUB.to_string();
            let icon = lay_out(&mut font, &text);
            let boxed = lay_out(&mut without_system_fonts(size), &text);
            assert_ne!(icon[0].1, boxed[0].1);
            assert!(ink(&mut font, &text) > 0.1 * size * size, "{size}");
            assert_eq!(font.faces.len(), Font::BUILT_IN.len() + 1);
            lay_out(&mut font, &text.repeat(3));
            assert_eq!(font.faces.len(), Font::BUILT_IN.len() + 1);
        }
    }

    #[test]
    fn a_font_of_the_system_that_is_none_or_lacks_the_letter_leaves_a_box() {
        let broken = |_| Some(SystemFace { number: 0, data: b"no font", index: 0 });
        let lacking = |_| Some(SystemFace { number: 0, data: EGUI_ICONS, index: 0 });
        let expected = lay_out(&mut without_system_fonts(14.0), "左");
        for find in [broken, lacking] {
            assert_eq!(lay_out(&mut Font::new(14.0, LONGEST, find), "左"), expected);
        }
    }

    #[test]
    fn u_with_a_diaeresis_is_one_letter_however_it_is_written() {
        let mut font = without_system_fonts(28.0);
        assert!(ink(&mut font, "ü") > ink(&mut font, "u") + 2.0);
        assert_eq!(lay_out(&mut font, "Hu\u{308}fte"), lay_out(&mut font, "Hüfte"));
    }

    #[test]
    fn a_mark_is_drawn_over_the_letter_before_it() {
        let mut font = without_system_fonts(28.0);
        // Unicode has no single letter for q with an acute accent.
        let laid = lay_out(&mut font, "q\u{301}q");
        let plain = lay_out(&mut font, "qq");
        assert_eq!((laid[0], laid[2]), (plain[0], plain[1]));
        let middle = |target: Rectangle| target.at.x + target.size.x / 2.0;
        assert!((middle(laid[1].0) - middle(laid[0].0)).abs() < 6.0, "{laid:?}");
    }

    #[test]
    fn what_shows_nothing_takes_no_room() {
        let mut font = without_system_fonts(14.0);
        let plain = lay_out(&mut font, "ab");
        for letter in [
            '\0',
            '\n',
            '\t',
            '\u{7f}',
            '\u{ad}',
            '\u{200b}',
            '\u{200d}',
            '\u{202e}',
            '\u{fe0f}',
            '\u{feff}',
            '\u{e0100}',
        ] {
            assert_eq!(lay_out(&mut font, &format!("a{letter}b")), plain, "{letter:?}");
        }
        for space in [' ', '\u{a0}', '\u{2003}', '\u{3000}'] {
            let laid = lay_out(&mut font, &format!("a{space}b"));
            assert!(laid.len() == 2 && laid[1].0.at.x > plain[1].0.at.x, "{space:?}");
        }
    }

    #[test]
    fn a_thousand_letters_are_in_one_atlas() {
        let letters = many_letters();
        assert!(letters.len() >= 1000, "{}", letters.len());
        for size in [15.0, 30.0] {
            let mut font = without_system_fonts(size);
            let text: String = letters.iter().collect();
            let mut sources: Vec<_> =
                lay_out(&mut font, &text).into_iter().map(|(_, source)| source.at).collect();
            assert_eq!(sources.len(), letters.len());
            sources.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            sources.dedup();
            assert_eq!(sources.len(), letters.len(), "each has a place of its own");
        }
    }

    #[test]
    fn more_letters_than_an_atlas_holds_are_drawn_as_boxes_and_others_take_their_place() {
        let letters = many_letters();
        let all: String = letters.iter().collect();
        let mut font = Font::new(40.0, 512, |_| None);
        let laid = lay_out(&mut font, &all);
        assert_eq!(laid.len(), letters.len(), "none is left out");
        let boxed = font.missing.image.expect("a box").source;
        let boxes = laid.iter().filter(|(_, source)| *source == boxed).count();
        assert!((100..letters.len() - 50).contains(&boxes), "{boxes} boxes");

        font.atlas.take_changed();
        assert_eq!(lay_out(&mut font, &all), laid);
        assert!(font.atlas.take_changed().is_empty(), "the same texts need nothing new");

        for some in letters.chunks(40) {
            let text: String = some.iter().collect();
            let laid = lay_out(&mut font, &text);
            assert!(laid.iter().all(|(_, source)| *source != boxed), "there is room for {text}");
        }
        assert_eq!(lay_out(&mut font, &all), laid, "whatever was drawn before");
        assert_eq!(font.atlas.size(), (512, 512));
    }

    #[test]
    fn the_number_of_letters_that_are_kept_has_an_end() {
        let mut font = without_system_fonts(10.0);
        let letters: Vec<_> = ('\u{20000}'..).take(3 * Font::MAX_GLYPHS).collect();
        for some in letters.chunks(1000) {
            let text: String = some.iter().collect();
            assert_eq!(lay_out(&mut font, &text).len(), some.len());
            assert!(font.glyphs.len() <= Font::MAX_GLYPHS);
        }
        let all: String = letters.iter().collect();
        assert_eq!(lay_out(&mut font, &all).len(), letters.len());
        assert!(font.glyphs.len() <= Font::MAX_GLYPHS);
    }

    #[test]
    fn any_size_has_letters() {
        for size in [0.1, 1.0, 300.0, 1e4, f32::MAX] {
            let mut font = without_system_fonts(size);
            assert_eq!(lay_out(&mut font, "a左").len(), 2, "{size}");
        }
    }
}
