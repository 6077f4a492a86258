//! Fields of a skin in a file, and conversions between these fields and a [`Skin`].

use serde::{Deserialize, Serialize};

use super::check::{fraction, joint, number};
use super::mesh_skin::MeshSkinFields;
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::{JsonNumber, JsonNumbers, JsonObject, JsonPoint, Whole};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::Skeleton;
use crate::kinematics::skin::{Blob, SkinShape, SkinShapeError, Skinning};
use crate::rig::{BoneSkin, Skin, SkinSource};

#[derive(Serialize, Deserialize)]
pub struct SkinFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    bones: Option<JsonObject<SkinShapeFields>>,
    /// The mesh of a skin that is not from bones.
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<JsonObject<MeshSkinFields>>,
    skinning: Option<Skinning>,
    colour: Option<JsonNumbers<3>>,
}

#[derive(Default, Serialize, Deserialize)]
struct SkinShapeFields {
    detail: Option<JsonNumber>,
    thickness: Option<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    blobs: Option<Vec<JsonObject<BlobFields>>>,
}

#[derive(Serialize, Deserialize)]
struct BlobFields {
    joint: Whole,
    base: JsonPoint,
    /// Without it, the blob is a sphere.
    #[serde(skip_serializing_if = "Option::is_none")]
    tip: Option<JsonPoint>,
    radius: JsonNumber,
    /// Without it, both radii are the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    tip_radius: Option<JsonNumber>,
}

impl SkinFields {
    pub fn new(skin: &Skin) -> Self {
        let (bones, mesh) = match &skin.source {
            SkinSource::Bones(bones) => (Some(SkinShapeFields::new(bones.shape())), None),
            SkinSource::Mesh(mesh) => (None, Some(MeshSkinFields::new(mesh))),
        };
        Self {
            bones: bones.map(JsonObject),
            mesh: mesh.map(JsonObject),
            skinning: Some(skin.skinning),
            colour: Some(JsonNumbers(skin.colour)),
        }
    }

    /// Converts the fields to a skin of `skeleton`. `at` is the path of the fields.
    pub fn skin(self, skeleton: &Shared<Skeleton>, at: &JsonPath) -> Result<Skin, FieldError> {
        let source = match (self.bones, self.mesh) {
            (Some(_), Some(_)) => {
                return Err(FieldError::new(at.clone(), "must not have both `bones` and `mesh`"));
            }
            (None, Some(JsonObject(mesh))) => {
                SkinSource::Mesh(mesh.skin(skeleton, &at.clone().key("mesh"))?)
            }
            (bones, None) => {
                let JsonObject(bones) = bones.unwrap_or(JsonObject(SkinShapeFields::default()));
                SkinSource::Bones(bones.skin(skeleton, &at.clone().key("bones"))?)
            }
        };
        let skin = Skin::new(source);
        let JsonNumbers(colour) = self.colour.unwrap_or(JsonNumbers(skin.colour));
        for (channel, value) in colour.into_iter().enumerate() {
            fraction(at.clone().key("colour").index(channel), value)?;
        }
        Ok(Skin { skinning: self.skinning.unwrap_or(skin.skinning), colour, ..skin })
    }
}

impl SkinShapeFields {
    fn new(shape: &SkinShape) -> Self {
        let blobs = shape.blobs.iter().map(BlobFields::new).map(JsonObject).collect();
        Self {
            detail: Some(JsonNumber(shape.detail)),
            thickness: Some(JsonNumber(shape.thickness)),
            blobs: (!shape.blobs.is_empty()).then_some(blobs),
        }
    }

    fn skin(self, skeleton: &Shared<Skeleton>, at: &JsonPath) -> Result<BoneSkin, FieldError> {
        let shape = self.shape(skeleton.joints().len(), at)?;
        shape.check(skeleton).map_err(|error| {
            let field = match &error {
                SkinShapeError::Detail(_) => at.clone().key("detail"),
                SkinShapeError::Thickness(_) => at.clone().key("thickness"),
                SkinShapeError::Blob { blob } => at.clone().key("blobs").index(*blob),
                _ => at.clone(),
            };
            FieldError::new(field, error.to_string())
        })?;
        Ok(BoneSkin::new(skeleton.clone(), shape))
    }

    fn shape(self, joints: usize, at: &JsonPath) -> Result<SkinShape, FieldError> {
        let default = SkinShape::default();
        let at_blob = |index: usize| at.clone().key("blobs").index(index);
        let blobs = self.blobs.unwrap_or_default().into_iter().enumerate();
        let blobs = blobs.map(|(index, JsonObject(blob))| blob.blob(joints, at_blob(index)));
        Ok(SkinShape {
            detail: number(self.detail, default.detail),
            thickness: number(self.thickness, default.thickness),
            blobs: blobs.collect::<Result<_, _>>()?,
        })
    }
}

impl BlobFields {
    fn new(blob: &Blob) -> Self {
        let Blob { joint, base, tip, base_radius, tip_radius } = *blob;
        Self {
            joint: Whole(u32::try_from(joint.index()).unwrap_or(u32::MAX)),
            base: JsonPoint(base),
            tip: (tip != base).then_some(JsonPoint(tip)),
            radius: JsonNumber(base_radius),
            tip_radius: (tip_radius != base_radius).then_some(JsonNumber(tip_radius)),
        }
    }

    fn blob(self, joints: usize, at: JsonPath) -> Result<Blob, FieldError> {
        let JsonPoint(base) = self.base;
        let JsonNumber(base_radius) = self.radius;
        Ok(Blob {
            joint: joint(at.key("joint"), self.joint, joints)?.into(),
            base,
            tip: self.tip.map_or(base, |JsonPoint(tip)| tip),
            base_radius,
            tip_radius: number(self.tip_radius, base_radius),
        })
    }
}
