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

/// Opens a document, a Scotty3D scene, a glTF file (text or binary) or a BVH file. The format is
/// detected by the content. If the file has several skeletons, the one called `skeleton` is opened,
/// or with `None` the first.
///
/// # Errors
///
/// Fails if the file cannot be read, has none of these formats, has invalid content, or has no
/// skeleton called `skeleton`.
pub fn open(path: &Path, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    open_source(&Source::open(path)?, skeleton)
}

/// Like [`open`], but reads the content from `input`. Errors call the file `name`.
///
/// # Errors
///
/// See [`open`].
pub fn read(name: &str, input: impl Read, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    open_source(&Source::read(name, input)?, skeleton)
}

/// Like [`open`], but takes the content as a text. Errors call the file `name`.
///
/// # Errors
///
/// See [`open`].
pub fn parse(name: &str, text: &str, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    open_source(&Source::new(name, text), skeleton)
}

fn open_source(source: &Source, skeleton: Option<&str>) -> Result<Opened, OpenError> {
    match (detect_format(source)?, skeleton) {
        (FileFormat::Scene, skeleton) => js3d::read(source, skeleton),
        (FileFormat::Gltf, skeleton) => gltf::read(source, skeleton),
        (FileFormat::Motion, skeleton) => bvh::read(source, skeleton),
        (FileFormat::Document, None) => format::read(source),
        (FileFormat::Document, Some(name)) => Err(OpenError::NoSkeleton {
            file: source.name().to_owned(),
            name: name.to_owned(),
            names: Vec::new(),
        }),
    }
}

#[derive(Clone, Copy)]
enum FileFormat {
    Document,
    Scene,
    Gltf,
    Motion,
}

/// Detects the format by the first word or key that identifies it, and parses no further.
fn detect_format(source: &Source) -> Result<FileFormat, OpenError> {
    if source.binary().is_some() {
        return Ok(FileFormat::Gltf);
    }
    if bvh::is_bvh(source.text()) {
        return Ok(FileFormat::Motion);
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
