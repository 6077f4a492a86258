//! Export of the shown rig as a skinned, animated mesh.

mod error;
mod file;
mod joint_track;
mod kept_tracks;
mod limbs;
mod mesh;
mod motion;
mod nodes;
mod quaternion_spline;
mod rig;
mod writer;

use crate::document::{Document, Timeline};
use crate::io::exported::Progress;
pub use error::GlbError;
use kept_tracks::KeptTracks;
use limbs::LimbMesh;
use mesh::RigMesh;
use motion::JointAnimation;
use nodes::JointNodes;
use rig::GltfRig;

/// Exports the shown rig as a `.glb` file with joints, a skinned mesh and the motion. The mesh is
/// the skin of the skeleton; without one, cones around the bones. The motion has a key at every
/// frame. The frame rate is `frames_per_second`, or with `None` that of the timeline, clamped to
/// the range 0.01 to 1000. With `None`, tracks whose keys glTF can have are written as they are.
/// Lengths are in metres, and no node has a scale.
///
/// # Errors
///
/// Fails if the skeleton has no joints, a position overflows, the motion has too many frames, or
/// the export is cancelled.
pub fn glb(
    document: &Document,
    frames_per_second: Option<f64>,
    progress: &Progress,
) -> Result<Vec<u8>, GlbError> {
    let rate = frames_per_second.unwrap_or(document.timeline.frame_rate);
    let frame_rate = rate.clamp(Timeline::MIN_FRAME_RATE, Timeline::MAX_FRAME_RATE);
    let timeline = Timeline { frame_rate, ..document.timeline };
    let rig = GltfRig::new(document)?;
    let bones = JointNodes::new(&rig)?;
    let kept = match frames_per_second {
        None if timeline.is_valid() => KeptTracks::new(document, &rig, timeline),
        _ => KeptTracks::default(),
    };
    let motion = JointAnimation::new(&rig, &bones, timeline, kept, progress)?;
    let mesh = match RigMesh::of_skin(document) {
        Some(skin) => skin,
        None => LimbMesh::new(&rig, &bones)?.into(),
    };
    file::write(&bones, &motion, &mesh, document.animation_name.as_deref())
}
