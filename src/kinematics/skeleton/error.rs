use glam::Vec3;
use thiserror::Error;

use super::{JointId, Skeleton};

/// An invalid skeleton or edit.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SkeletonError {
    /// The index is not one of the skeleton.
    #[error("there is no joint {0}")]
    NoJoint(JointId),
    /// The parent does not precede the joint.
    #[error("parent {parent} of joint {joint} does not stand before it")]
    Parent { joint: JointId, parent: JointId },
    /// The parent is the joint or one of its descendants.
    #[error("joint {parent} hangs from joint {joint} and cannot be its parent")]
    Cycle { joint: JointId, parent: JointId },
    /// The name is empty.
    #[error("a joint needs a name")]
    NoName,
    /// The name is already taken.
    #[error("two joints are called {0:?}; names must differ")]
    Name(String),
    /// A vector is not finite.
    #[error("{field} of joint {joint} is {value}; it must be finite numbers")]
    NotFinite { joint: JointId, field: &'static str, value: Vec3 },
    /// The radius is negative or not finite.
    #[error("radius of joint {joint} is {value}; it must be a finite number, 0 or more")]
    Radius { joint: JointId, value: f32 },
    /// The frame is not a right-handed orthonormal basis.
    #[error("the frame of joint {joint} must be three unit vectors at right angles, right-handed")]
    Frame { joint: JointId },
    /// A limit is not finite, or its bounds are swapped.
    #[error(
        "the limit of joint {joint} about {axis} is {min} to {max}; it must be finite numbers, the \
         lower one first"
    )]
    Limit { joint: JointId, axis: char, min: f32, max: f32 },
    /// There are more than [`Skeleton::MOST_JOINTS`] joints.
    #[error("a skeleton has at most {} joints", Skeleton::MOST_JOINTS)]
    TooMany,
    /// The transform is not finite.
    #[error("the skeleton's transform must be finite numbers")]
    Transform,
}
