//! Fields of a skin in a file, and conversions between these fields and a [`Skin`].

use std::path::PathBuf;

use glam::{Affine3A, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::check::{fraction, joint, number};
use crate::io::json::{
    FieldError, JsonNumber, JsonNumbers, JsonObject, JsonPath, JsonPoint, Whole,
};
use crate::io::packed;
use crate::io::texture::TextureReader;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::skin::{
    Blob, SkinShape, SkinShapeError, SkinnedMesh, Skinning, TriangleMesh, VertexWeights,
};
use crate::rig::{
    BoneSkin, FileMesh, MeshSkin, Skin, SkinFile, SkinFileError, SkinPart, SkinSource, SkinTexture,
};

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

#[derive(Serialize, Deserialize)]
pub struct MeshSkinFields {
    /// Path of the file; without it, `packed` has the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    checksum: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    skeleton: Option<String>,
    joints: Vec<Option<Whole>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    packed: Option<JsonObject<FileMeshFields>>,
}

#[derive(Serialize, Deserialize)]
struct FileMeshFields {
    parents: Vec<Option<Whole>>,
    inverse_binds: Bytes,
    positions: Bytes,
    normals: Bytes,
    #[serde(skip_serializing_if = "Option::is_none")]
    texture_coordinates: Option<Bytes>,
    triangles: Bytes,
    vertex_joints: Bytes,
    vertex_weights: Bytes,
    parts: Vec<JsonObject<SkinPartFields>>,
    /// PNG or JPEG files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    textures: Vec<Bytes>,
}

#[derive(Serialize, Deserialize)]
struct SkinPartFields {
    triangles: Whole,
    colour: JsonNumbers<3>,
    /// Index in the list of textures.
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<Whole>,
}

/// Bytes in base64.
#[derive(Serialize, Deserialize)]
#[serde(transparent)]
struct Bytes(String);

impl Bytes {
    fn of_floats(numbers: impl IntoIterator<Item = f32>) -> Self {
        Self::new(numbers.into_iter().flat_map(f32::to_le_bytes))
    }

    fn new(bytes: impl IntoIterator<Item = u8>) -> Self {
        Self(packed::encode_base64(&bytes.into_iter().collect::<Vec<u8>>()))
    }

    fn decoded(&self, at: &JsonPath) -> Result<Vec<u8>, FieldError> {
        packed::decode_base64(&self.0).map_err(|reason| FieldError::new(at.clone(), reason))
    }

    /// Rows of `N` floats.
    fn floats<const N: usize>(&self, at: &JsonPath) -> Result<Vec<[f32; N]>, FieldError> {
        let bytes = self.decoded(at)?;
        let (row, got) = (4 * N, bytes.len());
        if got % row != 0 {
            let reason = format!("must have a multiple of {row} bytes, got {got}");
            return Err(FieldError::new(at.clone(), reason));
        }
        Ok(packed::floats(&bytes).as_chunks().0.to_vec())
    }

    fn vectors(&self, at: &JsonPath) -> Result<Vec<Vec3>, FieldError> {
        Ok(self.floats(at)?.into_iter().map(Vec3::from_array).collect())
    }
}

fn whole(number: usize) -> Whole {
    Whole(u32::try_from(number).unwrap_or(u32::MAX))
}

fn wholes(joints: &[Option<JointId>]) -> Vec<Option<Whole>> {
    joints.iter().map(|joint| joint.map(|joint| whole(joint.index()))).collect()
}

impl MeshSkinFields {
    pub fn new(skin: &MeshSkin) -> Self {
        let file = skin.file();
        let packed = skin.in_file().filter(|_| file.is_none());
        Self {
            file: file.map(|file| portable(&file.path)),
            checksum: file.map(|file| Whole(file.checksum)),
            skeleton: file.map(|file| file.skeleton.clone()),
            joints: wholes(skin.joints()),
            packed: packed.map(|mesh| JsonObject(FileMeshFields::new(mesh))),
        }
    }

    /// Converts the fields to a skin of `skeleton`. `at` is their path. The file of a skin that has
    /// one is still to be read.
    pub fn skin(self, skeleton: &Skeleton, at: &JsonPath) -> Result<MeshSkin, FieldError> {
        let count = skeleton.joints().len();
        let at_joint = |index| at.clone().key("joints").index(index);
        let joints = self.joints.into_iter().enumerate().map(|(index, number)| {
            let number = number.map(|number| joint(at_joint(index), number, count));
            Ok(number.transpose()?.map(JointId::new))
        });
        let joints: Vec<Option<JointId>> = joints.collect::<Result<_, FieldError>>()?;
        match (self.file, self.packed) {
            (Some(path), None) => {
                let file = SkinFile {
                    path: PathBuf::from(path),
                    checksum: self.checksum.map_or(0, |checksum| checksum.0),
                    skeleton: self.skeleton.unwrap_or_default(),
                };
                let missing = SkinFileError::Missing(file.path.clone());
                Ok(MeshSkin::without_mesh(file, joints, missing))
            }
            (None, Some(JsonObject(packed))) => {
                let mesh = packed.mesh(&at.clone().key("packed"))?;
                if mesh.parents.len() != joints.len() {
                    let (expected, got) = (mesh.parents.len(), joints.len());
                    let reason = format!("must have {expected} entries, as `parents`, got {got}");
                    return Err(FieldError::new(at.clone().key("joints"), reason));
                }
                Ok(MeshSkin::new(mesh.into(), None, joints, skeleton))
            }
            _ => Err(FieldError::new(at.clone(), "must have either `file` or `packed`")),
        }
    }
}

/// A path with `/` between its parts, as on all systems.
fn portable(path: &std::path::Path) -> String {
    let text = path.to_string_lossy();
    if path.is_relative() { text.replace('\\', "/") } else { text.into_owned() }
}

impl FileMeshFields {
    fn new(mesh: &FileMesh) -> Self {
        let FileMesh { mesh, parents, parts } = mesh;
        let triangles = mesh.mesh();
        let points = |points: &[Vec3]| Bytes::of_floats(points.iter().flat_map(Vec3::to_array));
        let coordinates = &triangles.texture_coordinates;
        let weights = || mesh.weights().iter();
        let textures = SkinPart::textures(parts);
        Self {
            parents: wholes(parents),
            inverse_binds: Bytes::of_floats(
                mesh.inverse_binds().iter().flat_map(Affine3A::to_cols_array),
            ),
            positions: points(&triangles.positions),
            normals: points(&triangles.normals),
            texture_coordinates: (!coordinates.is_empty())
                .then(|| Bytes::of_floats(coordinates.iter().flat_map(Vec2::to_array))),
            triangles: Bytes::new(
                triangles.triangles.iter().flatten().flat_map(|corner| corner.to_le_bytes()),
            ),
            vertex_joints: Bytes::new(
                weights().flat_map(VertexWeights::joints).flat_map(u16::to_le_bytes),
            ),
            vertex_weights: Bytes::of_floats(weights().flat_map(VertexWeights::weights)),
            parts: parts
                .iter()
                .map(|part| JsonObject(SkinPartFields::new(part, &textures)))
                .collect(),
            textures: textures
                .iter()
                .map(|texture| Bytes(packed::encode_base64(&texture.file)))
                .collect(),
        }
    }

    fn mesh(self, at: &JsonPath) -> Result<FileMesh, FieldError> {
        let at = |key: &str| at.clone().key(key);
        let mut parents = Vec::with_capacity(self.parents.len());
        for (index, parent) in self.parents.into_iter().enumerate() {
            let at = at("parents").index(index);
            let parent = parent.map(|parent| joint(at, parent, index)).transpose()?;
            parents.push(parent.map(JointId::new));
        }
        let coordinates = self.texture_coordinates;
        let coordinates =
            coordinates.map(|bytes| bytes.floats(&at("texture_coordinates"))).transpose()?;
        let mesh = TriangleMesh {
            positions: self.positions.vectors(&at("positions"))?,
            normals: self.normals.vectors(&at("normals"))?,
            texture_coordinates: coordinates
                .unwrap_or_default()
                .into_iter()
                .map(Vec2::from_array)
                .collect(),
            triangles: packed::wholes(&self.triangles.decoded(&at("triangles"))?)
                .as_chunks()
                .0
                .to_vec(),
        };
        let joints = self.vertex_joints.decoded(&at("vertex_joints"))?;
        let (joints, _) = joints.as_chunks::<8>();
        let joints = joints.iter().map(|bytes| {
            std::array::from_fn(|index| {
                u16::from_le_bytes([bytes[2 * index], bytes[2 * index + 1]])
            })
        });
        let weights = joints.zip(self.vertex_weights.floats(&at("vertex_weights"))?);
        let weights = weights.map(|(joints, weights)| VertexWeights::listed(joints, weights));
        let binds: Vec<[f32; 12]> = self.inverse_binds.floats(&at("inverse_binds"))?;
        if binds.len() != parents.len() {
            let (expected, got) = (parents.len(), binds.len());
            let reason = format!("must have {expected} transforms, as `parents`, got {got}");
            return Err(FieldError::new(at("inverse_binds"), reason));
        }
        let binds = binds.iter().map(Affine3A::from_cols_array).collect();
        let mesh = SkinnedMesh::new(mesh, weights.collect(), binds)
            .map_err(|error| FieldError::new(at("positions"), error.to_string()))?;
        let textures = textures(self.textures, &at("textures"))?;
        let parts = self.parts.into_iter().enumerate();
        let parts =
            parts.map(|(index, JsonObject(part))| part.part(&textures, &at("parts").index(index)));
        Ok(FileMesh { mesh, parents, parts: parts.collect::<Result<_, _>>()? })
    }
}

/// Reads the textures of a mesh.
fn textures(files: Vec<Bytes>, at: &JsonPath) -> Result<Vec<Shared<SkinTexture>>, FieldError> {
    let mut reader = TextureReader::default();
    let texture = |(index, bytes): (usize, Bytes)| {
        let at = at.clone().index(index);
        let texture = reader.read(bytes.decoded(&at)?);
        Ok(texture.map_err(|reason| FieldError::new(at, reason))?.into())
    };
    files.into_iter().enumerate().map(texture).collect()
}

impl SkinPartFields {
    fn new(part: &SkinPart, textures: &[&Shared<SkinTexture>]) -> Self {
        let index = |texture| textures.iter().position(|known| known.is_same(texture));
        Self {
            triangles: whole(part.triangles),
            colour: JsonNumbers(part.colour),
            texture: part.texture.as_ref().and_then(index).map(whole),
        }
    }

    fn part(self, textures: &[Shared<SkinTexture>], at: &JsonPath) -> Result<SkinPart, FieldError> {
        let JsonNumbers(colour) = self.colour;
        for (channel, value) in colour.into_iter().enumerate() {
            fraction(at.clone().key("colour").index(channel), value)?;
        }
        let texture = |Whole(index): Whole| {
            textures.get(index as usize).cloned().ok_or_else(|| {
                let count = textures.len();
                let reason = format!("must be below {count}, the number of textures, got {index}");
                FieldError::new(at.clone().key("texture"), reason)
            })
        };
        let texture = self.texture.map(texture).transpose()?;
        Ok(SkinPart { triangles: self.triangles.0 as usize, colour, texture })
    }
}
