use std::collections::{HashMap, HashSet};

use glam::{DAffine3, DQuat, DVec3, DVec4};

use super::file::{Js3dScene, Js3dTransform};
use crate::io::json::JsonPath;
use crate::io::json::{FieldError, FieldWarnings};
use crate::io::json::{JsonNumbers, JsonPoint};

/// World transform of the first instance of a mesh; the identity if the mesh has no instance.
pub fn of_mesh(
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
