use glam::Affine3A;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Joint, Skeleton};

/// A skeleton as it is serialized; unchecked when it is deserialized.
#[derive(Serialize, Deserialize)]
struct UncheckedSkeleton {
    joints: Vec<Joint>,
    transform: Affine3A,
}

/// Serializes the fields `joints` and `transform`.
impl Serialize for Skeleton {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let joints = self.joints().iter().map(|joint| Joint::clone(joint)).collect();
        UncheckedSkeleton { joints, transform: self.transform() }.serialize(serializer)
    }
}

/// Refuses an invalid skeleton.
impl<'de> Deserialize<'de> for Skeleton {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let UncheckedSkeleton { joints, transform } = Deserialize::deserialize(deserializer)?;
        let mut skeleton = Self::from_joints(joints).map_err(D::Error::custom)?;
        skeleton.set_transform(transform).map_err(D::Error::custom)?;
        Ok(skeleton)
    }
}
