use std::io::Read;
use std::path::Path;

use super::error::{OpenError, Remark};
use super::formats::Reader;
use super::opened::{OpenOptions, Opened, Upwards};
use super::skin_file::load_skin;
use super::source::Source;
use crate::document::RigKind;

/// Opens a document, a Scotty3D scene, a glTF file (text or binary) or a BVH file. The format is
/// detected by the content. `options` choose one of several skeletons and animations, and tell
/// which axis points up.
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

/// Refuses a file that is larger than files of its format may be.
fn limited(source: Source) -> Result<Source, OpenError> {
    let bytes = source.text().len() as u64;
    if bytes > OpenError::MAX_BYTES && bytes > Reader::detect(&source)?.most_bytes() {
        return Err(source.too_large());
    }
    Ok(source)
}

fn open_source(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let reader = Reader::detect(source)?;
    let mut opened = reader.read(source, options)?;
    if let (Some(name), None) = (&options.animation, opened.animation) {
        let (file, name) = (source.name().to_owned(), name.clone());
        return Err(OpenError::NoAnimation { file, name, names: Vec::new() });
    }
    if reader.is_own() {
        let warnings = load_skin(&mut opened.document, source.folder());
        opened.warnings.extend(source.warnings(&warnings));
    }
    if options.skeleton.is_none() {
        opened.warnings.extend(one_of_several(&opened.skeletons));
    }
    // In a document of this program, y points up unless the caller knows better.
    let is_told = matches!(options.up, Some(Upwards::Y | Upwards::Z));
    let seems_z = !is_told && !reader.is_own() && opened.document.looks_z_up();
    turn_up(&mut opened, options.up, seems_z);
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

/// Turns the skeleton if z points up, or remarks that it seems to.
fn turn_up(opened: &mut Opened, up: Option<Upwards>, seems_z: bool) {
    let document = &mut opened.document;
    let turns = up == Some(Upwards::Z) || up == Some(Upwards::Auto) && seems_z;
    if turns && document.rig == RigKind::Skeleton {
        document.turn_y_up();
        document.camera = document.framing_camera();
    }
    if seems_z {
        let reason = if turns {
            "z points up: turned to y up"
        } else {
            "z seems to point up: --up z, or Edit → Turn to y up, turns it"
        };
        opened.warnings.push(Remark::new(reason.to_owned()));
    }
}
