use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec3};

use super::mesh_part::{GltfMesh, MeshPart};
use super::rig::joint_spaces;
use crate::document::{Document, RigKind, Skin};
use crate::kinematics::skeleton::Skeleton;
use crate::kinematics::skin::{SkinnedMesh, VertexWeights};

impl GltfMesh {
    /// The skin of the shown skeleton; `None` without one.
    ///
    /// The mesh keeps its own space. Inverse bind matrices bring it to the joints, so that a viewer gets
    /// the vertices that linear blending gives in the program.
    pub fn of_skin(document: &Document) -> Option<Self> {
        let skin = document.skeleton_rig.skin.as_ref();
        let skin = skin.filter(|_| document.rig == RigKind::Skeleton)?;
        let mesh = &skin.mesh().ok()?.mesh;
        let metres = f64::from(document.metres_per_unit());
        Some(Self {
            parts: vec![part(skin, mesh, document.skeleton())],
            attached: attached(mesh, document.skeleton(), metres),
        })
    }
}

fn part(skin: &Skin, mesh: &SkinnedMesh, skeleton: &Skeleton) -> MeshPart {
    let triangles = mesh.mesh();
    let is_mirrored = skeleton.transform().matrix3.determinant() < 0.0;
    let indices = triangles.triangles.iter().flat_map(|[a, b, c]| match is_mirrored {
        true => [*a, *c, *b],
        false => [*a, *b, *c],
    });
    MeshPart {
        colour: skin.colour.map(|channel| (channel * 255.0).round() as u8),
        positions: triangles.positions.iter().map(Vec3::to_array).collect(),
        normals: triangles.normals.iter().map(Vec3::to_array).collect(),
        joints: mesh.weights().iter().map(VertexWeights::joints).collect(),
        weights: mesh.weights().iter().map(VertexWeights::weights).collect(),
        indices: indices.collect(),
    }
}

/// For each joint the transform from mesh space to the world that its inverse bind transform gives in the
/// bind pose of the skeleton, in metres.
fn attached(mesh: &SkinnedMesh, skeleton: &Skeleton, metres: f64) -> Vec<DAffine3> {
    let to_metres = DAffine3::from_scale(DVec3::splat(metres));
    let spaces = joint_spaces(skeleton, |_| DMat3::IDENTITY).into_iter();
    let binds = mesh.inverse_binds().iter().map(Affine3A::as_daffine3);
    spaces.zip(binds).map(|(space, bind)| to_metres * space * bind).collect()
}
