//! Those fields of a file that concern skeletons and their motions.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, SeqAccess, Visitor};

use crate::io::value::{JsonNumbers, JsonObject, JsonPoint, Whole};

#[derive(Deserialize)]
pub struct GltfFile {
    pub asset: JsonObject<GltfAsset>,
    #[serde(default)]
    pub nodes: List<GltfNode>,
    #[serde(default)]
    pub skins: List<GltfSkin>,
    #[serde(default)]
    pub animations: List<GltfAnimation>,
    #[serde(default)]
    pub accessors: List<GltfAccessor>,
    #[serde(default, rename = "bufferViews")]
    pub views: List<GltfBufferView>,
    #[serde(default)]
    pub buffers: List<GltfBuffer>,
}

#[derive(Deserialize)]
pub struct GltfAsset {
    pub version: String,
}

#[derive(Deserialize)]
pub struct GltfNode {
    pub name: Option<String>,
    pub children: Option<Vec<Whole>>,
    pub matrix: Option<Box<JsonNumbers<16>>>,
    pub translation: Option<JsonPoint>,
    pub rotation: Option<JsonNumbers<4>>,
    pub scale: Option<JsonPoint>,
    pub skin: Option<Whole>,
}

#[derive(Deserialize)]
pub struct GltfSkin {
    pub name: Option<String>,
    pub joints: Vec<Whole>,
}

#[derive(Deserialize)]
pub struct GltfAnimation {
    pub channels: List<GltfChannel>,
    pub samplers: List<GltfSampler>,
}

#[derive(Deserialize)]
pub struct GltfChannel {
    pub sampler: Whole,
    pub target: JsonObject<GltfTarget>,
}

#[derive(Deserialize)]
pub struct GltfTarget {
    pub node: Option<Whole>,
    pub path: String,
}

#[derive(Deserialize)]
pub struct GltfSampler {
    pub input: Whole,
    pub output: Whole,
    pub interpolation: Option<String>,
}

#[derive(Deserialize)]
pub struct GltfAccessor {
    #[serde(rename = "bufferView")]
    pub view: Option<Whole>,
    #[serde(rename = "byteOffset")]
    pub offset: Option<Whole>,
    #[serde(rename = "componentType")]
    pub component: Whole,
    pub count: Whole,
    #[serde(rename = "type")]
    pub shape: String,
    pub normalized: Option<bool>,
    pub sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
pub struct GltfBufferView {
    pub buffer: Whole,
    #[serde(rename = "byteOffset")]
    pub offset: Option<Whole>,
    #[serde(rename = "byteLength")]
    pub length: Whole,
    #[serde(rename = "byteStride")]
    pub stride: Option<Whole>,
}

#[derive(Deserialize)]
pub struct GltfBuffer {
    #[serde(rename = "byteLength")]
    pub length: Whole,
    pub uri: Option<String>,
}

/// An array of objects. Its length is limited, so that a malicious file cannot exhaust the memory.
pub struct List<T>(pub Vec<T>);

/// Returns the error message for an index that is not below `count`, the number of `items`.
pub fn index_rule(items: &str, count: usize, index: usize) -> String {
    format!("must be below {count}, the number of {items}, got {index}")
}

impl<T> List<T> {
    const MAX_LENGTH: usize = 200_000;
}

impl<T> Default for List<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for List<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListVisitor<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for ListVisitor<T> {
            type Value = List<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of objects: [{…}, …]")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut row: A) -> Result<List<T>, A::Error> {
                let mut list = Vec::new();
                while let Some(JsonObject(entry)) = row.next_element()? {
                    if list.len() == List::<T>::MAX_LENGTH {
                        let max = List::<T>::MAX_LENGTH;
                        return Err(A::Error::custom(format!("must have at most {max} entries")));
                    }
                    list.push(entry);
                }
                Ok(List(list))
            }
        }

        deserializer.deserialize_seq(ListVisitor(PhantomData))
    }
}
