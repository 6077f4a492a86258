use std::io::Read;
use std::path::Path;

use super::error::{OpenError, Remark};
use super::formats::FileFormat;
use super::formats::{bvh, document, gltf, js3d};
use super::open_options::OpenOptions;
use super::opened::Opened;
use super::source::Source;
use super::turn_up;

/// Opens a document, a Scotty3D scene, a glTF file (text or binary) or a BVH file. The format is
/// detected by the content. `options` choose one of several skeletons and animations, and tell which axis
/// points up.
///
/// # Errors
///
/// Fails if the file cannot be read, has none of these formats, has invalid content, or has no
/// skeleton or animation of the given name.
pub fn open(path: &Path, options: &OpenOptions) -> Result<Opened, OpenError> {
    open_source(&limited(Source::open(path)?)?, options)
}

/// Like [`open`], but reads the content from `input`. Errors call the file `name`.
///
/// # Errors
///
/// See [`open`].
pub fn read(name: &str, input: impl Read, options: &OpenOptions) -> Result<Opened, OpenError> {
    open_source(&limited(Source::read(name, input)?)?, options)
}

/// Like [`open`], but takes the content as a text. Errors call the file `name`.
///
/// # Errors
///
/// See [`open`].
pub fn parse(name: &str, text: &str, options: &OpenOptions) -> Result<Opened, OpenError> {
    open_source(&Source::new(name, text), options)
}

/// Refuses a file that is larger than files other than glTF may be.
fn limited(source: Source) -> Result<Source, OpenError> {
    let is_large = source.text().len() as u64 > OpenError::MAX_BYTES;
    match is_large && FileFormat::detect(&source)? != FileFormat::Gltf {
        true => Err(source.too_large()),
        false => Ok(source),
    }
}

fn open_source(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let format = FileFormat::detect(source)?;
    let mut opened = read_format(source, format, options)?;
    if options.skeleton.is_none() {
        opened.warnings.extend(one_of_several(&opened.skeletons));
    }
    turn_up::turn_up(&mut opened, format, options.up);
    Ok(opened)
}

/// Remarks that a file has several skeletons, of which the first is read.
fn one_of_several(names: &[String]) -> Option<Remark> {
    /// Maximum number of names that are listed.
    const MOST: usize = 20;
    let [first, _, ..] = names else { return None };
    let quoted: Vec<_> = names.iter().take(MOST).map(|name| format!("{name:?}")).collect();
    let more = if names.len() > MOST { " …" } else { "" };
    let (count, list) = (names.len(), quoted.join(", "));
    let reason = format!("the skeleton {first:?} is read, one of {count}: {list}{more}");
    Some(Remark::new(reason))
}

fn read_format(
    source: &Source,
    format: FileFormat,
    options: &OpenOptions,
) -> Result<Opened, OpenError> {
    let OpenOptions { skeleton, animation, .. } = options;
    let (file, skeleton) = (source.name().to_owned(), skeleton.as_deref());
    let opened = match (format, skeleton) {
        (FileFormat::Gltf, _) => return gltf::read(source, options),
        (FileFormat::Scene, skeleton) => js3d::read(source, skeleton)?,
        (FileFormat::Motion, skeleton) => bvh::read(source, skeleton)?,
        (FileFormat::Document, None) => document::read(source, options)?,
        (FileFormat::Document, Some(name)) => {
            return Err(OpenError::NoSkeleton { file, name: name.to_owned(), names: Vec::new() });
        }
    };
    match animation {
        Some(name) => Err(OpenError::NoAnimation { file, name: name.clone(), names: Vec::new() }),
        None => Ok(opened),
    }
}
