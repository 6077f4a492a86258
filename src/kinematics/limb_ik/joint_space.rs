use glam::{DMat3, DVec3, Vec3};

use crate::kinematics::skeleton::{Joint, JointId, Skeleton};

/// The space of a joint: its rotation and origin in another space, in f64.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointSpace {
    pub rotation: DMat3,
    pub origin: DVec3,
}

impl JointSpace {
    pub const IDENTITY: Self = Self { rotation: DMat3::IDENTITY, origin: DVec3::ZERO };

    /// A joint's own space in skeleton space; that of no joint is skeleton space.
    pub fn of(skeleton: &Skeleton, joint: Option<JointId>) -> Self {
        match joint.and_then(|joint| skeleton.joint(joint)) {
            Some(joint) => Self::of(skeleton, joint.parent).of_child(joint),
            None => Self::IDENTITY,
        }
    }

    /// The own space of `joint`, for a joint `upper` above it, or the same, whose parent has the space
    /// `above`.
    pub fn below(skeleton: &Skeleton, joint: JointId, upper: JointId, above: Self) -> Self {
        let parent = skeleton[joint].parent.filter(|_| joint != upper);
        let parent = parent.map_or(above, |parent| Self::below(skeleton, parent, upper, above));
        parent.of_child(&skeleton[joint])
    }

    /// The own space of a child of this space's joint.
    pub fn of_child(self, child: &Joint) -> Self {
        let base = self.at_base_of(child);
        Self { rotation: base.rotation * child.rotation_f64(child.rotation), ..base }
    }

    /// The space of a child before its rotation.
    pub fn at_base_of(self, child: &Joint) -> Self {
        Self { origin: self.point(child.offset), ..self }
    }

    /// The position of a point of this space.
    pub fn point(self, point: Vec3) -> DVec3 {
        self.origin + self.rotation * point.as_dvec3()
    }
}
