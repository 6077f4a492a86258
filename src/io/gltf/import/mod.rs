//! Import of the skeleton of a skin, with its motion.

mod buffers;
mod clip;
mod file;
mod material;
mod motion;
mod nodes;
mod part;
mod primitive;
mod rig;
mod rows;
mod sampler;
mod skin_mesh;
mod skins;
mod tracks;

use crate::document::Timeline;
use crate::io::attach_skin::attach_skin;
use crate::io::error::OpenError;
use crate::io::field_error::{FieldError, FieldWarnings};
use crate::io::json_path::JsonPath;
use crate::io::opened::Opened;
use crate::io::source::Source;
use crate::io::value::JsonObject;
use crate::kinematics::skeleton::{Joint, JointId};
use crate::rig::SkinFile;
use file::{GltfAnimation, GltfFile, GltfSkin};
use motion::{JointMotion, JointPlacement, NodePoser};
use nodes::NodeTree;
use rig::ImportedRig;
use skin_mesh::MeshImport;
use skins::{SkinJoints, at_skin};
use tracks::NodeTracks;

/// Maximum number of node transforms in all frames.
const MOST_SAMPLES: usize = 4_000_000;

/// Reads the skeleton of the skin called `name`, or of the first skin.
pub fn read(source: &Source, name: Option<&str>) -> Result<Opened, OpenError> {
    let JsonObject(file) = source.parse::<JsonObject<GltfFile>>(|_| {})?;
    check(&file).map_err(|error| source.error(&error))?;
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
    let mut warnings = FieldWarnings::default();
    let imported = import(source, &file, index, skin, &mut warnings);
    let (ImportedRig { document, kept }, order) = imported.map_err(|error| source.error(&error))?;
    Ok(Opened {
        document,
        warnings: source.warnings(&warnings),
        order: order.into_iter().filter_map(|joint| kept[joint]).map(JointId::new).collect(),
        skeletons: names,
    })
}

fn check(file: &GltfFile) -> Result<(), FieldError> {
    let JsonObject(asset) = &file.asset;
    if asset.version.split('.').next() != Some("2") {
        let reason = format!("must be 2 or 2.x, got {:?}", asset.version);
        return Err(FieldError::new(JsonPath::root().key("asset").key("version"), reason));
    }
    if file.skins.0.is_empty() {
        let reason = "must have at least one skin";
        return Err(FieldError::new(JsonPath::root().key("skins"), reason));
    }
    Ok(())
}

fn import(
    source: &Source,
    file: &GltfFile,
    index: usize,
    skin: &GltfSkin,
    warnings: &mut FieldWarnings,
) -> Result<(ImportedRig, Vec<usize>), FieldError> {
    let nodes = NodeTree::new(file)?;
    let skin_joints = SkinJoints::new(file, &nodes, index, skin)?;
    let mut poser = NodePoser::new(&nodes, &skin_joints);
    let bind_pose = poser.bind_pose()?;
    let mut joints = rig::joints(file, &skin_joints, &bind_pose);
    let at = JsonPath::root().key("animations");
    if file.animations.0.len() > 1 {
        let reason = "ignored; only the first animation is read";
        warnings.push(at.clone().index(1), reason);
    }
    let (motions, timeline) = match file.animations.0.first() {
        None => (Vec::new(), None),
        Some(first) => {
            let at = at.index(0);
            animate(
                source,
                file,
                &nodes,
                (first, &at),
                &mut poser,
                &mut joints,
                &bind_pose,
                warnings,
            )?
        }
    };
    let built = rig::build(joints, &motions, timeline);
    let mut built = built.map_err(|error| FieldError::new(at_skin(index), error.to_string()))?;
    let mesh = MeshImport {
        source,
        file,
        nodes: &nodes,
        index,
        skin,
        joints: &skin_joints,
        bind_pose: &bind_pose,
    };
    match mesh.read(warnings) {
        Ok(Some((mesh, checksum))) => {
            let skeleton = skins::names(file).swap_remove(index);
            let joints = built.kept.iter().map(|joint| joint.map(JointId::new)).collect();
            let file = source.path().map(|path| SkinFile { path: path.into(), checksum, skeleton });
            attach_skin(&mut built.document, mesh, file, joints);
        }
        Ok(None) => {}
        Err(error) => {
            let reason = format!("{}; the skin is left out", error.reason);
            warnings.push(error.field, reason);
        }
    }
    Ok((built, skin_joints.order))
}

fn animate(
    source: &Source,
    file: &GltfFile,
    nodes: &NodeTree,
    (animation, at): (&GltfAnimation, &JsonPath),
    poser: &mut NodePoser<'_>,
    joints: &mut [Joint],
    bind_pose: &[JointPlacement],
    warnings: &mut FieldWarnings,
) -> Result<(Vec<JointMotion>, Option<Timeline>), FieldError> {
    let channels = tracks::used_channels(animation, at, nodes, &poser.is_needed())?;
    let buffers = tracks::buffers(source, file, &channels)?;
    let tracks = NodeTracks::new(file, &buffers, &channels, warnings)?;
    let Some((start, _)) = clip::time_range(&tracks) else {
        return Ok((Vec::new(), None));
    };
    let timeline = clip::timeline(&tracks, at)?;
    let frames = timeline.map_or(1, |timeline| timeline.frames());
    if frames.saturating_mul(poser.len()) > MOST_SAMPLES {
        let nodes = poser.len();
        let reason = format!(
            "must have at most {} frames of {nodes} nodes, got {frames}",
            MOST_SAMPLES / nodes
        );
        return Err(FieldError::new(at.clone(), reason));
    }
    let sampled = timeline.unwrap_or(Timeline { start, ..Timeline::default() });
    let motions = motion::sample(poser, &tracks, sampled, frames, joints, bind_pose)?;
    Ok((motions, timeline))
}
