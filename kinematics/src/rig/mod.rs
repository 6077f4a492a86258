//! Rigs: the arm as a hierarchy of transforms (Root → Limb → Socket) with limbs and
//! guides, the skeleton with its targets and its skin, and crowds of arms.

mod arm;
mod balance;
mod balance_target;
mod body_follows;
mod carried;
mod chain;
mod crowd;
mod diagnose;
mod drag;
mod evaluate;
mod follow_path;
mod humanoid_targets;
mod limb_frames;
mod mesh_skin;
mod path_following;
mod pop_cause;
mod pops;
mod reach_grid;
mod reach_region;
mod skeleton_rig;
mod skin;
mod tapered_cylinder;
mod target;
mod target_match;
mod up_axis;

pub use balance_target::{BalanceOver, BalanceReport, BalanceTarget};
pub use carried::{Carried, Posture, PosturedJoint};
pub use crowd::{Crowd, CrowdArrays, CrowdTimes, Processor};
pub use diagnose::RemedyError;
pub use evaluate::{EvaluatedSkeleton, TargetOutcome, TargetReport, TargetSpaceError};
pub use follow_path::{FollowPath, PathKind, WavyRing};
pub use limb_frames::{LimbFrames, LimbPart};
pub use mesh_skin::{
    AttachedMesh, FileMesh, MeshSkin, PartLook, SkinFile, SkinFileError, SkinPart, SkinTexture,
};
pub use pop_cause::RigPopCause;
pub use pops::{RigMoment, RigPop};
pub use reach_region::{ReachRegion, ReachSearch};
pub use skeleton_rig::SkeletonRig;
pub use skin::{BoneSkin, Skin, SkinMeshError, SkinSource};
pub use tapered_cylinder::TaperedCylinder;
pub use target::{Aim, LimbSettings, Target, TargetKind, TargetMotion, TargetPath, TargetSpace};
pub use up_axis::UpAxis;
