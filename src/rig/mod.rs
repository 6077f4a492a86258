//! The arm as a hierarchy of transforms (Root → Limb → Socket) with limbs and guides, and crowds of
//! arms.

mod arm;
mod crowd;
mod tapered_cylinder;

pub use arm::{ArmPart, ArmRig};
pub use crowd::{Crowd, CrowdArrays, CrowdTimes, Processor};
pub use tapered_cylinder::TaperedCylinder;
