//! Import of the skeleton of a skin, with its motion.

mod animations;
mod buffers;
mod exact_tracks;
mod joint_tracks;
mod nodes;
mod primitive;
mod rig;
mod rows;
mod sampler;
mod skin_mesh;

use std::collections::BTreeSet;

use crate::document::Timeline;
use crate::io::error::OpenError;
use crate::io::foreign::ForeignFormat;
use crate::io::formats::gltf::extras::Extras;
use crate::io::formats::gltf::file::{GltfFile, GltfSkin, VersionedFile};
use crate::io::json::{FieldError, FieldWarnings, JsonObject, JsonPath};
use crate::io::opened::{FileAnimation, OpenOptions, Opened, attach_skin};
use crate::io::source::Source;
use crate::kinematics::skeleton::{Joint, JointId};
use crate::rig::SkinFile;
use animations::NodeTracks;
use animations::at_animation;
use exact_tracks::ExactTracks;
use joint_tracks::JointTracks;
use joint_tracks::{JointPlacement, NodePoser};
use nodes::{NodeTree, at_node};
use nodes::{SkinJoints, at_skin};
use rig::{BoneEnds, ImportedRig};
use skin_mesh::MeshImport;

/// Maximum number of node transforms in all frames.
const MOST_SAMPLES: usize = 4_000_000;

/// Reads a skeleton and one of the animations: the skin's joints, or without a skin the nodes that
/// the animations move.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let JsonObject(file) = source.parse::<JsonObject<GltfFile<'_>>>(|_| {})?;
    check(&file).map_err(|error| source.error(&error))?;
    let nodes = NodeTree::new(&file).map_err(|error| source.error(&error))?;
    let scans = animations::scan(source, &file, &nodes);
    let moving: BTreeSet<usize> =
        scans.iter().flat_map(|scan| scan.moving.iter().copied()).collect();
    let names = nodes::names(&file, &nodes, &moving);
    let chosen = match &options.skeleton {
        Some(name) => names.iter().position(|other| other == name),
        None => (!names.is_empty()).then_some(0),
    };
    let Some(index) = chosen else {
        return Err(match &options.skeleton {
            Some(name) => {
                OpenError::NoSkeleton { file: source.name().to_owned(), name: name.clone(), names }
            }
            None => source.error(&no_skeleton()),
        });
    };
    let joints = skin_joints(&file, &nodes, index, &moving);
    let joints = joints.map_err(|error| source.error(&error))?;
    let described: Vec<FileAnimation> = scans.iter().map(|scan| scan.described(&joints)).collect();
    let animation = animations::choose(source, &described, options.animation.as_deref())?;
    let mut warnings = FieldWarnings::default();
    for name in file.unread_extensions() {
        let reason = format!("{name} is not read: what it changes is missing");
        warnings.push(JsonPath::root().key("extensionsRequired"), reason);
    }
    if let (Some(chosen), true) = (animation, described.len() > 1) {
        let reason = format!("{:?} is read, one of {}", described[chosen].name, described.len());
        warnings.push(at_animation(chosen), reason);
    }
    warn_of_left_out(&moving, &joints, &mut warnings);
    let import = GltfImport { source, file: &file, nodes: &nodes, index, joints: &joints };
    let imported = import.read(animation, &names[index], &mut warnings);
    let ImportedRig { mut document, kept } = imported.map_err(|error| source.error(&error))?;
    document.animation_name = animation.map(|chosen| described[chosen].name.clone());
    let order = joints.order.iter().chain(&joints.added);
    Ok(Opened {
        document,
        warnings: source.warnings(&warnings),
        order: order.filter_map(|joint| kept[*joint]).map(JointId::new).collect(),
        skeletons: names,
        animations: described,
        animation,
    })
}

/// The first version of glTF, in which lists are objects, if the file has it.
pub fn former(source: &Source) -> Option<ForeignFormat> {
    let file = source.parse::<VersionedFile>(|_| {}).ok()?;
    file.asset.is_version_1().then_some(ForeignFormat::GLTF_1)
}

fn check(file: &GltfFile<'_>) -> Result<(), FieldError> {
    let JsonObject(asset) = &file.asset;
    if asset.version.split('.').next() != Some("2") {
        let reason = format!("must be 2 or 2.x, got {:?}", asset.version);
        return Err(FieldError::new(JsonPath::root().key("asset").key("version"), reason));
    }
    if let Some(least) = asset.min_version.as_deref().filter(|least| *least != "2.0") {
        let reason = format!("must be 2.0, the version that is read, got {least:?}");
        return Err(FieldError::new(JsonPath::root().key("asset").key("minVersion"), reason));
    }
    Ok(())
}

fn no_skeleton() -> FieldError {
    let reason = "must have at least one skin, or an animation that moves a node";
    FieldError::new(JsonPath::root().key("skins"), reason)
}

fn skin_joints(
    file: &GltfFile<'_>,
    nodes: &NodeTree,
    index: usize,
    moving: &BTreeSet<usize>,
) -> Result<SkinJoints, FieldError> {
    match file.skins.0.get(index) {
        Some(skin) => SkinJoints::new(file, nodes, index, skin, moving),
        None => SkinJoints::of_moving(nodes, moving).ok_or_else(no_skeleton),
    }
}

/// Warns of nodes that move and are no joints.
fn warn_of_left_out(moving: &BTreeSet<usize>, joints: &SkinJoints, warnings: &mut FieldWarnings) {
    let is_joint: BTreeSet<usize> = joints.nodes.iter().copied().collect();
    let mut left_out = moving.difference(&is_joint);
    let count = left_out.clone().count();
    if let Some(first) = left_out.next() {
        let reason = match count {
            1 => "moves, but is not in the hierarchy of the skeleton, and is left out".to_owned(),
            _ => format!(
                "and {} more nodes move, but are not in the hierarchy of the skeleton, and are left out",
                count - 1
            ),
        };
        warnings.push(at_node(*first), reason);
    }
}

/// A skeleton of a file that is imported.
struct GltfImport<'a> {
    source: &'a Source,
    file: &'a GltfFile<'a>,
    nodes: &'a NodeTree,
    /// Index of the skin; for a file without skins 0.
    index: usize,
    joints: &'a SkinJoints,
}

impl GltfImport<'_> {
    fn read(
        &self,
        animation: Option<usize>,
        name: &str,
        warnings: &mut FieldWarnings,
    ) -> Result<ImportedRig, FieldError> {
        let Self { source, file, nodes, index, joints: skin_joints } = *self;
        let mut poser = NodePoser::new(nodes, skin_joints);
        let bind_pose = poser.bind_pose()?;
        let mut joints = rig::joints(file, skin_joints, &bind_pose);
        let (motions, timeline) = match animation {
            None => (Vec::new(), None),
            Some(chosen) => self.animate(chosen, &mut poser, &mut joints, &bind_pose, warnings)?,
        };
        let ends = BoneEnds::new(file, nodes, skin_joints, &bind_pose);
        let built = rig::build(joints, &motions, timeline, &ends);
        let mut built =
            built.map_err(|error| FieldError::new(at_skin(index), error.to_string()))?;
        let no_skin = GltfSkin::default();
        let mesh = MeshImport {
            source,
            file,
            nodes,
            index,
            skin: file.skins.0.get(index).unwrap_or(&no_skin),
            joints: skin_joints,
            bind_pose: &bind_pose,
        };
        match mesh.read(warnings) {
            Ok(Some((mesh, checksum))) => {
                let joints = built.kept.iter().map(|joint| joint.map(JointId::new)).collect();
                let skeleton = name.to_owned();
                let file =
                    source.path().map(|path| SkinFile { path: path.into(), checksum, skeleton });
                attach_skin(&mut built.document, mesh, file, joints);
            }
            Ok(None) => {}
            Err(error) => {
                let reason = format!("{}; the skin is left out", error.reason);
                warnings.push(error.field, reason);
            }
        }
        built.document.camera = built.document.framing_camera();
        Ok(built)
    }

    /// Reads the motion of an animation.
    fn animate(
        &self,
        chosen: usize,
        poser: &mut NodePoser<'_>,
        joints: &mut [Joint],
        bind_pose: &[JointPlacement],
        warnings: &mut FieldWarnings,
    ) -> Result<(Vec<JointTracks>, Option<Timeline>), FieldError> {
        let at = at_animation(chosen);
        let Some(animation) = self.file.animations.0.get(chosen) else {
            return Ok((Vec::new(), None));
        };
        let channels = animations::used_channels(animation, &at, self.nodes, &poser.is_needed())?;
        let buffers = animations::buffers(self.source, self.file, &channels)?;
        let tracks = NodeTracks::new(self.file, &buffers, &channels, &at, warnings)?;
        let Some((start, _)) = animations::time_range(&tracks) else {
            return Ok((Vec::new(), None));
        };
        let is_own = self.file.asset.0.is_of_this_program();
        let extras = animation.extras.as_ref().and_then(Extras::own).filter(|_| is_own);
        let own_rate = extras.and_then(|extras| extras.frame_rate());
        let timeline = animations::timeline(&tracks, own_rate, &at)?;
        let own = is_own.then_some(self.file);
        let exact = ExactTracks::new(self.nodes, self.joints, &tracks, bind_pose, timeline, own);
        let exact: Vec<_> = (0..joints.len()).map(|joint| exact.of(joint)).collect();
        if exact.iter().all(Option::is_some) {
            return Ok((exact.into_iter().flatten().collect(), timeline));
        }
        // Joints below scales that are uneven or change have keys at every frame.
        let frames = timeline.map_or(1, |timeline| timeline.frames());
        if frames.saturating_mul(poser.len()) > MOST_SAMPLES {
            let nodes = poser.len();
            let most = MOST_SAMPLES / nodes;
            let reason = format!("must have at most {most} frames of {nodes} nodes, got {frames}");
            return Err(FieldError::new(at, reason));
        }
        let frame_times = timeline.unwrap_or(Timeline { start, ..Timeline::default() });
        let sampled = joint_tracks::sample(poser, &tracks, frame_times, frames, joints, bind_pose)?;
        let motions = exact.into_iter().zip(sampled);
        let motions = motions.map(|(exact, sampled)| exact.unwrap_or(sampled)).collect();
        Ok((motions, timeline))
    }
}
