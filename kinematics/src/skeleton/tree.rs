use core::ops::Index;

use glam::{Affine3A, DMat3, DQuat, Vec3};

use super::joint::MOST_JOINTS;
use super::{Joint, JointId, SkeletonError, SkeletonPose};
use crate::Shared;

/// A forest of joints with its transform to the world.
///
/// ```
/// use glam::Vec3;
/// use ik_arm_kinematics::skeleton::{Joint, JointId, Skeleton};
///
/// let mut skeleton = Skeleton::with_root("hip");
/// let thigh = skeleton.add(Joint::new("thigh", Some(JointId::new(0)), Vec3::Y))?;
/// let shin = skeleton.add(Joint { offset: Vec3::Y, ..Joint::new("shin", Some(thigh), Vec3::Y) })?;
///
/// skeleton.set_rotation(thigh, Vec3::new(0.0, 0.0, std::f32::consts::FRAC_PI_2))?;
/// assert!(skeleton.tip(shin).distance(Vec3::new(-2.0, 0.0, 0.0)) < 1e-6);
/// # Ok::<(), ik_arm_kinematics::skeleton::SkeletonError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    pub(super) joints: Vec<Shared<Joint>>,
    pub(super) transform: Affine3A,
}

impl Default for Skeleton {
    /// A skeleton without joints.
    fn default() -> Self {
        Self { joints: Vec::new(), transform: Affine3A::IDENTITY }
    }
}

impl Skeleton {
    /// Maximum number of joints.
    pub const MOST_JOINTS: usize = MOST_JOINTS;

    /// A skeleton of one locked joint without a bone.
    pub fn with_root(name: &str) -> Self {
        let root = Joint { locked: true, ..Joint::new(name, None, Vec3::ZERO) };
        Self { joints: vec![root.into()], ..Self::default() }
    }

    /// A skeleton of joints in which parents precede their children. Rotations are clamped to the
    /// limits.
    ///
    /// # Errors
    ///
    /// See [`SkeletonError`].
    pub fn from_joints(joints: Vec<Joint>) -> Result<Self, SkeletonError> {
        let mut skeleton = Self::default();
        if joints.len() > Self::MOST_JOINTS {
            return Err(SkeletonError::TooMany);
        }
        let mut names = std::collections::HashSet::new();
        for (index, joint) in joints.iter().enumerate() {
            joint.check(index.into())?;
            if !names.insert(joint.name.as_str()) {
                return Err(SkeletonError::Name(joint.name.clone()));
            }
        }
        let clamped = |mut joint: Joint| {
            joint.clamp();
            joint.into()
        };
        skeleton.joints = joints.into_iter().map(clamped).collect();
        skeleton.ids().for_each(|joint| skeleton.fit_cone(joint));
        Ok(skeleton)
    }

    /// All joints, parents before children. Clones of a skeleton share unchanged joints in memory.
    pub fn joints(&self) -> &[Shared<Joint>] {
        &self.joints
    }

    /// The joint with this index; `None` if the skeleton has no such joint.
    pub fn joint(&self, joint: JointId) -> Option<&Joint> {
        self.joints.get(joint.index()).map(|joint| &**joint)
    }

    /// The indices of all joints, parents before children.
    pub fn ids(
        &self,
    ) -> impl DoubleEndedIterator<Item = JointId> + ExactSizeIterator + Clone + use<> {
        (0..self.joints.len()).map(JointId::new)
    }

    /// All joints with their indices, parents before children.
    pub fn iter(
        &self,
    ) -> impl DoubleEndedIterator<Item = (JointId, &Joint)> + ExactSizeIterator + Clone {
        self.joints.iter().enumerate().map(|(index, joint)| (JointId::new(index), &**joint))
    }

    /// Index of the joint with this name; `None` if the skeleton has no such joint.
    pub fn find(&self, name: &str) -> Option<JointId> {
        self.joints.iter().position(|joint| joint.name == name).map(JointId::new)
    }

    /// The joints whose parent is `joint`.
    pub fn children(&self, joint: JointId) -> impl Iterator<Item = JointId> + '_ {
        self.iter().filter(move |(_, child)| child.parent == Some(joint)).map(|(child, _)| child)
    }

    /// The joint, its parent, and so on up to its root.
    pub fn ancestors(&self, joint: JointId) -> impl Iterator<Item = JointId> + '_ {
        let first = self.joint(joint).map(|_| joint);
        std::iter::successors(first, |joint| self.joint(*joint)?.parent)
    }

    /// True if `joint` is in the subtree of `root`: `root` itself or one of its descendants.
    pub fn is_in_subtree(&self, joint: JointId, root: JointId) -> bool {
        self.ancestors(joint).any(|above| above == root)
    }

    /// Transform from skeleton space to the world.
    pub fn transform(&self) -> Affine3A {
        self.transform
    }

    /// Replaces the transform from skeleton space to the world. A singular transform (a scale of 0)
    /// is allowed here and refused by solvers.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::Transform`] if the transform is not finite.
    pub fn set_transform(&mut self, transform: Affine3A) -> Result<(), SkeletonError> {
        if !transform.is_finite() {
            return Err(SkeletonError::Transform);
        }
        self.transform = transform;
        Ok(())
    }
}

impl Index<JointId> for Skeleton {
    type Output = Joint;

    /// # Panics
    ///
    /// If there is no such joint; [`Skeleton::joint`] returns `None` then.
    fn index(&self, joint: JointId) -> &Joint {
        &self.joints[joint.index()]
    }
}

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
        self.fold_down(joint, self.transform, |above, joint| above * self[joint].local())
    }

    /// Folds the joints from the root above a joint down to it. Allocates only for long chains.
    fn fold_down<T>(&self, joint: JointId, start: T, step: impl FnMut(T, JointId) -> T) -> T {
        const SHORT: usize = 32;
        let count = self.ancestors(joint).count();
        if count > SHORT {
            let path: Vec<_> = self.ancestors(joint).collect();
            return path.into_iter().rev().fold(start, step);
        }
        let mut path = [joint; SHORT];
        path.iter_mut().zip(self.ancestors(joint)).for_each(|(place, joint)| *place = joint);
        path[..count].iter().rev().copied().fold(start, step)
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
        self.point_in_world(joint, self[joint].axis)
    }

    /// Position in the world of a point in a joint's space.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn point_in_world(&self, joint: JointId, point: Vec3) -> Vec3 {
        let in_parent = |point, joint: JointId| self[joint].local().transform_point3(point);
        self.transform.transform_point3(self.ancestors(joint).fold(point, in_parent))
    }

    /// Rotation of the joint's own space in the world: that of the skeleton's transform, without
    /// its scale, times those of the joints down to this one.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn rotation_in_world(&self, joint: JointId) -> DQuat {
        let below = self.fold_down(joint, DMat3::IDENTITY, |above, joint| {
            above * self[joint].rotation_f64(self[joint].rotation)
        });
        (self.own_rotation() * DQuat::from_mat3(&below)).normalize()
    }

    /// A rotation in skeleton space that is `rotation` in the world, as
    /// [`Skeleton::rotation_in_world`] measures it.
    pub fn rotation_from_world(&self, rotation: DQuat) -> DQuat {
        (self.own_rotation().inverse() * rotation).normalize()
    }

    /// The rotation of the skeleton's transform, without its scale.
    fn own_rotation(&self) -> DQuat {
        let (_, rotation, _) = self.transform.as_daffine3().to_scale_rotation_translation();
        if rotation.is_finite() { rotation } else { DQuat::IDENTITY }
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

    /// Writes [`Skeleton::pose_in_skeleton`] into an existing pose. Allocates only if that pose has
    /// too little memory.
    pub fn write_pose_in_skeleton(&self, pose: &mut SkeletonPose) {
        pose.refill(&self.joints, Affine3A::IDENTITY, |_, joint| joint.local());
    }

    /// Transforms of all joints in skeleton space.
    pub fn pose_in_skeleton(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, Affine3A::IDENTITY, |_, joint| joint.local())
    }

    /// Writes [`Skeleton::bind_pose_in_skeleton`] into an existing pose. Allocates only if that
    /// pose has too little memory.
    pub(crate) fn write_bind_pose_in_skeleton(&self, pose: &mut SkeletonPose) {
        let local = |_, joint: &Joint| joint.local_in_bind_pose();
        pose.refill(&self.joints, Affine3A::IDENTITY, local);
    }

    /// Transforms of all joints in the bind pose, in skeleton space.
    pub fn bind_pose_in_skeleton(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, Affine3A::IDENTITY, |_, joint| joint.local_in_bind_pose())
    }
}

#[cfg(feature = "serde")]
mod serialization {
    use glam::Affine3A;
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::Skeleton;
    use crate::skeleton::Joint;

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
}
