//! The files that documents take the meshes of their skins from.

use std::io::ErrorKind;
use std::path::Path;

use super::error::OpenError;
use super::formats::Reader;
use super::json::{FieldWarnings, JsonPath};
use super::opened::OpenOptions;
use super::source::Source;
use crate::document::{Document, Skin};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::rig::{FileMesh, MeshSkin, SkinFile, SkinFileError, SkinSource};

/// Takes the mesh of a skin from the file at `path` as it is now: from the skeleton of the same
/// name, or from the file's only one.
///
/// # Errors
///
/// [`SkinFileError`] if the file cannot be read, has no such mesh, or one for another number of
/// joints.
pub fn relocated_skin(
    path: &Path,
    skeleton_name: &str,
    joints: &[Option<JointId>],
    skeleton: &Skeleton,
) -> Result<MeshSkin, SkinFileError> {
    let read = read(path, Some(skeleton_name));
    let read = match read {
        Err(OpenError::NoSkeleton { names, .. }) if names.len() == 1 => self::read(path, None),
        read => read,
    };
    let read = read.map_err(|error| match error {
        OpenError::Read { source, .. } if source.kind() == ErrorKind::NotFound => {
            SkinFileError::Missing(path.to_owned())
        }
        error => SkinFileError::Invalid(error.to_string()),
    })?;
    let invalid =
        |reason: String| Err(SkinFileError::Invalid(format!("{} {reason}", path.display())));
    let Some((mesh, file)) = read else {
        return invalid(format!("has no mesh on the skeleton {skeleton_name:?}"));
    };
    let (expected, got) = (joints.len(), mesh.parents.len());
    if expected != got {
        return invalid(format!("must have a skeleton of {expected} joints, got {got}"));
    }
    Ok(MeshSkin::new(mesh, Some(file), joints.to_vec(), skeleton))
}

/// The mesh on a skeleton of a file; `None` if it has none.
fn read(
    path: &Path,
    skeleton: Option<&str>,
) -> Result<Option<(Shared<FileMesh>, SkinFile)>, OpenError> {
    let source = Source::open(path)?;
    let options = skeleton.map_or_else(OpenOptions::default, OpenOptions::of_skeleton);
    let reader = Reader::detect(&source)?;
    if !reader.has_skins() {
        return Ok(None);
    }
    let opened = reader.read(&source, &options)?;
    Ok(opened.document.skeleton_rig.skin.and_then(|skin| match skin.source {
        SkinSource::Mesh(mesh) => Some((mesh.in_file()?.clone(), mesh.file()?.clone())),
        SkinSource::Bones(_) => None,
    }))
}

/// Reads the file that the skin of a document refers to, from the folder of the document if its
/// path is relative. Warns if that is impossible or the file has changed; the skin then has no
/// mesh.
pub fn load_skin(document: &mut Document, folder: Option<&Path>) -> FieldWarnings {
    let mut warnings = FieldWarnings::default();
    let rig = &mut document.skeleton_rig;
    let Some(Skin { source: SkinSource::Mesh(skin), .. }) = &mut rig.skin else { return warnings };
    let Some(file) = skin.file() else { return warnings };
    let path = folder.map_or_else(|| file.path.clone(), |folder| folder.join(&file.path));
    let located = SkinFile { path, ..file.clone() };
    let read = relocated_skin(&located.path, &located.skeleton, skin.joints(), &rig.skeleton);
    let is_unchanged =
        |read: &MeshSkin| read.file().is_some_and(|file| file.checksum == located.checksum);
    *skin = match read {
        Ok(read) if is_unchanged(&read) => read,
        other => {
            let error = other.err().unwrap_or(SkinFileError::Changed(located.path.clone()));
            let at = JsonPath::root().key("skin").key("mesh").key("file");
            warnings.push(at, error.to_string());
            MeshSkin::without_mesh(located, skin.joints().to_vec(), error)
        }
    };
    warnings
}
