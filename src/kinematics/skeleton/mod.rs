//! Joint trees with Euler angles, and their forward kinematics.
//!
//! A skeleton is a forest, parents before children in memory. A joint is a ball joint with one bone:
//!
//! ```text
//!   parent's base        base                     tip
//!        o──── offset ────o════════ axis ══════════o      all in the joint's own space, which is
//!                                                         its parent's, translated by the offset
//!                                                         and rotated by R
//! R          = A · R_z(r_z) · R_y(r_y) · R_x(r_x) · Aᵀ     x is applied first
//! X(joint)   = X(parent) · T(offset) · R                   full transform
//! base       = X · (0, 0, 0)          tip = X · axis
//! ```
//!
//! A is a fixed orthonormal frame in which the angles are measured. The skeleton's own transform maps
//! skeleton space to the world and may mirror and scale. The bind pose is the skeleton as built,
//! before any rotation.
//!
//! Angles are radians. Offsets, axes and radii are in skeleton units; positions in the world are
//! called so.
//!
//! # Source
//!
//! *Skeleton Kinematics*, wiki of Scotty3D (CMU 15-462), task 2a.

mod build;
mod error;
mod euler;
mod joint;
mod joint_id;
mod pose;

use core::ops::Index;

use glam::{Affine3A, Vec3};

use crate::kinematics::Shared;

pub use build::JointRemap;
pub use error::SkeletonError;
pub use joint::{Joint, Limit};
pub use joint_id::JointId;
pub use pose::{SkeletonPose, is_within_numbers};

pub(crate) use euler::{EulerAngles, angle_triples, nearest_angles};
pub(crate) use joint::within;

/// A forest of joints with its transform to the world.
///
/// ```
/// use glam::Vec3;
/// use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
///
/// let mut skeleton = Skeleton::with_root("hip");
/// let thigh = skeleton.add(Joint::new("thigh", Some(JointId::new(0)), Vec3::Y))?;
/// let shin = skeleton.add(Joint { offset: Vec3::Y, ..Joint::new("shin", Some(thigh), Vec3::Y) })?;
///
/// skeleton.set_rotation(thigh, Vec3::new(0.0, 0.0, std::f32::consts::FRAC_PI_2))?;
/// assert!(skeleton.tip(shin).distance(Vec3::new(-2.0, 0.0, 0.0)) < 1e-6);
/// # Ok::<(), ik_arm::kinematics::skeleton::SkeletonError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    joints: Vec<Shared<Joint>>,
    transform: Affine3A,
}

impl Default for Skeleton {
    /// A skeleton without joints.
    fn default() -> Self {
        Self { joints: Vec::new(), transform: Affine3A::IDENTITY }
    }
}

impl Skeleton {
    /// Maximum number of joints.
    pub const MOST_JOINTS: usize = 10_000;

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
        Ok(skeleton)
    }

    /// All joints, parents before children. Clones of a skeleton share them.
    pub fn joints(&self) -> &[Shared<Joint>] {
        &self.joints
    }

    /// The joint of an index; `None` if there is none.
    pub fn joint(&self, joint: JointId) -> Option<&Joint> {
        self.joints.get(joint.index()).map(|joint| &**joint)
    }

    /// The indices of all joints, parents before children.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = JointId> + ExactSizeIterator + use<> {
        (0..self.joints.len()).map(JointId::new)
    }

    /// All joints with their indices, parents before children.
    pub fn iter(
        &self,
    ) -> impl DoubleEndedIterator<Item = (JointId, &Joint)> + ExactSizeIterator + Clone {
        self.joints.iter().enumerate().map(|(index, joint)| (JointId::new(index), &**joint))
    }

    /// The joint of a name.
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

    /// Whether `joint` is `ancestor` or one of its descendants.
    pub fn hangs_from(&self, joint: JointId, ancestor: JointId) -> bool {
        self.ancestors(joint).any(|above| above == ancestor)
    }

    /// Transform from skeleton space to the world.
    pub fn transform(&self) -> Affine3A {
        self.transform
    }

    /// Replaces the transform from skeleton space to the world. A singular one (a scale of 0) is
    /// allowed here and refused by solvers.
    ///
    /// # Errors
    ///
    /// [`SkeletonError::Transform`] if it is not finite.
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
    /// Transform from the joint's base, before its rotation R, to the world.
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
        self.full_transform(joint).transform_point3(self[joint].axis)
    }

    /// Transforms of all joints in the world.
    pub fn pose(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, self.transform, |_, joint| joint.local())
    }

    /// [`Skeleton::pose`] into an existing pose, which allocates only if it is too small.
    pub fn write_pose(&self, pose: &mut SkeletonPose) {
        self.write_pose_with(pose, |_, joint| joint.local());
    }

    /// [`Skeleton::write_pose`] with other local transforms, given by index and joint, parents first.
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

    /// Transforms of all joints in skeleton space.
    pub fn pose_in_skeleton(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, Affine3A::IDENTITY, |_, joint| joint.local())
    }

    /// Transforms of all joints in the bind pose, in skeleton space.
    pub fn bind_pose_in_skeleton(&self) -> SkeletonPose {
        SkeletonPose::new(&self.joints, Affine3A::IDENTITY, |_, joint| joint.local_in_bind_pose())
    }
}
