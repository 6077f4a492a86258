//! What is posed: the arm as a hierarchy of transforms (Root → Limb → Socket) with limbs and guides,
//! the skeleton with its targets, and crowds of arms.

mod arm;
mod crowd;
mod evaluate;
mod follow_path;
mod skeleton_rig;
mod tapered_cylinder;
mod target;

pub use arm::{ArmPart, ArmRig};
pub use crowd::{Crowd, CrowdArrays, CrowdTimes, Processor};
pub use evaluate::{EvaluatedSkeleton, TargetOutcome, TargetReport};
pub use follow_path::FollowPath;
pub use skeleton_rig::SkeletonRig;
pub use tapered_cylinder::TaperedCylinder;
pub use target::{LimbSettings, Target, TargetKind, TargetMotion, TargetPath};
