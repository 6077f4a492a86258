use glam::Vec3;

use crate::kinematics::skeleton::Skeleton;
use crate::kinematics::skin::SkinnedMesh;

/// A skinned mesh with its thickness around each bone.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachedMesh {
    /// The mesh.
    pub mesh: SkinnedMesh,
    /// For each joint the mean distance from its bone of the vertices that follow it most, in skeleton
    /// units; 0 for a joint without vertices.
    pub radii: Vec<f32>,
}

impl AttachedMesh {
    /// Measures the thickness of a mesh around the bones of its skeleton.
    pub fn new(mesh: SkinnedMesh, skeleton: &Skeleton) -> Self {
        let mut sums = vec![(0.0_f32, 0_u32); skeleton.joints().len()];
        for (position, weights) in mesh.mesh().positions.iter().zip(mesh.weights()) {
            let joint = weights.first();
            if let (Some(bone), Some(bind)) =
                (skeleton.joint(joint), mesh.inverse_binds().get(joint.index()))
            {
                let (sum, count) = &mut sums[joint.index()];
                *sum += distance_from_bone(bind.transform_point3(*position), bone.axis);
                *count += 1;
            }
        }
        let mean = |(sum, count): (f32, u32)| if count > 0 { sum / count as f32 } else { 0.0 };
        Self { mesh, radii: sums.into_iter().map(mean).collect() }
    }
}

/// Distance of a point in joint space from the bone along `axis`.
fn distance_from_bone(point: Vec3, axis: Vec3) -> f32 {
    let along = point.dot(axis) / axis.length_squared();
    let along = if along.is_finite() { along.clamp(0.0, 1.0) } else { 0.0 };
    point.distance(axis * along)
}
