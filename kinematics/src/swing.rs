//! A small turn of one angle of a joint: the path of a tip against the line that the Jacobian
//! predicts.
//!
//! The tip moves on a circle about the angle's axis; the column of the Jacobian is the velocity on it,
//! so that line and circle part by about r φ²/2 after a turn by φ at the distance r from the axis.

use glam::Vec3;

use super::chain_ik::jacobian;
use super::skeleton::{JointId, RotationAxis, Skeleton};

/// A turn of one angle of a joint, seen at the tip of a joint below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Swing {
    /// The joint that turns.
    pub joint: JointId,
    /// The axis of its angle.
    pub axis: RotationAxis,
    /// The joint whose tip is looked at: the joint itself or one below it.
    pub tip: JointId,
}

impl Swing {
    /// The skeleton with the angle changed by `by`, in radians, whatever its limits are.
    pub fn posed(&self, skeleton: &Skeleton, by: f32) -> Skeleton {
        let mut posed = skeleton.clone();
        posed.write_local(self.joint, |joint| joint.rotation[self.axis.index()] += by);
        posed
    }

    /// Position of the tip in the world with the angle changed by `by`, in radians.
    ///
    /// # Panics
    ///
    /// If the skeleton has no such joints.
    pub fn tip_at(&self, skeleton: &Skeleton, by: f32) -> Vec3 {
        self.posed(skeleton, by).tip(self.tip)
    }

    /// Position of the tip in the world that the Jacobian predicts for a change of the angle by `by`, in
    /// radians.
    ///
    /// # Panics
    ///
    /// If the skeleton has no such joints.
    pub fn predicted_at(&self, skeleton: &Skeleton, by: f32) -> Vec3 {
        let column = jacobian(skeleton, self.tip)[self.joint.index()][self.axis.index()];
        skeleton.tip(self.tip) + by * skeleton.transform().transform_vector3(column)
    }
}
