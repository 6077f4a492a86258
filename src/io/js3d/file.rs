//! Those fields of a scene that concern skeletons.

use std::collections::HashSet;
use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, Visitor};

use crate::io::value::{JsonNumber, JsonNumbers, JsonObject, JsonPoint, Whole};

#[derive(Deserialize)]
pub struct Js3dFile {
    pub scene: JsonObject<Js3dScene>,
}

#[derive(Deserialize)]
pub struct Js3dScene {
    #[serde(default)]
    pub transforms: Named<Js3dTransform>,
    #[serde(default)]
    skinned_meshes: Named<Js3dMesh>,
    #[serde(default)]
    pub instances: JsonObject<Js3dInstances>,
}

#[derive(Deserialize)]
pub struct Js3dTransform {
    pub parent: Option<String>,
    pub translation: Option<JsonPoint>,
    pub rotation: Option<JsonNumbers<4>>,
    pub scale: Option<JsonPoint>,
}

#[derive(Deserialize)]
struct Js3dMesh {
    skeleton: Option<JsonObject<Js3dSkeleton>>,
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
}

#[derive(Deserialize)]
pub struct Js3dHandle {
    pub bone: Whole,
    pub target: JsonPoint,
    pub enabled: Option<bool>,
}

impl Js3dScene {
    /// The skeletons in the file's order, each with its name, which is the name of its mesh.
    pub fn skeletons(&self) -> impl Iterator<Item = (&str, &Js3dSkeleton)> {
        let meshes = self.skinned_meshes.0.iter();
        meshes.filter_map(|(name, mesh)| Some((name.as_str(), &mesh.skeleton.as_ref()?.0)))
    }
}

impl Js3dBone {
    pub fn parent(&self) -> Option<usize> {
        const NONE: u32 = u32::MAX;
        self.parent.filter(|parent| parent.0 != NONE).map(|parent| parent.0 as usize)
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
