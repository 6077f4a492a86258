use glam::Vec3;

use super::cached::Cached;
use super::pops::{CursorMove, Pops};
use super::skin_areas::SkinAreas;
use super::transport::TransportPath;
use crate::document::{Arm, Document};
use crate::kinematics::Shared;
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::SkeletonPose;
use crate::kinematics::skin::TriangleMesh;
use crate::kinematics::two_bone::TwoBonePose;
use crate::rig::EvaluatedSkeleton;

/// Poses at the playhead and values derived from them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Evaluated {
    pose: TwoBonePose,
    skeleton: Shared<EvaluatedSkeleton>,
    skeleton_pose: SkeletonPose,
    transport_path: TransportPath,
    pops: Pops,
    /// Why each target is not reached.
    why: Cached<Vec<Cached<Vec<Diagnosis>>>>,
    trail: Cached<Vec<Vec3>>,
    posed_skin: Cached<TriangleMesh>,
    skin_areas: Cached<Option<SkinAreas>>,
}

impl Evaluated {
    pub fn new(document: &Document) -> Self {
        let pose = document.arm.pose();
        let skeleton = Shared::from(document.skeleton_rig.evaluate(0.0));
        Self {
            pose,
            skeleton_pose: skeleton.solved.pose(),
            skeleton,
            transport_path: TransportPath::new(&document.arm),
            pops: Pops::new(&document.arm, pose, 0.0),
            why: Cached::default(),
            trail: Cached::default(),
            posed_skin: Cached::default(),
            skin_areas: Cached::default(),
        }
    }

    pub fn pose(&self) -> &TwoBonePose {
        &self.pose
    }

    pub fn skeleton(&self) -> &Shared<EvaluatedSkeleton> {
        &self.skeleton
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

    /// The diagnoses of the target with this index, which the skeleton has.
    pub fn why(&self, index: usize, diagnose: impl FnOnce() -> Vec<Diagnosis>) -> &[Diagnosis] {
        let targets = self.skeleton.targets.len();
        let why = self.why.get(|| vec![Cached::default(); targets]);
        why.get(index).map_or(&[], |why| why.get(diagnose))
    }

    /// Whether the diagnoses of any target were made.
    pub fn knows_why(&self) -> bool {
        self.why.known().is_some()
    }

    /// The diagnoses of the target with this index, if they were made.
    pub fn known_why(&self, index: usize) -> &[Diagnosis] {
        let why = self.why.known().and_then(|why| why.get(index)?.known());
        why.map_or(&[], Vec::as_slice)
    }

    pub fn trail(&self, sample: impl FnOnce() -> Vec<Vec3>) -> &[Vec3] {
        self.trail.get(sample)
    }

    /// The mesh of the skin in the world.
    pub fn posed_skin(&self, pose: impl FnOnce() -> TriangleMesh) -> &TriangleMesh {
        self.posed_skin.get(pose)
    }

    /// The areas of the skin over the timeline.
    pub fn skin_areas(&self, compute: impl FnOnce() -> Option<SkinAreas>) -> Option<&SkinAreas> {
        self.skin_areas.get(compute).as_ref()
    }

    /// Updates the poses, and the values derived from them, to a document that was evaluated at
    /// `time`, in seconds.
    pub fn update(&mut self, shown: &Document, time: f64, cause: CursorMove) {
        self.pose = shown.arm.pose();
        self.transport_path.advance(&shown.arm);
        self.pops.record(&shown.arm, self.pose, cause, time);
        self.skeleton = Shared::from(shown.skeleton_rig.evaluate(time));
        self.skeleton.solved.write_pose(&mut self.skeleton_pose);
        self.posed_skin.clear();
        self.why.clear();
    }

    pub fn reset_transport(&mut self, arm: &Arm) {
        self.transport_path = TransportPath::new(arm);
    }

    pub fn reset_pops(&mut self, arm: &Arm, time: f64) {
        self.pops = Pops::new(arm, self.pose, time);
    }

    /// Discards the trail and the areas of the skin; they are computed again when they are next needed.
    pub fn forget_trail(&mut self) {
        self.trail.clear();
        self.skin_areas.clear();
    }
}
