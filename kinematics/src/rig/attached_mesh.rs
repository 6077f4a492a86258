use core::fmt;
use std::sync::OnceLock;

use glam::Vec3;

use crate::Shared;
use crate::skeleton::{JointId, Skeleton, SkeletonPose};
use crate::skin::SkinnedMesh;

/// A skinned mesh on the joints of a skeleton, with its materials and its thickness around each bone.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachedMesh {
    /// The mesh.
    pub mesh: SkinnedMesh,
    /// The parts of the mesh in the order of its triangles, one after the other.
    pub parts: Vec<SkinPart>,
    /// For each joint, how thick the mesh is around its bone: the mean distance from the bone to the vertices
    /// whose greatest weight is this joint's, in skeleton units; 0 for a joint without such vertices.
    pub radii: Vec<f32>,
    /// For each joint, the box around those vertices in the joint's own space in the bind pose: its lowest and its
    /// highest corner; `None` for a joint without such vertices.
    pub boxes: Vec<Option<[Vec3; 2]>>,
    /// The bones on which the thickness was measured: the axis of each joint.
    axes: Vec<Vec3>,
}

impl AttachedMesh {
    /// Measures the thickness of a mesh around the bones of its skeleton. Triangles after the last of `parts`
    /// become a white part.
    pub fn new(mesh: SkinnedMesh, mut parts: Vec<SkinPart>, skeleton: &Skeleton) -> Self {
        let listed: usize = parts.iter().map(|part| part.triangles).sum();
        let rest = mesh.mesh().triangles.len().saturating_sub(listed);
        if rest > 0 {
            parts.push(SkinPart { triangles: rest, colour: [1.0; 3], texture: None });
        }
        let mut sums = vec![(0.0_f64, 0_u32); skeleton.joints().len()];
        let mut boxes = vec![None; sums.len()];
        for (position, weights) in mesh.mesh().positions.iter().zip(mesh.weights()) {
            let joint = weights.first();
            if let (Some(bone), Some(bind)) =
                (skeleton.joint(joint), mesh.inverse_binds().get(joint.index()))
            {
                let at = bind.transform_point3(*position);
                let distance = bone.distance(at);
                // Numbers near the limit of f32 overflow.
                if !distance.is_finite() {
                    continue;
                }
                let (sum, count) = &mut sums[joint.index()];
                *sum += f64::from(distance);
                *count += 1;
                let [low, high] = boxes[joint.index()].get_or_insert([at, at]);
                (*low, *high) = (low.min(at), high.max(at));
            }
        }
        let mean = |(sum, count): (f64, u32)| (sum / f64::from(count.max(1))) as f32;
        let axes = skeleton.joints().iter().map(|joint| joint.axis).collect();
        Self { mesh, parts, radii: sums.into_iter().map(mean).collect(), boxes, axes }
    }

    /// True if the mesh was measured on joints with the bones of this skeleton.
    pub(super) fn is_measured_on(&self, skeleton: &Skeleton) -> bool {
        skeleton.joints().iter().map(|joint| joint.axis).eq(self.axes.iter().copied())
    }

    /// The corners of boxes in the world that contain nearly all of the mesh in a pose.
    pub fn corners(&self, pose: &SkeletonPose) -> impl Iterator<Item = Vec3> {
        let corners = move |(joint, bounds): (usize, &Option<[Vec3; 2]>)| {
            let ends = (*bounds)?;
            let to_world = pose.full(JointId::new(joint));
            let end = move |corner: usize, axis: usize| ends[corner >> axis & 1][axis];
            let corner = move |at: usize| Vec3::from_array([end(at, 0), end(at, 1), end(at, 2)]);
            Some((0..8).map(move |at| to_world.transform_point3(corner(at))))
        };
        self.boxes.iter().enumerate().filter_map(corners).flatten()
    }
}

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

impl SkinPart {
    /// The textures of parts, each once, in the order of the parts that have them first.
    pub fn textures(parts: &[Self]) -> Vec<&Shared<SkinTexture>> {
        let mut textures: Vec<&Shared<SkinTexture>> = Vec::new();
        for texture in parts.iter().filter_map(|part| part.texture.as_ref()) {
            if !textures.iter().any(|known| known.is_same(texture)) {
                textures.push(texture);
            }
        }
        textures
    }
}

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

/// True if two textures are the same file.
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
