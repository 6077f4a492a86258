use std::rc::Rc;

use ::gltf::json::animation::Interpolation as Curve;
use glam::DQuat;

use super::error::GlbError;
use super::joint_track::{ClipTimes, JointTrack, same_side};
use super::kept_tracks::{KeptTrack, KeptTracks};
use super::nodes::{JointNodes, RigidTransform};
use super::rig::GltfRig;
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

/// A time at which the rig is posed.
pub struct Moment {
    /// In the document, in seconds.
    pub time: f64,
    pub is_frame: bool,
}

/// Collects the values of all nodes: those of kept tracks at their keys, all others at every frame.
pub struct TrackRecorder {
    rotations: Vec<NodeRecord<4>>,
    translations: Vec<NodeRecord<3>>,
}

struct NodeRecord<const N: usize> {
    track: JointTrack<N>,
    kept: Option<KeptTrack>,
    /// Number of keys recorded.
    keys: usize,
}

impl TrackRecorder {
    /// A recorder of `nodes` nodes. `times` has the times of the frames in the file, and `in_file`
    /// turns a time of the document into one of the file.
    pub fn new(
        rotations: Vec<KeptTrack>,
        translations: Vec<KeptTrack>,
        nodes: usize,
        times: &Rc<Vec<f32>>,
        in_file: impl Fn(f64) -> f32,
    ) -> Self {
        Self {
            rotations: records(rotations, nodes, times, &in_file),
            translations: records(translations, nodes, times, &in_file),
        }
    }

    /// The frames and the keys of kept tracks, in the order of time.
    pub fn moments(&self, frames: impl Iterator<Item = f64>) -> Vec<Moment> {
        let rotations = self.rotations.iter().filter_map(|record| record.kept.as_ref());
        let translations = self.translations.iter().filter_map(|record| record.kept.as_ref());
        let keys = rotations.chain(translations).flat_map(|kept| kept.times.iter().copied());
        let keys = keys.map(|time| Moment { time, is_frame: false });
        let mut moments: Vec<Moment> =
            frames.map(|time| Moment { time, is_frame: true }).chain(keys).collect();
        // Stable, so that of several at one time the frame comes first and stays.
        moments.sort_by(|a, b| a.time.total_cmp(&b.time));
        moments.dedup_by(|later, first| later.time == first.time);
        moments
    }

    /// Records the transforms of all nodes at a moment.
    pub fn record(&mut self, time: f64, is_frame: bool, locals: &[RigidTransform]) {
        for record in &mut self.rotations {
            let rotation = locals[record.track.node].rotation;
            record.add(time, is_frame, rotation.as_quat().to_array(), |_| [0.0; 4]);
        }
        for record in &mut self.translations {
            let translation = locals[record.track.node].translation;
            record.add(time, is_frame, translation.as_vec3().to_array(), |slope| slope);
        }
    }

    pub fn tracks(self) -> (Vec<JointTrack<4>>, Vec<JointTrack<3>>) {
        let rotations = self.rotations.into_iter().map(|record| record.track).collect();
        (rotations, self.translations.into_iter().map(|record| record.track).collect())
    }
}

fn records<const N: usize>(
    kept: Vec<KeptTrack>,
    nodes: usize,
    times: &Rc<Vec<f32>>,
    in_file: impl Fn(f64) -> f32,
) -> Vec<NodeRecord<N>> {
    let at_frames = |node| NodeRecord {
        track: JointTrack {
            node,
            times: times.clone(),
            curve: Curve::Linear,
            values: Vec::new(),
            keys: Vec::new(),
        },
        kept: None,
        keys: 0,
    };
    let mut records: Vec<NodeRecord<N>> = (0..nodes).map(at_frames).collect();
    for mut kept in kept {
        let record = &mut records[kept.node];
        record.track.times = Rc::new(kept.times.iter().map(|time| in_file(*time)).collect());
        record.track.curve = kept.curve;
        record.track.keys = std::mem::take(&mut kept.keys);
        record.kept = Some(kept);
    }
    records
}

impl<const N: usize> NodeRecord<N> {
    /// Adds the value if the track has a key at this time. `slope` turns a slope into numbers of
    /// the track.
    fn add(
        &mut self,
        time: f64,
        is_frame: bool,
        value: [f32; N],
        slope: impl Fn([f32; 3]) -> [f32; N],
    ) {
        let Some(kept) = &self.kept else {
            self.track.values.extend(is_frame.then_some(value));
            return;
        };
        if kept.times.get(self.keys) != Some(&time) {
            return;
        }
        match kept.slopes.get(self.keys) {
            Some(slopes) => {
                let [arriving, leaving] =
                    [slopes.arriving, slopes.leaving].map(|it| slope(it.to_array()));
                self.track.values.extend([arriving, value, leaving]);
            }
            None => self.track.values.push(value),
        }
        self.keys += 1;
    }
}
