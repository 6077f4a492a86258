use ab_glyph::{Font as _, FontRef, GlyphId, OutlinedGlyph, PxScale};

/// A face of a font at one size.
#[derive(Debug)]
pub(super) struct FontFace {
    /// Number of the system's face; `None` for a built-in font.
    pub number: Option<u16>,
    pub font: FontRef<'static>,
    pub scale: PxScale,
}

impl FontFace {
    pub fn new(number: Option<u16>, font: FontRef<'static>, pixels_per_em: f32) -> Self {
        let height = font.height_unscaled();
        let units = font.units_per_em().unwrap_or(height);
        let scale = PxScale::from(pixels_per_em * height / units);
        Self { number, font, scale }
    }

    /// Outline of a letter; `None` if the face does not have the letter or its outline.
    pub fn outline(&self, letter: char) -> Option<OutlinedGlyph> {
        let id = self.font.glyph_id(letter);
        if id == GlyphId(0) {
            return None;
        }
        self.font.outline_glyph(id.with_scale(self.scale))
    }
}
