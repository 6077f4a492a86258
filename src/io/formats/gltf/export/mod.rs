//! Export of the shown rig as a skinned, animated mesh.

mod glb;
mod mesh;
mod morphs;
mod motion;
mod nodes;
mod quaternion_spline;
mod rig;
mod stretch;

use thiserror::Error;

use crate::io::exported::Cancelled;
pub use glb::glb;

/// The reason why a document cannot be exported to glTF.
#[derive(Debug, Error)]
pub enum GlbError {
    /// The skeleton has no joints.
    #[error("the skeleton must have at least one joint")]
    NoJoints,
    /// The position of a joint overflows in metres.
    #[error(
        "the position of joint {joint:?} must be within ±3.4028235e38 m{}; bring it nearer, or \
         make metres_per_unit smaller",
        at(*time)
    )]
    TooFar {
        /// Name of the joint.
        joint: String,
        /// Time in seconds; `None` for the bind pose.
        time: Option<f64>,
    },
    /// The motion has more than [`GlbError::MAX_FRAMES`] frames or [`GlbError::MAX_SAMPLES`]
    /// samples.
    #[error(
        "a motion of {joints} joints must have at most {} frames, got {frames}; export a shorter \
         time or fewer frames per second",
        GlbError::MAX_FRAMES.min(GlbError::MAX_SAMPLES / joints)
    )]
    TooLong {
        /// Number of frames.
        frames: usize,
        /// Number of joints.
        joints: usize,
    },
    /// The export was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The JSON chunk cannot be serialized.
    #[error("the file cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

impl GlbError {
    /// Maximum number of joint transforms in all frames; each takes 28 bytes.
    pub const MAX_SAMPLES: usize = 20_000_000;
    /// Maximum number of frames. Above it, two frames can have the same 32-bit time.
    pub const MAX_FRAMES: usize = 1 << 23;
}

fn at(time: Option<f64>) -> String {
    time.map_or_else(|| " in the bind pose".to_owned(), |time| format!(" at {time} s"))
}
