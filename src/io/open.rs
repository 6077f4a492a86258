//! Opening files: the document, and the file that it takes the mesh of its skin from.

use std::io::{ErrorKind, Read};
use std::path::Path;

use super::error::{MOST_NAMES, OpenError, Remark, quoted};
use super::formats::Reader;
use super::json::{FieldWarnings, JsonPath};
use super::opened::{OpenOptions, Opened, Upwards};
use super::source::Source;
use crate::document::{Document, Skin};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::Skeleton;
use crate::rig::{FileMesh, MeshSkin, SkinFile, SkinFileError, SkinSource};

/// Opens a document, a Scotty3D scene, a glTF file (text or binary), a BVH, OBJ or URDF file. The
/// format is detected by the content. `options` choose one of several skeletons and animations, and
/// tell which axis points up.
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
    let up = match (options.up, reader.says_up()) {
        (None | Some(Upwards::Auto), Some(Upwards::Z)) => Some(Upwards::Z),
        (up, _) => up,
    };
    let is_doubtful = match up {
        Some(Upwards::Y | Upwards::Z) => false,
        Some(Upwards::Auto) => !reader.is_own(),
        None => reader.says_up().is_none(),
    };
    let seems_z = is_doubtful && opened.document.looks_z_up();
    turn_up(&mut opened, up, seems_z);
    Ok(opened)
}

/// Remarks that a file has several skeletons, of which the first is read.
fn one_of_several(names: &[String]) -> Option<Remark> {
    let [first, _, ..] = names else { return None };
    let (count, listed) = (names.len(), quoted(&names[..names.len().min(MOST_NAMES)]));
    let more = if count > MOST_NAMES { " …" } else { "" };
    let reason = format!("the skeleton {first:?} is read, one of {count}: {listed}{more}");
    Some(Remark::new(reason))
}

/// Turns the skeleton if z points up, or remarks that it seems to.
fn turn_up(opened: &mut Opened, up: Option<Upwards>, seems_z: bool) {
    let document = &mut opened.document;
    let turns = up == Some(Upwards::Z) || up == Some(Upwards::Auto) && seems_z;
    if turns {
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

/// Reads the file that the skin of a document refers to, from the folder of the document if its
/// path is relative. Warns if that is impossible or the file has changed; the skin then has no
/// mesh.
fn load_skin(document: &mut Document, folder: Option<&Path>) -> FieldWarnings {
    let mut warnings = FieldWarnings::default();
    let rig = &mut document.rig;
    let Some(Skin { source: SkinSource::Mesh(skin), .. }) = &mut rig.skin else { return warnings };
    let Some(file) = skin.file() else { return warnings };
    let path = folder.map_or_else(|| file.path.clone(), |folder| folder.join(&file.path));
    let located = SkinFile { path, ..file.clone() };
    let read = relocated_skin(&located.path, skin, &rig.skeleton);
    let is_unchanged =
        |read: &MeshSkin| read.file().is_some_and(|file| file.checksum == located.checksum);
    *skin = match read {
        Ok(read) if is_unchanged(&read) => read,
        other => {
            let error = other.err().unwrap_or(SkinFileError::Changed(located.path.clone()));
            let at = JsonPath::root().key("skin").key("mesh").key("file");
            warnings.push(at, error.to_string());
            let weights = skin.morph_weights().to_vec();
            MeshSkin::without_mesh(located, skin.joints().to_vec(), error)
                .with_morph_weights(weights)
        }
    };
    warnings
}

/// Takes the mesh of a skin from the file at `path` as it is now: from the skeleton of the same
/// name as before, or from the file's only one, and in the animation of the same name, or in the
/// first that moves the skeleton.
///
/// # Errors
///
/// [`SkinFileError`] if the file cannot be read, has no such mesh, or one for another number of
/// joints.
pub fn relocated_skin(
    path: &Path,
    skin: &MeshSkin,
    skeleton: &Skeleton,
) -> Result<MeshSkin, SkinFileError> {
    let before = skin.file();
    let skeleton_name = before.map_or("", |file| &file.skeleton);
    let mut options = OpenOptions {
        animation: before.and_then(|file| file.animation.clone()),
        ..OpenOptions::of_skeleton(skeleton_name)
    };
    let mut found = read_skin(path, &options);
    if matches!(found, Err(OpenError::NoAnimation { .. })) {
        options.animation = None;
        found = read_skin(path, &options);
    }
    if let Err(OpenError::NoSkeleton { names, .. }) = &found
        && names.len() == 1
    {
        options.skeleton = None;
        found = read_skin(path, &options);
    }
    let found = found.map_err(|error| match error {
        OpenError::Read { source, .. } if source.kind() == ErrorKind::NotFound => {
            SkinFileError::Missing(path.to_owned())
        }
        error => SkinFileError::Invalid(error.to_string()),
    })?;
    let invalid =
        |reason: String| Err(SkinFileError::Invalid(format!("{} {reason}", path.display())));
    let Some((mesh, file)) = found else {
        return invalid(format!("has no mesh on the skeleton {skeleton_name:?}"));
    };
    let (expected, got) = (skin.joints().len(), mesh.parents.len());
    if expected != got {
        return invalid(format!("must have a skeleton of {expected} joints, got {got}"));
    }
    let weights = skin.morph_weights().to_vec();
    let skin = MeshSkin::new(mesh, Some(file), skin.joints().to_vec(), skeleton);
    Ok(skin.with_morph_weights(weights))
}

/// The mesh on a skeleton of a file; `None` if it has none.
fn read_skin(
    path: &Path,
    options: &OpenOptions,
) -> Result<Option<(Shared<FileMesh>, SkinFile)>, OpenError> {
    let source = Source::open(path)?;
    let reader = Reader::detect(&source)?;
    if !reader.has_skins() {
        return Ok(None);
    }
    let opened = reader.read(&source, options)?;
    Ok(opened.document.rig.skin.and_then(|skin| match skin.source {
        SkinSource::Mesh(mesh) => Some((mesh.in_file()?.clone(), mesh.file()?.clone())),
        SkinSource::Bones(_) => None,
    }))
}
