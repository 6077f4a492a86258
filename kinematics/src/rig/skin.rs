use std::sync::{Arc, OnceLock};

use thiserror::Error;

use super::mesh_skin::{AttachedMesh, MeshSkin, SkinFile, SkinFileError};
use crate::Shared;
use crate::skeleton::{Joint, JointRemap, Skeleton};
use crate::skin::{Blob, SkinShape, SkinShapeError, SkinnedMesh, Skinning};

/// The skin of a skeleton: a mesh that follows its joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Where the mesh comes from.
    pub source: SkinSource,
    /// The way of blending the joints of a vertex.
    pub skinning: Skinning,
    /// Colour as sRGB channels from 0 to 1. For a mesh from a file, it multiplies the file's
    /// colours.
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

    /// A skin from the bones of a skeleton in the default shape, with dual quaternions. It is made in
    /// the bind pose or, if bones overlap there, in the pose that the skeleton has.
    pub fn from_bones(skeleton: &Shared<Skeleton>) -> Self {
        let shape = SkinShape::default().with_bones_apart(skeleton);
        Self::new(SkinSource::Bones(BoneSkin::new(skeleton.clone(), shape)))
    }

    /// A skin from bones in the default colour with dual quaternions, or a mesh in the colours of
    /// its file with linear blending, which most programs have.
    pub fn new(source: SkinSource) -> Self {
        let (skinning, colour) = match &source {
            SkinSource::Bones(_) => (Skinning::default(), Self::DEFAULT_COLOUR),
            SkinSource::Mesh(_) => (Skinning::Linear, [1.0; 3]),
        };
        Self { source, skinning, colour }
    }

    /// The mesh. That of a skin from bones is made when it is first needed, in about ten
    /// milliseconds per thousand vertices, and then kept.
    ///
    /// # Errors
    ///
    /// [`SkinMeshError`] if no mesh can be made from the bones, or the file of the mesh cannot be
    /// read.
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

    /// The skin's mesh, if it is imported; `None` for a skin from bones.
    pub fn mesh_skin(&self) -> Option<&MeshSkin> {
        match &self.source {
            SkinSource::Bones(_) => None,
            SkinSource::Mesh(mesh) => Some(mesh),
        }
    }

    /// True if the mesh of the skin is from the file `before`, and follows the same joints as
    /// `mesh`.
    pub fn can_become(&self, mesh: &MeshSkin, before: Option<&SkinFile>) -> bool {
        let SkinSource::Mesh(own) = &self.source else { return false };
        own.joints() == mesh.joints() && own.file() == before
    }

    /// The skin with its mesh made or measured again, if the bones, or the shape of a skin from
    /// bones, have changed since; otherwise `None`.
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

/// A skin from the bones of a skeleton. Its mesh follows from the bind pose and the shape; it is
/// made when it is first needed, and clones share it.
#[derive(Clone, Debug)]
pub struct BoneSkin {
    shape: SkinShape,
    made: Arc<MadeMesh>,
}

/// A mesh with what it is made from.
#[derive(Debug)]
struct MadeMesh {
    shape: SkinShape,
    skeleton: Shared<Skeleton>,
    mesh: OnceLock<Result<Shared<AttachedMesh>, SkinShapeError>>,
}

impl BoneSkin {
    /// A skin for the bind pose of a skeleton.
    pub fn new(skeleton: Shared<Skeleton>, shape: SkinShape) -> Self {
        let made = MadeMesh { shape: shape.clone(), skeleton, mesh: OnceLock::new() };
        Self { shape, made: Arc::new(made) }
    }

    /// Its parameters beside the bones.
    pub fn shape(&self) -> &SkinShape {
        &self.shape
    }

    /// The same bones in another shape. The mesh stays until it is refreshed.
    #[must_use]
    pub fn with_shape(&self, shape: SkinShape) -> Self {
        Self { shape, made: Arc::clone(&self.made) }
    }

    /// The mesh.
    ///
    /// # Errors
    ///
    /// See [`SkinnedMesh::from_bones`].
    pub fn mesh(&self) -> Result<&Shared<AttachedMesh>, SkinShapeError> {
        let MadeMesh { shape, skeleton, mesh } = &*self.made;
        let make = || {
            let mesh = SkinnedMesh::from_bones(skeleton, shape)?;
            Ok(Shared::from(AttachedMesh::new(mesh, Vec::new(), skeleton)))
        };
        mesh.get_or_init(make).as_ref().map_err(Clone::clone)
    }

    /// The mesh, if it has been needed already.
    pub fn made_mesh(&self) -> Option<Result<&Shared<AttachedMesh>, SkinShapeError>> {
        Some(self.made.mesh.get()?.as_ref().map_err(Clone::clone))
    }

    pub(super) fn refreshed(&self, skeleton: &Shared<Skeleton>) -> Option<Self> {
        let MadeMesh { shape, skeleton: made_for, .. } = &*self.made;
        let is_current = self.shape == *shape && has_same_bind_pose(made_for, skeleton);
        (!is_current).then(|| Self::new(skeleton.clone(), self.shape.clone()))
    }

    pub(super) fn remapped(&self, remap: &JointRemap) -> Self {
        let moved = |blob: &Blob| remap.get(blob.joint).map(|joint| Blob { joint, ..blob.clone() });
        let blobs = self.shape.blobs.iter().filter_map(moved).collect();
        let pose = self.shape.pose.iter();
        let pose = pose.filter_map(|(joint, angles)| Some((remap.get(*joint)?, *angles)));
        let pose = pose.collect();
        self.with_shape(SkinShape { blobs, pose, ..self.shape.clone() })
    }
}

/// The mesh follows from bind pose and shape, and the skeleton from the rig that has the skin.
impl PartialEq for BoneSkin {
    fn eq(&self, other: &Self) -> bool {
        self.shape == other.shape
    }
}

fn has_same_bind_pose(one: &Shared<Skeleton>, other: &Shared<Skeleton>) -> bool {
    let is_same = |(one, other): (&Shared<Joint>, &Shared<Joint>)| {
        one.is_same(other)
            || one.parent == other.parent
                && one.offset == other.offset
                && one.axis == other.axis
                && one.radius == other.radius
    };
    let (one, other) = (one.joints(), other.joints());
    one.len() == other.len() && one.iter().zip(other).all(is_same)
}
