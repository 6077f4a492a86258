use std::collections::{BTreeSet, HashMap, HashSet};

use glam::Vec3;

use super::buffers::GltfBuffers;
use super::file::{GltfAnimation, GltfChannel, GltfFile, index_rule};
use super::nodes::{NodeTransform, NodeTree, TransformParts, at_node};
use super::rows::at_accessor;
use super::sampler::AnimatedPart;
use super::sampler::{Interpolation, KeySampler};
use crate::io::formats::gltf::extras::{ReadExtras, SamplerExtras};
use crate::io::json::JsonObject;
use crate::io::json::JsonPath;
use crate::io::json::{FieldError, FieldWarnings};
use crate::io::source::Source;
use crate::kinematics::spline::Spline;

/// The animated values of all nodes.
pub struct NodeTracks<'a> {
    tracks: Vec<NodeTrack<'a>>,
    /// Index of the track of a part of a node.
    places: HashMap<(usize, AnimatedPart), usize>,
}

struct NodeTrack<'a> {
    node: usize,
    part: AnimatedPart,
    sampler: KeySampler<'a>,
    own: Option<&'a SamplerExtras>,
}

/// An animation channel that moves a joint or an ancestor of a joint. `input` and `output` are the
/// accessors of its times and values, and `at` is the path of its animation.
pub struct UsedChannel<'a> {
    node: usize,
    part: AnimatedPart,
    interpolation: Interpolation,
    input: usize,
    output: usize,
    /// The keys that this program has written beside the sampler.
    own: Option<&'a SamplerExtras>,
    at: &'a JsonPath,
}

/// Returns those channels of an animation that move a node for which `is_needed` is true.
pub fn used_channels<'a>(
    animation: &'a GltfAnimation,
    at: &'a JsonPath,
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
        let sampler_index = channel.sampler.0 as usize;
        let Some(sampler) = animation.samplers.0.get(sampler_index) else {
            let reason = index_rule("samplers", animation.samplers.0.len(), sampler_index);
            return Err(FieldError::new(at_channel().key("sampler"), reason));
        };
        let at_sampler = || at.clone().key("samplers").index(sampler_index);
        let name = sampler.interpolation.as_deref().unwrap_or("LINEAR");
        let interpolation = Interpolation::new(name).ok_or_else(|| {
            let reason = format!("must be LINEAR, STEP or CUBICSPLINE, got {name:?}");
            FieldError::new(at_sampler().key("interpolation"), reason)
        })?;
        let (input, output) = (sampler.input.0 as usize, sampler.output.0 as usize);
        let own = sampler.extras.as_ref().and_then(ReadExtras::own);
        all.push(UsedChannel { node, part, interpolation, input, output, own, at });
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

/// Reads the buffers that contain the times and values of the channels.
pub fn buffers<'a>(
    source: &'a Source,
    file: &GltfFile<'_>,
    channels: &[UsedChannel<'_>],
) -> Result<GltfBuffers<'a>, FieldError> {
    let accessors: BTreeSet<usize> =
        channels.iter().flat_map(|channel| [channel.input, channel.output]).collect();
    let mut needed = BTreeSet::new();
    for accessor in accessors {
        needed.extend(super::rows::buffers_of(file, accessor)?);
    }
    GltfBuffers::read(source, file, &needed)
}

impl<'a> NodeTracks<'a> {
    pub fn new(
        file: &GltfFile<'_>,
        buffers: &'a GltfBuffers<'_>,
        channels: &[UsedChannel<'a>],
        warnings: &mut FieldWarnings,
    ) -> Result<Self, FieldError> {
        /// Maximum number of keys in all channels together. Bounds the time, because many channels
        /// can share the same few bytes.
        const MOST_KEYS: usize = 20_000_000;
        let mut tracks = Vec::with_capacity(channels.len());
        let mut keys = 0_usize;
        let mut unsorted: Option<usize> = None;
        for UsedChannel { node, part, interpolation, input, output, own, at } in channels {
            let (node, part, accessors) = (*node, *part, [*input, *output]);
            let sampler = KeySampler::new(file, buffers, accessors, part, *interpolation)?;
            keys = keys.saturating_add(sampler.len());
            if keys > MOST_KEYS {
                let reason = format!("must have at most {MOST_KEYS} keys");
                return Err(FieldError::new((*at).clone(), reason));
            }
            tracks.push(NodeTrack { node, part, sampler, own: *own });
        }
        for (track, UsedChannel { input, output, .. }) in tracks.iter_mut().zip(channels) {
            if track.sampler.sort(*input)? {
                unsorted.get_or_insert(*input);
            }
            track.sampler.check(*output)?;
        }
        if let Some(input) = unsorted {
            let reason = "times must increase; the keys are sorted, and of several keys at the same \
                          time the last one counts";
            warnings.push(at_accessor(input), reason);
        }
        let places = tracks.iter().enumerate();
        let places = places.map(|(place, track)| ((track.node, track.part), place)).collect();
        Ok(Self { tracks, places })
    }

    /// The keys of a part of a node's transform; `None` if it has none.
    pub fn track(&self, node: usize, part: AnimatedPart) -> Option<&KeySampler<'a>> {
        Some(&self.tracks[*self.places.get(&(node, part))?].sampler)
    }

    /// The keys that this program has written beside a track; `None` if there are none.
    pub fn own_keys(&self, node: usize, part: AnimatedPart) -> Option<Spline<Vec3>> {
        self.tracks[*self.places.get(&(node, part))?].own?.spline()
    }

    /// The nodes that some track moves, unsorted and with repetitions.
    pub fn moving(&self) -> impl Iterator<Item = usize> + '_ {
        self.tracks.iter().filter(|track| track.sampler.varies()).map(|track| track.node)
    }

    /// Times of all keys in seconds, unsorted.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        self.tracks
            .iter()
            .flat_map(|track| (0..track.sampler.len()).map(|key| track.sampler.time(key)))
    }

    /// Sets the transforms of the animated nodes in `locals` to their values at `time`, in seconds.
    pub fn pose(&self, time: f64, locals: &mut [NodeTransform]) {
        for NodeTrack { node, part, sampler, .. } in &self.tracks {
            if let Some(NodeTransform::TransformParts(parts)) = locals.get_mut(*node) {
                let TransformParts { translation, rotation, scale } = parts;
                match part {
                    AnimatedPart::Translation => *translation = sampler.point(time),
                    AnimatedPart::Rotation => *rotation = sampler.rotation(time),
                    AnimatedPart::Scale => *scale = sampler.point(time),
                }
            }
        }
    }
}
