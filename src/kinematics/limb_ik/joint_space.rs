use glam::{DMat3, DVec3, Vec3};

use crate::kinematics::skeleton::{Joint, JointId, Skeleton};

/// The space of a joint: its rotation and origin in another space, in f64.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointSpace {
    pub rotation: DMat3,
    pub origin: DVec3,
}

impl JointSpace {
    pub const IDENTITY: Self = Self { rotation: DMat3::IDENTITY, origin: DVec3::ZERO };

    /// A joint's own space in skeleton space; that of no joint is skeleton space.
    pub fn of(skeleton: &Skeleton, joint: Option<JointId>) -> Self {
        match joint.and_then(|joint| skeleton.joint(joint)) {
            Some(joint) => Self::of(skeleton, joint.parent).of_child(joint),
            None => Self::IDENTITY,
        }
    }

    /// The own space of a child of this space's joint.
    pub fn of_child(self, child: &Joint) -> Self {
        let base = self.at_base_of(child);
        Self { rotation: base.rotation * rotation(child, child.rotation), ..base }
    }

    /// The space of a child before its rotation.
    pub fn at_base_of(self, child: &Joint) -> Self {
        Self { origin: self.point(child.offset), ..self }
    }

    /// The position of a point of this space.
    pub fn point(self, point: Vec3) -> DVec3 {
        self.origin + self.rotation * point.as_dvec3()
    }
}

/// The rotation A·R_z·R_y·R_x·Aᵀ of a joint for Euler angles in radians.
pub(super) fn rotation(joint: &Joint, angles: Vec3) -> DMat3 {
    let angles = angles.as_dvec3();
    let frame = joint.frame.as_dmat3();
    let rotation = DMat3::from_rotation_z(angles.z)
        * DMat3::from_rotation_y(angles.y)
        * DMat3::from_rotation_x(angles.x);
    frame * rotation * frame.transpose()
}

/// The axes about which the angles x, y and z of a joint turn it, as columns, in the space of its
/// base.
pub(super) fn axes(joint: &Joint, angles: Vec3) -> DMat3 {
    let angles = angles.as_dvec3();
    let about_z = DMat3::from_rotation_z(angles.z);
    let about_zy = about_z * DMat3::from_rotation_y(angles.y);
    joint.frame.as_dmat3() * DMat3::from_cols(about_zy.x_axis, about_z.y_axis, DVec3::Z)
}
