//! The weights of morph targets over time.

use glam::Vec3;

use super::buffers::GltfBuffers;
use super::rows::{AccessorRows, at_accessor};
use super::sampler::{KeySource, UNSORTED, on_frame};
use crate::document::{Channel, Document, Timeline};
use crate::io::formats::gltf::file::{GltfAnimation, GltfFile, KeyCurve};
use crate::io::json::{FieldError, FieldWarnings, JsonObject, JsonPath};
use crate::kinematics::spline::{Interpolation, Knot, Slopes, Spline};

/// The weights of the morph targets of nodes in an animation.
#[derive(Default)]
pub struct WeightTracks(Vec<WeightTrack>);

/// A node whose mesh has morph targets.
pub struct MorphOwner {
    pub node: usize,
    /// Index of the first of its morph targets among those of the figure.
    pub first: usize,
    /// Number of its morph targets.
    pub count: usize,
}

/// The weights of all morph targets of a node's mesh.
struct WeightTrack {
    node: usize,
    curve: KeyCurve,
    /// Times of the keys in seconds, in the order of the file.
    times: Vec<f64>,
    /// For each key a row of weights; with cubic splines three: slopes on arrival, weights, slopes on
    /// leaving.
    rows: Vec<Vec<f32>>,
}

/// A channel of an animation that changes the weights of a node.
#[derive(Clone, Copy)]
pub struct WeightChannel<'a> {
    node: usize,
    pub source: KeySource<'a>,
}

/// Returns the channels of an animation that change weights. `at` is the path of the animation.
pub fn weight_channels<'a>(
    animation: &'a GltfAnimation,
    at: &JsonPath,
) -> Result<Vec<WeightChannel<'a>>, FieldError> {
    let mut channels = Vec::new();
    for (index, channel) in animation.channels.0.iter().enumerate() {
        let JsonObject(target) = &channel.target;
        let Some(node) = target.node.filter(|_| target.path == "weights") else { continue };
        let source = KeySource::of(animation, index, at)?;
        channels.push(WeightChannel { node: node.0 as usize, source });
    }
    Ok(channels)
}

impl WeightTracks {
    /// Reads the weights of an animation. Warns of times that do not increase.
    pub fn new(
        file: &GltfFile<'_>,
        buffers: &GltfBuffers<'_>,
        channels: &[WeightChannel<'_>],
        warnings: &mut FieldWarnings,
    ) -> Result<Self, FieldError> {
        let read = |channel: &WeightChannel<'_>| WeightTrack::new(file, buffers, *channel);
        let tracks: Vec<WeightTrack> = channels.iter().map(read).collect::<Result<_, _>>()?;
        for (track, channel) in tracks.iter().zip(channels) {
            if !track.times.is_sorted_by(|before, after| before < after) {
                warnings.push(at_accessor(channel.source.input), UNSORTED);
            }
        }
        Ok(Self(tracks))
    }

    /// Times of all keys in seconds.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.0.iter().flat_map(|track| track.times.iter().copied())
    }

    /// Returns whether any weight changes.
    pub fn vary(&self) -> bool {
        self.0.iter().any(WeightTrack::varies)
    }

    /// Adds the keys of the weights to a document whose skin has the morph targets of `owners`.
    /// Weights that do not change are set instead.
    pub fn add_to(
        &self,
        document: &mut Document,
        owners: &[MorphOwner],
        timeline: Option<Timeline>,
    ) {
        for owner in owners {
            let Some(track) = self.0.iter().find(|track| track.node == owner.node) else {
                continue;
            };
            for morph in 0..owner.count.min(track.width()) {
                let Some(channel) = u16::try_from(owner.first + morph).ok().map(Channel::Morph)
                else {
                    continue;
                };
                let spline = track.spline(morph, timeline);
                if let Some(first) = spline.knots().first() {
                    document.rig.set_morph_weight(owner.first + morph, first.value.x);
                }
                let is_still = |knot: &Knot<Vec3>| {
                    knot.value == spline.knots()[0].value
                        && knot.slopes.is_none_or(|it| [it.arriving, it.leaving] == [Vec3::ZERO; 2])
                };
                if !spline.knots().iter().all(is_still) {
                    document.keys.set_track(channel, spline);
                }
            }
        }
    }
}

impl WeightTrack {
    fn new(
        file: &GltfFile<'_>,
        buffers: &GltfBuffers<'_>,
        WeightChannel { node, source: KeySource { curve, input, output, .. } }: WeightChannel<'_>,
    ) -> Result<Self, FieldError> {
        /// Maximum number of weights of a track.
        const MOST: usize = 20_000_000;
        let times = AccessorRows::new(file, buffers, input, "SCALAR")?;
        let values = AccessorRows::new(file, buffers, output, "SCALAR")?;
        if !(times.is_float() && (values.is_float() || values.is_normalized())) {
            let (at, reason) = match times.is_float() {
                false => (input, "must be 5126 (float) for times"),
                true => (output, "must be 5126 (float) or normalized integers for weights"),
            };
            return Err(FieldError::new(at_accessor(at).key("componentType"), reason));
        }
        let rows = curve.values_per_key() * times.len();
        let fault = match (rows, values.len()) {
            (0, _) => Some("must have weights for at least one time, got none".to_owned()),
            (_, got) if got % rows != 0 => {
                let (times, each) = (times.len(), curve.values_per_key());
                Some(format!("must be a multiple of {times} times with {each} values, got {got}"))
            }
            (_, got) if got > MOST => Some(format!("must be at most {MOST}, got {got}")),
            _ => None,
        };
        if let Some(reason) = fault {
            return Err(FieldError::new(at_accessor(output).key("count"), reason));
        }
        let width = values.len() / rows;
        let number = |index: usize| values.row::<1>(index)[0] as f32;
        let row = |row: usize| (row * width..(row + 1) * width).map(number).collect();
        let rows: Vec<Vec<f32>> = (0..rows).map(row).collect();
        let times: Vec<f64> = (0..times.len()).map(|key| times.row::<1>(key)[0]).collect();
        let are_finite = times.iter().all(|time| time.is_finite())
            && rows.iter().flatten().all(|it| it.is_finite());
        if !are_finite {
            return Err(FieldError::new(at_accessor(output), "times and weights must be finite"));
        }
        Ok(Self { node, curve, times, rows })
    }

    /// Returns whether a weight changes from key to key, or leaves its keys on a cubic spline.
    fn varies(&self) -> bool {
        let each = self.curve.values_per_key();
        let is_slope = |row: usize| row % each != each / 2;
        let first = &self.rows[each / 2];
        self.rows.iter().enumerate().any(|(row, weights)| {
            if is_slope(row) { weights.iter().any(|it| *it != 0.0) } else { weights != first }
        })
    }

    /// Number of weights of a key.
    fn width(&self) -> usize {
        self.rows.first().map_or(0, Vec::len)
    }

    /// The keys of a morph target. Of several keys at the same time, the last one counts.
    fn spline(&self, morph: usize, timeline: Option<Timeline>) -> Spline<Vec3> {
        let each = self.curve.values_per_key();
        let number = |row: usize| Vec3::X * self.rows[row][morph];
        let knot = |(key, time): (usize, &f64)| {
            let (interpolation, slopes) = match self.curve {
                KeyCurve::Linear => (Interpolation::Linear, None),
                KeyCurve::Step => (Interpolation::Step, None),
                KeyCurve::CubicSpline => {
                    let (arriving, leaving) = (number(each * key), number(each * key + 2));
                    (Interpolation::Smooth, Some(Slopes { arriving, leaving }))
                }
            };
            let time = timeline.map_or(*time, |timeline| on_frame(*time, timeline));
            Knot { time, value: number(each * key + each / 2), interpolation, slopes }
        };
        self.times.iter().enumerate().map(knot).collect()
    }
}
