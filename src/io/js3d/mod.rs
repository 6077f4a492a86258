//! Skeletons of Scotty3D scenes, `.js3d`.
//!
//! ```text
//! scene.skinned_meshes.NAME.skeleton
//!     base, base_offset      their sum is the base of bones without a parent
//!     bones[]                extent, roll (degrees), radius, parent, pose (x, y, z in degrees)
//!     handles[]              bone, target (in the skeleton's own space), enabled
//! scene.instances.skinned_meshes.*   mesh (a NAME), transform (the name of one)
//! scene.transforms.*                 parent, translation, rotation [x, y, z, w], scale
//! ```
//!
//! SkeletonWithOrder count from 0 in the file's order, and a parent may come after its children; 4294967295 is
//! none. The angles of a bone are measured in the frame [`Js3dBone::frame`](file::Js3dBone::frame). The
//! skeleton has the transform of the first instance of its mesh.

mod bones;
mod file;
mod transform;

use glam::DAffine3;

use super::error::OpenError;
use super::field_error::{FieldError, FieldWarnings};
use super::json_path::JsonPath;
use super::opened::Opened;
use super::source::Source;
use super::value::JsonObject;
use crate::document::{Document, RigKind, SkeletonRig, Target};
use crate::kinematics::skeleton::JointId;
use bones::SkeletonWithOrder;
use file::{Js3dFile, Js3dHandle, Js3dScene, Js3dSkeleton};

/// Reads the skeleton called `name`, or the first one.
pub fn read(source: &Source, name: Option<&str>) -> Result<Opened, OpenError> {
    let JsonObject(Js3dFile { scene: JsonObject(scene) }) =
        source.parse::<JsonObject<Js3dFile>>(|_| {})?;
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
    let mut odd = FieldWarnings::default();
    let (rig, order) = rig(&scene, chosen, skeleton, &mut odd).map_err(|w| source.error(&w))?;
    let camera = rig.default_camera();
    Ok(Opened {
        document: Document {
            rig: RigKind::Skeleton,
            skeleton_rig: rig,
            camera,
            ..Document::default()
        },
        warnings: source.warnings(&odd),
        order,
        skeletons: names,
    })
}

fn no_skeleton() -> FieldError {
    let field = JsonPath::root().key("scene").key("skinned_meshes");
    FieldError::new(field, "must have a mesh with a `skeleton`")
}

fn rig(
    scene: &Js3dScene,
    name: &str,
    file: &Js3dSkeleton,
    odd: &mut FieldWarnings,
) -> Result<(SkeletonRig, Vec<JointId>), FieldError> {
    let at = JsonPath::root().key("scene").key("skinned_meshes").key(name).key("skeleton");
    let place = transform::of_mesh(scene, name, odd)?;
    let SkeletonWithOrder { mut skeleton, order } = bones::read(&at, file)?;
    skeleton.set_transform(place.as_affine3a()).map_err(|error| {
        FieldError::new(JsonPath::root().key("scene").key("transforms"), error.to_string())
    })?;
    let mut rig = SkeletonRig::new(skeleton);
    rig.targets = targets(&at, file, place, &order, rig.default_path_radius(), odd)?;
    Ok((rig, order))
}

/// Targets of the handles. Of several on a bone, the first enabled one is used, or the first.
fn targets(
    at: &JsonPath,
    file: &Js3dSkeleton,
    place: DAffine3,
    order: &[JointId],
    circle: f32,
    odd: &mut FieldWarnings,
) -> Result<Vec<Target>, FieldError> {
    let at_handle = |handle| at.clone().key("handles").index(handle);
    // Targets with their handles, and the index of each joint's own.
    let mut targets: Vec<(usize, Target)> = Vec::new();
    let mut own = vec![None; order.len()];
    for (handle, JsonObject(file)) in file.handles.iter().flatten().enumerate() {
        let target = target(&at_handle(handle), file, place, order, circle)?;
        let Some(own) = own[target.joint.index()] else {
            own[target.joint.index()] = Some(targets.len());
            targets.push((handle, target));
            continue;
        };
        let (mut counts, mut ignored) = (targets[own], (handle, target));
        if target.enabled && !counts.1.enabled {
            std::mem::swap(&mut counts, &mut ignored);
        }
        let reason = format!("ignored; handle {} of the same bone is used", counts.0);
        odd.push(at_handle(ignored.0), reason);
        targets[own] = counts;
    }
    Ok(targets.into_iter().map(|(_, target)| target).collect())
}

fn target(
    at: &JsonPath,
    handle: &Js3dHandle,
    place: DAffine3,
    order: &[JointId],
    circle: f32,
) -> Result<Target, FieldError> {
    let bone = handle.bone.0 as usize;
    let joint = order.get(bone).copied().ok_or_else(|| {
        let reason = format!("there is no bone {bone}; {}", bones::counted(order.len()));
        FieldError::new(at.clone().key("bone"), reason)
    })?;
    let home = place.transform_point3(handle.target.0.as_dvec3()).as_vec3();
    if !home.is_finite() {
        let reason = "is beyond 3.4028235e38 in the world; bring it nearer to 0";
        return Err(FieldError::new(at.clone().key("target"), reason));
    }
    let enabled = handle.enabled.unwrap_or(true);
    Ok(Target { enabled, ..Target::new(joint, home, circle) })
}
