//! Images of skins: their sizes when a file is read, their pixels when they are drawn.

use std::io::Cursor;

use image::{ImageReader, Limits};

use super::error::Remark;
use crate::document::Document;
use crate::rig::{SkinPart, SkinSource, SkinTexture};

/// Reads the images of one skin, as long as they have no more pixels in all than a skin may have.
pub struct TextureReader {
    rest: usize,
}

impl Default for TextureReader {
    fn default() -> Self {
        const MOST_PIXELS: usize = 1 << 27;
        Self { rest: MOST_PIXELS }
    }
}

impl TextureReader {
    /// Reads the size of the image in a PNG or JPEG file. Does not decode the pixels: they may need
    /// 20,000 times the size of the file. The error is the reason why the image cannot be used.
    pub fn read(&mut self, file: Vec<u8>) -> Result<SkinTexture, String> {
        let (width, height) =
            image_reader(&file)?.into_dimensions().map_err(|error| error.to_string())?;
        if width.max(height) > LONGEST {
            return Err(format!(
                "images must have sides of at most {LONGEST} pixels, got {width} × {height}"
            ));
        }
        let (rest, pixels) = (self.rest, width as usize * height as usize);
        if pixels > rest {
            return Err(format!(
                "images must have at most {rest} pixels more, got {width} × {height}"
            ));
        }
        self.rest -= pixels;
        Ok(SkinTexture::new(file, [width, height]))
    }
}

/// Width and height of the largest image.
const LONGEST: u32 = 16_384;

/// The pixels of a texture, decoded at the first call. The error is the reason why that is
/// impossible.
pub fn texture_pixels(texture: &SkinTexture) -> Result<&[[u8; 4]], &str> {
    texture.pixels(|SkinTexture { file, size, .. }| {
        let mut reader = image_reader(file)?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(LONGEST), Some(LONGEST));
        reader.limits(limits);
        let image = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
        if image.dimensions() != (*size).into() {
            return Err("the image must have the size that its header says".to_owned());
        }
        Ok(image.into_raw().as_chunks().0.to_vec())
    })
}

/// Decodes the textures of the document's skin, before they are drawn. Returns a remark for each
/// that cannot be decoded and is drawn as white.
pub fn undrawn_textures(document: &Document) -> Vec<Remark> {
    let Some(SkinSource::Mesh(skin)) = document.rig.skin.as_ref().map(|skin| &skin.source) else {
        return Vec::new();
    };
    let parts = skin.mesh().map_or(&[][..], |mesh| &mesh.parts);
    let textures = SkinPart::textures(parts).into_iter();
    let broken = textures.filter_map(|texture| texture_pixels(texture).err());
    broken.map(|reason| Remark::new(format!("a texture is drawn as white: {reason}"))).collect()
}

fn image_reader(file: &[u8]) -> Result<ImageReader<Cursor<&[u8]>>, String> {
    ImageReader::new(Cursor::new(file)).with_guessed_format().map_err(|error| error.to_string())
}
