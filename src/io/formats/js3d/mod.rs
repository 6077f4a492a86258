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

mod animator;
mod bones;
mod file;
mod mesh;

use glam::DAffine3;

use crate::document::{Document, RigKind, SkeletonRig, Target};
use crate::io::error::OpenError;
use crate::io::json::JsonObject;
use crate::io::json::JsonPath;
use crate::io::json::{FieldError, FieldWarnings};
use crate::io::opened::attach_skin;
use crate::io::opened::{OpenOptions, Opened};
use crate::io::source::Source;
use crate::kinematics::skeleton::JointId;
use crate::rig::SkinFile;
use animator::AnimatedSkeleton;
use bones::SkeletonWithOrder;
use file::{Js3dFile, Js3dHandle, Js3dScene, Js3dSkeleton};

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
    let ImportedRig { rig, order, handles, transform } =
        rig(scene, chosen, skeleton, &mut warnings).map_err(|error| source.error(&error))?;
    let mut document =
        Document { rig: RigKind::Skeleton, skeleton_rig: rig, ..Document::default() };
    if let Some(JsonObject(animator)) = &file.animator {
        let animated = AnimatedSkeleton::new(chosen, skeleton, &order, &handles, transform);
        animator::add_keys(&mut document, animator, &animated, &mut warnings);
    }
    warn_of_unread(scene, &mut warnings);
    add_skin(&mut document, source, scene, chosen, &order, &mut warnings);
    document.camera = document.framing_camera();
    Ok(Opened {
        document,
        warnings: source.warnings(&warnings),
        order,
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
            let file = source.path().map(|path| SkinFile { path: path.into(), checksum, skeleton });
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
struct ImportedRig {
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
) -> Result<ImportedRig, FieldError> {
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
    Ok(ImportedRig { rig, order, handles, transform })
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
