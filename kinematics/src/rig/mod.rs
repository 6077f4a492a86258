//! What is posed: the arm as a hierarchy of transforms (Root → Limb → Socket) with limbs and guides,
//! the skeleton with its targets and its skin, and crowds of arms.

mod arm;
mod attached_mesh;
mod crowd;
mod diagnose;
mod evaluate;
mod follow_path;
mod head_path;
mod mesh_skin;
mod path_chain;
mod path_following;
mod remedy;
mod skeleton_rig;
mod skin;
mod target;
mod target_match;
mod target_order;
mod up_axis;

pub use arm::TaperedCylinder;
pub use arm::{ArmPart, ArmRig};
pub use attached_mesh::AttachedMesh;
pub use attached_mesh::SkinPart;
pub use attached_mesh::SkinTexture;
pub use crowd::{Crowd, CrowdArrays, CrowdTimes, Processor};
pub use evaluate::{EvaluatedSkeleton, TargetOutcome, TargetReport};
pub use follow_path::WavyRing;
pub use follow_path::{FollowPath, PathKind};
pub use mesh_skin::FileMesh;
pub use mesh_skin::{MeshSkin, SkinFile, SkinFileError};
pub use remedy::RemedyError;
pub use skeleton_rig::SkeletonRig;
pub use skin::BoneSkin;
pub use skin::{Skin, SkinMeshError, SkinSource};
pub use target::LimbSettings;
pub use target::TargetSpace;
pub use target::{Target, TargetKind};
pub use target::{TargetMotion, TargetPath};
pub use target_order::TargetSpaceError;
pub use up_axis::UpAxis;
