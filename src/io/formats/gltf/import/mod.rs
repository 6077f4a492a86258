//! Import of the skeleton of a skin, with its motion.

mod animations;
mod bind_tables;
mod buffers;
mod draco;
mod exact_tracks;
mod figures;
mod joint_tracks;
mod morphs;
mod nodes;
mod primitive;
mod rig;
mod rows;
mod sampler;
mod skin_mesh;

use std::collections::BTreeSet;

use glam::{Affine3A, Mat3, Vec3};

use crate::document::Timeline;
use crate::io::error::OpenError;
use crate::io::foreign::ForeignFormat;
use crate::io::formats::gltf::extras::Extras;
use crate::io::formats::gltf::file::{GltfAnimation, GltfFile, VersionedFile};
use crate::io::json::{FieldError, FieldWarnings, JsonObject, JsonPath};
use crate::io::opened::{FileAnimation, OpenOptions, Opened, attach_skin};
use crate::io::source::Source;
use crate::kinematics::skeleton::{JointId, SkeletonError};
use crate::rig::SkinFile;
use animations::NodeTracks;
use animations::at_animation;
use exact_tracks::ExactTracks;
use figures::Figure;
use joint_tracks::{ExactJoint, NodePoser};
use morphs::WeightTracks;
use nodes::{NodeTree, SkinJoints, at_node, at_skin};
use rig::{BoneEnds, ImportedRig};
use sampler::UsedChannel;
use skin_mesh::{FigureMesh, MeshImport};

/// Maximum number of node transforms in all frames.
const MOST_SAMPLES: usize = 4_000_000;

/// Reads a skeleton and one of the animations: the joints of skins, or without a skin the nodes that
/// move, that are bones of a humanoid, or that have meshes.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let JsonObject(file) = source.parse::<JsonObject<GltfFile<'_>>>(|_| {})?;
    check(&file).map_err(|error| source.error(&error))?;
    let nodes = NodeTree::new(&file).map_err(|error| source.error(&error))?;
    let scans = animations::scan(source, &file, &nodes);
    let moving: BTreeSet<usize> =
        scans.iter().flat_map(|scan| scan.moving.iter().copied()).collect();
    let parts = figures::parts(&file, &nodes, &moving);
    let figures = figures::figures(&file, &nodes, &parts);
    let names: Vec<String> = figures.iter().map(|figure| figure.name.clone()).collect();
    let chosen = match &options.skeleton {
        Some(name) => figures.iter().position(|figure| figure.is_called(name)),
        None => (!figures.is_empty()).then_some(0),
    };
    let Some(index) = chosen else {
        return Err(match &options.skeleton {
            Some(name) => {
                OpenError::NoSkeleton { file: source.name().to_owned(), name: name.clone(), names }
            }
            None => source.error(&no_skeleton()),
        });
    };
    let figure = &figures[index];
    let joints = match figure.skins.is_empty() {
        false => SkinJoints::new(&file, &nodes, &figure.skins, &parts),
        true => Ok(SkinJoints::of_parts(&file, &nodes, &parts)),
    };
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
    let import = GltfImport {
        source,
        file: &file,
        nodes: &nodes,
        figure,
        joints: &joints,
        animation: animation.map(|chosen| (chosen, &described[chosen])),
    };
    let imported = import.read(&mut warnings);
    let ImportedRig { mut document, kept } = imported.map_err(|error| source.error(&error))?;
    document.animation_name = animation.map(|chosen| described[chosen].name.clone());
    Ok(Opened {
        document,
        warnings: source.warnings(&warnings),
        order: joints.in_order_of_file().filter_map(|it| kept[it]).map(JointId::new).collect(),
        skeleton: Some(index),
        skeletons: names,
        animations: described,
        animation,
    })
}

/// The first version of glTF, in which lists are objects, if the file has it.
pub fn former(source: &Source) -> Option<ForeignFormat> {
    let file = source.parse::<VersionedFile>(|_| {}).ok()?;
    file.is_version_1().then_some(ForeignFormat::GLTF_1)
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
    let reason = "must have at least one node with a mesh, or several named nodes";
    FieldError::new(JsonPath::root().key("nodes"), reason)
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

/// A figure of a file that is imported.
struct GltfImport<'a> {
    source: &'a Source,
    file: &'a GltfFile<'a>,
    nodes: &'a NodeTree,
    figure: &'a Figure,
    joints: &'a SkinJoints,
    /// The animation, with its number in the file.
    animation: Option<(usize, &'a FileAnimation)>,
}

impl GltfImport<'_> {
    fn read(&self, warnings: &mut FieldWarnings) -> Result<ImportedRig, FieldError> {
        let Self { source, file, figure, joints: skin_joints, .. } = *self;
        let at = at_animation(self.animation.map_or(0, |(chosen, _)| chosen));
        let animation = self.animation.and_then(|(chosen, _)| file.animations.0.get(chosen));
        let channels = self.channels(animation, &at)?;
        let weights = animation.map(|animation| morphs::weight_channels(animation, &at));
        let weights = weights.transpose()?.unwrap_or_default();
        let buffers = animations::buffers(source, file, &channels, &weights)?;
        let tracks = NodeTracks::new(file, &buffers, &channels, &at, warnings)?;
        let nodes = &tracks.at_rest(self.nodes, skin_joints);
        let mut poser = NodePoser::new(nodes, skin_joints);
        let bind_pose = poser.bind_pose()?;
        let joints = rig::joints(file, skin_joints, &bind_pose);
        let is_own = file.asset.0.is_of_this_program();
        let extras = animation.and_then(|it| it.extras.as_ref()).and_then(Extras::own);
        let own_rate = extras.filter(|_| is_own).and_then(|extras| extras.frame_rate());
        let weights = WeightTracks::new(file, &buffers, &weights, warnings)?;
        let times = tracks.times().chain(weights.times()).collect();
        let timeline = animations::timeline(times, own_rate, &at)?;
        let own = is_own.then_some(file);
        let exact = ExactTracks::new(nodes, skin_joints, &tracks, &bind_pose, timeline, own);
        let exact: Vec<_> = (0..joints.len()).map(|joint| exact.of(joint)).collect();
        let times = match exact.iter().all(ExactJoint::is_complete) {
            true => Vec::new(),
            false => sampled_times(&tracks, timeline, poser.len(), at)?,
        };
        let motions =
            joint_tracks::sample(&mut poser, &tracks, &times, &joints, exact, &bind_pose)?;
        let ends = BoneEnds::new(file, nodes, skin_joints, &bind_pose);
        let built = rig::build(joints, &motions, timeline, &ends);
        let mut built =
            built.map_err(|error| FieldError::new(at_skin(figure.first()), error.to_string()))?;
        let mesh =
            MeshImport { source, file, nodes, figure, joints: skin_joints, bind_pose: &bind_pose };
        match mesh.read(warnings) {
            Ok(Some(FigureMesh { mesh, checksum, owners, morph_weights })) => {
                let joints = built.kept.iter().map(|joint| joint.map(JointId::new)).collect();
                let file = source.path().map(|path| SkinFile {
                    path: path.into(),
                    checksum,
                    skeleton: figure.name.clone(),
                    animation: self
                        .animation
                        .filter(|_| nodes.locals != self.nodes.locals)
                        .map(|(_, animation)| animation.name.clone()),
                });
                attach_skin(&mut built.document, mesh, file, joints);
                for (morph, weight) in morph_weights.into_iter().enumerate() {
                    built.document.rig.set_morph_weight(morph, weight);
                }
                weights.add_to(&mut built.document, &owners, timeline);
            }
            Ok(None) => {}
            Err(error) => {
                let reason = format!("{}; the skin is left out", error.reason);
                warnings.push(error.field, reason);
            }
        }
        if file.extensions.looks_back() {
            let turned = Affine3A::from_mat3(Mat3::from_diagonal(Vec3::new(-1.0, 1.0, -1.0)));
            let error = |error: SkeletonError| {
                let at = JsonPath::root().key("extensions").key("VRM");
                FieldError::new(at, error.to_string())
            };
            built.document.skeleton_mut().set_transform(turned).map_err(error)?;
        }
        built.document.camera = built.document.framing_camera();
        Ok(built)
    }

    /// The channels of an animation that move joints, meshes and nodes above them.
    fn channels<'b>(
        &self,
        animation: Option<&'b GltfAnimation>,
        at: &JsonPath,
    ) -> Result<Vec<UsedChannel<'b>>, FieldError> {
        let Some(animation) = animation else { return Ok(Vec::new()) };
        let nodes = self.file.nodes.0.iter().enumerate();
        let with_meshes = nodes.filter(|(_, node)| node.mesh.is_some()).map(|(index, _)| index);
        let joints = self.joints.skin_nodes.iter().copied();
        let is_needed = self.nodes.with_ancestors(joints.chain(with_meshes));
        animations::used_channels(animation, at, self.nodes, &is_needed)
    }
}

/// The times at which joints below scales that are uneven or change have keys: all frames, and keys
/// that are no frames. `posed` is the number of nodes that are posed at each.
fn sampled_times(
    tracks: &NodeTracks<'_>,
    timeline: Option<Timeline>,
    posed: usize,
    at: JsonPath,
) -> Result<Vec<f64>, FieldError> {
    let frames = timeline.map_or(0, |timeline| timeline.frames());
    let mut times = tracks.distinct_times();
    let count = frames.saturating_add(times.len());
    if count.saturating_mul(posed) > MOST_SAMPLES {
        let most = MOST_SAMPLES / posed;
        let reason =
            format!("must have at most {most} frames and keys of {posed} nodes, got {count}");
        return Err(FieldError::new(at, reason));
    }
    if let Some(timeline) = timeline {
        times.iter_mut().for_each(|time| *time = sampler::on_frame(*time, timeline));
        times.extend((0..frames).map(|frame| timeline.time(frame)));
    }
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}
