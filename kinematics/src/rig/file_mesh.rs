use super::skin_part::SkinPart;
use crate::skeleton::JointId;
use crate::skin::SkinnedMesh;

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
