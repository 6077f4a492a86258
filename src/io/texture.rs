//! Decodes the images of skins.

use std::io::Cursor;

use crate::rig::SkinTexture;

/// Decodes a PNG or JPEG file of at most `most` pixels. The error is the reason why that is impossible.
pub fn decoded(file: Vec<u8>, most: usize) -> Result<SkinTexture, String> {
    /// Width and height of the largest image that is decoded.
    const MOST_PIXELS: u32 = 16_384;
    let sized = image::ImageReader::new(Cursor::new(&file));
    let (width, height) = sized
        .with_guessed_format()
        .map_err(|error| error.to_string())?
        .into_dimensions()
        .map_err(|error| error.to_string())?;
    if width as usize * height as usize > most {
        return Err(format!("images must have at most {most} pixels more, got {width} × {height}"));
    }
    let mut reader = image::ImageReader::new(Cursor::new(&file))
        .with_guessed_format()
        .map_err(|error| error.to_string())?;
    let mut limits = image::Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST_PIXELS), Some(MOST_PIXELS));
    reader.limits(limits);
    let image = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
    let size = image.dimensions().into();
    let pixels = image.into_raw().as_chunks().0.to_vec();
    Ok(SkinTexture { file, size, pixels })
}
