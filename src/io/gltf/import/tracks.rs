use std::collections::{BTreeSet, HashSet};

use super::buffers::Buffers;
use super::file::{Animation, Channel, File};
use super::nodes::{Local, Nodes, Parts, at_node};
use super::sampler::{Interpolation, Sampler};
use crate::io::field_error::FieldError;
use crate::io::json_path::JsonPath;
use crate::io::source::Source;
use crate::io::value::Object;

/// What moves the nodes.
pub struct Tracks<'a>(Vec<Track<'a>>);

struct Track<'a> {
    node: usize,
    part: Part,
    sampler: Sampler<'a>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub enum Part {
    Translation,
    Rotation,
    Scale,
}

/// A channel of an animation that counts, where it stands, and the accessors that it takes.
pub struct Chosen<'a> {
    node: usize,
    part: Part,
    interpolation: Interpolation,
    input: usize,
    output: usize,
    at: &'a JsonPath,
}

/// The channels of an animation that move one of the nodes that are needed.
pub fn chosen<'a>(
    animation: &Animation,
    at: &'a JsonPath,
    nodes: &Nodes,
    is_needed: &[bool],
) -> Result<Vec<Chosen<'a>>, FieldError> {
    let mut seen = HashSet::new();
    let mut all = Vec::new();
    for (index, channel) in animation.channels.0.iter().enumerate() {
        let at_channel = || at.clone().key("channels").index(index);
        let Some((node, part)) = moved(channel) else { continue };
        let Some(is_needed) = is_needed.get(node) else {
            let reason = format!("there is no node {node}");
            return Err(FieldError::new(at_channel().key("target").key("node"), reason));
        };
        if !is_needed {
            continue;
        }
        if let Local::Matrix(_) = nodes.locals[node] {
            let reason = "a node that moves cannot have a matrix";
            return Err(FieldError::new(at_node(node).key("matrix"), reason));
        }
        if !seen.insert((node, part)) {
            let reason = format!("node {node} is moved so by a channel before");
            return Err(FieldError::new(at_channel(), reason));
        }
        let place = channel.sampler.0 as usize;
        let Some(sampler) = animation.samplers.0.get(place) else {
            let reason = format!("there is no sampler {place}");
            return Err(FieldError::new(at_channel().key("sampler"), reason));
        };
        let at_sampler = || at.clone().key("samplers").index(place);
        let name = sampler.interpolation.as_deref().unwrap_or("LINEAR");
        let interpolation = Interpolation::new(name).ok_or_else(|| {
            let reason = format!("is {name:?}; it must be LINEAR, STEP or CUBICSPLINE");
            FieldError::new(at_sampler().key("interpolation"), reason)
        })?;
        let (input, output) = (sampler.input.0 as usize, sampler.output.0 as usize);
        all.push(Chosen { node, part, interpolation, input, output, at });
    }
    Ok(all)
}

fn moved(channel: &Channel) -> Option<(usize, Part)> {
    let Object(target) = &channel.target;
    let part = match target.path.as_str() {
        "translation" => Part::Translation,
        "rotation" => Part::Rotation,
        "scale" => Part::Scale,
        _ => return None,
    };
    Some((target.node?.0 as usize, part))
}

/// Reads the buffers that channels need.
pub fn buffers<'a>(
    source: &'a Source,
    file: &File,
    chosen: &[Chosen<'_>],
) -> Result<Buffers<'a>, FieldError> {
    let accessors: BTreeSet<usize> =
        chosen.iter().flat_map(|chosen| [chosen.input, chosen.output]).collect();
    let needed: Result<BTreeSet<usize>, FieldError> =
        accessors.into_iter().map(|accessor| super::rows::buffer_of(file, accessor)).collect();
    let needed: Vec<usize> = needed?.into_iter().collect();
    Buffers::read(source, file, &needed)
}

impl<'a> Tracks<'a> {
    pub fn new(
        file: &File,
        buffers: &'a Buffers<'_>,
        chosen: &[Chosen<'_>],
    ) -> Result<Self, FieldError> {
        /// So that few bytes that are read again and again do not take hours.
        const MOST_KEYS: usize = 20_000_000;
        let mut tracks = Vec::with_capacity(chosen.len());
        let mut keys = 0_usize;
        for Chosen { node, part, interpolation, input, output, at } in chosen {
            let (node, part, accessors) = (*node, *part, [*input, *output]);
            let sampler = Sampler::new(file, buffers, accessors, part, *interpolation)?;
            keys = keys.saturating_add(sampler.len());
            if keys > MOST_KEYS {
                let reason = format!("has more than {MOST_KEYS} keys; fewer are possible");
                return Err(FieldError::new((*at).clone(), reason));
            }
            tracks.push(Track { node, part, sampler });
        }
        for (track, Chosen { input, output, .. }) in tracks.iter().zip(chosen) {
            track.sampler.check([*input, *output])?;
        }
        Ok(Self(tracks))
    }

    /// All times of keys, in no order.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        self.0.iter().flat_map(|track| (0..track.sampler.len()).map(|key| track.sampler.time(key)))
    }

    /// Moves the nodes to where they are at a time, in seconds.
    pub fn pose(&self, time: f64, locals: &mut [Local]) {
        for Track { node, part, sampler } in &self.0 {
            if let Some(Local::Parts(parts)) = locals.get_mut(*node) {
                let Parts { translation, rotation, scale } = parts;
                match part {
                    Part::Translation => *translation = sampler.point(time),
                    Part::Rotation => *rotation = sampler.rotation(time),
                    Part::Scale => *scale = sampler.point(time),
                }
            }
        }
    }
}
