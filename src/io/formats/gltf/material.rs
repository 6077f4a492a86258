//! Materials and their images.

use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::{Affine2, Vec2, Vec3};
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::io::json::{JsonNumber, JsonNumbers, JsonObject, JsonPoint, Whole};
use crate::rig::PartLook;

#[derive(Default, Deserialize, Serialize)]
pub struct GltfMaterial {
    #[serde(rename = "alphaMode")]
    pub alpha_mode: Option<String>,
    #[serde(rename = "alphaCutoff", skip_serializing_if = "Option::is_none")]
    alpha_cutoff: Option<JsonNumber>,
    #[serde(rename = "doubleSided")]
    pub double_sided: Option<bool>,
    #[serde(rename = "pbrMetallicRoughness")]
    pub roughness: Option<JsonObject<GltfRoughness>>,
    #[serde(rename = "normalTexture", skip_serializing)]
    pub normal: Option<IgnoredAny>,
    #[serde(rename = "occlusionTexture", skip_serializing)]
    pub occlusion: Option<IgnoredAny>,
    #[serde(rename = "emissiveTexture", skip_serializing_if = "Option::is_none")]
    pub emissive_texture: Option<JsonObject<GltfTextureUse>>,
    #[serde(rename = "emissiveFactor")]
    pub emissive: Option<JsonPoint>,
    #[serde(default, skip_serializing)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

impl GltfMaterial {
    /// A surface without gloss, with the look of a part of a skin and the indices of the textures of
    /// its colour and of its emission, whose texture coordinates have the number `emission_set`.
    /// `colour` has sRGB channels from 0 to 1.
    pub fn matte(
        colour: [f32; 3],
        [texture, emission_texture]: [Option<Whole>; 2],
        emission_set: u32,
        look: &PartLook,
    ) -> Self {
        let PartLook { is_double_sided, alpha_cutoff, opacity, emission } = *look;
        let is_masked = alpha_cutoff > 0.0;
        let alpha_mode = match opacity {
            Some(_) => "BLEND",
            None if is_masked => "MASK",
            None => "OPAQUE",
        };
        let [red, green, blue] = colour.map(linear);
        let used = |index, set| {
            let (coordinates, extensions) = (Some(Whole(set)), BTreeMap::new());
            JsonObject(GltfTextureUse { index, coordinates, extensions })
        };
        Self {
            alpha_mode: Some(alpha_mode.to_owned()),
            alpha_cutoff: (alpha_mode == "MASK").then_some(JsonNumber(alpha_cutoff)),
            double_sided: Some(is_double_sided),
            roughness: Some(JsonObject(GltfRoughness {
                factor: Some(JsonNumbers([red, green, blue, opacity.unwrap_or(1.0)])),
                texture: texture.map(|index| used(index, 0)),
                metallic: 0.0,
                roughness: 1.0,
                roughness_texture: None,
            })),
            emissive_texture: emission_texture.map(|index| used(index, emission_set)),
            emissive: Some(JsonPoint(Vec3::from(emission.map(linear)))),
            ..Self::default()
        }
    }

    /// The texture that gives the texture coordinates: that of the base colour, else of the emission.
    pub fn coordinates_of(&self) -> Option<&GltfTextureUse> {
        self.texture_use().or(self.emission_use())
    }

    /// The image of the emission.
    pub fn emission_use(&self) -> Option<&GltfTextureUse> {
        self.emissive_texture.as_ref().map(|JsonObject(used)| used)
    }

    /// The image of the emission, if its texture coordinates are others than those of the base colour.
    pub fn apart_emission(&self) -> Option<&GltfTextureUse> {
        let (used, own) = (self.emission_use()?, self.coordinates_of()?);
        (used.set() != own.set() || used.moved() != own.moved()).then_some(used)
    }

    /// The image of the base colour.
    pub fn texture_use(&self) -> Option<&GltfTextureUse> {
        let JsonObject(GltfRoughness { texture, .. }) = self.roughness.as_ref()?;
        texture.as_ref().map(|JsonObject(texture)| texture)
    }

    /// How the surface is drawn; with an `alpha_cutoff` above 1, not at all.
    pub fn look(&self) -> PartLook {
        /// The least opacity that is drawn if the file does not tell it.
        const CUTOFF: f32 = 0.5;
        let factor = self.roughness.as_ref().map_or(1.0, |JsonObject(it)| it.opacity());
        let alpha_cutoff = match self.alpha_mode.as_deref() {
            Some("MASK") => {
                let JsonNumber(cutoff) = self.alpha_cutoff.unwrap_or(JsonNumber(CUTOFF));
                // The opacity is that of the texture times the factor.
                if cutoff > 0.0 { (cutoff / factor.max(f32::MIN_POSITIVE)).min(2.0) } else { 0.0 }
            }
            _ => 0.0,
        };
        let is_blended = self.alpha_mode.as_deref() == Some("BLEND");
        let emission = self.emissive.map_or(Vec3::ZERO, |it| it.0).to_array().map(srgb);
        PartLook {
            is_double_sided: self.double_sided.unwrap_or(false),
            alpha_cutoff,
            opacity: is_blended.then_some(factor),
            emission,
        }
    }

    /// Numbers of the sets of texture coordinates that the textures take: that of the base colour, and
    /// that of the emission, if it is apart.
    pub fn sets(&self) -> (u32, Option<u32>) {
        let own = self.coordinates_of().map_or(0, GltfTextureUse::set);
        (own, self.apart_emission().map(GltfTextureUse::set))
    }

    /// Names of the channels that are not read.
    pub fn unread(&self) -> impl Iterator<Item = String> {
        let roughness = self.roughness.as_ref().map(|JsonObject(roughness)| roughness);
        let of_roughness = roughness.and_then(|it| it.roughness_texture.as_ref());
        let channels = [
            ("normal textures", self.normal.is_some()),
            ("occlusion textures", self.occlusion.is_some()),
            ("metallic and roughness textures", of_roughness.is_some()),
        ];
        let named = channels.into_iter().filter(|(_, has)| *has).map(|(name, _)| name.to_owned());
        let of_texture = self.texture_use().into_iter().flat_map(|used| used.extensions.keys());
        let of_texture = of_texture.filter(|name| *name != TEXTURE_TRANSFORM);
        named.chain(self.extensions.keys().chain(of_texture).cloned())
    }
}

/// The extension that moves texture coordinates.
pub const TEXTURE_TRANSFORM: &str = "KHR_texture_transform";

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
    /// The factor of the opacity, from 0 to 1.
    fn opacity(&self) -> f32 {
        self.factor.as_ref().map_or(1.0, |JsonNumbers([.., opacity])| opacity.clamp(0.0, 1.0))
    }

    /// The base colour as sRGB channels from 0 to 1.
    pub fn colour(&self) -> [f32; 3] {
        let factor = self.factor.as_ref();
        factor
            .map_or([1.0; 3], |JsonNumbers([red, green, blue, _])| [*red, *green, *blue].map(srgb))
    }
}

/// The linear channel of an sRGB one.
pub fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB channel of a linear one, which is clamped to 0 to 1.
pub fn srgb(linear: f32) -> f32 {
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
    pub extensions: BTreeMap<String, serde_json::Value>,
}

impl GltfTextureUse {
    /// Number of the set of texture coordinates.
    fn set(&self) -> u32 {
        let of_transform = self.transform().and_then(|it| it.get("texCoord")?.as_u64());
        let of_transform = of_transform.and_then(|set| u32::try_from(set).ok());
        of_transform.or(self.coordinates.map(|set| set.0)).unwrap_or_default()
    }

    fn transform(&self) -> Option<&serde_json::Value> {
        self.extensions.get(TEXTURE_TRANSFORM)
    }

    /// What moves texture coordinates: a scale, then a rotation, then an offset. Numbers that are not
    /// there, or are none, leave them as they are.
    pub fn moved(&self) -> Option<Affine2> {
        let transform = self.transform()?;
        let number = |value: Option<&serde_json::Value>, default: f64| {
            value.and_then(serde_json::Value::as_f64).unwrap_or(default) as f32
        };
        let pair = |key: &str, default: f64| {
            let values = transform.get(key);
            [0, 1].map(|index| number(values.and_then(|it| it.get(index)), default))
        };
        let [scale, offset] = [pair("scale", 1.0), pair("offset", 0.0)].map(Vec2::from);
        // Counter-clockwise with v downwards.
        let angle = -number(transform.get("rotation"), 0.0);
        Some(Affine2::from_scale_angle_translation(scale, angle, offset)).filter(Affine2::is_finite)
    }
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
