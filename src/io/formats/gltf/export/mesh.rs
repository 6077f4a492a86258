//! The mesh of an exported rig: parts of one material each, and the parts of a skin.

use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec2};

use super::rig::joint_spaces;
use crate::document::{Document, RigKind, Skin};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::Skeleton;
use crate::kinematics::skin::{SkinnedMesh, TriangleMesh, VertexWeights};
use crate::rig::{AttachedMesh, SkinPart, SkinTexture};

/// The mesh of an exported rig.
pub struct RigMesh {
    /// One part for each material.
    pub parts: Vec<MeshPart>,
    /// For each joint the transform from the mesh to the world in the bind pose, in metres;
    /// identity for joints beyond the list.
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

impl RigMesh {
    /// The skin of the shown skeleton; `None` without one that has triangles.
    ///
    /// The mesh keeps its own space. Inverse bind matrices bring it to the joints, so that a viewer
    /// gets the vertices that linear blending gives in the program.
    pub fn of_skin(document: &Document) -> Option<Self> {
        let skin = document.skeleton_rig.skin.as_ref();
        let skin = skin.filter(|_| document.rig == RigKind::Skeleton)?;
        let mesh = skin.mesh().ok().filter(|mesh| !mesh.mesh.mesh().triangles.is_empty())?;
        let metres = f64::from(document.metres_per_unit());
        Some(Self {
            parts: parts(skin, mesh, document.skeleton()),
            attached: attached(&mesh.mesh, document.skeleton(), metres),
        })
    }
}

/// The parts of a skin, each with its own vertices in the order of the mesh.
fn parts(skin: &Skin, mesh: &AttachedMesh, skeleton: &Skeleton) -> Vec<MeshPart> {
    let is_mirrored = skeleton.transform().matrix3.determinant() < 0.0;
    let mut rest = &mesh.mesh.mesh().triangles[..];
    let part = |part: &SkinPart| {
        let (triangles, others) = rest.split_at(part.triangles.min(rest.len()));
        rest = others;
        let colour = std::array::from_fn(|channel| skin.colour[channel] * part.colour[channel]);
        let corners = triangles
            .iter()
            .flat_map(|[a, b, c]| if is_mirrored { [*a, *c, *b] } else { [*a, *b, *c] });
        MeshPart {
            colour,
            texture: part.texture.clone(),
            ..of_corners(&mesh.mesh, &corners.collect::<Vec<_>>(), part.texture.is_some())
        }
    };
    mesh.parts.iter().map(part).collect()
}

/// The triangles with these corners, and the vertices that they have.
fn of_corners(mesh: &SkinnedMesh, corners: &[u32], has_texture: bool) -> MeshPart {
    let TriangleMesh { positions, normals, texture_coordinates, .. } = mesh.mesh();
    let mut places: Vec<Option<u32>> = vec![None; positions.len()];
    corners.iter().for_each(|corner| places[*corner as usize] = Some(0));
    let vertices: Vec<usize> = (0..places.len()).filter(|at| places[*at].is_some()).collect();
    for (place, vertex) in vertices.iter().enumerate() {
        places[*vertex] = Some(place as u32);
    }
    let weights = || vertices.iter().map(|vertex| &mesh.weights()[*vertex]);
    let coordinates = vertices.iter().filter_map(|vertex| texture_coordinates.get(*vertex));
    MeshPart {
        positions: vertices.iter().map(|vertex| positions[*vertex].to_array()).collect(),
        normals: vertices.iter().map(|vertex| normals[*vertex].to_array()).collect(),
        joints: weights().map(VertexWeights::joints).collect(),
        weights: weights().map(VertexWeights::weights).collect(),
        coordinates: coordinates.filter(|_| has_texture).map(Vec2::to_array).collect(),
        indices: corners.iter().filter_map(|corner| places[*corner as usize]).collect(),
        ..MeshPart::default()
    }
}

/// For each joint the transform from mesh space to the world that its inverse bind transform gives
/// in the bind pose of the skeleton, in metres.
fn attached(mesh: &SkinnedMesh, skeleton: &Skeleton, metres: f64) -> Vec<DAffine3> {
    let to_metres = DAffine3::from_scale(DVec3::splat(metres));
    let spaces = joint_spaces(skeleton, |_| DMat3::IDENTITY).into_iter();
    let binds = mesh.inverse_binds().iter().map(Affine3A::as_daffine3);
    spaces.zip(binds).map(|(space, bind)| to_metres * space * bind).collect()
}
