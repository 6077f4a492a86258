use std::cell::OnceCell;

use glam::Vec3;

use super::pops::{CursorMove, Pops};
use super::transport::TransportPath;
use crate::document::{Arm, Document};
use crate::kinematics::skeleton::SkeletonPose;
use crate::kinematics::two_bone::TwoBonePose;

/// Poses at the playhead and what is derived from them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Evaluated {
    pose: TwoBonePose,
    skeleton_pose: SkeletonPose,
    transport_path: TransportPath,
    pops: Pops,
    /// Computed when it is first shown.
    trail: OnceCell<Vec<Vec3>>,
}

impl Evaluated {
    pub fn new(document: &Document) -> Self {
        let pose = document.arm.pose();
        Self {
            pose,
            skeleton_pose: document.skeleton_rig.skeleton_at(0.0).pose(),
            transport_path: TransportPath::new(&document.arm),
            pops: Pops::new(&document.arm, pose, 0.0),
            trail: OnceCell::new(),
        }
    }

    pub fn pose(&self) -> &TwoBonePose {
        &self.pose
    }

    pub fn skeleton_pose(&self) -> &SkeletonPose {
        &self.skeleton_pose
    }

    pub fn transport_path(&self) -> &TransportPath {
        &self.transport_path
    }

    pub fn pops(&self) -> &Pops {
        &self.pops
    }

    pub fn trail(&self, walk: impl FnOnce() -> Vec<Vec3>) -> &[Vec3] {
        self.trail.get_or_init(walk)
    }

    /// Poses a document at a time.
    pub fn update(&mut self, shown: &Document, time: f64, cause: CursorMove) {
        self.pose = shown.arm.pose();
        self.transport_path.go_on(&shown.arm);
        self.pops.watch(&shown.arm, self.pose, cause, time);
        shown.skeleton_rig.write_pose(time, &mut self.skeleton_pose);
    }

    pub fn reset_transport(&mut self, arm: &Arm) {
        self.transport_path = TransportPath::new(arm);
    }

    pub fn reset_pops(&mut self, arm: &Arm, time: f64) {
        self.pops = Pops::new(arm, self.pose, time);
    }

    /// Lets the trail be computed anew.
    pub fn forget_trail(&mut self) {
        self.trail.take();
    }
}
