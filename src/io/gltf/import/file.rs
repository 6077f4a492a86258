//! What stands in a file, as far as skeletons and their motions go.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, SeqAccess, Visitor};

use crate::io::value::{Numbers, Object, Point, Whole};

#[derive(Deserialize)]
pub struct File {
    pub asset: Object<Asset>,
    #[serde(default)]
    pub nodes: List<Node>,
    #[serde(default)]
    pub skins: List<Skin>,
    #[serde(default)]
    pub animations: List<Animation>,
    #[serde(default)]
    pub accessors: List<Accessor>,
    #[serde(default, rename = "bufferViews")]
    pub views: List<View>,
    #[serde(default)]
    pub buffers: List<Buffer>,
}

#[derive(Deserialize)]
pub struct Asset {
    pub version: String,
}

#[derive(Deserialize)]
pub struct Node {
    pub name: Option<String>,
    pub children: Option<Vec<Whole>>,
    pub matrix: Option<Box<Numbers<16>>>,
    pub translation: Option<Point>,
    pub rotation: Option<Numbers<4>>,
    pub scale: Option<Point>,
    pub skin: Option<Whole>,
}

#[derive(Deserialize)]
pub struct Skin {
    pub name: Option<String>,
    pub joints: Vec<Whole>,
}

#[derive(Deserialize)]
pub struct Animation {
    pub channels: List<Channel>,
    pub samplers: List<Sampler>,
}

#[derive(Deserialize)]
pub struct Channel {
    pub sampler: Whole,
    pub target: Object<Target>,
}

#[derive(Deserialize)]
pub struct Target {
    pub node: Option<Whole>,
    pub path: String,
}

#[derive(Deserialize)]
pub struct Sampler {
    pub input: Whole,
    pub output: Whole,
    pub interpolation: Option<String>,
}

#[derive(Deserialize)]
pub struct Accessor {
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
pub struct View {
    pub buffer: Whole,
    #[serde(rename = "byteOffset")]
    pub offset: Option<Whole>,
    #[serde(rename = "byteLength")]
    pub length: Whole,
    #[serde(rename = "byteStride")]
    pub stride: Option<Whole>,
}

#[derive(Deserialize)]
pub struct Buffer {
    #[serde(rename = "byteLength")]
    pub length: Whole,
    pub uri: Option<String>,
}

/// Objects in a row: no more than a file of some sense has, so that one of none takes no more memory
/// than there is.
pub struct List<T>(pub Vec<T>);

impl<T> List<T> {
    const LONGEST: usize = 200_000;
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
                f.write_str("a row of objects: [{…}, …]")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut row: A) -> Result<List<T>, A::Error> {
                let mut list = Vec::new();
                while let Some(Object(entry)) = row.next_element()? {
                    if list.len() == List::<T>::LONGEST {
                        let most = List::<T>::LONGEST;
                        return Err(A::Error::custom(format!("at most {most} are possible")));
                    }
                    list.push(entry);
                }
                Ok(List(list))
            }
        }

        deserializer.deserialize_seq(ListVisitor(PhantomData))
    }
}
