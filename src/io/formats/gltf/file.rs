//! The JSON of a file, for reading and writing: those fields that concern skeletons, their skins
//! and their motions. Fields are in the order in which they are written.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserializer, Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::extras::{
    AnimationExtras, Extras, MeshExtras, NodeExtras, SamplerExtras, is_this_program, this_program,
};
use super::material::{GltfImage, GltfMaterial, GltfTexture, TEXTURE_TRANSFORM, Uri};
use crate::io::json::{
    FieldError, JsonNumber, JsonNumbers, JsonObject, JsonPath, JsonPoint, Whole,
};

#[derive(Default, Deserialize, Serialize)]
pub struct GltfFile<'a> {
    #[serde(default, skip_serializing_if = "List::is_empty")]
    pub accessors: List<GltfAccessor>,
    #[serde(default, skip_serializing_if = "List::is_empty")]
    pub animations: List<GltfAnimation>,
    pub asset: JsonObject<GltfAsset>,
    #[serde(borrow, default, skip_serializing_if = "List::is_empty")]
    pub buffers: List<GltfBuffer<'a>>,
    #[serde(default, rename = "bufferViews", skip_serializing_if = "List::is_empty")]
    pub views: List<GltfBufferView>,
    #[serde(skip_deserializing)]
    pub scene: u32,
    #[serde(default, skip_serializing)]
    pub extensions: GltfExtensions,
    #[serde(default, rename = "extensionsRequired", skip_serializing)]
    pub required: Vec<String>,
    #[serde(borrow, default, skip_serializing_if = "List::is_empty")]
    pub images: List<GltfImage<'a>>,
    #[serde(default, skip_serializing_if = "List::is_empty")]
    pub materials: List<GltfMaterial>,
    #[serde(default, skip_serializing_if = "List::is_empty")]
    pub meshes: List<GltfMesh>,
    #[serde(default, skip_serializing_if = "List::is_empty")]
    pub nodes: List<GltfNode>,
    #[serde(skip_deserializing)]
    pub scenes: [GltfScene; 1],
    #[serde(default, skip_serializing_if = "List::is_empty")]
    pub skins: List<GltfSkin>,
    #[serde(default, skip_serializing_if = "List::is_empty")]
    pub textures: List<GltfTexture>,
}

/// Extensions of a file that are read: which nodes are bones of a humanoid, as VRM tells it.
#[derive(Default, Deserialize)]
pub struct GltfExtensions {
    /// VRM 0.x.
    #[serde(rename = "VRM")]
    vrm_0: Option<serde_json::Value>,
    #[serde(rename = "VRMC_vrm")]
    vrm_1: Option<serde_json::Value>,
    #[serde(rename = "VRMC_vrm_animation")]
    vrm_animation: Option<serde_json::Value>,
}

impl GltfExtensions {
    /// The nodes that are bones of a humanoid, with the names of these bones; none without one. What is
    /// no number of a node is left out.
    pub fn humanoid<'a>(&'a self) -> Vec<(usize, &'a str)> {
        let bones = |vrm: &'a serde_json::Value| {
            let bones = vrm.get("humanoid")?.get("humanBones")?;
            let node = |bone: &serde_json::Value| usize::try_from(bone.get("node")?.as_u64()?).ok();
            let listed = |bone: &'a serde_json::Value| {
                Some((
                    node(bone)?,
                    bone.get("bone").and_then(|name| name.as_str()).unwrap_or_default(),
                ))
            };
            // By names, or in VRM 0.x as a list.
            Some(match bones {
                serde_json::Value::Object(bones) => {
                    bones.iter().filter_map(|(name, bone)| Some((node(bone)?, &**name))).collect()
                }
                serde_json::Value::Array(bones) => bones.iter().filter_map(listed).collect(),
                _ => Vec::new(),
            })
        };
        let all = [&self.vrm_1, &self.vrm_animation, &self.vrm_0];
        all.into_iter().flatten().find_map(bones).unwrap_or_default()
    }

    /// Returns whether the file is a figure of VRM 0.x, which looks along −z.
    pub fn looks_back(&self) -> bool {
        self.vrm_0.is_some() && self.vrm_1.is_none()
    }
}

/// What tells the version of a file, in which everything else may be as in another version.
#[derive(Deserialize)]
pub struct VersionedFile {
    asset: serde_json::Value,
    nodes: Option<serde_json::Value>,
}

impl VersionedFile {
    /// Returns whether the file is of the first version of glTF: by its number, or without one by
    /// its lists, which are objects.
    pub fn is_version_1(&self) -> bool {
        match self.asset.get("version") {
            Some(serde_json::Value::String(version)) => version.split('.').next() == Some("1"),
            Some(version) => version.as_f64().is_some_and(|version| version.trunc() == 1.0),
            None => self.nodes.as_ref().is_some_and(serde_json::Value::is_object),
        }
    }
}

/// The extension that compresses meshes, which is read.
pub const DRACO: &str = "KHR_draco_mesh_compression";

impl GltfFile<'_> {
    /// Why compressed data cannot be read, and what makes them readable; `None` for a file whose
    /// data are all there without extensions.
    pub fn compression(&self) -> Option<String> {
        let is_unread = |name: &&String| name.ends_with("_compression") && *name != DRACO;
        let name = self.required.iter().find(is_unread)?;
        let advice = match name.as_str() {
            "EXT_meshopt_compression" => "; gltfpack -i x.glb -o y.glb unpacks them",
            _ => "",
        };
        Some(format!("its data are compressed by {name}, which is not read{advice}"))
    }

    /// Names of required extensions that are not read, except for those that compress data.
    pub fn unread_extensions(&self) -> impl Iterator<Item = &str> {
        /// Extensions that need nothing beyond what is read.
        const READ: [&str; 2] = ["KHR_mesh_quantization", TEXTURE_TRANSFORM];
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

#[derive(Default, Deserialize, Serialize)]
pub struct GltfAsset {
    #[serde(skip_serializing_if = "Option::is_none")]
    generator: Option<String>,
    #[serde(rename = "minVersion", skip_serializing_if = "Option::is_none")]
    pub min_version: Option<String>,
    pub version: String,
}

impl GltfAsset {
    /// The asset of a file that this program writes.
    pub fn of_this_program() -> Self {
        Self { generator: Some(this_program()), min_version: None, version: "2.0".to_owned() }
    }

    /// Returns whether this program has written the file.
    pub fn is_of_this_program(&self) -> bool {
        self.generator.as_deref().is_some_and(is_this_program)
    }
}

#[derive(Default, Deserialize, Serialize)]
pub struct GltfNode {
    #[serde(skip_serializing)]
    pub camera: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub children: Option<Vec<Whole>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extras: Option<Extras<NodeExtras>>,
    #[serde(skip_serializing)]
    pub matrix: Option<Box<JsonNumbers<16>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<JsonNumbers<4>>,
    #[serde(skip_serializing)]
    pub scale: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub translation: Option<JsonPoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skin: Option<Whole>,
    /// Weights of the mesh's morph targets, instead of those of the mesh.
    #[serde(skip_serializing)]
    pub weights: Option<Vec<JsonNumber>>,
}

/// A scene, which only tells other programs what to show.
#[derive(Default, Serialize)]
pub struct GltfScene {
    pub nodes: Vec<Whole>,
}

#[derive(Default, Deserialize, Serialize)]
pub struct GltfSkin {
    #[serde(rename = "inverseBindMatrices", skip_serializing_if = "Option::is_none")]
    pub inverse_binds: Option<Whole>,
    pub joints: Vec<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    #[serde(skip_deserializing)]
    pub skeleton: Option<Whole>,
}

#[derive(Deserialize, Serialize)]
pub struct GltfMesh {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extras: Option<Extras<MeshExtras>>,
    #[serde(skip_deserializing)]
    pub name: String,
    pub primitives: List<GltfPrimitive>,
    /// Weights of the morph targets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<JsonNumber>>,
}

#[derive(Default, Deserialize, Serialize)]
pub struct GltfPrimitive {
    /// Accessors by attribute, like `POSITION` or `JOINTS_0`.
    #[serde(serialize_with = "write_attributes")]
    pub attributes: BTreeMap<String, Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub indices: Option<Whole>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<Whole>,
    #[serde(skip_serializing)]
    pub mode: Option<Whole>,
    #[serde(default, skip_serializing)]
    pub extensions: PrimitiveExtensions,
    /// The morph targets: accessors of changes by attribute.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub targets: Vec<BTreeMap<String, Whole>>,
}

/// Extensions of a primitive that are read.
#[derive(Default, Deserialize)]
pub struct PrimitiveExtensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    draco: Option<JsonObject<DracoFields>>,
}

/// A compressed mesh.
#[derive(Deserialize)]
pub struct DracoFields {
    #[serde(rename = "bufferView")]
    pub view: Whole,
    /// Numbers of attributes in the compressed mesh, by their names.
    pub attributes: BTreeMap<String, Whole>,
}

impl GltfPrimitive {
    /// The compressed mesh, if there is one.
    pub fn draco(&self) -> Option<&DracoFields> {
        self.extensions.draco.as_ref().map(|JsonObject(fields)| fields)
    }
}

/// Attributes that are written, in their order.
const WRITTEN: [&str; 7] =
    ["POSITION", "NORMAL", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0", "JOINTS_0", "WEIGHTS_0"];

fn write_attributes<S: Serializer>(
    all: &BTreeMap<String, Whole>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(WRITTEN.iter().filter_map(|name| Some((name, all.get(*name)?))))
}

#[derive(Deserialize, Serialize)]
pub struct GltfAnimation {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extras: Option<Extras<AnimationExtras>>,
    pub channels: List<GltfChannel>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    pub samplers: List<GltfSampler>,
}

#[derive(Deserialize, Serialize)]
pub struct GltfChannel {
    pub sampler: Whole,
    pub target: JsonObject<GltfTarget>,
}

#[derive(Deserialize, Serialize)]
pub struct GltfTarget {
    pub node: Option<Whole>,
    pub path: String,
}

#[derive(Deserialize, Serialize)]
pub struct GltfSampler {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extras: Option<Extras<SamplerExtras>>,
    pub input: Whole,
    pub interpolation: Option<String>,
    pub output: Whole,
}

/// Interpolation of a sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyCurve {
    Linear,
    Step,
    CubicSpline,
}

impl KeyCurve {
    /// Returns the curve that has this name in files.
    pub fn new(name: &str) -> Option<Self> {
        [Self::Linear, Self::Step, Self::CubicSpline].into_iter().find(|it| it.name() == name)
    }

    /// Name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "LINEAR",
            Self::Step => "STEP",
            Self::CubicSpline => "CUBICSPLINE",
        }
    }

    /// Number of values of a key: for a cubic spline the in-tangent, the value and the out-tangent.
    pub fn values_per_key(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

/// Type of the numbers of an accessor, with its code in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    I8 = 5120,
    U8 = 5121,
    I16 = 5122,
    U16 = 5123,
    U32 = 5125,
    F32 = 5126,
}

impl Component {
    /// The type with this code.
    pub fn new(code: Whole) -> Option<Self> {
        let all = [Self::I8, Self::U8, Self::I16, Self::U16, Self::U32, Self::F32];
        all.into_iter().find(|component| *component as u32 == code.0)
    }

    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The little-endian number in as many bytes as the component has.
    pub fn number(self, bytes: &[u8]) -> f64 {
        let mut four = [0; 4];
        four.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
        let [a, b, ..] = four;
        match self {
            Self::I8 => f64::from(i8::from_le_bytes([a])),
            Self::U8 => f64::from(a),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::U32 => f64::from(u32::from_le_bytes(four)),
            Self::F32 => f64::from(f32::from_le_bytes(four)),
        }
    }

    /// The integer that stands for 1 if numbers are normalized; `None` for floats.
    pub fn largest(self) -> Option<f64> {
        Some(match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::U32 => 4_294_967_295.0,
            Self::F32 => return None,
        })
    }
}

#[derive(Deserialize, Serialize)]
pub struct GltfAccessor {
    #[serde(rename = "bufferView", skip_serializing_if = "Option::is_none")]
    pub view: Option<Whole>,
    #[serde(rename = "byteOffset", skip_serializing_if = "Option::is_none")]
    pub offset: Option<Whole>,
    pub count: Whole,
    #[serde(rename = "componentType")]
    pub component: Whole,
    #[serde(rename = "type")]
    pub shape: Cow<'static, str>,
    #[serde(skip_deserializing, skip_serializing_if = "Vec::is_empty")]
    pub min: Vec<f64>,
    #[serde(skip_deserializing, skip_serializing_if = "Vec::is_empty")]
    pub max: Vec<f64>,
    #[serde(skip_serializing)]
    pub normalized: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sparse: Option<JsonObject<GltfSparse>>,
}

impl GltfAccessor {
    /// The integer that stands for 1; `None` if numbers are not normalized.
    pub fn largest(&self) -> Option<f64> {
        let component = Component::new(self.component)?;
        let is_normalized = self.normalized == Some(true) && component != Component::U32;
        component.largest().filter(|_| is_normalized)
    }
}

/// Rows of an accessor that replace those of its buffer view.
#[derive(Deserialize, Serialize)]
pub struct GltfSparse {
    pub count: Whole,
    pub indices: JsonObject<GltfSparseIndices>,
    pub values: JsonObject<GltfSparseValues>,
}

#[derive(Deserialize, Serialize)]
pub struct GltfSparseIndices {
    #[serde(rename = "bufferView")]
    pub view: Whole,
    #[serde(rename = "byteOffset", skip_serializing_if = "Option::is_none")]
    pub offset: Option<Whole>,
    #[serde(rename = "componentType")]
    pub component: Whole,
}

#[derive(Deserialize, Serialize)]
pub struct GltfSparseValues {
    #[serde(rename = "bufferView")]
    pub view: Whole,
    #[serde(rename = "byteOffset", skip_serializing_if = "Option::is_none")]
    pub offset: Option<Whole>,
}

#[derive(Deserialize, Serialize)]
pub struct GltfBufferView {
    pub buffer: Whole,
    #[serde(rename = "byteLength")]
    pub length: Whole,
    #[serde(rename = "byteOffset")]
    pub offset: Option<Whole>,
    #[serde(rename = "byteStride", skip_serializing)]
    pub stride: Option<Whole>,
    #[serde(skip_deserializing, skip_serializing_if = "Option::is_none")]
    pub target: Option<Whole>,
}

#[derive(Deserialize, Serialize)]
pub struct GltfBuffer<'a> {
    #[serde(rename = "byteLength")]
    pub length: Whole,
    #[serde(borrow, skip_serializing)]
    pub uri: Option<Uri<'a>>,
}

/// An array of objects. Its length is limited, so that a malicious file cannot exhaust the memory.
#[derive(Serialize)]
#[serde(transparent)]
pub struct List<T>(pub Vec<T>);

/// Returns the error message for an index that is not below `count`, the number of `items`.
pub fn index_rule(items: &str, count: usize, index: usize) -> String {
    format!("must be below {count}, the number of {items}, got {index}")
}

impl<T> List<T> {
    const MAX_LENGTH: usize = 200_000;

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds an entry, and returns its index.
    pub fn push(&mut self, entry: T) -> Whole {
        self.0.push(entry);
        whole(self.0.len() - 1)
    }
}

/// A number of bytes or entries of a file that this program writes, which are below 2³².
pub fn whole(number: usize) -> Whole {
    Whole(u32::try_from(number).unwrap_or(u32::MAX))
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
