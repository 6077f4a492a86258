use std::collections::BTreeMap;

use super::buffers::{GltfBuffers, is_file, read_uri};
use super::file::{
    GltfFile, GltfImage, GltfMaterial, GltfRoughness, GltfTextureUse, Uri, index_rule,
};
use super::rows::view_bytes;
use crate::io::error::OpenError;
use crate::io::formats::gltf::conversions::srgb;
use crate::io::json::JsonPath;
use crate::io::json::{FieldError, FieldWarnings};
use crate::io::json::{JsonNumbers, JsonObject};
use crate::io::source::Source;
use crate::io::texture::TextureReader;
use crate::kinematics::Shared;
use crate::rig::SkinTexture;

/// What a skin takes of a material.
#[derive(Clone)]
pub struct PartMaterial {
    /// Colour as sRGB channels from 0 to 1.
    pub colour: [f32; 3],
    pub texture: Option<Shared<SkinTexture>>,
}

impl PartMaterial {
    /// White, for primitives without a material.
    pub const WHITE: Self = Self { colour: [1.0; 3], texture: None };
}

/// Where the images of materials are.
pub struct MaterialSource<'a> {
    pub source: &'a Source,
    pub file: &'a GltfFile<'a>,
    pub buffers: &'a GltfBuffers<'a>,
}

/// The images of a skin that were read, by their index; `None` for one that cannot be used.
#[derive(Default)]
pub struct ImageCache {
    images: BTreeMap<usize, Option<Shared<SkinTexture>>>,
    reader: TextureReader,
}

impl ImageCache {
    /// Reads the base colour of a material. A texture that cannot be read is left out, with a warning.
    pub fn material(
        &mut self,
        from: &MaterialSource<'_>,
        material: &GltfMaterial,
        checksum: &mut crc32fast::Hasher,
        warnings: &mut FieldWarnings,
    ) -> PartMaterial {
        let Some(JsonObject(GltfRoughness { factor, texture, .. })) = &material.roughness else {
            return PartMaterial::WHITE;
        };
        let colour = factor
            .as_ref()
            .map_or([1.0; 3], |JsonNumbers([red, green, blue, _])| [*red, *green, *blue].map(srgb));
        let texture = texture.as_ref().and_then(|JsonObject(used)| {
            let texture = self.texture(from, used, checksum);
            texture
                .map_err(|error| warnings.push(error.field, format!("not read: {}", error.reason)))
                .ok()
                .flatten()
        });
        PartMaterial { colour, texture }
    }

    /// The image of a texture; `None` if it has failed before.
    fn texture(
        &mut self,
        from: &MaterialSource<'_>,
        used: &GltfTextureUse,
        checksum: &mut crc32fast::Hasher,
    ) -> Result<Option<Shared<SkinTexture>>, FieldError> {
        let (index, image) = image(from.file, used)?;
        if let Some(known) = self.images.get(&index) {
            return Ok(known.clone());
        }
        self.images.insert(index, None);
        let bytes = image_bytes(from, (index, image))?;
        if image.uri.as_ref().is_some_and(|Uri(uri)| is_file(uri)) {
            checksum.update(&bytes);
        }
        let error = |reason| FieldError::new(at_image(index), reason);
        let texture = Some(Shared::from(self.reader.read(bytes).map_err(error)?));
        self.images.insert(index, texture.clone());
        Ok(texture)
    }
}

impl GltfMaterial {
    fn texture_use(&self) -> Option<&GltfTextureUse> {
        let JsonObject(GltfRoughness { texture, .. }) = self.roughness.as_ref()?;
        texture.as_ref().map(|JsonObject(texture)| texture)
    }

    /// Number of the set of texture coordinates that the base colour takes.
    pub fn coordinates(&self) -> u32 {
        self.texture_use().and_then(|used| used.coordinates).map_or(0, |set| set.0)
    }

    /// Buffer view of the base colour's image, if it is in one.
    pub fn image_view(&self, file: &GltfFile<'_>) -> Option<usize> {
        let (_, image) = image(file, self.texture_use()?).ok()?;
        Some(image.view?.0 as usize)
    }

    /// Names of the channels that are not read.
    pub fn unread(&self) -> impl Iterator<Item = String> {
        let roughness = self.roughness.as_ref().map(|JsonObject(roughness)| roughness);
        let of_roughness = roughness.and_then(|it| it.roughness_texture.as_ref());
        let glow = self.emissive.is_some_and(|it| it.0 != glam::Vec3::ZERO);
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

fn at_image(index: usize) -> JsonPath {
    JsonPath::root().key("images").index(index)
}

/// The image of a texture, with its index.
fn image<'a>(
    file: &'a GltfFile<'a>,
    used: &GltfTextureUse,
) -> Result<(usize, &'a GltfImage<'a>), FieldError> {
    let index = used.index.0 as usize;
    let at = JsonPath::root().key("textures").index(index);
    let Some(texture) = file.textures.0.get(index) else {
        return Err(FieldError::new(at, index_rule("textures", file.textures.0.len(), index)));
    };
    let Some(source) = texture.source else {
        return Err(FieldError::new(at, "must have an image in PNG or JPEG as its source"));
    };
    let image = source.0 as usize;
    let found = file.images.0.get(image).ok_or_else(|| {
        FieldError::new(at.key("source"), index_rule("images", file.images.0.len(), image))
    })?;
    Ok((image, found))
}

fn image_bytes(
    from: &MaterialSource<'_>,
    (index, image): (usize, &GltfImage<'_>),
) -> Result<Vec<u8>, FieldError> {
    let MaterialSource { source, file, buffers } = *from;
    let at = at_image(index);
    match (&image.uri, image.view) {
        (Some(Uri(uri)), _) => read_uri(source, uri, OpenError::MAX_BYTES as usize)
            .map_err(|reason| FieldError::new(at.key("uri"), reason)),
        (None, Some(view)) => Ok(view_bytes(file, buffers, view.0 as usize, &at)?.to_vec()),
        (None, None) => Err(FieldError::new(at, "must have a uri or a buffer view")),
    }
}
