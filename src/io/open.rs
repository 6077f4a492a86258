use std::borrow::Cow;
use std::fmt;
use std::io::Read;
use std::path::Path;

use serde::de::{Deserializer as _, Error as _, IgnoredAny, MapAccess, Visitor};

use super::error::OpenError;
use super::field_error::FieldError;
use super::json_path::JsonPath;
use super::opened::Opened;
use super::source::Source;
use super::value::Whole;
use super::{bvh, format, gltf, js3d};

/// Opens a document, a scene of Scotty3D, glTF (text or binary) or a motion in BVH, whichever the file
/// has; of a scene and of glTF the skeleton of that name, or the first.
///
/// # Errors
///
/// If the file cannot be read, or what is in it is no document.
pub fn open(path: &Path, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    opened(&Source::open(path)?, skeleton)
}

/// As [`open`], from something that is called `name` in errors.
///
/// # Errors
///
/// As [`open`].
pub fn read(name: &str, input: impl Read, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    opened(&Source::read(name, input)?, skeleton)
}

/// As [`open`], from a text that is called `name` in errors.
///
/// # Errors
///
/// As [`open`].
pub fn parse(name: &str, text: &str, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    opened(&Source::new(name, text), skeleton)
}

fn opened(source: &Source, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    match (kind(source)?, skeleton) {
        (Kind::Scene, skeleton) => js3d::read(source, skeleton),
        (Kind::Gltf, skeleton) => gltf::read(source, skeleton),
        (Kind::Motion, skeleton) => bvh::read(source, skeleton),
        (Kind::Document, None) => format::read(source),
        (Kind::Document, Some(name)) => Err(OpenError::NoSkeleton {
            file: source.name().to_owned(),
            name: name.to_owned(),
            names: Vec::new(),
        }),
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Document,
    Scene,
    Gltf,
    Motion,
}

/// What the first word or the first key that tells says; the rest is not read for it.
fn kind(source: &Source) -> Result<Kind, OpenError> {
    if source.binary().is_some() {
        return Ok(Kind::Gltf);
    }
    if bvh::is_bvh(source.text()) {
        return Ok(Kind::Motion);
    }
    let mut kind = None;
    let mut json = serde_json::Deserializer::from_str(source.text());
    let read = json.deserialize_map(KindVisitor(&mut kind)).and_then(|()| json.end());
    match (kind, read) {
        (Some(kind), _) => Ok(kind),
        (None, Err(error)) => Err(source.parse_error(&JsonPath::root(), &error)),
        (None, Ok(())) => {
            let reason = "neither \"format\" is there, as in a document of ik-arm, nor \"scene\", \
                          as in a .js3d file of Scotty3D, nor \"asset\", as in glTF";
            Err(source.error(&FieldError::new(JsonPath::root(), reason)))
        }
    }
}

struct KindVisitor<'a>(&'a mut Option<Kind>);

impl<'de> Visitor<'de> for KindVisitor<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object: {…}")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<Cow<'_, str>>()? {
            let kind = match &*key {
                "format" => Kind::Document,
                // In glTF this is a number, and tells nothing if "asset" comes, too.
                "scene" if map.next_value::<Whole>().is_ok() => {
                    *self.0 = Some(Kind::Scene);
                    continue;
                }
                "scene" => Kind::Scene,
                "asset" => Kind::Gltf,
                _ => {
                    map.next_value::<IgnoredAny>()?;
                    continue;
                }
            };
            *self.0 = Some(kind);
            return Err(A::Error::custom("enough is read"));
        }
        Ok(())
    }
}
