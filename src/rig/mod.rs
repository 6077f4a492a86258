//! The arm as the seed has it: a hierarchy of transforms with limbs and guides hung in it.

mod arm;
mod cone;
mod crowd;

pub use arm::{ArmRig, Part};
pub use cone::Cone;
pub use crowd::{Crowd, CrowdArrays, CrowdTimes, SolvedBy};
