use glam::Vec3;

use super::{ASPECT, Session};
use crate::document::Camera;
use crate::kinematics::skeleton::JointId;
use crate::rig::LimbPart;

/// Cameras that frame the rig.
impl Session {
    /// A camera that frames the selected joints; without a selection, the whole rig. If the crowd
    /// is shown, the camera frames the crowd.
    pub fn framing_selection(&self) -> Camera {
        if self.crowd().is_some() {
            return self.framing_all();
        }
        let selected = self.rig().bounds_of(self.skeleton_pose(), self.selection().joints());
        let (centre, radius) = selected.unwrap_or_else(|| self.posed().bounds());
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// A camera that frames what is shown, over the whole timeline: all points in reach of a
    /// [measured limb](crate::document::Document::measured_limb), the skeleton with its targets, or
    /// the crowd.
    pub fn framing_all(&self) -> Camera {
        if let Some(crowd) = self.crowd() {
            let (centre, radius) = crowd.bounds();
            return self.settled_camera().framing(centre, radius, ASPECT);
        }
        let (centre, radius) = self.shown().motion_bounds_by(|posed| {
            let limb = posed.measured_frames()?;
            Some((limb.origin(LimbPart::Root), limb.limits.outer))
        });
        self.settled_camera().framing(centre, radius, ASPECT)
    }

    /// The point that the camera follows, in the world: the mean of the bases of the selected
    /// joints, or without a selection of all joints; the base of a measured limb.
    pub(in crate::session) fn followed_point(&self) -> Vec3 {
        let pose = self.skeleton_pose();
        let bases = |joints: &[JointId]| {
            let weight = 1.0 / joints.len() as f32;
            joints.iter().map(|joint| pose.base(*joint) * weight).sum()
        };
        match (self.posed().measured_frames(), self.selection().joints()) {
            (Some(limb), []) => limb.origin(LimbPart::Root),
            (None, []) => bases(&pose.ids().collect::<Vec<_>>()),
            (_, selected) => bases(selected),
        }
    }
}
