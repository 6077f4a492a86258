use std::borrow::Cow;
use std::fmt;

use serde::de::{Deserializer as _, Error as _, IgnoredAny, MapAccess, Visitor};

use super::bvh;
use crate::io::error::OpenError;
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::io::json::Whole;
use crate::io::source::Source;

/// The format of a file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum FileFormat {
    /// A document of this program.
    Document,
    /// A Scotty3D scene.
    Scene,
    /// glTF, text or binary.
    Gltf,
    /// BVH.
    Motion,
}

impl FileFormat {
    /// Detects the format by the first word or key that identifies it, and parses no further.
    pub fn detect(source: &Source) -> Result<Self, OpenError> {
        if source.binary().is_some() {
            return Ok(Self::Gltf);
        }
        if bvh::is_bvh(source.text()) {
            return Ok(Self::Motion);
        }
        let mut format = None;
        let mut json = serde_json::Deserializer::from_str(source.text());
        let read = json.deserialize_map(FileFormatVisitor(&mut format)).and_then(|()| json.end());
        match (format, read) {
            (Some(format), _) => Ok(format),
            (None, Err(error)) => Err(source.parse_error(&JsonPath::root(), &error)),
            (None, Ok(())) => {
                let reason = "must have \"format\" (a document of ik-arm), \"scene\" (a .js3d file of \
                              Scotty3D) or \"asset\" (glTF)";
                Err(source.error(&FieldError::new(JsonPath::root(), reason)))
            }
        }
    }
}

struct FileFormatVisitor<'a>(&'a mut Option<FileFormat>);

impl<'de> Visitor<'de> for FileFormatVisitor<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object: {…}")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<Cow<'_, str>>()? {
            let format = match &*key {
                "format" => FileFormat::Document,
                // A number can be the "scene" of a glTF file whose "asset" comes later.
                "scene" if map.next_value::<Whole>().is_ok() => {
                    *self.0 = Some(FileFormat::Scene);
                    continue;
                }
                "scene" => FileFormat::Scene,
                "asset" => FileFormat::Gltf,
                _ => {
                    map.next_value::<IgnoredAny>()?;
                    continue;
                }
            };
            *self.0 = Some(format);
            // Stops the parser; the caller ignores this error.
            return Err(A::Error::custom("the format is detected"));
        }
        Ok(())
    }
}
