use glam::{Affine3A, Mat3A, Quat, Vec3};

use crate::skeleton::{JointId, JointRemap, Skeleton, nearest_angles};

/// The space in which a target, or the pole of a limb, is fixed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TargetSpace {
    /// The world.
    #[default]
    World,
    /// The space of a joint: it moves and turns with the joint's bone, with the origin at the base.
    Joint(JointId),
}

impl TargetSpace {
    /// The joint; `None` for the world.
    pub fn joint(self) -> Option<JointId> {
        match self {
            Self::World => None,
            Self::Joint(joint) => Some(joint),
        }
    }

    /// Transform from this space to the world, for a pose of the skeleton. A joint that the skeleton
    /// does not have counts as the world.
    pub fn to_world(self, pose: &Skeleton) -> Affine3A {
        let joint = self.joint().filter(|joint| pose.joint(*joint).is_some());
        joint.map_or(Affine3A::IDENTITY, |joint| pose.full_transform(joint))
    }

    /// Transform from this space to skeleton space, for a pose of the skeleton. That of the world is not
    /// finite if the skeleton's own transform is singular.
    pub(super) fn to_skeleton(self, pose: &Skeleton) -> Affine3A {
        let Some(joint) = self.joint().filter(|joint| pose.joint(*joint).is_some()) else {
            return pose.transform().inverse();
        };
        let below = |above: Affine3A, joint: JointId| pose[joint].local() * above;
        pose.ancestors(joint).fold(Affine3A::IDENTITY, below)
    }

    /// Rotation from this space to the world, for a pose of the skeleton.
    pub fn rotation(self, pose: &Skeleton) -> Quat {
        let joint = self.joint().filter(|joint| pose.joint(*joint).is_some());
        joint.map_or(Quat::IDENTITY, |joint| pose.rotation_in_world(joint).as_quat())
    }

    /// Point in this space that is at `point`, in the world. Where the space is singular (a scale of
    /// 0) or the result overflows, returns `point`.
    pub fn point_from_world(self, pose: &Skeleton, point: Vec3) -> Vec3 {
        if self == Self::World {
            return point;
        }
        let local = self.to_world(pose).inverse().transform_point3(point);
        if local.is_finite() { local } else { point }
    }

    /// Euler angles in this space, in radians, of a rotation in the world: of all equivalent angles
    /// those nearest to `near`.
    pub fn angles_from_world(self, pose: &Skeleton, rotation: Quat, near: Vec3) -> Vec3 {
        let local = self.rotation(pose).inverse() * rotation;
        nearest_angles(Mat3A::from_quat(local.normalize()), near)
    }

    /// The same space after its joint was renumbered; the world if the joint was removed.
    #[must_use]
    pub(super) fn remapped(self, remap: &JointRemap) -> Self {
        self.joint().and_then(|joint| remap.get(joint)).map_or(Self::World, Self::Joint)
    }
}
