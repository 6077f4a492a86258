use std::rc::Rc;

use glam::DQuat;

use super::error::GlbError;
use super::joint_track::{ClipTimes, JointTrack, same_side};
use super::kept_tracks::KeptTracks;
use super::nodes::JointNodes;
use super::rig::GltfRig;
use super::track_recorder::{Moment, TrackRecorder};
use crate::document::Timeline;
use crate::io::exported::Progress;

/// The animation: the transforms of all nodes that leave the bind pose.
pub struct JointAnimation {
    /// Rotations relative to the parents, as unit quaternions. Their signs are chosen so that
    /// interpolation takes the shorter arc.
    pub rotations: Vec<JointTrack<4>>,
    /// Translations relative to the parents, in metres.
    pub translations: Vec<JointTrack<3>>,
    /// Nodes with the frames of their joints' angles, relative to the nodes.
    pub frames: Vec<(usize, DQuat)>,
    pub timeline: Timeline,
}

impl JointAnimation {
    /// The tracks that are `kept`, and for all other nodes a key at every frame.
    pub fn new(
        rig: &GltfRig,
        bones: &JointNodes,
        timeline: Timeline,
        kept: KeptTracks,
        progress: &Progress,
    ) -> Result<Self, GlbError> {
        let is_moving = rig.is_moving() && timeline.is_valid();
        let frames = if is_moving { timeline.frames() } else { 1 };
        let joints = bones.nodes.len();
        let too_long = || GlbError::TooLong { frames, joints };
        if frames > GlbError::MAX_FRAMES {
            return Err(too_long());
        }
        let clip = ClipTimes::new(timeline);
        let in_file = |time: f64| clip.of(time) as f32;
        let times = Rc::new((0..frames).map(|frame| in_file(timeline.time(frame))).collect());
        let KeptTracks { rotations, translations, turns, frames: angle_frames } = kept;
        let mut recorder = TrackRecorder::new(rotations, translations, joints, &times, in_file);
        let moments = recorder.moments((0..frames).map(|frame| timeline.time(frame)));
        let count = moments.len();
        if count.saturating_mul(joints) > GlbError::MAX_SAMPLES {
            return Err(too_long());
        }
        let mut previous: Vec<DQuat> =
            bones.bind_pose.iter().map(|bind_pose| bind_pose.rotation).collect();
        for (done, Moment { time, is_frame }) in moments.into_iter().enumerate() {
            progress.step(done, count)?;
            let mut locals = bones.locals(&rig.at(time), Some(time))?;
            for (previous, local) in previous.iter_mut().zip(&mut locals) {
                local.rotation = same_side(*previous, local.rotation);
                *previous = local.rotation;
            }
            recorder.record(time, is_frame, &locals);
        }
        let (mut rotations, mut translations) = recorder.tracks();
        for turn in turns {
            let node = turn.node;
            rotations[node] = turn;
        }
        rotations.retain(|track| track.turns(&bones.bind_pose[track.node]));
        translations.retain(|track| track.moves(&bones.bind_pose[track.node]));
        Ok(Self { rotations, translations, frames: angle_frames, timeline })
    }

    pub fn is_empty(&self) -> bool {
        self.rotations.is_empty() && self.translations.is_empty()
    }
}
