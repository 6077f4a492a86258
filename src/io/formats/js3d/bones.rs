//! The bones of a skeleton, and the transform of its mesh.

use std::collections::{HashMap, HashSet};

use glam::{DAffine3, DMat3, DQuat, DVec3, DVec4, Vec3};

use super::file::{Js3dBone, Js3dScene, Js3dSkeleton, Js3dTransform};
use crate::io::json::{
    FieldError, FieldWarnings, JsonNumber, JsonNumbers, JsonObject, JsonPath, JsonPoint,
};
use crate::kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonError};

/// A skeleton, and for every bone in the file's order its joint in the skeleton.
pub struct SkeletonWithOrder {
    pub skeleton: Skeleton,
    pub order: Vec<JointId>,
}

pub fn read(at: &JsonPath, file: &Js3dSkeleton) -> Result<SkeletonWithOrder, FieldError> {
    let at_bone = |bone| at.clone().key("bones").index(bone);
    if file.bones.len() > Skeleton::MOST_JOINTS {
        return Err(FieldError::new(at.clone().key("bones"), SkeletonError::TooMany.to_string()));
    }
    let parents: Vec<_> = file.bones.iter().map(|JsonObject(bone)| bone.parent()).collect();
    let bones = parents_first(&parents)
        .map_err(|(bone, reason)| FieldError::new(at_bone(bone).key("parent"), reason))?;
    let mut order = vec![JointId::default(); bones.len()];
    for (joint, bone) in bones.iter().enumerate() {
        order[*bone] = joint.into();
    }
    let root = file.base.0 + file.base_offset.0;
    if !root.is_finite() {
        let reason = "base + base_offset must be within ±3.4028235e38";
        return Err(FieldError::new(at.clone().key("base_offset"), reason));
    }
    let joints = bones.iter().map(|&index| joint(file, index, root, &order)).collect();
    let skeleton = Skeleton::from_joints(joints).map_err(|error| match &error {
        SkeletonError::Radius { joint, value } => {
            let reason = format!("must be 0 or more, got {value}");
            FieldError::new(at_bone(bones[joint.index()]).key("radius"), reason)
        }
        _ => FieldError::new(at.clone(), error.to_string()),
    })?;
    Ok(SkeletonWithOrder { skeleton, order })
}

/// Sorts the bones so that parents come before their children, otherwise in the file's order.
/// Returns their indices. The error is the index of a bone whose parent is invalid, and the reason.
fn parents_first(parents: &[Option<usize>]) -> Result<Vec<usize>, (usize, String)> {
    let mut sorted = Vec::with_capacity(parents.len());
    let mut is_placed = vec![false; parents.len()];
    let mut path_of = vec![None; parents.len()];
    for start in 0..parents.len() {
        let mut path = Vec::new();
        let mut next = Some(start).filter(|bone| !is_placed[*bone]);
        while let Some(bone) = next {
            path_of[bone] = Some(start);
            path.push(bone);
            next = parents[bone];
            match next {
                Some(parent) if parent >= parents.len() => {
                    return Err((bone, index_rule(parents.len(), parent)));
                }
                Some(parent) if path_of[parent] == Some(start) => {
                    let reason = format!("must not be a descendant of bone {bone}, got {parent}");
                    return Err((bone, reason));
                }
                Some(parent) if is_placed[parent] => next = None,
                _ => {}
            }
        }
        for bone in path.into_iter().rev() {
            is_placed[bone] = true;
            sorted.push(bone);
        }
    }
    Ok(sorted)
}

/// Returns the error message for the index of a bone that is not below `bones`, the number of
/// bones.
pub fn index_rule(bones: usize, index: usize) -> String {
    match bones {
        0 => format!("must be a bone, but there are none, got {index}"),
        1 => format!("must be 0, the only bone, got {index}"),
        _ => format!("must be a bone from 0 to {}, got {index}", bones - 1),
    }
}

fn joint(file: &Js3dSkeleton, index: usize, root: Vec3, order: &[JointId]) -> Joint {
    let JsonObject(bone) = &file.bones[index];
    let JsonPoint(axis) = bone.extent;
    let parent = bone.parent();
    let default = Joint::new(&format!("bone_{index}"), parent.map(|parent| order[parent]), axis);
    Joint {
        offset: parent.map_or(root, |parent| file.bones[parent].0.extent.0),
        rotation: radians(bone.pose.0.as_dvec3()).as_vec3(),
        frame: bone.frame().as_mat3(),
        radius: bone.radius.map_or(default.radius.min(f32::MAX), |JsonNumber(radius)| radius),
        ..default
    }
}

fn radians(degrees: DVec3) -> DVec3 {
    DVec3::from_array(degrees.to_array().map(f64::to_radians))
}

impl Js3dBone {
    /// The frame in which the bone's angles are measured. y is along the bone, and x is as near as
    /// possible to the skeleton's x axis; the frame is then turned about y by the bone's roll.
    ///
    /// Computed in f64, so that squares of f32 numbers neither overflow nor underflow.
    pub fn frame(&self) -> DMat3 {
        let y = self.extent.0.as_dvec3().try_normalize().unwrap_or(DVec3::Y);
        // (1, 0, 0) − y_x·y, without cancellation.
        let perpendicular = DVec3::new(y.y * y.y + y.z * y.z, -y.x * y.y, -y.x * y.z);
        let unrolled = perpendicular.try_normalize().unwrap_or(DVec3::Z);
        let (sin, cos) = f64::from(self.roll.0).to_radians().sin_cos();
        let x = unrolled * cos - unrolled.cross(y) * sin;
        DMat3::from_cols(x, y, x.cross(y))
    }
}

/// World transform of the first instance of a mesh; the identity if the mesh has no instance.
pub fn world_of_mesh(
    scene: &Js3dScene,
    mesh: &str,
    warnings: &mut FieldWarnings,
) -> Result<DAffine3, FieldError> {
    let instances = &scene.instances.0.skinned_meshes.0;
    let at = JsonPath::root().key("scene").key("instances").key("skinned_meshes");
    let mut of_mesh =
        instances.iter().filter(|(_, instance)| instance.mesh.as_deref() == Some(mesh));
    let Some((name, instance)) = of_mesh.next() else {
        return Ok(DAffine3::IDENTITY);
    };
    for (other, _) in of_mesh {
        let reason = format!("ignored; instance {name:?} of the same mesh is used");
        warnings.push(at.clone().key(other), reason);
    }
    match &instance.transform {
        Some(transform) => world(scene, transform, at.key(name).key("transform")),
        None => Ok(DAffine3::IDENTITY),
    }
}

/// World transform of the transform called `name`: the product of all its ancestors and itself.
/// `field` is the path of the field that contains the name.
fn world(scene: &Js3dScene, name: &str, field: JsonPath) -> Result<DAffine3, FieldError> {
    let mut product = DAffine3::IDENTITY;
    let (mut next, mut field) = (Some(name), field);
    let transforms: HashMap<_, _> =
        scene.transforms.0.iter().map(|(name, transform)| (name.as_str(), transform)).collect();
    let mut seen = HashSet::new();
    while let Some(name) = next {
        if !seen.insert(name) {
            return Err(FieldError::new(
                field,
                format!("transform must not be its own ancestor, got {name:?}"),
            ));
        }
        let Some(transform) = transforms.get(name) else {
            return Err(FieldError::new(
                field,
                format!("must be the name of a transform, got {name:?}"),
            ));
        };
        let at = JsonPath::root().key("scene").key("transforms").key(name);
        product = local(&at, transform)? * product;
        if !product.as_affine3a().is_finite() {
            return Err(FieldError::new(at, "must be within ±3.4028235e38 in the world"));
        }
        field = at.key("parent");
        next = transform.parent.as_deref();
    }
    Ok(product)
}

fn local(at: &JsonPath, transform: &Js3dTransform) -> Result<DAffine3, FieldError> {
    let Js3dTransform { translation, rotation, scale, .. } = transform;
    let or = |point: &Option<JsonPoint>, default: DVec3| {
        point.map_or(default, |JsonPoint(p)| p.as_dvec3())
    };
    let rotation = match rotation {
        Some(JsonNumbers(rotation)) => {
            let unit = DVec4::from_array(rotation.map(f64::from)).try_normalize();
            unit.map(DQuat::from_vec4).ok_or_else(|| {
                let reason = "must not be four zeros; the identity is [0, 0, 0, 1]";
                FieldError::new(at.clone().key("rotation"), reason)
            })?
        }
        None => DQuat::IDENTITY,
    };
    let (translation, scale) = (or(translation, DVec3::ZERO), or(scale, DVec3::ONE));
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
}
