use std::rc::Rc;

use ::gltf::json::animation::Interpolation as Curve;
use glam::{DQuat, DVec3};

use super::nodes::RigidTransform;

/// The values of one node over time.
pub struct JointTrack<const N: usize> {
    pub node: usize,
    /// Times of the keys in the file, in seconds.
    pub times: Rc<Vec<f32>>,
    pub curve: Curve,
    /// One value for each key; for cubic splines the arriving slope, the value and the leaving slope.
    pub values: Vec<[f32; N]>,
}

/// Changes below this count as rounding errors: in radians for a rotation, relative to the distance
/// from the parent for a translation.
const LEAST: f64 = 1e-6;

impl JointTrack<4> {
    /// Whether the rotation ever leaves the bind pose.
    pub fn turns(&self, bind_pose: &RigidTransform) -> bool {
        self.values.iter().any(|value| {
            let rotation = DQuat::from_array(value.map(f64::from));
            let difference = same_side(bind_pose.rotation, rotation) - bind_pose.rotation;
            2.0 * difference.length() > LEAST
        })
    }
}

impl JointTrack<3> {
    /// Whether the node ever leaves the bind pose.
    pub fn moves(&self, bind_pose: &RigidTransform) -> bool {
        if self.curve == Curve::CubicSpline {
            return true;
        }
        self.values.iter().any(|value| {
            let translation = DVec3::from_array(value.map(f64::from));
            let size = translation.length().max(bind_pose.translation.length());
            translation.distance(bind_pose.translation) > LEAST * size
        })
    }
}

/// Returns `rotation` or its negative, which is the same rotation, whichever is nearer to
/// `previous`.
pub fn same_side(previous: DQuat, rotation: DQuat) -> DQuat {
    if previous.dot(rotation) < 0.0 { -rotation } else { rotation }
}
