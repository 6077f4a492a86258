use glam::{DQuat, DVec3};

use super::GlbError;
use super::bones::{Bones, Local};
use super::figure::Figure;
use crate::document::Timeline;
use crate::io::progress::Progress;

/// So many times a joint can be somewhere; each takes 28 bytes.
pub const MOST_SAMPLES: usize = 20_000_000;
/// Beyond, two frames may have the same time in 32 bits.
pub const MOST_FRAMES: usize = 1 << 23;

/// How the joints move: what leaves its rest, frame by frame.
pub struct Motion {
    /// When each frame is, in seconds from the first.
    pub times: Vec<f32>,
    /// Unit quaternions of joints; neighbours are on the same side, so that what is between two goes
    /// the shorter way.
    pub rotations: Vec<Track<4>>,
    /// In metres.
    pub translations: Vec<Track<3>>,
}

/// What a joint does.
pub struct Track<const N: usize> {
    pub node: usize,
    /// One for every frame.
    pub values: Vec<[f32; N]>,
}

impl Motion {
    pub fn new(
        figure: &mut Figure,
        bones: &Bones,
        timeline: Timeline,
        progress: &Progress,
    ) -> Result<Self, GlbError> {
        let is_moving = figure.is_moving() && timeline.is_valid();
        let frames = if is_moving { timeline.frames() } else { 1 };
        let joints = bones.nodes.len();
        if frames > MOST_FRAMES || frames.saturating_mul(joints) > MOST_SAMPLES {
            return Err(GlbError::TooLong { frames, joints });
        }
        let empty = |node| Track { node, values: Vec::with_capacity(frames) };
        let mut rotations: Vec<_> = (0..joints).map(empty).collect();
        let empty = |node| Track { node, values: Vec::with_capacity(frames) };
        let mut translations: Vec<_> = (0..joints).map(empty).collect();
        let mut before: Vec<DQuat> = bones.rest.iter().map(|rest| rest.rotation).collect();
        for frame in 0..frames {
            progress.step(frame, frames)?;
            let time = timeline.time(frame);
            for (node, local) in bones.locals(&figure.at(time), Some(time))?.iter().enumerate() {
                let rotation = same_side(before[node], local.rotation);
                before[node] = rotation;
                rotations[node].values.push(rotation.as_quat().to_array());
                translations[node].values.push(local.translation.as_vec3().to_array());
            }
        }
        rotations.retain(|track| track.turns(&bones.rest[track.node]));
        translations.retain(|track| track.moves(&bones.rest[track.node]));
        let rate = f64::from(timeline.frame_rate);
        let times = (0..frames).map(|frame| (frame as f64 / rate) as f32).collect();
        Ok(Self { times, rotations, translations })
    }

    pub fn is_empty(&self) -> bool {
        self.rotations.is_empty() && self.translations.is_empty()
    }
}

/// What is less is rounding: a part of a radian, or of how far a joint is from its parent.
const LEAST: f64 = 1e-6;

impl Track<4> {
    /// Whether it ever leaves its rest.
    fn turns(&self, rest: &Local) -> bool {
        self.values.iter().any(|value| {
            let rotation = DQuat::from_array(value.map(f64::from));
            let gap = same_side(rest.rotation, rotation) - rest.rotation;
            2.0 * gap.length() > LEAST
        })
    }
}

impl Track<3> {
    fn moves(&self, rest: &Local) -> bool {
        self.values.iter().any(|value| {
            let place = DVec3::from_array(value.map(f64::from));
            let size = place.length().max(rest.translation.length());
            place.distance(rest.translation) > LEAST * size
        })
    }
}

/// A quaternion or its negative, which turns the same: the one that is nearer.
fn same_side(before: DQuat, rotation: DQuat) -> DQuat {
    if before.dot(rotation) < 0.0 { -rotation } else { rotation }
}
