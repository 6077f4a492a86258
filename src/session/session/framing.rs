use glam::Vec3;

use super::{ASPECT, Session};
use crate::document::{Camera, RigKind};
use crate::kinematics::skeleton::JointId;

/// Cameras that frame the rig.
impl Session {
    /// A camera that frames the selected joints; without a selection, the whole rig. If the crowd
    /// is shown, the camera frames the crowd.
    pub fn framing_selection(&self) -> Camera {
        if self.crowd().is_some() {
            return self.framing_all();
        }
        let (centre, radius) = match self.rig() {
            RigKind::Arm => self.arm().bounds(self.pose()),
            RigKind::Skeleton => self
                .skeleton_rig()
                .bounds_of(self.skeleton_pose(), self.selection().joints())
                .unwrap_or_else(|| {
                    self.skeleton_rig().bounds(self.skeleton_pose(), self.playback().time())
                }),
        };
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// A camera that frames what is shown, over the whole timeline: all points in reach of the arm,
    /// the skeleton with its targets, or the crowd.
    pub fn framing_all(&self) -> Camera {
        if let Some(crowd) = self.crowd() {
            let (centre, radius) = crowd.bounds();
            return self.settled_camera().framing(centre, radius, ASPECT);
        }
        let (centre, radius) = self
            .shown()
            .motion_bounds_by(|posed| (posed.arm().root, posed.arm().reach_limits().outer));
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// The point that the camera follows, in the world: the mean of the bases of the selected
    /// joints, or without a selection of all joints. For the arm it is the Root.
    pub(in crate::session) fn followed_point(&self) -> Vec3 {
        let pose = self.skeleton_pose();
        let bases = |joints: &[JointId]| {
            let weight = 1.0 / joints.len() as f32;
            joints.iter().map(|joint| pose.base(*joint) * weight).sum()
        };
        match self.rig() {
            RigKind::Arm => self.arm().root,
            RigKind::Skeleton if self.selection().joints().is_empty() => {
                bases(&pose.ids().collect::<Vec<_>>())
            }
            RigKind::Skeleton => bases(self.selection().joints()),
        }
    }
}
