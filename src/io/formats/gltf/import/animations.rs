//! The animations of a file: what each moves, and its timeline.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::buffers::GltfBuffers;
use super::morphs::{self, WeightChannel, WeightTracks};
use super::nodes::{NodeTransform, NodeTree, SkinJoints, at_node, stretched_joint};
use super::rows::{at_accessor, buffers_of};
use super::sampler::{
    AnimatedPart, KeySampler, KeySource, UNSORTED, UsedChannel, on_frame, tolerance,
};
use crate::document::Timeline;
use crate::io::error::OpenError;
use crate::io::formats::gltf::UniqueNames;
use crate::io::formats::gltf::file::{GltfAnimation, GltfChannel, GltfFile, index_rule};
use crate::io::frame_rate;
use crate::io::json::{FieldError, FieldWarnings, JsonObject, JsonPath};
use crate::io::opened::FileAnimation;
use crate::io::source::Source;

/// The nodes that an animation moves, and its range.
#[derive(Default)]
pub struct AnimationScan {
    pub name: String,
    /// Nodes whose translation, rotation or scale changes.
    pub moving: BTreeSet<usize>,
    /// True if weights of morph targets change.
    pub has_morphs: bool,
    /// Times of the first and the last key in seconds.
    pub range: (f64, f64),
}

impl AnimationScan {
    /// The animation as seen from a skeleton.
    pub fn described(&self, joints: &SkinJoints) -> FileAnimation {
        let moving = joints.nodes.iter().filter(|node| self.moving.contains(node)).count();
        let (start, end) = self.range;
        FileAnimation {
            name: self.name.clone(),
            start,
            end,
            moving_joints: moving,
            has_morphs: self.has_morphs,
        }
    }
}

pub fn at_animation(index: usize) -> JsonPath {
    JsonPath::root().key("animations").index(index)
}

/// Looks through all animations. One that is damaged moves nothing here; reading it fails.
pub fn scan(source: &Source, file: &GltfFile<'_>, nodes: &NodeTree) -> Vec<AnimationScan> {
    let mut names = UniqueNames::default();
    let animations = file.animations.0.iter().enumerate();
    let scans = animations.map(|(index, animation)| {
        let given = animation.name.as_deref().filter(|name| !name.trim().is_empty());
        let name = names.free(given.unwrap_or(&format!("animation_{index}")));
        let scan = scan_one(source, file, nodes, index).unwrap_or_default();
        AnimationScan { name, ..scan }
    });
    scans.collect()
}

fn scan_one(
    source: &Source,
    file: &GltfFile<'_>,
    nodes: &NodeTree,
    index: usize,
) -> Result<AnimationScan, FieldError> {
    let (animation, at) = (&file.animations.0[index], at_animation(index));
    let all = vec![true; nodes.parents.len()];
    let channels = used_channels(animation, &at, nodes, &all)?;
    let weights = morphs::weight_channels(animation, &at)?;
    let buffers = buffers(source, file, &channels, &weights)?;
    let tracks = NodeTracks::new(file, &buffers, &channels, &at, &mut FieldWarnings::default())?;
    let weights = WeightTracks::new(file, &buffers, &weights, &mut FieldWarnings::default())?;
    Ok(AnimationScan {
        name: String::new(),
        moving: tracks.moving().map(|node| stretched_joint(file, nodes, node)).collect(),
        has_morphs: weights.vary(),
        range: time_range(tracks.times().chain(weights.times())).unwrap_or_default(),
    })
}

/// The index of the animation to read: the one that is called `name` or has this number, or with
/// `None` the first that moves a joint, or else the first. `None` if the file has no animation.
pub fn choose(
    source: &Source,
    animations: &[FileAnimation],
    name: Option<&str>,
) -> Result<Option<usize>, OpenError> {
    let Some(name) = name else {
        let moving = animations.iter().position(FileAnimation::moves);
        return Ok(moving.or((!animations.is_empty()).then_some(0)));
    };
    let named = animations.iter().position(|animation| animation.name == name);
    let numbered = || name.parse().ok().filter(|number| *number < animations.len());
    named.or_else(numbered).map(Some).ok_or_else(|| OpenError::NoAnimation {
        file: source.name().to_owned(),
        name: name.to_owned(),
        names: animations.iter().map(|animation| animation.name.clone()).collect(),
    })
}

/// Frame rate of a motion whose keys fit no frame rate.
const FALLBACK_RATE: f64 = 60.0;

/// Returns the timeline from the first to the last of the times of keys. Its frame rate is the one that
/// [`frame_rate::of_times`] finds with as little tolerance as possible, or else [`FALLBACK_RATE`];
/// `own_rate`, if the file tells it. Returns `None` if all keys are at the same time. `at` is the
/// path of the animation.
pub fn timeline(
    mut times: Vec<f64>,
    own_rate: Option<f64>,
    at: &JsonPath,
) -> Result<Option<Timeline>, FieldError> {
    let Some((start, end)) = time_range(times.iter().copied()) else { return Ok(None) };
    if start == end {
        return Ok(None);
    }
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    times.iter_mut().for_each(|time| *time -= start);
    let rounded = |time: f64| ((time + start) * f64::from(f32::EPSILON)).max(1e-7);
    let found = own_rate.or_else(|| frame_rate::of_times(&times, rounded));
    let found = found.or_else(|| frame_rate::of_times(&times, |_| 2e-6));
    let found = found.or_else(|| frame_rate::of_times(&times, |time| tolerance(time + start)));
    let frame_rate = found.unwrap_or(FALLBACK_RATE);
    let whole = Timeline {
        start: on_frame(start, Timeline { start: 0.0, end, frame_rate }),
        end,
        frame_rate,
    };
    let timeline = Timeline { end: on_frame(end, whole), ..whole };
    if !timeline.is_valid() {
        let max = Timeline::MAX_TIME;
        let reason = format!("must be within ±{max} s, got {start} to {end} s");
        return Err(FieldError::new(at.clone(), reason));
    }
    Ok(Some(timeline))
}

/// The first and the last of the times of keys in seconds; `None` without keys.
fn time_range(times: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    times.map(|time| (time, time)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// The animated values of all nodes.
pub struct NodeTracks<'a> {
    tracks: Vec<KeySampler<'a>>,
    /// Index of the track of a part of a node.
    places: HashMap<(usize, AnimatedPart), usize>,
}

/// Returns those channels of an animation that move a node for which `is_needed` is true.
pub fn used_channels<'a>(
    animation: &'a GltfAnimation,
    at: &JsonPath,
    nodes: &NodeTree,
    is_needed: &[bool],
) -> Result<Vec<UsedChannel<'a>>, FieldError> {
    let mut seen = HashSet::new();
    let mut all = Vec::new();
    for (index, channel) in animation.channels.0.iter().enumerate() {
        let at_channel = || at.clone().key("channels").index(index);
        let Some((node, part)) = animated_part(channel) else { continue };
        let Some(is_needed) = is_needed.get(node) else {
            let reason = index_rule("nodes", nodes.parents.len(), node);
            return Err(FieldError::new(at_channel().key("target").key("node"), reason));
        };
        if !is_needed {
            continue;
        }
        if let NodeTransform::Matrix(_) = nodes.locals[node] {
            let reason = "must not be given for an animated node";
            return Err(FieldError::new(at_node(node).key("matrix"), reason));
        }
        if !seen.insert((node, part)) {
            let reason = format!("target must be unique, got the same part of node {node} twice");
            return Err(FieldError::new(at_channel(), reason));
        }
        let source = KeySource::of(animation, index, at)?;
        all.push(UsedChannel { node, part, source });
    }
    Ok(all)
}

/// Returns the node that a channel animates, and the part of the node's transform. `None` if the
/// channel has no node or does not animate a transform.
fn animated_part(channel: &GltfChannel) -> Option<(usize, AnimatedPart)> {
    let JsonObject(target) = &channel.target;
    let part = match target.path.as_str() {
        "translation" => AnimatedPart::Translation,
        "rotation" => AnimatedPart::Rotation,
        "scale" => AnimatedPart::Scale,
        _ => return None,
    };
    Some((target.node?.0 as usize, part))
}

/// Reads the buffers that contain the times and values of the channels and of the weights.
pub fn buffers<'a>(
    source: &'a Source,
    file: &GltfFile<'_>,
    channels: &[UsedChannel<'_>],
    weights: &[WeightChannel<'_>],
) -> Result<GltfBuffers<'a>, FieldError> {
    let sources = channels.iter().map(|channel| channel.source);
    let sources = sources.chain(weights.iter().map(|channel| channel.source));
    let accessors: BTreeSet<usize> = sources.flat_map(|it| [it.input, it.output]).collect();
    let mut needed = BTreeSet::new();
    for accessor in accessors {
        needed.extend(buffers_of(file, accessor)?);
    }
    GltfBuffers::read(source, file, &needed)
}

impl<'a> NodeTracks<'a> {
    pub fn new(
        file: &GltfFile<'_>,
        buffers: &'a GltfBuffers<'_>,
        channels: &[UsedChannel<'a>],
        at: &JsonPath,
        warnings: &mut FieldWarnings,
    ) -> Result<Self, FieldError> {
        /// Maximum number of keys in all channels together. Bounds the time, because many channels
        /// can share the same few bytes.
        const MOST_KEYS: usize = 20_000_000;
        let mut tracks = Vec::with_capacity(channels.len());
        let mut keys = 0_usize;
        for channel in channels {
            let track = KeySampler::new(file, buffers, *channel)?;
            keys = keys.saturating_add(track.len());
            if keys > MOST_KEYS {
                let reason = format!("must have at most {MOST_KEYS} keys");
                return Err(FieldError::new(at.clone(), reason));
            }
            tracks.push(track);
        }
        let mut unsorted = None;
        for track in &mut tracks {
            if track.sort()? {
                unsorted.get_or_insert(track.channel.source.input);
            }
            track.check()?;
        }
        if let Some(input) = unsorted {
            warnings.push(at_accessor(input), UNSORTED);
        }
        let places = tracks.iter().enumerate();
        let places =
            places.map(|(place, KeySampler { channel, .. })| ((channel.node, channel.part), place));
        Ok(Self { places: places.collect(), tracks })
    }

    /// The keys of a part of a node's transform; `None` if it has none.
    pub fn track(&self, node: usize, part: AnimatedPart) -> Option<&KeySampler<'a>> {
        self.tracks.get(*self.places.get(&(node, part))?)
    }

    /// Returns whether the scale of a node changes by more than `least` of itself.
    pub fn scales(&self, node: usize, least: f64) -> bool {
        self.track(node, AnimatedPart::Scale).is_some_and(|track| track.varies_by(least))
    }

    /// Returns whether the scale of a node is ever uneven by more than `least` of itself, or mirrors
    /// or vanishes.
    pub fn scales_unevenly(&self, node: usize, least: f64) -> bool {
        self.track(node, AnimatedPart::Scale).is_some_and(|track| track.is_uneven(least))
    }

    /// Nodes with the scales with which the animation begins, or if these are 0 with the greatest,
    /// and with the places and rotations that it gives to nodes that are no joints and does not
    /// change. Nodes that only stretch the skin stay as they are.
    pub fn at_rest(&self, nodes: &NodeTree, joints: &SkinJoints) -> NodeTree {
        let is_joint: HashSet<usize> = joints.nodes.iter().copied().collect();
        let of_skin: HashSet<usize> = joints.stretching(nodes).collect();
        let mut nodes = nodes.clone();
        for track in &self.tracks {
            let UsedChannel { node, part, .. } = track.channel;
            if of_skin.contains(&node) {
                continue;
            }
            if part == AnimatedPart::Scale {
                track.pose(track.time(track.key_with_volume()), &mut nodes.locals);
            } else if !is_joint.contains(&node) && !track.varies() {
                track.pose(track.time(0), &mut nodes.locals);
            }
        }
        nodes
    }

    /// The nodes that some track moves, unsorted and with repetitions.
    pub fn moving(&self) -> impl Iterator<Item = usize> + '_ {
        self.tracks.iter().filter(|track| track.varies()).map(|track| track.channel.node)
    }

    /// Times of all keys in seconds, unsorted.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        self.tracks.iter().flat_map(|track| (0..track.len()).map(|key| track.time(key)))
    }

    /// Times of all keys in seconds, ascending, each once.
    pub fn distinct_times(&self) -> Vec<f64> {
        let mut times: Vec<f64> = self.times().collect();
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// Sets the transforms of the animated nodes in `locals` to their values at `time`, in seconds.
    pub fn pose(&self, time: f64, locals: &mut [NodeTransform]) {
        self.tracks.iter().for_each(|track| track.pose(time, locals));
    }
}
