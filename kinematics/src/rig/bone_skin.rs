use std::sync::{Arc, OnceLock};

use super::attached_mesh::AttachedMesh;
use crate::Shared;
use crate::skeleton::{Joint, JointRemap, Skeleton};
use crate::skin::{Blob, SkinShape, SkinShapeError, SkinnedMesh};

/// A skin from the bones of a skeleton. Its mesh follows from the bind pose and the shape; it is made when
/// it is first needed, and clones share it.
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

    /// What it is made of beside the bones.
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
        let moved = |blob: &Blob| remap.get(blob.joint).map(|joint| Blob { joint, ..*blob });
        let blobs = self.shape.blobs.iter().filter_map(moved).collect();
        self.with_shape(SkinShape { blobs, ..self.shape.clone() })
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
