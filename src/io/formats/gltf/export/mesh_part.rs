use glam::DAffine3;

use crate::kinematics::Shared;
use crate::rig::SkinTexture;

/// The mesh of an exported rig.
pub struct RigMesh {
    /// One part for each material.
    pub parts: Vec<MeshPart>,
    /// For each joint the transform from the mesh to the world in the bind pose, in metres; identity for
    /// joints beyond the list.
    pub attached: Vec<DAffine3>,
}

/// Triangles of one material.
#[derive(Default)]
pub struct MeshPart {
    /// Colour as sRGB channels from 0 to 1.
    pub colour: [f32; 3],
    /// Image that multiplies the colour.
    pub texture: Option<Shared<SkinTexture>>,
    /// Texture coordinates; empty without a texture.
    pub coordinates: Vec<[f32; 2]>,
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    /// The four joints that each vertex follows.
    pub joints: Vec<[u16; 4]>,
    /// Their weights, with the sum 1.
    pub weights: Vec<[f32; 4]>,
    /// Indices of three vertices for each triangle, counter-clockwise seen from outside.
    pub indices: Vec<u32>,
}
