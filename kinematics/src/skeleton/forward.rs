use glam::{Affine3A, DMat3, DQuat, Vec3};

use super::{Joint, JointId, Skeleton, SkeletonPose};

/// Forward kinematics. For several joints use [`Skeleton::pose`], which visits each joint once.
impl Skeleton {
    /// Transform to the world from the space of the joint's base: the joint's own space before its
    /// rotation R.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn transform_to_base(&self, joint: JointId) -> Affine3A {
        let Joint { parent, offset, .. } = &self[joint];
        let above = parent.map_or(self.transform, |parent| self.full_transform(parent));
        above * Affine3A::from_translation(*offset)
    }

    /// Transform from the joint's own space to the world: the skeleton's transform times X.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn full_transform(&self, joint: JointId) -> Affine3A {
        let mut path: Vec<_> = self.ancestors(joint).collect();
        path.reverse();
        path.into_iter().fold(self.transform, |above, joint| above * self[joint].local())
    }

    /// Position of the bone's base in the world.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn base(&self, joint: JointId) -> Vec3 {
        self.full_transform(joint).translation.into()
    }

    /// Position of the bone's tip in the world.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn tip(&self, joint: JointId) -> Vec3 {
        let in_parent = |point, joint: JointId| self[joint].local().transform_point3(point);
        self.transform.transform_point3(self.ancestors(joint).fold(self[joint].axis, in_parent))
    }

    /// Rotation of the joint's own space in the world: that of the skeleton's transform, without its
    /// scale, times those of the joints down to this one.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn rotation_in_world(&self, joint: JointId) -> DQuat {
        let (_, rotation, _) = self.transform.as_daffine3().to_scale_rotation_translation();
        let rotation = if rotation.is_finite() { rotation } else { DQuat::IDENTITY };
        let joints: Vec<_> = self.ancestors(joint).collect();
        let below = joints.into_iter().rev().map(|it| self[it].rotation_f64(self[it].rotation));
        let below = below.fold(DMat3::IDENTITY, |above, local| above * local);
        (rotation * DQuat::from_mat3(&below)).normalize()
    }

    /// Transforms of all joints in the world.
    pub fn pose(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, self.transform, |_, joint| joint.local())
    }

    /// Writes [`Skeleton::pose`] into an existing pose. Allocates only if that pose has too little
    /// memory.
    pub fn write_pose(&self, pose: &mut SkeletonPose) {
        self.write_pose_with(pose, |_, joint| joint.local());
    }

    /// [`Skeleton::write_pose`] with local transforms by `local`, which is called with each joint's
    /// index and the joint, parents first.
    pub(crate) fn write_pose_with(
        &self,
        pose: &mut SkeletonPose,
        local: impl FnMut(usize, &Joint) -> Affine3A,
    ) {
        pose.refill(&self.joints, self.transform, local);
    }

    /// Transforms of all joints in the bind pose, in the world.
    pub fn bind_pose(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, self.transform, |_, joint| joint.local_in_bind_pose())
    }

    /// Writes [`Skeleton::pose_in_skeleton`] into an existing pose. Allocates only if that pose has too
    /// little memory.
    pub fn write_pose_in_skeleton(&self, pose: &mut SkeletonPose) {
        pose.refill(&self.joints, Affine3A::IDENTITY, |_, joint| joint.local());
    }

    /// Transforms of all joints in skeleton space.
    pub fn pose_in_skeleton(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, Affine3A::IDENTITY, |_, joint| joint.local())
    }

    /// Transforms of all joints in the bind pose, in skeleton space.
    pub fn bind_pose_in_skeleton(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, Affine3A::IDENTITY, |_, joint| joint.local_in_bind_pose())
    }
}
