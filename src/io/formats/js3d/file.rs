//! Those fields of a scene that concern skeletons, and the number of entries of the others.

use std::collections::HashSet;
use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::Value;

use crate::io::json::{JsonNumber, JsonNumbers, JsonObject, JsonPoint, Whole};

#[derive(Deserialize)]
pub struct Js3dFile {
    pub scene: JsonObject<Js3dScene>,
    pub animator: Option<JsonObject<Js3dAnimator>>,
}

/// Values of any kind: what cannot be read of them is left out.
#[derive(Deserialize)]
pub struct Js3dAnimator {
    #[serde(default)]
    pub splines: Value,
    #[serde(default)]
    pub frame_rate: Value,
}

#[derive(Deserialize)]
pub struct Js3dScene {
    #[serde(default)]
    pub transforms: Named<Js3dTransform>,
    #[serde(default)]
    pub skinned_meshes: Named<Js3dSkinnedMesh>,
    #[serde(default)]
    pub instances: JsonObject<Js3dInstances>,
    #[serde(default)]
    meshes: Unread,
    #[serde(default)]
    shapes: Unread,
    #[serde(default)]
    particles: Unread,
    #[serde(default)]
    cameras: Unread,
    #[serde(default)]
    delta_lights: Unread,
    #[serde(default)]
    env_lights: Unread,
    #[serde(default)]
    materials: Unread,
    #[serde(default)]
    textures: Unread,
}

#[derive(Deserialize)]
pub struct Js3dTransform {
    pub parent: Option<String>,
    pub translation: Option<JsonPoint>,
    pub rotation: Option<JsonNumbers<4>>,
    pub scale: Option<JsonPoint>,
}

#[derive(Deserialize)]
pub struct Js3dSkinnedMesh {
    mesh: Option<Js3dMeshField>,
    skeleton: Option<JsonObject<Js3dSkeleton>>,
}

/// A mesh, or anything else that is not read.
#[derive(Deserialize)]
#[serde(untagged)]
enum Js3dMeshField {
    HalfEdges(Box<Js3dMesh>),
    Other(Unread),
}

/// A half-edge mesh. Half-edges 2·i and 2·i + 1 are the two sides of an edge. Lists are texts of a
/// type, a colon and base64, like `uint32:AgAAAA`.
#[derive(Deserialize)]
pub struct Js3dMesh {
    #[serde(rename = "FORMAT")]
    pub format: String,
    /// For each half-edge the next one around its face.
    #[serde(default, rename = "halfedge_nexts")]
    pub nexts: String,
    /// For each half-edge the texture coordinates of the corner from which it goes.
    #[serde(default, rename = "halfedge_corner_uvs")]
    pub coordinates: String,
    /// For each half-edge the normal of that corner.
    #[serde(default, rename = "halfedge_corner_normals")]
    pub normals: String,
    /// For each vertex a half-edge that goes from it.
    #[serde(default, rename = "vertex_halfedges")]
    pub vertices: String,
    #[serde(default, rename = "vertex_positions")]
    pub positions: String,
    /// For each vertex the end of its weights in the two following lists.
    #[serde(default, rename = "vertex_bone_weight_ends")]
    pub weight_ends: String,
    #[serde(default, rename = "bone_weight_bones")]
    pub weight_bones: String,
    #[serde(default, rename = "bone_weight_weights")]
    pub weights: String,
    /// For each face a half-edge around it.
    #[serde(default, rename = "face_halfedges")]
    pub faces: String,
    /// For each face a bit, from the highest of a byte to the lowest: 1 for a hole. A bit 1 follows
    /// the last face.
    #[serde(default, rename = "face_boundaries")]
    pub boundaries: String,
}

#[derive(Default, Deserialize)]
pub struct Js3dInstances {
    #[serde(default)]
    pub skinned_meshes: Named<Js3dInstance>,
}

#[derive(Deserialize)]
pub struct Js3dInstance {
    pub mesh: Option<String>,
    pub transform: Option<String>,
}

#[derive(Deserialize)]
pub struct Js3dSkeleton {
    #[serde(default)]
    pub base: JsonPoint,
    #[serde(default)]
    pub base_offset: JsonPoint,
    pub bones: Vec<JsonObject<Js3dBone>>,
    pub handles: Option<Vec<JsonObject<Js3dHandle>>>,
}

#[derive(Deserialize)]
pub struct Js3dBone {
    pub extent: JsonPoint,
    #[serde(default)]
    pub roll: JsonNumber,
    pub radius: Option<JsonNumber>,
    parent: Option<Whole>,
    #[serde(default)]
    pub pose: JsonPoint,
    /// Number in the names of its channels; `None` for the bone's index.
    pub channel_id: Option<Whole>,
}

#[derive(Deserialize)]
pub struct Js3dHandle {
    pub bone: Whole,
    pub target: JsonPoint,
    pub enabled: Option<bool>,
    /// Number in the names of its channels; `None` for the handle's index.
    pub channel_id: Option<Whole>,
}

/// Number of entries of an object or array that is not read; 0 for any other value.
#[derive(Clone, Copy, Default)]
struct Unread(usize);

impl Js3dScene {
    /// Contents of the scene that are not read: their name in the singular, and how many there are.
    pub fn unread(&self) -> impl Iterator<Item = (&'static str, usize)> {
        let skinned = self.skinned_meshes.0.iter().filter(|(_, skinned)| skinned.has_other_mesh());
        let contents = [
            ("mesh", self.meshes.0 + skinned.count()),
            ("shape", self.shapes.0),
            ("particle system", self.particles.0),
            ("camera", self.cameras.0),
            ("light", self.delta_lights.0 + self.env_lights.0),
            ("material", self.materials.0),
            ("texture", self.textures.0),
        ];
        contents.into_iter().filter(|(_, count)| *count > 0)
    }

    /// The skeletons in the file's order, each with its name, which is the name of its mesh.
    pub fn skeletons(&self) -> impl Iterator<Item = (&str, &Js3dSkeleton)> {
        let meshes = self.skinned_meshes.0.iter();
        meshes.filter_map(|(name, mesh)| Some((name.as_str(), &mesh.skeleton.as_ref()?.0)))
    }
}

impl Js3dSkinnedMesh {
    pub fn mesh(&self) -> Option<&Js3dMesh> {
        match &self.mesh {
            Some(Js3dMeshField::HalfEdges(mesh)) => Some(mesh),
            _ => None,
        }
    }

    fn has_other_mesh(&self) -> bool {
        matches!(self.mesh, Some(Js3dMeshField::Other(Unread(1..))))
    }
}

impl Js3dBone {
    pub fn parent(&self) -> Option<usize> {
        const NONE: u32 = u32::MAX;
        self.parent.filter(|parent| parent.0 != NONE).map(|parent| parent.0 as usize)
    }
}

impl<'de> Deserialize<'de> for Unread {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct UnreadVisitor;

        impl<'de> Visitor<'de> for UnreadVisitor {
            type Value = Unread;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("any value")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Unread, A::Error> {
                let mut count = 0;
                while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {
                    count += 1;
                }
                Ok(Unread(count))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Unread, A::Error> {
                let mut count = 0;
                while seq.next_element::<IgnoredAny>()?.is_some() {
                    count += 1;
                }
                Ok(Unread(count))
            }

            fn visit_bool<E>(self, _: bool) -> Result<Unread, E> {
                Ok(Unread(0))
            }

            fn visit_i64<E>(self, _: i64) -> Result<Unread, E> {
                Ok(Unread(0))
            }

            fn visit_u64<E>(self, _: u64) -> Result<Unread, E> {
                Ok(Unread(0))
            }

            fn visit_f64<E>(self, _: f64) -> Result<Unread, E> {
                Ok(Unread(0))
            }

            fn visit_str<E>(self, _: &str) -> Result<Unread, E> {
                Ok(Unread(0))
            }

            fn visit_unit<E>(self) -> Result<Unread, E> {
                Ok(Unread(0))
            }
        }

        deserializer.deserialize_any(UnreadVisitor)
    }
}

/// Named objects in the file's order.
pub struct Named<T>(pub Vec<(String, T)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NamedVisitor<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for NamedVisitor<T> {
            type Value = Named<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object of named objects: {\"NAME\": {…}}")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut named = Vec::new();
                let mut names = HashSet::new();
                while let Some(name) = map.next_key::<String>()? {
                    if !names.insert(name.clone()) {
                        return Err(A::Error::custom(format!("duplicate name {name:?}")));
                    }
                    let JsonObject(value) = map.next_value()?;
                    named.push((name, value));
                }
                Ok(Named(named))
            }
        }

        deserializer.deserialize_map(NamedVisitor(PhantomData))
    }
}
