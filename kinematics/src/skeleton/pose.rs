use glam::{Affine3A, Vec3};

use super::{Joint, JointId};
use crate::Shared;

/// Transforms of all joints to one space, the world or skeleton space. Overflow is clamped to
/// ±`f32::MAX`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkeletonPose {
    joints: Vec<PosedJoint>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct PosedJoint {
    full: Affine3A,
    tip: Vec3,
}

impl SkeletonPose {
    pub(super) fn new(
        joints: &[Shared<Joint>],
        transform: Affine3A,
        local: impl FnMut(usize, &Joint) -> Affine3A,
    ) -> Self {
        let mut pose = Self::default();
        pose.refill(joints, transform, local);
        pose
    }

    /// Refills the pose as [`SkeletonPose::new`] does, in its existing memory.
    pub(super) fn refill(
        &mut self,
        joints: &[Shared<Joint>],
        transform: Affine3A,
        mut local: impl FnMut(usize, &Joint) -> Affine3A,
    ) {
        let posed = &mut self.joints;
        posed.clear();
        posed.reserve(joints.len());
        for (index, joint) in joints.iter().enumerate() {
            let above = joint.parent.map_or(transform, |parent| posed[parent.index()].full);
            let mut full = above * local(index, joint);
            let mut tip = full.transform_point3(joint.axis);
            if !(full.is_finite() && tip.is_finite()) {
                full = Affine3A::from_cols_array(&full.to_cols_array().map(saturated));
                tip = Vec3::from_array(full.transform_point3(joint.axis).to_array().map(saturated));
            }
            posed.push(PosedJoint { full, tip });
        }
    }

    /// Number of joints.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// True if the pose has no joints.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// The indices of all joints.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = JointId> + ExactSizeIterator + use<> {
        (0..self.len()).map(JointId::new)
    }

    /// Transform from the joint's own space to the space of the pose.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn full(&self, joint: JointId) -> Affine3A {
        self.joints[joint.index()].full
    }

    /// Position of the bone's base, in the space of the pose.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn base(&self, joint: JointId) -> Vec3 {
        self.full(joint).translation.into()
    }

    /// Position of the bone's tip, in the space of the pose.
    ///
    /// # Panics
    ///
    /// If there is no such joint.
    pub fn tip(&self, joint: JointId) -> Vec3 {
        self.joints[joint.index()].tip
    }

    /// Positions of all bases and tips, in the space of the pose.
    pub fn points(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.joints.iter().flat_map(|posed| [posed.full.translation.into(), posed.tip])
    }
}

/// True if the point is finite and was not clamped.
pub fn is_within_numbers(point: Vec3) -> bool {
    point.is_finite() && point.abs().max_element() < f32::MAX
}

fn saturated(number: f32) -> f32 {
    if number.is_nan() { 0.0 } else { number.clamp(f32::MIN, f32::MAX) }
}
