//! Those fields of a file that concern skeletons, their skins and their motions.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, IgnoredAny, SeqAccess, Visitor};

use crate::io::formats::gltf::extras::is_this_program;
use crate::io::formats::gltf::extras::{AnimationExtras, NodeExtras, ReadExtras, SamplerExtras};
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::{JsonNumbers, JsonObject, JsonPoint, Whole};

#[derive(Deserialize)]
pub struct GltfFile<'a> {
    pub asset: JsonObject<GltfAsset>,
    #[serde(default, rename = "extensionsRequired")]
    pub required: Vec<String>,
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
    #[serde(borrow, default)]
    pub buffers: List<GltfBuffer<'a>>,
    #[serde(default)]
    pub meshes: List<GltfMesh>,
    #[serde(default)]
    pub materials: List<GltfMaterial>,
    #[serde(default)]
    pub textures: List<GltfTexture>,
    #[serde(borrow, default)]
    pub images: List<GltfImage<'a>>,
}

/// The version of a file, in which everything else may be as in another version.
#[derive(Deserialize)]
pub struct VersionedFile {
    pub asset: GltfAsset,
}

impl GltfFile<'_> {
    /// Why compressed data cannot be read, and what makes them readable; `None` for a file whose
    /// data are all there without extensions.
    pub fn compression(&self) -> Option<String> {
        let name = self.required.iter().find(|name| name.ends_with("_compression"))?;
        let advice = match name.as_str() {
            "KHR_draco_mesh_compression" => "; gltf-transform cp x.glb y.glb unpacks them",
            "EXT_meshopt_compression" => "; gltfpack -i x.glb -o y.glb unpacks them",
            _ => "",
        };
        Some(format!("its data are compressed by {name}, which is not read{advice}"))
    }

    /// Names of required extensions that are not read, except for those that compress data.
    pub fn unread_extensions(&self) -> impl Iterator<Item = &str> {
        /// Extensions that need nothing beyond what is read.
        const READ: [&str; 1] = ["KHR_mesh_quantization"];
        let names = self.required.iter().map(String::as_str);
        names.filter(|name| !READ.contains(name) && !name.ends_with("_compression"))
    }

    /// The error, or for a file with compressed data the reason behind it.
    pub fn blamed(&self, error: FieldError) -> FieldError {
        match self.compression() {
            Some(reason) => FieldError::new(JsonPath::root().key("extensionsRequired"), reason),
            None => error,
        }
    }
}

#[derive(Deserialize)]
pub struct GltfAsset {
    pub version: String,
    #[serde(rename = "minVersion")]
    pub min_version: Option<String>,
    generator: Option<String>,
}

impl GltfAsset {
    /// Returns whether the file is of the first version of glTF.
    pub fn is_version_1(&self) -> bool {
        self.version.split('.').next() == Some("1")
    }

    /// Returns whether this program has written the file.
    pub fn is_of_this_program(&self) -> bool {
        self.generator.as_deref().is_some_and(is_this_program)
    }
}

#[derive(Deserialize)]
pub struct GltfNode {
    pub name: Option<String>,
    pub children: Option<Vec<Whole>>,
    pub matrix: Option<Box<JsonNumbers<16>>>,
    pub translation: Option<JsonPoint>,
    pub rotation: Option<JsonNumbers<4>>,
    pub scale: Option<JsonPoint>,
    pub mesh: Option<Whole>,
    pub camera: Option<Whole>,
    pub skin: Option<Whole>,
    pub extras: Option<ReadExtras<NodeExtras>>,
}

#[derive(Default, Deserialize)]
pub struct GltfSkin {
    pub name: Option<String>,
    pub joints: Vec<Whole>,
    #[serde(rename = "inverseBindMatrices")]
    pub inverse_binds: Option<Whole>,
}

#[derive(Deserialize)]
pub struct GltfMesh {
    pub primitives: List<GltfPrimitive>,
}

#[derive(Deserialize)]
pub struct GltfPrimitive {
    /// Accessors by attribute, like `POSITION` or `JOINTS_0`.
    pub attributes: BTreeMap<String, Whole>,
    pub indices: Option<Whole>,
    pub material: Option<Whole>,
    pub mode: Option<Whole>,
    pub targets: Option<IgnoredAny>,
}

#[derive(Default, Deserialize)]
pub struct GltfMaterial {
    #[serde(rename = "pbrMetallicRoughness")]
    pub roughness: Option<JsonObject<GltfRoughness>>,
    #[serde(rename = "normalTexture")]
    pub normal: Option<IgnoredAny>,
    #[serde(rename = "occlusionTexture")]
    pub occlusion: Option<IgnoredAny>,
    #[serde(rename = "emissiveTexture")]
    pub emissive_texture: Option<IgnoredAny>,
    #[serde(rename = "emissiveFactor")]
    pub emissive: Option<JsonPoint>,
    #[serde(rename = "doubleSided")]
    pub double_sided: Option<bool>,
    #[serde(rename = "alphaMode")]
    pub alpha_mode: Option<String>,
    #[serde(default)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

#[derive(Default, Deserialize)]
pub struct GltfRoughness {
    #[serde(rename = "baseColorFactor")]
    pub factor: Option<JsonNumbers<4>>,
    #[serde(rename = "baseColorTexture")]
    pub texture: Option<JsonObject<GltfTextureUse>>,
    #[serde(rename = "metallicRoughnessTexture")]
    pub roughness_texture: Option<IgnoredAny>,
}

#[derive(Deserialize)]
pub struct GltfTextureUse {
    pub index: Whole,
    #[serde(rename = "texCoord")]
    pub coordinates: Option<Whole>,
    #[serde(default)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

#[derive(Deserialize)]
pub struct GltfTexture {
    pub source: Option<Whole>,
}

#[derive(Deserialize)]
pub struct GltfImage<'a> {
    #[serde(borrow)]
    pub uri: Option<Uri<'a>>,
    #[serde(rename = "bufferView")]
    pub view: Option<Whole>,
}

#[derive(Deserialize)]
pub struct GltfAnimation {
    pub name: Option<String>,
    pub channels: List<GltfChannel>,
    pub samplers: List<GltfSampler>,
    pub extras: Option<ReadExtras<AnimationExtras>>,
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
    pub extras: Option<ReadExtras<SamplerExtras>>,
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
    pub sparse: Option<JsonObject<GltfSparse>>,
}

/// Rows of an accessor that replace those of its buffer view.
#[derive(Deserialize)]
pub struct GltfSparse {
    pub count: Whole,
    pub indices: JsonObject<GltfSparseIndices>,
    pub values: JsonObject<GltfSparseValues>,
}

#[derive(Deserialize)]
pub struct GltfSparseIndices {
    #[serde(rename = "bufferView")]
    pub view: Whole,
    #[serde(rename = "byteOffset")]
    pub offset: Option<Whole>,
    #[serde(rename = "componentType")]
    pub component: Whole,
}

#[derive(Deserialize)]
pub struct GltfSparseValues {
    #[serde(rename = "bufferView")]
    pub view: Whole,
    #[serde(rename = "byteOffset")]
    pub offset: Option<Whole>,
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
pub struct GltfBuffer<'a> {
    #[serde(rename = "byteLength")]
    pub length: Whole,
    #[serde(borrow)]
    pub uri: Option<Uri<'a>>,
}

/// The name of a file, or data, which may be most of the text. Borrows from the text, unless it has
/// escapes.
#[derive(Deserialize)]
pub struct Uri<'a>(#[serde(borrow)] pub Cow<'a, str>);

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
