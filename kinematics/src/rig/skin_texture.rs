use core::fmt;

/// An image on a skin.
#[derive(Clone, PartialEq)]
pub struct SkinTexture {
    /// The content of the PNG or JPEG file that holds the image.
    pub file: Vec<u8>,
    /// Width and height in pixels, both above 0.
    pub size: [u32; 2],
    /// Pixels as sRGB with opacity, row by row from the top.
    pub pixels: Vec<[u8; 4]>,
}

impl fmt::Debug for SkinTexture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, size: [width, height], .. } = self;
        write!(f, "SkinTexture({width} × {height} pixels from {} bytes)", file.len())
    }
}
