use std::io::Read;
use std::path::Path;

use super::error::OpenError;
use super::file_format::FileFormat;
use super::opened::Opened;
use super::source::Source;
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
    match (FileFormat::detect(source)?, skeleton) {
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
