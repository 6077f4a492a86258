use ab_glyph::{Font as _, FontRef, GlyphId, PxScale, ScaleFont as _};
use glam::Vec2;

/// The letters that labels are written with, drawn once at one size.
#[derive(Debug)]
pub(super) struct Font {
    /// Coverage, row by row, [`Self::WIDTH`] wide.
    pub pixels: Vec<u8>,
    pub height: u32,
    font: FontRef<'static>,
    size: PxScale,
    glyphs: Vec<Option<Glyph>>,
}

/// Where a letter is in the atlas, and where it stands beside the pen.
#[derive(Clone, Copy, Debug)]
struct Glyph {
    source: Rectangle,
    from_pen: Vec2,
}

/// In pixels, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub at: Vec2,
    pub size: Vec2,
}

impl Font {
    pub const WIDTH: u32 = 512;
    const ASCII: core::ops::RangeInclusive<char> = ' '..='~';
    /// What labels have besides.
    const SIGNS: [char; 3] = ['°', '·', '−'];
    /// Between letters, so that none bleeds into its neighbour.
    const GAP: u32 = 1;

    /// `size` is the height of a line in pixels.
    pub fn new(size: f32) -> Self {
        let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT)
            .unwrap_or_else(|_| unreachable!("the font in the program is a font"));
        let mut drawn =
            Self { pixels: Vec::new(), height: 0, font, size: size.into(), glyphs: Vec::new() };
        let mut pen = (Self::GAP, Self::GAP);
        let mut row_height = 0;
        for letter in Self::letters() {
            let glyph = drawn.font.glyph_id(letter).with_scale(drawn.size);
            let Some(outline) = drawn.font.outline_glyph(glyph) else {
                drawn.glyphs.push(None);
                continue;
            };
            let bounds = outline.px_bounds();
            let (width, height) = (bounds.width() as u32, bounds.height() as u32);
            if pen.0 + width + Self::GAP > Self::WIDTH {
                pen = (Self::GAP, pen.1 + row_height + Self::GAP);
                row_height = 0;
            }
            row_height = row_height.max(height);
            drawn.height = drawn.height.max(pen.1 + height + Self::GAP);
            drawn.pixels.resize((Self::WIDTH * drawn.height) as usize, 0);
            outline.draw(|x, y, cover| {
                let index = (pen.1 + y) * Self::WIDTH + pen.0 + x;
                drawn.pixels[index as usize] = (cover.clamp(0.0, 1.0) * 255.0).round() as u8;
            });
            drawn.glyphs.push(Some(Glyph {
                source: Rectangle {
                    at: Vec2::new(pen.0 as f32, pen.1 as f32),
                    size: Vec2::new(width as f32, height as f32),
                },
                from_pen: Vec2::new(bounds.min.x, bounds.min.y),
            }));
            pen.0 += width + Self::GAP;
        }
        drawn
    }

    fn letters() -> impl Iterator<Item = char> {
        Self::ASCII.chain(Self::SIGNS)
    }

    fn index(letter: char) -> Option<usize> {
        if Self::ASCII.contains(&letter) {
            return Some(letter as usize - *Self::ASCII.start() as usize);
        }
        let sign = Self::SIGNS.iter().position(|sign| *sign == letter)?;
        Some(Self::ASCII.count() + sign)
    }

    /// The letters of a text whose baseline starts at `pen`: where each stands, and its source.
    pub fn lay_out<'a>(
        &'a self,
        text: &'a str,
        mut pen: Vec2,
    ) -> impl Iterator<Item = (Rectangle, Rectangle)> + use<'a> {
        let scaled = self.font.as_scaled(self.size);
        let mut last: Option<GlyphId> = None;
        text.chars().filter_map(move |letter| {
            let id = self.font.glyph_id(letter);
            pen.x += last.map_or(0.0, |last| scaled.kern(last, id));
            last = Some(id);
            let start = pen.round();
            pen.x += scaled.h_advance(id);
            let glyph = (*self.glyphs.get(Self::index(letter)?)?)?;
            let stands = Rectangle { at: start + glyph.from_pen, size: glyph.source.size };
            Some((stands, glyph.source))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_of_a_label_is_drawn_inside_the_atlas() {
        for size in [9.0, 14.0, 28.0, 64.0] {
            let font = Font::new(size);
            let text: String = Font::letters().filter(|letter| *letter != ' ').collect();
            let laid: Vec<_> = font.lay_out(&text, Vec2::ZERO).collect();
            assert_eq!(laid.len(), text.chars().count());
            for (_, source) in laid {
                let end = source.at + source.size;
                assert!(end.x <= Font::WIDTH as f32 && end.y <= font.height as f32);
            }
            assert_eq!(font.pixels.len(), (Font::WIDTH * font.height) as usize);
        }
    }

    #[test]
    fn letters_outside_the_alphabet_take_room_and_draw_nothing() {
        let font = Font::new(14.0);
        let end = |text| font.lay_out(text, Vec2::ZERO).last().map(|(stands, _)| stands.at.x);
        assert!(end("a\u{4e00}b") > end("ab"));
    }
}
