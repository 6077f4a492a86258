//! Decodes the images of skins.

use std::io::{BufRead, Cursor, Seek};

use image::{ImageReader, Limits};

use crate::rig::SkinTexture;

/// Decodes the images of one skin, as long as they have no more pixels in all than a skin may have.
pub struct TextureDecoder {
    rest: usize,
}

impl Default for TextureDecoder {
    fn default() -> Self {
        const MOST_PIXELS: usize = 1 << 27;
        Self { rest: MOST_PIXELS }
    }
}

impl TextureDecoder {
    /// Decodes a PNG or JPEG file. The error is the reason why that is impossible.
    pub fn decode(&mut self, file: Vec<u8>) -> Result<SkinTexture, String> {
        /// Width and height of the largest image that is decoded.
        const LONGEST: u32 = 16_384;
        let (width, height) =
            reader(Cursor::new(&file))?.into_dimensions().map_err(|error| error.to_string())?;
        let (rest, pixels) = (self.rest, width as usize * height as usize);
        if pixels > rest {
            return Err(format!(
                "images must have at most {rest} pixels more, got {width} × {height}"
            ));
        }
        let mut reader = reader(Cursor::new(&file))?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(LONGEST), Some(LONGEST));
        reader.limits(limits);
        let image = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
        self.rest -= pixels;
        let size = image.dimensions().into();
        let pixels = image.into_raw().as_chunks().0.to_vec();
        Ok(SkinTexture { file, size, pixels })
    }
}

fn reader<R: BufRead + Seek>(file: R) -> Result<ImageReader<R>, String> {
    ImageReader::new(file).with_guessed_format().map_err(|error| error.to_string())
}
