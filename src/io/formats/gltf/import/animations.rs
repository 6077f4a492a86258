//! The animations of a file: what each moves, and its timeline.

use std::collections::BTreeSet;

use super::file::GltfFile;
use super::nodes::NodeTree;
use super::sampler::tolerance;
use super::skins::SkinJoints;
use super::tracks::{self, NodeTracks};
use crate::document::Timeline;
use crate::io::error::OpenError;
use crate::io::formats::gltf::names::UniqueNames;
use crate::io::frame_rate;
use crate::io::json::{FieldError, FieldWarnings, JsonPath};
use crate::io::opened::FileAnimation;
use crate::io::source::Source;

/// The nodes that an animation moves, and its range.
pub struct AnimationScan {
    pub name: String,
    /// Nodes whose translation, rotation or scale changes.
    pub moving: BTreeSet<usize>,
    /// Times of the first and the last key in seconds.
    pub range: (f64, f64),
}

impl AnimationScan {
    /// The animation as seen from a skeleton.
    pub fn described(&self, joints: &SkinJoints) -> FileAnimation {
        let moving = joints.nodes.iter().filter(|node| self.moving.contains(node)).count();
        let (start, end) = self.range;
        FileAnimation { name: self.name.clone(), start, end, moving_joints: moving }
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
        let (moving, range) = scan_one(source, file, nodes, index).unwrap_or_default();
        AnimationScan { name, moving, range }
    });
    scans.collect()
}

fn scan_one(
    source: &Source,
    file: &GltfFile<'_>,
    nodes: &NodeTree,
    index: usize,
) -> Result<(BTreeSet<usize>, (f64, f64)), FieldError> {
    let (animation, at) = (&file.animations.0[index], at_animation(index));
    let all = vec![true; nodes.parents.len()];
    let channels = tracks::used_channels(animation, &at, nodes, &all)?;
    let buffers = tracks::buffers(source, file, &channels)?;
    let tracks = NodeTracks::new(file, &buffers, &channels, &mut FieldWarnings::default())?;
    let range = time_range(&tracks).unwrap_or_default();
    Ok((tracks.moving().collect(), range))
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

/// Returns the timeline from the first key to the last. Its frame rate is the one that
/// [`frame_rate::of_times`] finds with as little tolerance as possible, or else [`FALLBACK_RATE`];
/// `own_rate`, if the file tells it. Returns `None` if all keys are at the same time. `at` is the
/// path of the animation.
pub fn timeline(
    tracks: &NodeTracks<'_>,
    own_rate: Option<f64>,
    at: &JsonPath,
) -> Result<Option<Timeline>, FieldError> {
    let Some((start, end)) = time_range(tracks) else { return Ok(None) };
    if start == end {
        return Ok(None);
    }
    let mut times: Vec<f64> = tracks.times().map(|time| time - start).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
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

/// The time of the frame at a time that single precision cannot tell from it; else the time itself.
pub fn on_frame(time: f64, timeline: Timeline) -> f64 {
    let frame = timeline.snapped(time);
    let rounding = (time.abs() * f64::from(f32::EPSILON)).max(1e-7);
    if (frame - time).abs() <= rounding { frame } else { time }
}

/// Times of the first and the last key in seconds; `None` without keys.
pub fn time_range(tracks: &NodeTracks<'_>) -> Option<(f64, f64)> {
    tracks.times().map(|time| (time, time)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}
