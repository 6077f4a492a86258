use std::collections::BTreeSet;

use super::clip;
use super::file::GltfFile;
use super::nodes::NodeTree;
use super::skins::SkinJoints;
use super::tracks::{self, NodeTracks};
use crate::io::error::OpenError;
use crate::io::formats::gltf::names::UniqueNames;
use crate::io::json::JsonPath;
use crate::io::json::{FieldError, FieldWarnings};
use crate::io::opened::FileAnimation;
use crate::io::source::Source;

/// What an animation moves.
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
    let range = clip::time_range(&tracks).unwrap_or_default();
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
