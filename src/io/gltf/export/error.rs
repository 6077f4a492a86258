use thiserror::Error;

use crate::io::progress::Cancelled;

/// The reason why a document has no glTF.
#[derive(Debug, Error)]
pub enum GlbError {
    #[error("the skeleton has no joints; add one before it is exported")]
    NoJoints,
    #[error(
        "joint {joint:?} is farther than 3.4028235e38 m from the origin{}; bring it nearer, or make \
         metres_per_unit smaller",
        at(*time)
    )]
    TooFar {
        joint: String,
        /// In seconds; `None` in the bind pose.
        time: Option<f64>,
    },
    #[error(
        "{frames} frames of {joints} joints are too many for a file; at most {} joints in {} frames \
         are possible: ask for fewer frames in a second, or for a shorter time",
        GlbError::MAX_SAMPLES / joints,
        GlbError::MAX_FRAMES.min(GlbError::MAX_SAMPLES / joints)
    )]
    TooLong { frames: usize, joints: usize },
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("the file cannot be written: {0}")]
    Write(#[from] ::gltf::Error),
    #[error("the file cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

impl GlbError {
    /// Most transforms of joints in all frames; each takes 28 bytes.
    pub const MAX_SAMPLES: usize = 20_000_000;
    /// Beyond this, two frames can have the same 32-bit time.
    pub const MAX_FRAMES: usize = 1 << 23;
}

fn at(time: Option<f64>) -> String {
    time.map_or_else(|| " in the bind pose".to_owned(), |time| format!(" at {time} s"))
}
