//! The skeleton of a skin, with its motion.

mod base64;
mod buffers;
mod clip;
mod file;
mod motion;
mod nodes;
mod part;
mod rig;
mod rows;
mod sampler;
mod skins;
mod tracks;

use crate::document::Timeline;
use crate::io::error::OpenError;
use crate::io::field_error::{FieldError, FieldWarnings};
use crate::io::json_path::JsonPath;
use crate::io::opened::Opened;
use crate::io::source::Source;
use crate::io::value::JsonObject;
use crate::kinematics::skeleton::{Joint, JointId};
use file::{GltfAnimation, GltfFile, GltfSkin};
use motion::{JointMotion, JointPlacement, NodePoser};
use nodes::NodeTree;
use rig::ImportedRig;
use skins::{SkinJoints, at_skin};
use tracks::NodeTracks;

/// Most transforms of nodes in all frames.
const MOST_SAMPLES: usize = 4_000_000;

/// Reads the skeleton of the skin called `name`, or of the first skin.
pub fn read(source: &Source, name: Option<&str>) -> Result<Opened, OpenError> {
    let JsonObject(file) = source.parse::<JsonObject<GltfFile>>(|_| {})?;
    check(&file).map_err(|wrong| source.error(&wrong))?;
    let names = skins::names(&file);
    let chosen = match name {
        Some(name) => names.iter().position(|other| other == name),
        None => Some(0),
    };
    let Some((index, skin)) = chosen.and_then(|skin| Some((skin, file.skins.0.get(skin)?))) else {
        return Err(OpenError::NoSkeleton {
            file: source.name().to_owned(),
            name: name.unwrap_or_default().to_owned(),
            names,
        });
    };
    let mut odd = FieldWarnings::default();
    let opened = opened(source, &file, index, skin, &mut odd);
    let (ImportedRig { document, kept }, order) = opened.map_err(|wrong| source.error(&wrong))?;
    Ok(Opened {
        document,
        warnings: source.warnings(&odd),
        order: order.into_iter().filter_map(|joint| kept[joint]).map(JointId::new).collect(),
        skeletons: names,
    })
}

fn check(file: &GltfFile) -> Result<(), FieldError> {
    let JsonObject(asset) = &file.asset;
    if asset.version.split('.').next() != Some("2") {
        let reason = format!("is {:?}; only glTF 2 is known", asset.version);
        return Err(FieldError::new(JsonPath::root().key("asset").key("version"), reason));
    }
    if file.skins.0.is_empty() {
        let reason = "there is none; joints are those of a skin";
        return Err(FieldError::new(JsonPath::root().key("skins"), reason));
    }
    Ok(())
}

fn opened(
    source: &Source,
    file: &GltfFile,
    index: usize,
    skin: &GltfSkin,
    odd: &mut FieldWarnings,
) -> Result<(ImportedRig, Vec<usize>), FieldError> {
    let nodes = NodeTree::new(file)?;
    let joints = SkinJoints::new(file, &nodes, index, skin)?;
    let mut stage = NodePoser::new(&nodes, &joints);
    let rest = stage.rest()?;
    let mut list = rig::joints(file, &joints, &rest);
    let at = JsonPath::root().key("animations");
    if file.animations.0.len() > 1 {
        let reason = "the first animation is read, the others are not";
        odd.push(at.clone().index(1), reason);
    }
    let (motions, timeline) = match file.animations.0.first() {
        None => (Vec::new(), None),
        Some(first) => {
            let at = at.index(0);
            animate(source, file, &nodes, (first, &at), &mut stage, &mut list, &rest)?
        }
    };
    let built = rig::build(list, &motions, timeline);
    let built = built.map_err(|error| FieldError::new(at_skin(index), error.to_string()))?;
    Ok((built, joints.order))
}

fn animate(
    source: &Source,
    file: &GltfFile,
    nodes: &NodeTree,
    (animation, at): (&GltfAnimation, &JsonPath),
    stage: &mut NodePoser<'_>,
    joints: &mut [Joint],
    rest: &[JointPlacement],
) -> Result<(Vec<JointMotion>, Option<Timeline>), FieldError> {
    let chosen = tracks::chosen(animation, at, nodes, &stage.is_needed())?;
    let buffers = tracks::buffers(source, file, &chosen)?;
    let tracks = NodeTracks::new(file, &buffers, &chosen)?;
    let Some((start, _)) = clip::ends(&tracks) else {
        return Ok((Vec::new(), None));
    };
    let timeline = clip::timeline(&tracks, at)?;
    let frames = timeline.map_or(1, |timeline| timeline.frames());
    if frames.saturating_mul(stage.len()) > MOST_SAMPLES {
        let nodes = stage.len();
        let reason = format!(
            "moves {nodes} nodes in {frames} frames; at most {} frames are possible",
            MOST_SAMPLES / nodes
        );
        return Err(FieldError::new(at.clone(), reason));
    }
    let sampled = timeline.unwrap_or(Timeline { start, ..Timeline::default() });
    let motions = motion::sample(stage, &tracks, sampled, frames, joints, rest)?;
    Ok((motions, timeline))
}
