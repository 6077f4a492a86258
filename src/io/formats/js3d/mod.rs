//! Skeletons of Scotty3D scenes, `.js3d`.
//!
//! ```text
//! scene.skinned_meshes.NAME.skeleton
//!     base, base_offset      their sum is the base of bones without a parent
//!     bones[]                extent, roll (degrees), radius, parent, pose (x, y, z in degrees)
//!     handles[]              bone, target (in the skeleton's own space), enabled
//! scene.skinned_meshes.NAME.mesh       a half-edge mesh, the skin of that skeleton
//! scene.instances.skinned_meshes.*   mesh (a NAME), transform (a name in scene.transforms)
//! scene.transforms.*                 parent, translation, rotation [x, y, z, w], scale
//! ```
//!
//! Bones are numbered from 0 in the file's order. A parent may come after its children; the number
//! 4294967295 stands for no parent. The angles of a bone are measured in the frame
//! [`Js3dBone::frame`](file::Js3dBone::frame). The skeleton has the transform of the first instance
//! of its mesh. The splines of the skeleton become keys, see [`animator`]. Everything else in the
//! scene is not read, with a warning.

mod bones;
mod file;
mod mesh;

use std::collections::HashMap;

use bones::SkeletonWithOrder;
use file::{Js3dAnimator, Js3dFile, Js3dHandle, Js3dScene, Js3dSkeleton};
use glam::{DAffine3, Vec3};
use serde_json::Value;

use crate::document::{Channel, Document, SkeletonRig, Target, Timeline};
use crate::io::error::OpenError;
use crate::io::json::{FieldError, FieldWarnings, JsonObject, JsonPath, Whole};
use crate::io::opened::{OpenOptions, Opened, attach_skin};
use crate::io::source::Source;
use crate::kinematics::skeleton::JointId;
use crate::rig::SkinFile;

/// The key of a scene, by which a file is recognized.
pub const KEY: &str = "scene";

/// Reads the skeleton that the options choose, or else the first one.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let name = options.skeleton.as_deref();
    let JsonObject(file) = source.parse::<JsonObject<Js3dFile>>(|_| {})?;
    let JsonObject(scene) = &file.scene;
    let names: Vec<String> = scene.skeletons().map(|(name, _)| name.to_owned()).collect();
    let mut skeletons = scene.skeletons();
    let chosen = match name {
        Some(name) => skeletons.find(|(other, _)| *other == name),
        None => skeletons.next(),
    };
    let Some((chosen, skeleton)) = chosen else {
        return Err(match name.filter(|_| !names.is_empty()) {
            Some(name) => OpenError::NoSkeleton {
                file: source.name().to_owned(),
                name: name.to_owned(),
                names,
            },
            None => source.error(&no_skeleton()),
        });
    };
    let mut warnings = FieldWarnings::default();
    let Js3dRig { rig, order, handles, transform } =
        rig(scene, chosen, skeleton, &mut warnings).map_err(|error| source.error(&error))?;
    let mut document = Document::new(rig);
    if let Some(JsonObject(animator)) = &file.animator {
        let animated = AnimatedSkeleton::new(chosen, skeleton, &order, &handles, transform);
        add_keys(&mut document, animator, &animated, &mut warnings);
    }
    warn_of_unread(scene, &mut warnings);
    add_skin(&mut document, source, scene, chosen, &order, &mut warnings);
    document.camera = document.framing_camera();
    Ok(Opened {
        document,
        warnings: source.warnings(&warnings),
        order,
        skeleton: names.iter().position(|name| name == chosen),
        skeletons: names,
        animations: Vec::new(),
        animation: None,
    })
}

/// Gives the skeleton the mesh called `name`. A mesh that cannot be read is left out, with a
/// warning.
fn add_skin(
    document: &mut Document,
    source: &Source,
    scene: &Js3dScene,
    name: &str,
    order: &[JointId],
    warnings: &mut FieldWarnings,
) {
    let mut meshes = scene.skinned_meshes.0.iter().filter(|(other, _)| other == name);
    let Some((_, skinned)) = meshes.next() else { return };
    let Some(mesh) = skinned.mesh() else { return };
    let at = JsonPath::root().key("scene").key("skinned_meshes").key(name).key("mesh");
    match mesh::read(mesh, document.skeleton(), order, &at, warnings) {
        Ok(mesh) => {
            let checksum = source.checksum().finalize();
            let skeleton = name.to_owned();
            let path = source.path();
            let file = path.map(|path| SkinFile {
                path: path.into(),
                checksum,
                skeleton,
                animation: None,
            });
            let joints = document.skeleton().ids().map(Some).collect();
            attach_skin(document, mesh, file, joints);
        }
        Err(error) => {
            let reason = format!("{}; the skin is left out", error.reason);
            warnings.push(error.field, reason);
        }
    }
}

/// Warns of everything else in the scene, which is not read.
fn warn_of_unread(scene: &Js3dScene, warnings: &mut FieldWarnings) {
    let count = |count: usize, one: &str| match (count, one) {
        (1, _) => format!("1 {one}"),
        (_, "mesh") => format!("{count} meshes"),
        _ => format!("{count} {one}s"),
    };
    let unread: Vec<_> = scene.unread().map(|(one, many)| count(many, one)).collect();
    if !unread.is_empty() {
        warnings.push(JsonPath::root().key("scene"), format!("not read: {}", unread.join(", ")));
    }
}

fn no_skeleton() -> FieldError {
    let field = JsonPath::root().key("scene").key("skinned_meshes");
    FieldError::new(field, "must have a mesh with a `skeleton`")
}

/// A skeleton with its targets.
struct Js3dRig {
    rig: SkeletonRig,
    /// For each bone of the file its joint.
    order: Vec<JointId>,
    /// The handle of each target.
    handles: Vec<usize>,
    /// From the skeleton's own space to the world.
    transform: DAffine3,
}

fn rig(
    scene: &Js3dScene,
    name: &str,
    file: &Js3dSkeleton,
    warnings: &mut FieldWarnings,
) -> Result<Js3dRig, FieldError> {
    let at = JsonPath::root().key("scene").key("skinned_meshes").key(name).key("skeleton");
    let transform = bones::world_of_mesh(scene, name, warnings)?;
    let SkeletonWithOrder { mut skeleton, order } = bones::read(&at, file)?;
    skeleton.set_transform(transform.as_affine3a()).map_err(|error| {
        FieldError::new(JsonPath::root().key("scene").key("transforms"), error.to_string())
    })?;
    let mut rig = SkeletonRig::new(skeleton);
    let targets = targets(&at, file, transform, &order, rig.default_path_radius(), warnings)?;
    let handles = targets.iter().map(|(handle, _)| *handle).collect();
    rig.targets = targets.into_iter().map(|(_, target)| target).collect();
    Ok(Js3dRig { rig, order, handles, transform })
}

/// Converts handles to targets, each with the index of its handle. Of several handles on the same
/// bone, the first enabled handle is used, or the first handle if none is enabled; the others are
/// ignored, with a warning each.
fn targets(
    at: &JsonPath,
    file: &Js3dSkeleton,
    transform: DAffine3,
    order: &[JointId],
    path_radius: f32,
    warnings: &mut FieldWarnings,
) -> Result<Vec<(usize, Target)>, FieldError> {
    let at_handle = |handle| at.clone().key("handles").index(handle);
    // `targets` has each target with the index of its handle. `target_of` has, for each joint, the
    // index of its target in `targets`.
    let mut targets: Vec<(usize, Target)> = Vec::new();
    let mut target_of = vec![None; order.len()];
    for (handle, JsonObject(file)) in file.handles.iter().flatten().enumerate() {
        let target = target(&at_handle(handle), file, transform, order, path_radius)?;
        let Some(index) = target_of[target.joint.index()] else {
            target_of[target.joint.index()] = Some(targets.len());
            targets.push((handle, target));
            continue;
        };
        let (mut used, mut ignored) = (targets[index], (handle, target));
        if target.enabled && !used.1.enabled {
            std::mem::swap(&mut used, &mut ignored);
        }
        let reason = format!("ignored; handle {} of the same bone is used", used.0);
        warnings.push(at_handle(ignored.0), reason);
        targets[index] = used;
    }
    Ok(targets)
}

fn target(
    at: &JsonPath,
    handle: &Js3dHandle,
    transform: DAffine3,
    order: &[JointId],
    path_radius: f32,
) -> Result<Target, FieldError> {
    let bone = handle.bone.0 as usize;
    let joint = order.get(bone).copied().ok_or_else(|| {
        let reason = bones::index_rule(order.len(), bone);
        FieldError::new(at.clone().key("bone"), reason)
    })?;
    let home = transform.transform_point3(handle.target.0.as_dvec3()).as_vec3();
    if !home.is_finite() {
        let reason = "must be within ±3.4028235e38 in the world";
        return Err(FieldError::new(at.clone().key("target"), reason));
    }
    let enabled = handle.enabled.unwrap_or(true);
    Ok(Target { enabled, ..Target::new(joint, home, path_radius) })
}

/// Frames per second of a scene without a rate.
const FRAME_RATE: f64 = 30.0;

/// The skeleton of a file that became that of a document.
pub struct AnimatedSkeleton<'a> {
    name: &'a str,
    base: Vec3,
    /// From the skeleton's own space to the world.
    transform: DAffine3,
    /// The joints of bones by their channel IDs.
    bones: HashMap<u32, JointId>,
    /// The joints of those handles that became targets, by their channel IDs.
    targets: HashMap<u32, JointId>,
}

impl<'a> AnimatedSkeleton<'a> {
    /// `order` has the joint of each bone, `handles` the index of the handle of each target.
    pub fn new(
        name: &'a str,
        file: &Js3dSkeleton,
        order: &[JointId],
        handles: &[usize],
        transform: DAffine3,
    ) -> Self {
        let id = |own: Option<Whole>, index: usize| own.map_or(index as u32, |own| own.0);
        let bones = file.bones.iter().zip(order).enumerate();
        let bones =
            bones.map(|(index, (JsonObject(bone), joint))| (id(bone.channel_id, index), *joint));
        let all = file.handles.as_deref().unwrap_or_default();
        let target = |index: &usize| {
            let JsonObject(handle) = all.get(*index)?;
            Some((id(handle.channel_id, *index), *order.get(handle.bone.0 as usize)?))
        };
        let (bones, targets) = (bones.collect(), handles.iter().filter_map(target).collect());
        Self { name, base: file.base.0, transform, bones, targets }
    }
}

/// Gives the document the keys of the skeleton's channels, and a timeline to their last one. Counts
/// what is left out in a warning.
pub fn add_keys(
    document: &mut Document,
    animator: &Js3dAnimator,
    skeleton: &AnimatedSkeleton<'_>,
    warnings: &mut FieldWarnings,
) {
    let rate = animator.frame_rate.as_f64().filter(|rate| Timeline::is_frame_rate(*rate));
    let frame_rate = rate.unwrap_or(FRAME_RATE);
    let mut others = 0;
    let mut end = 0.0_f64;
    for (resource, channels) in animator.splines.as_object().into_iter().flatten() {
        let channels = channels.as_object().into_iter().flatten();
        if resource != skeleton.name {
            others += channels.count();
            continue;
        }
        for (name, spline) in channels {
            let Some(channel) = skeleton.channel(name) else {
                others += 1;
                continue;
            };
            let at = at_splines().key(resource).key(name).key("knots");
            let Some(knots) = spline.get("knots").and_then(Value::as_array) else {
                warnings.push(at, "must be a list of times and values; the channel is left out");
                continue;
            };
            for (index, knot) in knots.chunks(2).enumerate() {
                let time = knot[0].as_f64().map(|frame| frame / frame_rate);
                let time = time.filter(|time| time.abs() <= Timeline::MAX_TIME);
                let value = knot.get(1).and_then(|value| channel.value(value, skeleton));
                let (Some(time), Some(value)) = (time, value) else {
                    let reason = "must be a time in frames and a value; left out";
                    warnings.push(at.clone().index(2 * index), reason);
                    continue;
                };
                channel.add_key(document, time, value);
                end = end.max(time);
            }
        }
    }
    if !document.keys.is_empty() {
        let start = document.keys.times().first().map_or(0.0, |time| time.min(0.0));
        let timeline = Timeline { start, end, frame_rate };
        let timeline = if timeline.is_valid() {
            timeline
        } else {
            Timeline { frame_rate, ..Timeline::default() }
        };
        document.timeline = timeline;
    }
    if others > 0 {
        let channels = if others == 1 {
            "1 animated channel".to_owned()
        } else {
            format!("{others} animated channels")
        };
        warnings.push(at_splines(), format!("not read: {channels}"));
    }
}

fn at_splines() -> JsonPath {
    JsonPath::root().key("animator").key("splines")
}

/// A channel of the file.
#[derive(Clone, Copy)]
enum Js3dChannel {
    BaseOffset,
    Pose(JointId),
    Target(JointId),
    Enabled(JointId),
}

impl AnimatedSkeleton<'_> {
    /// The channel of this name; `None` if the skeleton does not have it.
    fn channel(&self, name: &str) -> Option<Js3dChannel> {
        if name == "base_offset" {
            return Some(Js3dChannel::BaseOffset);
        }
        let mut parts = name.split('.');
        let (kind, id, what) = (parts.next()?, parts.next()?.parse().ok()?, parts.next()?);
        let (joint, target) = (self.bones.get(&id).copied(), self.targets.get(&id).copied());
        match (kind, what, parts.next()) {
            ("bone", "pose", None) => Some(Js3dChannel::Pose(joint?)),
            ("handle", "target", None) => Some(Js3dChannel::Target(target?)),
            ("handle", "enabled", None) => Some(Js3dChannel::Enabled(target?)),
            _ => None,
        }
    }
}

impl Js3dChannel {
    /// A value of the file as that of the document's channel.
    fn value(self, value: &Value, skeleton: &AnimatedSkeleton<'_>) -> Option<Vec3> {
        let value = match self {
            Self::Enabled(_) => Vec3::new(f32::from(u8::from(value.as_bool()?)), 0.0, 0.0),
            Self::BaseOffset => skeleton.base + point(value)?,
            Self::Pose(_) => (point(value)?.as_dvec3() * core::f64::consts::PI / 180.0).as_vec3(),
            Self::Target(_) => {
                skeleton.transform.transform_point3(point(value)?.as_dvec3()).as_vec3()
            }
        };
        value.is_finite().then_some(value)
    }

    fn add_key(self, document: &mut Document, time: f64, value: Vec3) {
        match self {
            Self::BaseOffset => {
                let roots = document.skeleton().iter().filter(|(_, joint)| joint.parent.is_none());
                let roots: Vec<JointId> = roots.map(|(joint, _)| joint).collect();
                for root in roots {
                    document.keys.insert(Channel::Offset(root), time, value);
                }
            }
            Self::Pose(joint) => document.keys.insert(Channel::Rotation(joint), time, value),
            Self::Target(joint) => document.keys.insert(Channel::Target(joint), time, value),
            Self::Enabled(joint) => document.keys.insert(Channel::Enabled(joint), time, value),
        }
    }
}

/// A point from a list of three numbers.
fn point(value: &Value) -> Option<Vec3> {
    let [x, y, z] = value.as_array()?.as_slice() else { return None };
    let number = |value: &Value| value.as_f64().map(|number| number as f32);
    Some(Vec3::new(number(x)?, number(y)?, number(z)?))
}
