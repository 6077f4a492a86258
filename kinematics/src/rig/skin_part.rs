use super::skin_texture::SkinTexture;
use crate::Shared;

/// Triangles of a skin with the same material.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinPart {
    /// Number of triangles.
    pub triangles: usize,
    /// Colour as sRGB channels from 0 to 1. It multiplies the texture and the colour of the skin.
    pub colour: [f32; 3],
    /// Image that colours the triangles by the mesh's texture coordinates, repeated beyond 0 to 1.
    pub texture: Option<Shared<SkinTexture>>,
}
