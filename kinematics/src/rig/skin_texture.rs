use core::fmt;
use std::sync::OnceLock;

/// An image on a skin, kept as the file that holds it. Most of what a program does with a skin needs no
/// pixels, and a small file can hold many of them, so they are decoded when they are first needed.
#[derive(Clone)]
pub struct SkinTexture {
    /// The content of the PNG or JPEG file that holds the image.
    pub file: Vec<u8>,
    /// Width and height in pixels, both above 0.
    pub size: [u32; 2],
    pixels: OnceLock<Result<Vec<[u8; 4]>, String>>,
}

impl SkinTexture {
    /// An image of `size`, both above 0, in a PNG or JPEG file with the content `file`.
    pub fn new(file: Vec<u8>, size: [u32; 2]) -> Self {
        Self { file, size, pixels: OnceLock::new() }
    }

    /// Pixels as sRGB with opacity, row by row from the top. The first call decodes them from the file
    /// by `decode`; later ones give the same result again.
    ///
    /// # Errors
    ///
    /// The reason that `decode` gives if the content of the file is invalid.
    pub fn pixels(
        &self,
        decode: impl FnOnce(&Self) -> Result<Vec<[u8; 4]>, String>,
    ) -> Result<&[[u8; 4]], &str> {
        let pixels = self.pixels.get_or_init(|| decode(self));
        pixels.as_deref().map_err(String::as_str)
    }
}

/// Whether two textures are the same file.
impl PartialEq for SkinTexture {
    fn eq(&self, other: &Self) -> bool {
        self.size == other.size && self.file == other.file
    }
}

impl fmt::Debug for SkinTexture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, size: [width, height], .. } = self;
        write!(f, "SkinTexture({width} × {height} pixels from {} bytes)", file.len())
    }
}
