use core::fmt;

use glam::{Affine3A, DMat3, DQuat, DVec3, EulerRot, Mat3, Mat3A, Vec3};
use thiserror::Error;

use super::{
    Cone, JointAngles, JointLimits, Limit, RotationAxis, SkinStretch, angle_triples,
    equivalent_triples, nearest_angles,
};

/// Maximum number of joints of a skeleton.
pub(super) const MOST_JOINTS: usize = 10_000;

/// The index of a joint in its skeleton.
///
/// An index is valid only for its own skeleton, and only until an edit moves joints; such an edit
/// returns a [`JointRemap`]. For an index that a skeleton does not have,
///
/// - lookups return `None`, and tree queries find nothing,
/// - edits and solvers return an error and change nothing,
/// - indexing and transforms panic, as indexing a slice does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
pub struct JointId(usize);

impl JointId {
    /// The joint at a position of [`Skeleton::joints`](super::Skeleton::joints).
    pub const fn new(index: usize) -> Self {
        Self(index)
    }

    /// The position in [`Skeleton::joints`](super::Skeleton::joints).
    pub const fn index(self) -> usize {
        self.0
    }
}

impl From<usize> for JointId {
    fn from(index: usize) -> Self {
        Self(index)
    }
}

impl From<JointId> for usize {
    fn from(joint: JointId) -> Self {
        joint.0
    }
}

/// Writes the index as a plain number.
impl fmt::Display for JointId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// New indices of joints after an edit, by old index.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointRemap(pub(super) Vec<Option<JointId>>);

impl JointRemap {
    /// The new index of `joint`; `None` if it was removed.
    pub fn get(&self, joint: JointId) -> Option<JointId> {
        self.0.get(joint.index()).copied().flatten()
    }
}

/// A ball joint and its bone.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Joint {
    /// Name, unique within the skeleton.
    pub name: String,
    /// The parent, which precedes the joint; `None` for a root.
    pub parent: Option<JointId>,
    /// Vector from the parent's base to this joint's base, in the parent's space; for a root, from
    /// the skeleton's origin. An offset equal to the parent's axis puts the joint on the parent's
    /// tip.
    pub offset: Vec3,
    /// The bone's vector from base to tip, in the joint's own space. Zero for a joint without a
    /// bone.
    pub axis: Vec3,
    /// Euler angles about the frame's x, y and z in radians, unbounded; x is applied first.
    pub rotation: Vec3,
    /// The frame A in which the angles are measured: a right-handed orthonormal basis as columns.
    pub frame: Mat3,
    /// Limits of the rotation.
    pub limits: JointLimits,
    /// Reluctance of each angle to turn when a solver divides a motion among joints, from 0 to
    /// below 1: an angle with the stiffness k counts as if it were 1/(1 − k) times as large. It
    /// changes which pose reaches a target, not whether it is reached.
    pub stiffness: Vec3,
    /// True if solvers leave the rotation unchanged.
    pub locked: bool,
    /// True if keys that move this joint also move the tip of its parent's bone, so that the bone
    /// ends here at every time.
    pub connected: bool,
    /// Radius with which the bone is drawn, in skeleton units.
    pub radius: f32,
    /// How the joint stretches the skin that follows it.
    pub skin: SkinStretch,
    /// The bone of a person that the joint is, if its file tells it, as VRM names bones: `leftHand`.
    /// [`Humanoid::of`](crate::humanoid::Humanoid::of) goes by these names first.
    pub human_bone: Option<String>,
}

impl Joint {
    /// True for a root without a bone, such as a pelvis.
    pub fn is_root_point(&self) -> bool {
        self.parent.is_none() && self.axis == Vec3::ZERO
    }

    /// The greatest stiffness.
    pub const MAX_STIFFNESS: f32 = 1.0 - f32::EPSILON;

    /// An unlimited joint at its parent's base, with a radius of a tenth of its bone's length.
    pub fn new(name: &str, parent: Option<JointId>, axis: Vec3) -> Self {
        Self {
            name: name.to_owned(),
            parent,
            offset: Vec3::ZERO,
            axis,
            rotation: Vec3::ZERO,
            frame: Mat3::IDENTITY,
            limits: JointLimits::NONE,
            stiffness: Vec3::ZERO,
            locked: false,
            connected: false,
            radius: (axis.as_dvec3().length() * 0.1) as f32,
            skin: SkinStretch::NONE,
            human_bone: None,
        }
    }

    /// Distance of a point in the joint's own space from its bone.
    pub fn distance(&self, point: Vec3) -> f32 {
        let along = point.dot(self.axis) / self.axis.length_squared();
        let along = if along.is_finite() { along.clamp(0.0, 1.0) } else { 0.0 };
        point.distance(self.axis * along)
    }

    /// The rotation R, in the space of the joint's base.
    pub fn local_rotation(&self) -> Mat3A {
        self.rotation_by(self.rotation)
    }

    /// The rotation R for other Euler angles.
    pub fn rotation_by(&self, angles: Vec3) -> Mat3A {
        // Exact, and most joints of a figure are in their bind pose.
        if angles == Vec3::ZERO {
            return Mat3A::IDENTITY;
        }
        let rotation = JointAngles(angles).matrix();
        if self.frame == Mat3::IDENTITY {
            return rotation;
        }
        let frame = Mat3A::from(self.frame);
        frame * rotation * frame.transpose()
    }

    /// Unit axis about which the joint's angle x, y or z turns, in the space of the joint's base:
    /// A·R_z·R_y·e_x, A·R_z·e_y or A·e_z with the joint's frame A.
    pub fn rotation_axis(&self, axis: RotationAxis) -> Vec3 {
        (Mat3A::from(self.frame) * JointAngles(self.rotation).axes()).col(axis.index()).into()
    }

    /// Transform T(offset) · R from the joint's own space to its parent's.
    pub fn local(&self) -> Affine3A {
        Affine3A { matrix3: self.local_rotation(), translation: self.offset.into() }
    }

    /// A transform to the joint's own space, followed by the stretch of the skin.
    pub(crate) fn stretched(&self, transform: Affine3A) -> Affine3A {
        if self.skin == SkinStretch::NONE {
            return transform;
        }
        let frame = Mat3A::from(self.frame);
        let stretch = frame * self.skin.matrix() * frame.transpose();
        Affine3A {
            matrix3: stretch * transform.matrix3,
            translation: stretch * transform.translation,
        }
    }

    /// T(offset): [`Joint::local`] without the rotation.
    pub(super) fn local_in_bind_pose(&self) -> Affine3A {
        Affine3A::from_translation(self.offset)
    }

    /// Euler angles of `rotation`, which is in the space of the joint's base. Of all equivalent
    /// angles, these are the ones nearest to the joint's present angles. They may violate the
    /// limits.
    pub fn angles_of(&self, rotation: Mat3A) -> Vec3 {
        let frame = Mat3A::from(self.frame);
        nearest_angles(frame.transpose() * rotation * frame, self.rotation)
    }

    /// Of all angles equivalent to `angles` and within the limits, those nearest to `near`. Without
    /// any, `angles`.
    pub fn equivalent_angles(&self, angles: Vec3, near: Vec3) -> Vec3 {
        let triples = equivalent_triples(angles, near);
        triples.into_iter().find(|triple| self.limits.contains(*triple)).unwrap_or(angles)
    }

    /// Clamps the rotation to the limits, with a cone around the bone. A cone of a joint without a bone
    /// is fitted by [`Skeleton`](super::Skeleton), which knows the children.
    pub(super) fn clamp(&mut self) {
        if self.axis != Vec3::ZERO {
            self.limits = self.limits.along(self.frame, self.axis);
        }
        if self.axis != Vec3::ZERO || self.limits.as_cone().is_none() {
            self.rotation = self.limits.project(self.rotation);
        }
    }

    pub(super) fn check(&self, joint: JointId) -> Result<(), SkeletonError> {
        const ORTHONORMAL: f32 = 1e-5;
        if let Some(parent) = self.parent.filter(|parent| *parent >= joint) {
            return Err(SkeletonError::Parent { joint, parent });
        }
        if self.name.trim().is_empty() {
            return Err(SkeletonError::NoName);
        }
        let vectors = [
            (JointField::Offset, self.offset),
            (JointField::Axis, self.axis),
            (JointField::Rotation, self.rotation),
            (JointField::SkinScale, self.skin.scale),
            (JointField::SkinShear, self.skin.shear),
        ];
        for (field, value) in vectors {
            if !value.is_finite() {
                return Err(SkeletonError::NotFinite { joint, field, value });
            }
        }
        if !(self.radius.is_finite() && self.radius >= 0.0) {
            return Err(SkeletonError::Radius { joint, value: self.radius });
        }
        if !(self.stiffness.cmpge(Vec3::ZERO).all() && self.stiffness.cmplt(Vec3::ONE).all()) {
            return Err(SkeletonError::Stiffness { joint, value: self.stiffness });
        }
        let squared = self.frame.transpose() * self.frame;
        if !(squared.abs_diff_eq(Mat3::IDENTITY, ORTHONORMAL) && self.frame.determinant() > 0.0) {
            return Err(SkeletonError::Frame { joint });
        }
        if let Some(cone) = self.limits.invalid_cone() {
            return Err(SkeletonError::Cone { joint, cone });
        }
        if let Some((axis, Limit { min, max })) = self.limits.invalid_range() {
            return Err(SkeletonError::Limit { joint, axis, min, max });
        }
        Ok(())
    }
}

/// Euler angles within the limits of a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AnglesWithin {
    /// The angles, radians.
    pub angles: Vec3,
    /// True if the limits changed the angles by more than rounding.
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

    /// The angles for a rotation in the space of the joint's base: of all equivalent angles those
    /// that the limits change least, then those nearest to the joint's own; clamped to the limits.
    pub(crate) fn angles_within(&self, rotation: DMat3) -> AnglesWithin {
        self.angles_within_near(rotation, self.rotation)
    }

    /// [`Joint::angles_within`] with the equivalent angles that are nearest to `near`.
    pub(crate) fn angles_within_near(&self, rotation: DMat3, near: Vec3) -> AnglesWithin {
        const ROUNDING: f32 = 1e-5;
        let rotation = Mat3A::from(rotation.as_mat3());
        let frame = Mat3A::from(self.frame);
        let all = angle_triples(frame.transpose() * rotation * frame, near);
        let [first, second] = all.map(|angles| {
            let within = self.limits.project(angles);
            let changed = (within - angles).abs().max_element();
            (AnglesWithin { angles: within, is_limited: changed > ROUNDING }, changed)
        });
        if second.1 + ROUNDING < first.1 { second.0 } else { first.0 }
    }

    /// The joint's angles turned towards other angles by a fraction of the rotation between the
    /// two. A hinge turns by a fraction of the difference of its angle. Another joint turns the way
    /// that `turn`, the rotation in the step before, continues; without one, the shortest way.
    /// `turn` becomes the rotation of this step. A fraction of 1 gives `angles` bit for bit.
    pub(crate) fn angles_towards(
        &self,
        angles: Vec3,
        fraction: f32,
        turn: &mut Option<DQuat>,
    ) -> Vec3 {
        let [from, to] = [self.rotation, angles].map(|it| DQuat::from_mat3(&self.rotation_f64(it)));
        let whole = (from.conjugate() * to).normalize();
        let continues = turn.map_or(whole.w, |before| before.dot(whole));
        let whole = if continues < 0.0 { -whole } else { whole };
        *turn = Some(whole);
        if fraction >= 1.0 {
            return angles;
        }
        if self.hinge().is_some() {
            return self.limits.project(self.rotation.lerp(angles, fraction));
        }
        let turned = from * part_of(whole, f64::from(fraction));
        self.angles_within(DMat3::from_quat(turned)).angles
    }

    /// The only axis about which the limits let the joint turn; `None` if there are several, or
    /// none.
    pub(crate) fn hinge(&self) -> Option<RotationAxis> {
        let mut movable = self.movable_axes();
        movable.next().filter(|_| movable.next().is_none())
    }

    /// The axes about which the limits let the joint turn.
    pub(crate) fn movable_axes(&self) -> impl Iterator<Item = RotationAxis> {
        const MOVABLE: f32 = 1e-6;
        RotationAxis::ALL.into_iter().filter(|axis| self.limits.span(*axis) >= MOVABLE)
    }
}

/// A fraction of a rotation, which is more than half a turn for a negative w.
fn part_of(rotation: DQuat, fraction: f64) -> DQuat {
    let axis = rotation.xyz();
    let half = axis.length().atan2(rotation.w);
    match axis.try_normalize() {
        Some(axis) => DQuat::from_axis_angle(axis, 2.0 * half * fraction),
        None => DQuat::IDENTITY,
    }
}

/// An invalid skeleton, or an invalid edit of one.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SkeletonError {
    /// The skeleton has no joint with this index.
    #[error("there is no joint {0}")]
    NoJoint(JointId),
    /// The parent does not precede the joint.
    #[error("the parent of joint {joint} must precede it, got {parent}")]
    Parent {
        /// The joint.
        joint: JointId,
        /// Its parent.
        parent: JointId,
    },
    /// The parent is the joint or one of its descendants.
    #[error("the parent of joint {joint} must not be one of its descendants, got {parent}")]
    Cycle {
        /// The joint.
        joint: JointId,
        /// Its parent.
        parent: JointId,
    },
    /// The name is empty.
    #[error("the name of a joint must not be empty")]
    NoName,
    /// The name is already taken by another joint.
    #[error("names of joints must be unique, got {0:?} twice")]
    Name(String),
    /// A vector is not finite.
    #[error("the {field} of joint {joint} must be finite, got {value}")]
    NotFinite {
        /// The joint.
        joint: JointId,
        /// The field that holds the vector.
        field: JointField,
        /// The vector.
        value: Vec3,
    },
    /// An angle of a cone is out of its range.
    #[error(
        "the cone of joint {joint} must have x and z above 0 and at most 170°, and a finite twist, the \
         lower bound first and at most a full turn wide, and its middle at most 170° from the bone at \
         rest; got x {}°, z {}°, twist {}° to {}°, middle {}°",
        cone.x.to_degrees(), cone.z.to_degrees(), cone.twist.min.to_degrees(),
        cone.twist.max.to_degrees(), cone.middle.length().to_degrees()
    )]
    Cone {
        /// The joint.
        joint: JointId,
        /// The cone.
        cone: Cone,
    },
    /// The radius is negative or not finite.
    #[error("the radius of joint {joint} must be finite and 0 or more, got {value}")]
    Radius {
        /// The joint.
        joint: JointId,
        /// Its radius.
        value: f32,
    },
    /// A stiffness is negative, 1 or more, or not a number.
    #[error("the stiffness of joint {joint} must be 0 or more and below 1, got {value}")]
    Stiffness {
        /// The joint.
        joint: JointId,
        /// Its stiffness.
        value: Vec3,
    },
    /// The frame is not a right-handed orthonormal basis.
    #[error("the frame of joint {joint} must be a right-handed orthonormal basis")]
    Frame {
        /// The joint.
        joint: JointId,
    },
    /// A limit is not finite, or its bounds are swapped.
    #[error(
        "the limit of joint {joint} about {axis} must be finite, the lower bound first, got {min} \
         to {max}"
    )]
    Limit {
        /// The joint.
        joint: JointId,
        /// The axis of the limited angle.
        axis: RotationAxis,
        /// The lower bound, in radians.
        min: f32,
        /// The upper bound, in radians.
        max: f32,
    },
    /// There are more than [`Skeleton::MOST_JOINTS`](super::Skeleton::MOST_JOINTS) joints.
    #[error("a skeleton must have at most {MOST_JOINTS} joints")]
    TooMany,
    /// The transform is not finite.
    #[error("the skeleton's transform must be finite")]
    Transform,
}

/// A vector field of a [`Joint`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointField {
    /// [`Joint::offset`]
    Offset,
    /// [`Joint::axis`]
    Axis,
    /// [`Joint::rotation`]
    Rotation,
    /// [`SkinStretch::scale`]
    SkinScale,
    /// [`SkinStretch::shear`]
    SkinShear,
}

/// The field's name, such as "offset" or "skin_scale".
impl fmt::Display for JointField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Offset => "offset",
            Self::Axis => "axis",
            Self::Rotation => "rotation",
            Self::SkinScale => "skin_scale",
            Self::SkinShear => "skin_shear",
        })
    }
}
