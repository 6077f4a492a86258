use glam::{DMat3, DVec3, Vec3};

use crate::skeleton::{Joint, JointId, Skeleton};

/// The space of a joint: its rotation and origin in another space, in f64.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointSpace {
    pub rotation: DMat3,
    pub origin: DVec3,
}

impl JointSpace {
    const IDENTITY: Self = Self { rotation: DMat3::IDENTITY, origin: DVec3::ZERO };

    /// A joint's own space in skeleton space; that of no joint is skeleton space.
    pub fn of(skeleton: &Skeleton, joint: Option<JointId>) -> Self {
        Self::from_top(skeleton, joint.into_iter().flat_map(|joint| skeleton.ancestors(joint)))
    }

    /// The own space of the first of `joints`, each the parent of the one before, in the space of the
    /// last one's parent.
    pub fn from_top(skeleton: &Skeleton, joints: impl Iterator<Item = JointId>) -> Self {
        joints.fold(Self::IDENTITY, |space, joint| {
            let joint = &skeleton[joint];
            let rotation = joint.rotation_f64(joint.rotation);
            Self { rotation, origin: joint.offset.as_dvec3() }.of_inner(space)
        })
    }

    /// A space that is given in this space, in the space in which this one is given.
    pub fn of_inner(self, inner: Self) -> Self {
        let origin = self.origin + self.rotation * inner.origin;
        Self { rotation: self.rotation * inner.rotation, origin }
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
