//! Fields of a skin in a file, and conversions between these fields and a [`Skin`].
//!
//! A mesh from a file of another program stands there as the name of that file, or by its lists of
//! numbers, which are little-endian bytes in base64.

use std::path::{Path, PathBuf};

use glam::{Affine3A, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::skeleton::joint;
use crate::io::json::{
    AtField, FieldError, Fraction, JsonNumber, JsonNumbers, JsonObject, JsonPoint, Whole,
    converted, value_or,
};
use crate::io::packed;
use crate::io::texture::TextureReader;
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::skin::{
    BindSet, Blob, BlobSphere, Morph, SkinShape, SkinShapeError, SkinnedMesh, Skinning,
    TriangleMesh, VertexWeights,
};
use crate::rig::{
    BoneSkin, FileMesh, MeshSkin, PartLook, Skin, SkinFile, SkinFileError, SkinPart, SkinSource,
    SkinTexture,
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
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    jointed: bool,
    /// The pose in which the mesh is made; without it, the bind pose.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pose: Vec<JsonObject<JointAnglesFields>>,
}

#[derive(Serialize, Deserialize)]
struct JointAnglesFields {
    joint: Whole,
    rotation: JsonPoint,
}

#[derive(Serialize, Deserialize)]
struct BlobFields {
    joint: Whole,
    /// Centre and radius of each sphere.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    spheres: Vec<JsonNumbers<4>>,
    /// Centre of the first sphere, as older versions of the program write it.
    #[serde(skip_serializing)]
    base: Option<JsonPoint>,
    /// Without it, there is one sphere.
    #[serde(skip_serializing)]
    tip: Option<JsonPoint>,
    #[serde(skip_serializing)]
    radius: Option<JsonNumber>,
    /// Without it, both radii are the same.
    #[serde(skip_serializing)]
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

    pub fn skin(self, skeleton: &Shared<Skeleton>) -> Result<Skin, FieldError> {
        let source = match (self.bones, self.mesh) {
            (Some(_), Some(_)) => return Err("must not have both `bones` and `mesh`".into()),
            (None, Some(JsonObject(mesh))) => SkinSource::Mesh(mesh.skin(skeleton).at("mesh")?),
            (bones, None) => {
                let JsonObject(bones) = bones.unwrap_or_default();
                SkinSource::Bones(bones.skin(skeleton).at("bones")?)
            }
        };
        let skin = Skin::new(source);
        Ok(Skin {
            skinning: self.skinning.unwrap_or(skin.skinning),
            colour: self.colour.map(colour).transpose()?.unwrap_or(skin.colour),
            ..skin
        })
    }
}

fn colour(JsonNumbers(colour): JsonNumbers<3>) -> Result<[f32; 3], FieldError> {
    for (channel, value) in colour.into_iter().enumerate() {
        Fraction::try_from(JsonNumber(value)).at(channel).at("colour")?;
    }
    Ok(colour)
}

impl SkinShapeFields {
    fn new(shape: &SkinShape) -> Self {
        let blobs = shape.blobs.iter().map(BlobFields::new).map(JsonObject).collect();
        Self {
            detail: Some(shape.detail.into()),
            thickness: Some(shape.thickness.into()),
            blobs: (!shape.blobs.is_empty()).then_some(blobs),
            jointed: shape.is_jointed,
            pose: shape.pose.iter().map(JointAnglesFields::new).map(JsonObject).collect(),
        }
    }

    fn skin(self, skeleton: &Shared<Skeleton>) -> Result<BoneSkin, FieldError> {
        let (default, joints) = (SkinShape::default(), skeleton.joints().len());
        let blobs = self.blobs.unwrap_or_default();
        let shape = SkinShape {
            detail: value_or(self.detail, default.detail),
            thickness: value_or(self.thickness, default.thickness),
            blobs: converted(blobs, |JsonObject(blob)| blob.blob(joints)).at("blobs")?,
            is_jointed: self.jointed,
            pose: converted(self.pose, |JsonObject(angles)| angles.angles(joints)).at("pose")?,
        };
        if let Err(error) = shape.check(skeleton) {
            let reason = Err(error.to_string());
            return match error {
                SkinShapeError::Detail(_) => reason.at("detail"),
                SkinShapeError::Thickness(_) => reason.at("thickness"),
                SkinShapeError::Blob { blob } => reason.at(blob).at("blobs"),
                _ => Ok(reason?),
            };
        }
        Ok(BoneSkin::new(skeleton.clone(), shape))
    }
}

impl JointAnglesFields {
    fn new((joint, rotation): &(JointId, Vec3)) -> Self {
        Self { joint: (*joint).into(), rotation: (*rotation).into() }
    }

    fn angles(self, joints: usize) -> Result<(JointId, Vec3), FieldError> {
        Ok((joint(self.joint, joints).at("joint")?, self.rotation.into()))
    }
}

impl BlobFields {
    fn new(blob: &Blob) -> Self {
        let numbers = |sphere: &BlobSphere| JsonNumbers(sphere.centre.extend(sphere.radius).into());
        Self {
            joint: blob.joint.into(),
            spheres: blob.spheres.iter().map(numbers).collect(),
            base: None,
            tip: None,
            radius: None,
            tip_radius: None,
        }
    }

    fn blob(self, joints: usize) -> Result<Blob, FieldError> {
        let joint = joint(self.joint, joints).at("joint")?;
        let sphere =
            |JsonNumbers([x, y, z, radius])| BlobSphere { centre: [x, y, z].into(), radius };
        let listed: Vec<BlobSphere> = self.spheres.into_iter().map(sphere).collect();
        let spheres = match (listed.is_empty(), self.base.zip(self.radius)) {
            (false, _) => listed,
            (true, Some((JsonPoint(centre), JsonNumber(radius)))) => {
                let base = BlobSphere { centre, radius };
                let tip = BlobSphere {
                    centre: value_or(self.tip, centre),
                    radius: value_or(self.tip_radius, radius),
                };
                if tip == base { vec![base] } else { vec![base, tip] }
            }
            (true, None) => return Err("must have `spheres`, or `base` and `radius`".into()),
        };
        Ok(Blob { joint, spheres })
    }
}

#[derive(Serialize, Deserialize)]
struct MeshSkinFields {
    /// Path of the file; without it, `packed` has the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    checksum: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    skeleton: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    animation: Option<String>,
    joints: Vec<Option<Whole>>,
    /// Weights of the morph targets, 0 for those beyond the list.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    morph_weights: Vec<JsonNumber>,
    #[serde(skip_serializing_if = "Option::is_none")]
    packed: Option<JsonObject<FileMeshFields>>,
}

#[derive(Serialize, Deserialize)]
struct FileMeshFields {
    parents: Vec<Option<Whole>>,
    inverse_binds: Bytes,
    /// The number of vertices of each set of inverse bind transforms; without it, there is one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    bind_sets: Vec<Whole>,
    positions: Bytes,
    normals: Bytes,
    #[serde(skip_serializing_if = "Option::is_none")]
    texture_coordinates: Option<Bytes>,
    #[serde(skip_serializing_if = "Option::is_none")]
    emission_coordinates: Option<Bytes>,
    #[serde(skip_serializing_if = "Option::is_none")]
    colours: Option<Bytes>,
    triangles: Bytes,
    vertex_joints: Bytes,
    vertex_weights: Bytes,
    parts: Vec<JsonObject<SkinPartFields>>,
    /// PNG or JPEG files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    textures: Vec<Bytes>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    morphs: Vec<JsonObject<MorphFields>>,
}

/// A morph target.
#[derive(Serialize, Deserialize)]
struct MorphFields {
    name: String,
    vertices: Bytes,
    offsets: Bytes,
    normals: Bytes,
}

#[derive(Serialize, Deserialize)]
struct SkinPartFields {
    triangles: Whole,
    colour: JsonNumbers<3>,
    /// Index in the list of textures.
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<Whole>,
    /// Index in the list of textures.
    #[serde(skip_serializing_if = "Option::is_none")]
    emission_texture: Option<Whole>,
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    double_sided: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    alpha_cutoff: Option<Fraction>,
    #[serde(skip_serializing_if = "Option::is_none")]
    opacity: Option<Fraction>,
    #[serde(skip_serializing_if = "Option::is_none")]
    emission: Option<JsonNumbers<3>>,
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
        Self::of(&bytes.into_iter().collect::<Vec<u8>>())
    }

    fn of(bytes: &[u8]) -> Self {
        Self(packed::encode_base64(bytes))
    }

    fn decoded(&self) -> Result<Vec<u8>, String> {
        packed::decode_base64(&self.0)
    }

    /// Rows of `N` floats.
    fn floats<const N: usize>(&self) -> Result<Vec<[f32; N]>, String> {
        let bytes = self.decoded()?;
        let (row, got) = (4 * N, bytes.len());
        if got % row != 0 {
            return Err(format!("must have a multiple of {row} bytes, got {got}"));
        }
        Ok(packed::floats(&bytes).as_chunks().0.to_vec())
    }

    fn vectors(&self) -> Result<Vec<Vec3>, String> {
        Ok(self.floats()?.into_iter().map(Vec3::from_array).collect())
    }
}

fn wholes(joints: &[Option<JointId>]) -> Vec<Option<Whole>> {
    joints.iter().map(|joint| joint.map(Whole::from)).collect()
}

impl MeshSkinFields {
    fn new(skin: &MeshSkin) -> Self {
        let file = skin.file();
        let packed = skin.in_file().filter(|_| file.is_none());
        Self {
            file: file.map(|file| portable(&file.path)),
            checksum: file.map(|file| Whole(file.checksum)),
            skeleton: file.map(|file| file.skeleton.clone()),
            animation: file.and_then(|file| file.animation.clone()),
            joints: wholes(skin.joints()),
            morph_weights: skin.morph_weights().iter().copied().map(JsonNumber).collect(),
            packed: packed.map(|mesh| JsonObject(FileMeshFields::new(mesh))),
        }
    }

    /// Converts the fields to a skin. The file of a skin that has one is still to be read.
    fn skin(self, skeleton: &Skeleton) -> Result<MeshSkin, FieldError> {
        let count = skeleton.joints().len();
        let joint = |number: Option<Whole>| number.map(|number| joint(number, count)).transpose();
        let joints = converted(self.joints, joint).at("joints")?;
        let weights = self.morph_weights.into_iter().map(f32::from).collect();
        let skin = match (self.file, self.packed) {
            (Some(path), None) => {
                let file = SkinFile {
                    path: PathBuf::from(path),
                    checksum: value_or(self.checksum, 0),
                    skeleton: self.skeleton.unwrap_or_default(),
                    animation: self.animation,
                };
                let missing = SkinFileError::Missing(file.path.clone());
                MeshSkin::without_mesh(file, joints, missing)
            }
            (None, Some(JsonObject(packed))) => {
                let mesh = packed.mesh().at("packed")?;
                let (expected, got) = (mesh.parents.len(), joints.len());
                if expected != got {
                    let reason = format!("must have {expected} entries, as `parents`, got {got}");
                    return Err(reason).at("joints");
                }
                MeshSkin::new(mesh.into(), None, joints, skeleton)
            }
            _ => return Err("must have either `file` or `packed`".into()),
        };
        Ok(skin.with_morph_weights(weights))
    }
}

/// A path with `/` between its parts, as on all systems.
fn portable(path: &Path) -> String {
    let text = path.to_string_lossy();
    if path.is_relative() { text.replace('\\', "/") } else { text.into_owned() }
}

impl FileMeshFields {
    fn new(mesh: &FileMesh) -> Self {
        let FileMesh { mesh, parents, parts } = mesh;
        let triangles = mesh.mesh();
        let points = |points: &[Vec3]| Bytes::of_floats(points.iter().flat_map(Vec3::to_array));
        let coordinates = |all: &[Vec2]| {
            (!all.is_empty()).then(|| Bytes::of_floats(all.iter().flat_map(Vec2::to_array)))
        };
        let sets = mesh.bind_sets();
        let binds = sets.iter().flat_map(|set| &set.inverse_binds);
        let binds = binds.flat_map(Affine3A::to_cols_array);
        let whole = |set: &BindSet| Whole(u32::try_from(set.vertices).unwrap_or(u32::MAX));
        let bind_sets = if sets.len() > 1 { sets.iter().map(whole).collect() } else { Vec::new() };
        let corners = triangles.triangles.iter().flatten();
        let weights = || mesh.weights().iter();
        let vertex_joints = weights().flat_map(VertexWeights::joints);
        let textures = SkinPart::textures(parts);
        let parts = parts.iter().map(|part| JsonObject(SkinPartFields::new(part, &textures)));
        Self {
            parents: wholes(parents),
            inverse_binds: Bytes::of_floats(binds),
            bind_sets,
            positions: points(&triangles.positions),
            normals: points(&triangles.normals),
            texture_coordinates: coordinates(&triangles.texture_coordinates),
            emission_coordinates: coordinates(&triangles.emission_coordinates),
            colours: (!triangles.colours.is_empty())
                .then(|| Bytes::of(triangles.colours.as_flattened())),
            triangles: Bytes::new(corners.flat_map(|corner| corner.to_le_bytes())),
            vertex_joints: Bytes::new(vertex_joints.flat_map(u16::to_le_bytes)),
            vertex_weights: Bytes::of_floats(weights().flat_map(VertexWeights::weights)),
            parts: parts.collect(),
            textures: textures.iter().map(|texture| Bytes::of(&texture.file)).collect(),
            morphs: mesh.morphs().iter().map(MorphFields::new).map(JsonObject).collect(),
        }
    }

    fn mesh(self) -> Result<FileMesh, FieldError> {
        // A parent precedes its joint.
        let parents = converted(self.parents.into_iter().enumerate(), |(index, parent)| {
            parent.map(|parent| joint(parent, index)).transpose()
        })
        .at("parents")?;
        let coordinates = |bytes: Option<Bytes>| {
            let numbers = bytes.map(|bytes| bytes.floats()).transpose();
            numbers.map(|rows| rows.into_iter().flatten().map(Vec2::from_array).collect())
        };
        let triangles = TriangleMesh {
            positions: self.positions.vectors().at("positions")?,
            normals: self.normals.vectors().at("normals")?,
            texture_coordinates: coordinates(self.texture_coordinates).at("texture_coordinates")?,
            emission_coordinates: coordinates(self.emission_coordinates)
                .at("emission_coordinates")?,
            colours: match self.colours {
                Some(bytes) => bytes.decoded().at("colours")?.as_chunks().0.to_vec(),
                None => Vec::new(),
            },
            triangles: packed::wholes(&self.triangles.decoded().at("triangles")?)
                .as_chunks()
                .0
                .to_vec(),
        };
        let joint_bytes = self.vertex_joints.decoded().at("vertex_joints")?;
        let joints = joint_bytes.as_chunks::<8>().0.iter().map(|bytes| {
            std::array::from_fn(|index| {
                u16::from_le_bytes([bytes[2 * index], bytes[2 * index + 1]])
            })
        });
        let weights = joints.zip(self.vertex_weights.floats().at("vertex_weights")?);
        let binds: Vec<[f32; 12]> = self.inverse_binds.floats().at("inverse_binds")?;
        let vertices = match &self.bind_sets[..] {
            [] => vec![triangles.positions.len()],
            sets => sets.iter().map(|vertices| vertices.0 as usize).collect(),
        };
        let (expected, got) = (parents.len().saturating_mul(vertices.len()), binds.len());
        if expected != got {
            let reason = match vertices.len() {
                1 => format!("must have {expected} transforms, as `parents`, got {got}"),
                sets => format!(
                    "must have {expected} transforms, {sets} times as many as `parents`, got {got}"
                ),
            };
            return Err(reason).at("inverse_binds");
        }
        let weights = weights.map(|(joints, weights)| VertexWeights::listed(joints, weights));
        let mut binds = binds.iter().map(Affine3A::from_cols_array);
        let set = |vertices| BindSet {
            vertices,
            inverse_binds: binds.by_ref().take(parents.len()).collect(),
        };
        let bind_sets = vertices.into_iter().map(set).collect();
        let mesh = SkinnedMesh::with_bind_sets(triangles, weights.collect(), bind_sets)
            .map_err(|error| error.to_string())
            .at("positions")?;
        let morphs = converted(self.morphs, |JsonObject(morph)| morph.morph()).at("morphs")?;
        let mesh = mesh.with_morphs(morphs).map_err(|error| error.to_string()).at("morphs")?;
        let mut reader = TextureReader::default();
        let texture = |bytes: Bytes| reader.read(bytes.decoded()?).map(Shared::from);
        let textures = converted(self.textures, texture).at("textures")?;
        let parts = converted(self.parts, |JsonObject(part)| part.part(&textures)).at("parts")?;
        Ok(FileMesh { mesh, parents, parts })
    }
}

impl MorphFields {
    fn new(morph: &Morph) -> Self {
        let vectors = |all: &[Vec3]| Bytes::of_floats(all.iter().flat_map(Vec3::to_array));
        Self {
            name: morph.name.clone(),
            vertices: Bytes::new(morph.vertices.iter().flat_map(|vertex| vertex.to_le_bytes())),
            offsets: vectors(&morph.offsets),
            normals: vectors(&morph.normals),
        }
    }

    fn morph(self) -> Result<Morph, FieldError> {
        Ok(Morph {
            name: self.name,
            vertices: packed::wholes(&self.vertices.decoded().at("vertices")?),
            offsets: self.offsets.vectors().at("offsets")?,
            normals: self.normals.vectors().at("normals")?,
        })
    }
}

impl SkinPartFields {
    fn new(part: &SkinPart, textures: &[&Shared<SkinTexture>]) -> Self {
        let whole = |number| Whole(u32::try_from(number).unwrap_or(u32::MAX));
        let PartLook { is_double_sided, alpha_cutoff, opacity, emission } = part.look;
        let index = |texture| textures.iter().position(|known| known.is_same(texture));
        Self {
            triangles: whole(part.triangles),
            colour: JsonNumbers(part.colour),
            texture: part.texture.as_ref().and_then(index).map(whole),
            emission_texture: part.emission_texture.as_ref().and_then(index).map(whole),
            double_sided: is_double_sided,
            alpha_cutoff: (alpha_cutoff > 0.0).then(|| alpha_cutoff.into()),
            opacity: opacity.map(Fraction::from),
            emission: (emission != [0.0; 3]).then_some(JsonNumbers(emission)),
        }
    }

    fn part(self, textures: &[Shared<SkinTexture>]) -> Result<SkinPart, FieldError> {
        let texture = |Whole(index): Whole| {
            textures.get(index as usize).cloned().ok_or_else(|| {
                let count = textures.len();
                format!("must be below {count}, the number of textures, got {index}")
            })
        };
        let look = PartLook {
            is_double_sided: self.double_sided,
            alpha_cutoff: value_or(self.alpha_cutoff, 0.0),
            opacity: self.opacity.map(f32::from),
            emission: self.emission.map(colour).transpose().at("emission")?.unwrap_or_default(),
        };
        Ok(SkinPart {
            look,
            triangles: self.triangles.0 as usize,
            colour: colour(self.colour)?,
            texture: self.texture.map(texture).transpose().at("texture")?,
            emission_texture: self
                .emission_texture
                .map(texture)
                .transpose()
                .at("emission_texture")?,
        })
    }
}
