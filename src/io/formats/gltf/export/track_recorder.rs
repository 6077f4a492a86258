use std::rc::Rc;

use ::gltf::json::animation::Interpolation as Curve;

use super::joint_track::JointTrack;
use super::kept_tracks::KeptTrack;
use super::nodes::RigidTransform;

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
    /// A recorder of `nodes` nodes. `times` has the times of the frames in the file, and `in_file` turns a
    /// time of the document into one of the file.
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
    /// Adds the value if the track has a key at this time. `slope` turns a slope into numbers of the track.
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
