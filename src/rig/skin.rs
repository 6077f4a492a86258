use super::attached_mesh::AttachedMesh;
use super::bone_skin::BoneSkin;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointRemap, Skeleton};
use crate::kinematics::skin::{SkinShapeError, Skinning};

/// The skin of a skeleton: a mesh that follows its joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Where the mesh comes from.
    pub source: SkinSource,
    /// How the joints of a vertex are blended.
    pub skinning: Skinning,
    /// Colour as sRGB channels from 0 to 1.
    pub colour: [f32; 3],
}

/// Where the mesh of a skin comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum SkinSource {
    /// Made from the bones of the skeleton.
    Bones(BoneSkin),
}

impl Skin {
    /// Colour of a new skin: a warm grey.
    pub const DEFAULT_COLOUR: [f32; 3] = [0.83, 0.76, 0.69];

    /// A skin from the bones of a skeleton in the default shape, with dual quaternions.
    pub fn from_bones(skeleton: &Shared<Skeleton>) -> Self {
        Self::new(SkinSource::Bones(BoneSkin::new(skeleton.clone(), Default::default())))
    }

    /// A skin in the default colour, with dual quaternions.
    pub fn new(source: SkinSource) -> Self {
        Self { source, skinning: Skinning::default(), colour: Self::DEFAULT_COLOUR }
    }

    /// The mesh. That of a skin from bones is made when it is first needed, in about ten milliseconds per
    /// thousand vertices, and then kept.
    ///
    /// # Errors
    ///
    /// [`SkinShapeError`] if no mesh can be made from the bones.
    pub fn mesh(&self) -> Result<&Shared<AttachedMesh>, SkinShapeError> {
        match &self.source {
            SkinSource::Bones(bones) => bones.mesh(),
        }
    }

    /// The mesh, if it has been needed already: see [`Skin::mesh`].
    pub fn made_mesh(&self) -> Option<Result<&Shared<AttachedMesh>, SkinShapeError>> {
        match &self.source {
            SkinSource::Bones(bones) => bones.made_mesh(),
        }
    }

    /// The skin with its mesh made again, if it is made from bones and the bind pose or the shape have
    /// changed since; otherwise `None`.
    pub(super) fn refreshed(&self, skeleton: &Shared<Skeleton>) -> Option<Self> {
        let SkinSource::Bones(bones) = &self.source;
        let source = SkinSource::Bones(bones.refreshed(skeleton)?);
        Some(Self { source, ..self.clone() })
    }

    /// The skin for a skeleton with other joint indices.
    #[must_use]
    pub(super) fn remapped(&self, remap: &JointRemap) -> Self {
        let SkinSource::Bones(bones) = &self.source;
        Self { source: SkinSource::Bones(bones.remapped(remap)), ..self.clone() }
    }
}
