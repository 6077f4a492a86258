use std::path::PathBuf;

use thiserror::Error;

use super::attached_mesh::{AttachedMesh, SkinPart};
use crate::Shared;
use crate::skeleton::{JointId, JointRemap, Skeleton};
use crate::skin::SkinnedMesh;

/// A skin whose mesh was imported: it is read from its file, or saved in the document.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSkin {
    /// The file that documents refer to; `None` if they contain the mesh.
    file: Option<SkinFile>,
    /// For each joint of the file the joint of the skeleton; `None` if that joint was removed.
    joints: Vec<Option<JointId>>,
    mesh: Result<LoadedMesh, SkinFileError>,
}

/// The file of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SkinFile {
    /// Path of the file.
    pub path: PathBuf,
    /// CRC-32 of what was read of the file and of the files that it names.
    pub checksum: u32,
    /// Name of the skeleton in the file.
    pub skeleton: String,
}

/// The reason why a skin has no mesh.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SkinFileError {
    /// There is no such file.
    #[error("the skin's file {0} is missing: locate it, or remove the skin")]
    Missing(PathBuf),
    /// The file has changed since the document was saved.
    #[error(
        "the skin's file {0} has changed since the document was saved: locate it to use its new version"
    )]
    Changed(PathBuf),
    /// The file cannot be read, or has no such skin.
    #[error("the skin cannot be read: {0}")]
    Invalid(String),
}

#[derive(Clone, Debug)]
struct LoadedMesh {
    in_file: Shared<FileMesh>,
    attached: Shared<AttachedMesh>,
}

impl MeshSkin {
    /// Attaches a mesh to a skeleton. `joints` has for each joint of the file the joint of the skeleton; the
    /// weights of joints without one go to their nearest ancestor that has one. Without `file`, documents
    /// contain the mesh.
    pub fn new(
        mesh: Shared<FileMesh>,
        file: Option<SkinFile>,
        joints: Vec<Option<JointId>>,
        skeleton: &Skeleton,
    ) -> Self {
        let mesh = LoadedMesh::new(mesh, &joints, skeleton);
        Self { file, joints, mesh: Ok(mesh) }
    }

    /// A skin whose file cannot be read.
    pub fn without_mesh(
        file: SkinFile,
        joints: Vec<Option<JointId>>,
        error: SkinFileError,
    ) -> Self {
        Self { file: Some(file), joints, mesh: Err(error) }
    }

    /// The file that documents refer to; `None` if they contain the mesh.
    pub fn file(&self) -> Option<&SkinFile> {
        self.file.as_ref()
    }

    /// For each joint of the file the joint of the skeleton; `None` if that joint was removed.
    pub fn joints(&self) -> &[Option<JointId>] {
        &self.joints
    }

    /// The mesh as the file has it; `None` if the file could not be read.
    pub fn in_file(&self) -> Option<&Shared<FileMesh>> {
        self.mesh.as_ref().ok().map(|mesh| &mesh.in_file)
    }

    /// The mesh on the joints of the skeleton.
    ///
    /// # Errors
    ///
    /// [`SkinFileError`] if the file could not be read.
    pub fn mesh(&self) -> Result<&Shared<AttachedMesh>, SkinFileError> {
        self.mesh.as_ref().map(|mesh| &mesh.attached).map_err(Clone::clone)
    }

    /// A copy whose mesh is saved in the document, not in a file of its own; `None` without a mesh.
    pub fn packed(&self) -> Option<Self> {
        self.mesh.is_ok().then(|| Self { file: None, ..self.clone() })
    }

    /// A copy that refers to its file by another path.
    #[must_use]
    pub fn with_path(&self, path: impl FnOnce(&SkinFile) -> PathBuf) -> Self {
        let file = self.file.as_ref().map(|file| SkinFile { path: path(file), ..file.clone() });
        Self { file, ..self.clone() }
    }

    /// The same skin, measured on another pose of its skeleton.
    #[must_use]
    pub fn attached_to(&self, skeleton: &Skeleton) -> Self {
        let mesh = self.mesh.as_ref().map_err(Clone::clone);
        let mesh = mesh.map(|mesh| LoadedMesh::new(mesh.in_file.clone(), &self.joints, skeleton));
        Self { mesh, ..self.clone() }
    }

    /// The skin measured again, if the bones of the skeleton have changed since; otherwise `None`.
    pub(super) fn refreshed(&self, skeleton: &Skeleton) -> Option<Self> {
        let mesh = self.mesh.as_ref().ok()?;
        (!mesh.attached.is_measured_on(skeleton)).then(|| self.attached_to(skeleton))
    }

    /// The skin for a skeleton with other joint indices.
    pub(super) fn remapped(&self, remap: &JointRemap, skeleton: &Skeleton) -> Self {
        let joints: Vec<_> =
            self.joints.iter().map(|joint| joint.and_then(|joint| remap.get(joint))).collect();
        Self { joints, ..self.clone() }.attached_to(skeleton)
    }
}

impl LoadedMesh {
    fn new(in_file: Shared<FileMesh>, joints: &[Option<JointId>], skeleton: &Skeleton) -> Self {
        let FileMesh { mesh, parents, parts } = &*in_file;
        let attached = AttachedMesh::new(mesh.renumbered(joints, parents), parts.clone(), skeleton);
        Self { attached: attached.into(), in_file }
    }
}

/// The attached mesh follows from the one in the file, the joints and the skeleton of the rig.
impl PartialEq for LoadedMesh {
    fn eq(&self, other: &Self) -> bool {
        self.in_file == other.in_file
    }
}

/// A skinned mesh as a file has it, with joints of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct FileMesh {
    /// The mesh, with an inverse bind transform for each joint of the file.
    pub mesh: SkinnedMesh,
    /// Parents of the file's joints, which precede their children.
    pub parents: Vec<Option<JointId>>,
    /// The parts of the mesh in the order of its triangles.
    pub parts: Vec<SkinPart>,
}
