//! What is posed: the arm as a hierarchy of transforms (Root → Limb → Socket) with limbs and guides,
//! the skeleton with its targets and its skin, and crowds of arms.

mod arm;
mod attached_mesh;
mod bone_skin;
mod crowd;
mod evaluate;
mod file_mesh;
mod follow_path;
mod head_path;
mod limb_settings;
mod mesh_skin;
mod moved_joints;
mod path_chain;
mod path_following;
mod skeleton_rig;
mod skin;
mod skin_part;
mod skin_texture;
mod tapered_cylinder;
mod target;
mod target_match;
mod target_motion;
mod target_order;
mod target_space;
mod up_axis;
mod wavy_ring;

pub use arm::{ArmPart, ArmRig};
pub use attached_mesh::AttachedMesh;
pub use bone_skin::BoneSkin;
pub use crowd::{Crowd, CrowdArrays, CrowdTimes, Processor};
pub use evaluate::{EvaluatedSkeleton, TargetOutcome, TargetReport};
pub use file_mesh::FileMesh;
pub use follow_path::FollowPath;
pub use limb_settings::LimbSettings;
pub use mesh_skin::{MeshSkin, SkinFile, SkinFileError};
pub use skeleton_rig::SkeletonRig;
pub use skin::{Skin, SkinMeshError, SkinSource};
pub use skin_part::SkinPart;
pub use skin_texture::SkinTexture;
pub use tapered_cylinder::TaperedCylinder;
pub use target::{Target, TargetKind};
pub use target_motion::{TargetMotion, TargetPath};
pub use target_order::TargetSpaceError;
pub use target_space::TargetSpace;
pub use up_axis::UpAxis;
pub use wavy_ring::WavyRing;
