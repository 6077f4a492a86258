use thiserror::Error;

use super::attached_mesh::AttachedMesh;
use super::bone_skin::BoneSkin;
use super::mesh_skin::{MeshSkin, SkinFile, SkinFileError};
use crate::Shared;
use crate::skeleton::{JointRemap, Skeleton};
use crate::skin::{SkinShapeError, Skinning};

/// The skin of a skeleton: a mesh that follows its joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Where the mesh comes from.
    pub source: SkinSource,
    /// How the joints of a vertex are blended.
    pub skinning: Skinning,
    /// Colour as sRGB channels from 0 to 1. For a mesh from a file, it multiplies the file's colours.
    pub colour: [f32; 3],
}

/// Where the mesh of a skin comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum SkinSource {
    /// Made from the bones of the skeleton.
    Bones(BoneSkin),
    /// From a file of another program.
    Mesh(MeshSkin),
}

/// The reason why a skin has no mesh.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SkinMeshError {
    /// No mesh can be made from the bones.
    #[error(transparent)]
    Shape(#[from] SkinShapeError),
    /// The file of the mesh cannot be read.
    #[error(transparent)]
    File(#[from] SkinFileError),
}

impl Skin {
    /// Colour of a new skin: a warm grey.
    pub const DEFAULT_COLOUR: [f32; 3] = [0.83, 0.76, 0.69];

    /// A skin from the bones of a skeleton in the default shape, with dual quaternions.
    pub fn from_bones(skeleton: &Shared<Skeleton>) -> Self {
        Self::new(SkinSource::Bones(BoneSkin::new(skeleton.clone(), Default::default())))
    }

    /// A skin from bones in the default colour with dual quaternions, or a mesh in the colours of its file
    /// with linear blending, which most programs have.
    pub fn new(source: SkinSource) -> Self {
        let (skinning, colour) = match &source {
            SkinSource::Bones(_) => (Skinning::default(), Self::DEFAULT_COLOUR),
            SkinSource::Mesh(_) => (Skinning::Linear, [1.0; 3]),
        };
        Self { source, skinning, colour }
    }

    /// The mesh. That of a skin from bones is made when it is first needed, in about ten milliseconds per
    /// thousand vertices, and then kept.
    ///
    /// # Errors
    ///
    /// [`SkinMeshError`] if no mesh can be made from the bones, or the file of the mesh cannot be read.
    pub fn mesh(&self) -> Result<&Shared<AttachedMesh>, SkinMeshError> {
        Ok(match &self.source {
            SkinSource::Bones(bones) => bones.mesh()?,
            SkinSource::Mesh(mesh) => mesh.mesh()?,
        })
    }

    /// The mesh, if it has been needed already: see [`Skin::mesh`].
    pub fn made_mesh(&self) -> Option<Result<&Shared<AttachedMesh>, SkinMeshError>> {
        match &self.source {
            SkinSource::Bones(bones) => bones.made_mesh().map(|made| made.map_err(Into::into)),
            SkinSource::Mesh(_) => Some(self.mesh()),
        }
    }

    /// The mesh, if it is from a file.
    pub(super) fn file_mesh(&self) -> Option<&AttachedMesh> {
        match &self.source {
            SkinSource::Bones(_) => None,
            SkinSource::Mesh(mesh) => mesh.mesh().ok().map(|mesh| &**mesh),
        }
    }

    /// Whether the mesh of the skin is from the file `before`, and follows the same joints as `mesh`.
    pub fn can_become(&self, mesh: &MeshSkin, before: Option<&SkinFile>) -> bool {
        let SkinSource::Mesh(own) = &self.source else { return false };
        own.joints() == mesh.joints() && own.file() == before
    }

    /// The skin with its mesh made or measured again, if the bones, or the shape of a skin from bones, have
    /// changed since; otherwise `None`.
    pub(super) fn refreshed(&self, skeleton: &Shared<Skeleton>) -> Option<Self> {
        let source = match &self.source {
            SkinSource::Bones(bones) => SkinSource::Bones(bones.refreshed(skeleton)?),
            SkinSource::Mesh(mesh) => SkinSource::Mesh(mesh.refreshed(skeleton)?),
        };
        Some(Self { source, ..self.clone() })
    }

    /// The skin for a skeleton with other joint indices.
    #[must_use]
    pub(super) fn remapped(&self, remap: &JointRemap, skeleton: &Skeleton) -> Self {
        let source = match &self.source {
            SkinSource::Bones(bones) => SkinSource::Bones(bones.remapped(remap)),
            SkinSource::Mesh(mesh) => SkinSource::Mesh(mesh.remapped(remap, skeleton)),
        };
        Self { source, ..self.clone() }
    }
}
