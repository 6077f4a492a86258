//! The arm as a hierarchy of transforms (Root → Limb → Socket) with limbs and guides, and crowds of
//! arms.

mod arm;
mod cone;
mod crowd;

pub use arm::{ArmRig, Part};
pub use cone::Cone;
pub use crowd::{Crowd, CrowdArrays, CrowdTimes, SolvedBy};
