use glam::{DMat3, DQuat, DVec3, EulerRot, Mat3, Mat3A, Vec3};

use super::{Joint, angle_triples};

/// Euler angles within the limits of a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AnglesWithin {
    /// The angles, radians.
    pub angles: Vec3,
    /// Whether the limits changed the angles by more than rounding.
    pub is_limited: bool,
}

/// Rotations in f64.
impl Joint {
    /// The rotation A·R_z·R_y·R_x·Aᵀ for Euler angles in radians, in the space of the joint's base.
    pub(crate) fn rotation_f64(&self, angles: Vec3) -> DMat3 {
        // Exact, and most joints of a figure are in their bind pose.
        if angles == Vec3::ZERO {
            return DMat3::IDENTITY;
        }
        let DVec3 { x, y, z } = angles.as_dvec3();
        let rotation = DMat3::from_euler(EulerRot::ZYX, z, y, x);
        if self.frame == Mat3::IDENTITY {
            return rotation;
        }
        let frame = self.frame.as_dmat3();
        frame * rotation * frame.transpose()
    }

    /// Unit axes about which the angles x, y and z turn the joint, as columns, in the space of the
    /// joint's base.
    pub(crate) fn rotation_axes_f64(&self, angles: Vec3) -> DMat3 {
        let angles = angles.as_dvec3();
        let about_z = DMat3::from_rotation_z(angles.z);
        let about_zy = about_z * DMat3::from_rotation_y(angles.y);
        self.frame.as_dmat3() * DMat3::from_cols(about_zy.x_axis, about_z.y_axis, DVec3::Z)
    }

    /// The angles for a rotation in the space of the joint's base: of all equivalent angles those that
    /// the limits change least, then those nearest to the joint's own; clamped to the limits.
    pub(crate) fn angles_within(&self, rotation: DMat3) -> AnglesWithin {
        const ROUNDING: f32 = 1e-5;
        let rotation = Mat3A::from(rotation.as_mat3());
        let frame = Mat3A::from(self.frame);
        let all = angle_triples(frame.transpose() * rotation * frame, self.rotation);
        let [first, second] = all.map(|angles| {
            let within = self.limits.project(angles);
            let changed = (within - angles).abs().max_element();
            (AnglesWithin { angles: within, is_limited: changed > ROUNDING }, changed)
        });
        if second.1 + ROUNDING < first.1 { second.0 } else { first.0 }
    }

    /// The joint's angles turned towards other angles by a fraction of the shortest rotation between
    /// the two. A fraction of 1 gives `angles` bit for bit.
    pub(crate) fn angles_towards(&self, angles: Vec3, fraction: f32) -> Vec3 {
        if fraction >= 1.0 {
            return angles;
        }
        let [from, to] = [self.rotation, angles].map(|it| DQuat::from_mat3(&self.rotation_f64(it)));
        self.angles_within(DMat3::from_quat(from.slerp(to, f64::from(fraction)))).angles
    }
}
