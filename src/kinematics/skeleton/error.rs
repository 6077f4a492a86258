use glam::Vec3;
use thiserror::Error;

use super::{JointId, Skeleton};

/// What no skeleton can have. Joints are named by their place in the list.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SkeletonError {
    #[error("there is no joint {0}")]
    NoJoint(JointId),
    #[error("parent {parent} of joint {joint} does not stand before it")]
    Parent { joint: JointId, parent: JointId },
    #[error("joint {parent} hangs from joint {joint} and cannot be its parent")]
    Cycle { joint: JointId, parent: JointId },
    #[error("a joint needs a name")]
    NoName,
    #[error("two joints are called {0:?}; names must differ")]
    Name(String),
    #[error("{field} of joint {joint} is {value}; it must be finite numbers")]
    NotFinite { joint: JointId, field: &'static str, value: Vec3 },
    #[error("radius of joint {joint} is {value}; it must be a finite number, 0 or more")]
    Radius { joint: JointId, value: f32 },
    #[error("the frame of joint {joint} must be three unit vectors at right angles, right-handed")]
    Frame { joint: JointId },
    #[error(
        "the limit of joint {joint} about {axis} is {min} to {max}; it must be finite numbers, the \
         lower one first"
    )]
    Limit { joint: JointId, axis: char, min: f32, max: f32 },
    #[error("a skeleton has at most {} joints", Skeleton::MOST_JOINTS)]
    TooMany,
    #[error("the skeleton's transform must be finite numbers")]
    Transform,
}
