use core::fmt;

use glam::Vec3;
use thiserror::Error;

use super::joint_id::MOST_JOINTS;
use super::{JointId, RotationAxis};

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
    /// The radius is negative or not finite.
    #[error("the radius of joint {joint} must be finite and 0 or more, got {value}")]
    Radius {
        /// The joint.
        joint: JointId,
        /// Its radius.
        value: f32,
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

/// A vector field of a [`Joint`](super::Joint).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointField {
    /// [`Joint::offset`](super::Joint::offset)
    Offset,
    /// [`Joint::axis`](super::Joint::axis)
    Axis,
    /// [`Joint::rotation`](super::Joint::rotation)
    Rotation,
}

/// The field's name: "offset", "axis" or "rotation".
impl fmt::Display for JointField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Offset => "offset",
            Self::Axis => "axis",
            Self::Rotation => "rotation",
        })
    }
}
