//! What stands in a scene, as far as skeletons go.

use std::collections::HashSet;
use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, Visitor};

use crate::io::value::{Number, Numbers, Object, Point, Whole};

#[derive(Deserialize)]
pub struct File {
    pub scene: Object<Scene>,
}

#[derive(Deserialize)]
pub struct Scene {
    #[serde(default)]
    pub transforms: Named<Transform>,
    #[serde(default)]
    skinned_meshes: Named<Mesh>,
    #[serde(default)]
    pub instances: Object<Instances>,
}

#[derive(Deserialize)]
pub struct Transform {
    pub parent: Option<String>,
    pub translation: Option<Point>,
    pub rotation: Option<Numbers<4>>,
    pub scale: Option<Point>,
}

#[derive(Deserialize)]
struct Mesh {
    skeleton: Option<Object<Skeleton>>,
}

#[derive(Default, Deserialize)]
pub struct Instances {
    #[serde(default)]
    pub skinned_meshes: Named<Instance>,
}

#[derive(Deserialize)]
pub struct Instance {
    pub mesh: Option<String>,
    pub transform: Option<String>,
}

#[derive(Deserialize)]
pub struct Skeleton {
    #[serde(default)]
    pub base: Point,
    #[serde(default)]
    pub base_offset: Point,
    pub bones: Vec<Object<Bone>>,
    pub handles: Option<Vec<Object<Handle>>>,
}

#[derive(Deserialize)]
pub struct Bone {
    pub extent: Point,
    #[serde(default)]
    pub roll: Number,
    pub radius: Option<Number>,
    parent: Option<Whole>,
    #[serde(default)]
    pub pose: Point,
}

#[derive(Deserialize)]
pub struct Handle {
    pub bone: Whole,
    pub target: Point,
    pub enabled: Option<bool>,
}

impl Scene {
    /// In the file's order.
    pub fn skeletons(&self) -> impl Iterator<Item = (&str, &Skeleton)> {
        let meshes = self.skinned_meshes.0.iter();
        meshes.filter_map(|(name, mesh)| Some((name.as_str(), &mesh.skeleton.as_ref()?.0)))
    }
}

impl Bone {
    pub fn parent(&self) -> Option<usize> {
        const NONE: u32 = u32::MAX;
        self.parent.filter(|parent| parent.0 != NONE).map(|parent| parent.0 as usize)
    }
}

/// Objects by name, in the file's order.
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
                    let Object(value) = map.next_value()?;
                    named.push((name, value));
                }
                Ok(Named(named))
            }
        }

        deserializer.deserialize_map(NamedVisitor(PhantomData))
    }
}
