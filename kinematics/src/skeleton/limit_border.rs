use core::f32::consts::PI;

use glam::{Mat3, Mat3A, Quat, Vec3};

use super::joint::Joint;
use super::joint_angles::nearest_angles;

/// The border of a joint's cone, found by [`JointLimits::contains`](super::JointLimits::contains)
/// alone.
impl Joint {
    /// The bone, in the space of the joint's base, with other Euler angles than the joint has.
    pub fn bone_at(&self, angles: Vec3) -> Vec3 {
        self.rotation_f64(angles).as_mat3() * self.axis
    }

    /// Euler angles with which the bone has swung by an angle in radians, with the twist in the
    /// middle of its range; `None` for a joint without a cone or a bone. The azimuth, in radians, is
    /// that of the swing's axis around the bone; it begins at the axis of the frame that is nearest
    /// to being across the bone.
    pub fn swung(&self, azimuth: f32, swing: f32) -> Option<Vec3> {
        let cone = self.limits.as_cone()?;
        let bone = (self.frame.transpose() * self.axis).try_normalize()?;
        let least =
            |one: &Vec3, other: &Vec3| one.dot(bone).abs().total_cmp(&other.dot(bone).abs());
        let start = Vec3::AXES.into_iter().min_by(least)?;
        let start = (start - bone * start.dot(bone)).try_normalize()?;
        let axis = Quat::from_axis_angle(bone, azimuth) * start;
        let twist = 0.5 * cone.twist.min + 0.5 * cone.twist.max;
        let turned = Mat3::from_axis_angle(axis, swing) * Mat3::from_axis_angle(bone, twist);
        Some(nearest_angles(Mat3A::from(turned), self.rotation))
    }

    /// The greatest swing towards an azimuth that the cone allows, in radians; `None` as for
    /// [`Joint::swung`].
    pub fn most_swing(&self, azimuth: f32) -> Option<f32> {
        const HALVINGS: u32 = 16;
        let is_within = |swing: f32| {
            let angles = self.swung(azimuth, swing);
            angles.map(|angles| self.limits.contains(angles))
        };
        let (mut within, mut beyond) = (0.0, PI);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (within + beyond);
            match is_within(middle)? {
                true => within = middle,
                false => beyond = middle,
            }
        }
        Some(within)
    }
}
