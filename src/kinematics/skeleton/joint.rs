use glam::{Affine3A, Mat3, Mat3A, Vec3};

use super::{EulerAngles, JointId, SkeletonError, nearest_angles};

/// A ball joint and its bone.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// No two joints of a skeleton have the same.
    pub name: String,
    /// What it hangs from: a joint before it in the list.
    pub parent: Option<JointId>,
    /// From the parent's base to this one's, in the parent's space; usually the parent's axis, so
    /// that the joint sits on its tip. Of a root: from the skeleton's origin.
    pub offset: Vec3,
    /// The bone: from base to tip, in the joint's own space. Zero for a point.
    pub axis: Vec3,
    /// Euler angles about the frame's x, y and z, radians; unbounded. x is applied first.
    pub rotation: Vec3,
    /// A, in which the angles are measured: columns are unit vectors at right angles, right-handed.
    pub frame: Mat3,
    /// How far each angle can go.
    pub limits: [Option<Limit>; 3],
    /// Solvers do not turn it.
    pub locked: bool,
    /// How thick the bone is drawn.
    pub radius: f32,
}

/// From and to, in radians, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    pub min: f32,
    pub max: f32,
}

impl Joint {
    /// A free joint that sits on its parent's base, a tenth as thick as its bone is long.
    pub fn new(name: &str, parent: Option<JointId>, axis: Vec3) -> Self {
        Self {
            name: name.to_owned(),
            parent,
            offset: Vec3::ZERO,
            axis,
            rotation: Vec3::ZERO,
            frame: Mat3::IDENTITY,
            limits: [None; 3],
            locked: false,
            radius: (axis.as_dvec3().length() * 0.1) as f32,
        }
    }

    /// R, in the space of the joint's base.
    pub fn local_rotation(&self) -> Mat3A {
        self.rotation_by(self.rotation)
    }

    /// R by other Euler angles.
    pub(crate) fn rotation_by(&self, angles: Vec3) -> Mat3A {
        let turned = EulerAngles(angles).matrix();
        if self.frame == Mat3::IDENTITY {
            return turned;
        }
        let frame = Mat3A::from(self.frame);
        frame * turned * frame.transpose()
    }

    /// What the angle x, y or z (0, 1, 2) turns about, as a unit vector in the space of the joint's
    /// base: A·R_z·R_y·e_x, A·R_z·e_y or A·e_z.
    pub fn rotation_axis(&self, axis: usize) -> Vec3 {
        (Mat3A::from(self.frame) * EulerAngles(self.rotation).axes()).col(axis).into()
    }

    /// T(offset) · R: from the joint's own space to its parent's.
    pub fn local(&self) -> Affine3A {
        Affine3A { matrix3: self.local_rotation(), translation: self.offset.into() }
    }

    /// T(offset): [`Joint::local`] without the rotation.
    pub(super) fn local_in_bind_pose(&self) -> Affine3A {
        Affine3A::from_translation(self.offset)
    }

    /// The angles that turn as `rotation` (in the space of the joint's base) does: of all that do,
    /// those nearest to the present ones. They may be beyond the limits.
    pub fn angles_of(&self, rotation: Mat3A) -> Vec3 {
        let frame = Mat3A::from(self.frame);
        nearest_angles(frame.transpose() * rotation * frame, self.rotation)
    }

    /// Angles brought within the limits.
    pub fn clamped(&self, rotation: Vec3) -> Vec3 {
        within(&self.limits, rotation)
    }

    /// Widens the limits that do not contain these angles until they do.
    pub fn widen_limits(&mut self, angles: Vec3) {
        for (limit, angle) in self.limits.iter_mut().zip(angles.to_array()) {
            if let Some(Limit { min, max }) = limit {
                (*min, *max) = (min.min(angle), max.max(angle));
            }
        }
    }

    pub fn is_limited(&self) -> bool {
        self.limits.iter().any(Option::is_some)
    }

    pub(super) fn clamp(&mut self) {
        self.rotation = self.clamped(self.rotation);
    }

    pub(super) fn check(&self, joint: JointId) -> Result<(), SkeletonError> {
        const ORTHONORMAL: f32 = 1e-5;
        if let Some(parent) = self.parent.filter(|parent| *parent >= joint) {
            return Err(SkeletonError::Parent { joint, parent });
        }
        if self.name.trim().is_empty() {
            return Err(SkeletonError::NoName);
        }
        let vectors = [("offset", self.offset), ("axis", self.axis), ("rotation", self.rotation)];
        for (field, value) in vectors {
            if !value.is_finite() {
                return Err(SkeletonError::NotFinite { joint, field, value });
            }
        }
        if !(self.radius.is_finite() && self.radius >= 0.0) {
            return Err(SkeletonError::Radius { joint, value: self.radius });
        }
        let squared = self.frame.transpose() * self.frame;
        if !(squared.abs_diff_eq(Mat3::IDENTITY, ORTHONORMAL) && self.frame.determinant() > 0.0) {
            return Err(SkeletonError::Frame { joint });
        }
        for (axis, limit) in ['x', 'y', 'z'].into_iter().zip(self.limits) {
            if let Some(Limit { min, max }) = limit
                && !(min.is_finite() && max.is_finite() && min <= max)
            {
                return Err(SkeletonError::Limit { joint, axis, min, max });
            }
        }
        Ok(())
    }
}

/// Angles brought within limits.
pub(crate) fn within(limits: &[Option<Limit>; 3], rotation: Vec3) -> Vec3 {
    let mut clamped = rotation;
    for (axis, limit) in limits.iter().enumerate() {
        if let Some(Limit { min, max }) = limit {
            clamped[axis] = rotation[axis].clamp(*min, *max);
        }
    }
    clamped
}
