//! Materials and their images.

use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::Vec3;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::io::json::{JsonNumbers, JsonObject, JsonPoint, Whole};

#[derive(Default, Deserialize, Serialize)]
pub struct GltfMaterial {
    #[serde(rename = "alphaMode")]
    pub alpha_mode: Option<String>,
    #[serde(rename = "doubleSided")]
    pub double_sided: Option<bool>,
    #[serde(rename = "pbrMetallicRoughness")]
    pub roughness: Option<JsonObject<GltfRoughness>>,
    #[serde(rename = "normalTexture", skip_serializing)]
    pub normal: Option<IgnoredAny>,
    #[serde(rename = "occlusionTexture", skip_serializing)]
    pub occlusion: Option<IgnoredAny>,
    #[serde(rename = "emissiveTexture", skip_serializing)]
    pub emissive_texture: Option<IgnoredAny>,
    #[serde(rename = "emissiveFactor")]
    pub emissive: Option<JsonPoint>,
    #[serde(default, skip_serializing)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

impl GltfMaterial {
    /// An opaque surface without gloss. `colour` has sRGB channels from 0 to 1.
    pub fn matte(colour: [f32; 3], texture: Option<Whole>) -> Self {
        let [red, green, blue] = colour.map(linear);
        let texture = texture.map(|index| GltfTextureUse {
            index,
            coordinates: Some(Whole(0)),
            extensions: BTreeMap::new(),
        });
        Self {
            alpha_mode: Some("OPAQUE".to_owned()),
            double_sided: Some(false),
            roughness: Some(JsonObject(GltfRoughness {
                factor: Some(JsonNumbers([red, green, blue, 1.0])),
                texture: texture.map(JsonObject),
                metallic: 0.0,
                roughness: 1.0,
                roughness_texture: None,
            })),
            emissive: Some(JsonPoint(Vec3::ZERO)),
            ..Self::default()
        }
    }

    /// The image of the base colour.
    pub fn texture_use(&self) -> Option<&GltfTextureUse> {
        let JsonObject(GltfRoughness { texture, .. }) = self.roughness.as_ref()?;
        texture.as_ref().map(|JsonObject(texture)| texture)
    }

    /// Number of the set of texture coordinates that the base colour takes.
    pub fn coordinates(&self) -> u32 {
        self.texture_use().and_then(|used| used.coordinates).map_or(0, |set| set.0)
    }

    /// Names of the channels that are not read.
    pub fn unread(&self) -> impl Iterator<Item = String> {
        let roughness = self.roughness.as_ref().map(|JsonObject(roughness)| roughness);
        let of_roughness = roughness.and_then(|it| it.roughness_texture.as_ref());
        let glow = self.emissive.is_some_and(|it| it.0 != Vec3::ZERO);
        let alpha = self.alpha_mode.as_deref().unwrap_or("OPAQUE");
        let channels = [
            ("normal textures", self.normal.is_some()),
            ("occlusion textures", self.occlusion.is_some()),
            ("emission", glow || self.emissive_texture.is_some()),
            ("metallic and roughness textures", of_roughness.is_some()),
            ("transparency", alpha != "OPAQUE"),
            ("back faces of double-sided materials", self.double_sided.unwrap_or(false)),
        ];
        let named = channels.into_iter().filter(|(_, has)| *has).map(|(name, _)| name.to_owned());
        let of_texture = self.texture_use().into_iter().flat_map(|used| used.extensions.keys());
        named.chain(self.extensions.keys().chain(of_texture).cloned())
    }
}

#[derive(Default, Deserialize, Serialize)]
pub struct GltfRoughness {
    #[serde(rename = "baseColorFactor")]
    factor: Option<JsonNumbers<4>>,
    #[serde(rename = "baseColorTexture", skip_serializing_if = "Option::is_none")]
    pub texture: Option<JsonObject<GltfTextureUse>>,
    #[serde(rename = "metallicFactor", skip_deserializing)]
    metallic: f32,
    #[serde(rename = "roughnessFactor", skip_deserializing)]
    roughness: f32,
    #[serde(rename = "metallicRoughnessTexture", skip_serializing)]
    pub roughness_texture: Option<IgnoredAny>,
}

impl GltfRoughness {
    /// The base colour as sRGB channels from 0 to 1.
    pub fn colour(&self) -> [f32; 3] {
        let factor = self.factor.as_ref();
        factor
            .map_or([1.0; 3], |JsonNumbers([red, green, blue, _])| [*red, *green, *blue].map(srgb))
    }
}

/// The linear channel of an sRGB one.
fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB channel of a linear one, which is clamped to 0 to 1.
fn srgb(linear: f32) -> f32 {
    match linear {
        1.0.. => 1.0,
        0.003_130_8.. => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
        0.0.. => 12.92 * linear,
        _ => 0.0,
    }
}

#[derive(Deserialize, Serialize)]
pub struct GltfTextureUse {
    pub index: Whole,
    #[serde(rename = "texCoord")]
    pub coordinates: Option<Whole>,
    #[serde(default, skip_serializing)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

#[derive(Deserialize, Serialize)]
pub struct GltfTexture {
    pub source: Option<Whole>,
}

#[derive(Default, Deserialize, Serialize)]
pub struct GltfImage<'a> {
    #[serde(rename = "bufferView")]
    pub view: Option<Whole>,
    #[serde(rename = "mimeType", skip_deserializing)]
    pub mime: &'static str,
    #[serde(borrow, skip_serializing)]
    pub uri: Option<Uri<'a>>,
}

/// The name of a file, or data, which may be most of the text. Borrows from the text, unless it has
/// escapes.
#[derive(Deserialize)]
pub struct Uri<'a>(#[serde(borrow)] pub Cow<'a, str>);
