use glam::{DQuat, DVec3};

use super::error::GlbError;
use super::nodes::{JointNodes, RigidTransform};
use super::rig::GltfRig;
use crate::document::Timeline;
use crate::io::progress::Progress;

/// The animation: the transforms of all nodes that leave the bind pose.
pub struct JointAnimation {
    /// Times of the frames, in seconds: those of the document where glTF can have them.
    pub times: Vec<f32>,
    /// Rotations relative to the parents, as unit quaternions. Their signs are chosen so that
    /// interpolation takes the shorter arc.
    pub rotations: Vec<JointTrack<4>>,
    /// Translations relative to the parents, in metres.
    pub translations: Vec<JointTrack<3>>,
}

/// The values of one node over time.
pub struct JointTrack<const N: usize> {
    pub node: usize,
    /// One value for each frame.
    pub values: Vec<[f32; N]>,
}

impl JointAnimation {
    pub fn new(
        rig: &mut GltfRig,
        bones: &JointNodes,
        timeline: Timeline,
        progress: &Progress,
    ) -> Result<Self, GlbError> {
        let is_moving = rig.is_moving() && timeline.is_valid();
        let frames = if is_moving { timeline.frames() } else { 1 };
        let joints = bones.nodes.len();
        if frames > GlbError::MAX_FRAMES || frames.saturating_mul(joints) > GlbError::MAX_SAMPLES {
            return Err(GlbError::TooLong { frames, joints });
        }
        let empty = |node| JointTrack { node, values: Vec::with_capacity(frames) };
        let mut rotations: Vec<_> = (0..joints).map(empty).collect();
        let empty = |node| JointTrack { node, values: Vec::with_capacity(frames) };
        let mut translations: Vec<_> = (0..joints).map(empty).collect();
        let mut previous: Vec<DQuat> =
            bones.bind_pose.iter().map(|bind_pose| bind_pose.rotation).collect();
        for frame in 0..frames {
            progress.step(frame, frames)?;
            let time = timeline.time(frame);
            for (node, local) in bones.locals(&rig.at(time), Some(time))?.iter().enumerate() {
                let rotation = same_side(previous[node], local.rotation);
                previous[node] = rotation;
                rotations[node].values.push(rotation.as_quat().to_array());
                translations[node].values.push(local.translation.as_vec3().to_array());
            }
        }
        rotations.retain(|track| track.turns(&bones.bind_pose[track.node]));
        translations.retain(|track| track.moves(&bones.bind_pose[track.node]));
        let first = first_time(timeline);
        let time = |frame: usize| first + frame as f64 / timeline.frame_rate;
        let times = (0..frames).map(|frame| time(frame) as f32).collect();
        Ok(Self { times, rotations, translations })
    }

    pub fn is_empty(&self) -> bool {
        self.rotations.is_empty() && self.translations.is_empty()
    }
}

/// Time of the first frame in the file: that of the document, unless it is below 0, which glTF does
/// not allow, or so late that single precision cannot tell the frames apart.
fn first_time(timeline: Timeline) -> f64 {
    let rounding = timeline.end * f64::from(f32::EPSILON);
    let is_exact = timeline.start >= 0.0 && rounding < 0.1 / timeline.frame_rate;
    if is_exact { timeline.start } else { 0.0 }
}

/// Changes below this count as rounding errors: in radians for a rotation, relative to the distance
/// from the parent for a translation.
const LEAST: f64 = 1e-6;

impl JointTrack<4> {
    /// Whether the rotation ever leaves the bind pose.
    fn turns(&self, bind_pose: &RigidTransform) -> bool {
        self.values.iter().any(|value| {
            let rotation = DQuat::from_array(value.map(f64::from));
            let difference = same_side(bind_pose.rotation, rotation) - bind_pose.rotation;
            2.0 * difference.length() > LEAST
        })
    }
}

impl JointTrack<3> {
    fn moves(&self, bind_pose: &RigidTransform) -> bool {
        self.values.iter().any(|value| {
            let translation = DVec3::from_array(value.map(f64::from));
            let size = translation.length().max(bind_pose.translation.length());
            translation.distance(bind_pose.translation) > LEAST * size
        })
    }
}

/// Returns `rotation` or its negative, which is the same rotation, whichever is nearer to
/// `previous`.
fn same_side(previous: DQuat, rotation: DQuat) -> DQuat {
    if previous.dot(rotation) < 0.0 { -rotation } else { rotation }
}
