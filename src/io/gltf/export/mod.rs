//! The shown rig as a skinned, animated mesh.

mod bones;
mod figure;
mod file;
mod limbs;
mod motion;
mod writer;

use thiserror::Error;

use crate::document::{Document, Timeline};
use crate::io::Cancelled;
use crate::io::progress::Progress;
use bones::Bones;
use figure::Figure;
use limbs::Limbs;
use motion::Motion;

/// Why there is no glTF of a document.
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
        /// In seconds; none in the bind pose.
        time: Option<f64>,
    },
    #[error(
        "{frames} frames of {joints} joints are too many for a file; at most {} joints in {} frames \
         are possible: ask for fewer frames in a second, or for a shorter time",
        motion::MOST_SAMPLES / joints,
        motion::MOST_FRAMES.min(motion::MOST_SAMPLES / joints)
    )]
    TooLong { frames: usize, joints: usize },
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    #[error("the file cannot be written: {0}")]
    Write(#[from] ::gltf::Error),
    #[error("the file cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

fn at(time: Option<f64>) -> String {
    time.map_or_else(|| " without rotations".to_owned(), |time| format!(" at {time} s"))
}

/// The shown rig as a `.glb` file: joints, a mesh that goes with them, and its motion at so many
/// frames in a second (1 to 1000), or as many as the timeline has. Lengths are metres, and no node
/// has a scale.
///
/// # Errors
///
/// If there are no joints, if numbers of 32 bits cannot say where one is, if there are too many
/// frames, or if the job is to stop.
pub fn glb(
    document: &Document,
    frames_per_second: Option<u32>,
    progress: &Progress,
) -> Result<Vec<u8>, GlbError> {
    let rate = frames_per_second.unwrap_or(document.timeline.frame_rate);
    let frame_rate = rate.clamp(1, Timeline::HIGHEST_FRAME_RATE);
    let timeline = Timeline { frame_rate, ..document.timeline };
    let mut figure = Figure::new(document)?;
    let bones = Bones::new(&figure)?;
    let motion = Motion::new(&mut figure, &bones, timeline, progress)?;
    let limbs = Limbs::new(&figure, &bones)?;
    file::write(&bones, &motion, &limbs)
}
