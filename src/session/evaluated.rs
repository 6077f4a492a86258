use std::cell::OnceCell;

use glam::Vec3;

use crate::document::{Document, Overlay, Posed, Ray};
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::{Joint, JointId, SkeletonPose};
use crate::kinematics::skin::TriangleMesh;
use crate::session::arm::edits::TransportPath;
use crate::session::arm::pops::{CursorMove, Pops};
use crate::session::skin::SkinAreas;

/// Values derived from the poses at the playhead.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
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
    pub(super) fn new(posed: &Posed) -> Self {
        Self {
            skeleton_pose: posed.skeleton().pose(),
            transport_path: TransportPath::new(posed),
            pops: Pops::new(posed),
            why: Cached::default(),
            trail: Cached::default(),
            posed_skin: Cached::default(),
            skin_areas: Cached::default(),
        }
    }

    pub(super) fn skeleton_pose(&self) -> &SkeletonPose {
        &self.skeleton_pose
    }

    /// Transport of a frame along the Pointer's path.
    pub fn transport_path(&self) -> &TransportPath {
        &self.transport_path
    }

    /// Ratios of elbow speed to Cursor speed in the latest steps.
    pub fn pops(&self) -> &Pops {
        &self.pops
    }

    /// The diagnoses of the target with this index, of as many as the skeleton has.
    pub(super) fn why(
        &self,
        index: usize,
        targets: usize,
        diagnose: impl FnOnce() -> Vec<Diagnosis>,
    ) -> &[Diagnosis] {
        let why = self.why.get(|| vec![Cached::default(); targets]);
        why.get(index).map_or(&[], |why| why.get(diagnose))
    }

    /// True if the diagnoses of any target were made.
    pub(super) fn knows_why(&self) -> bool {
        self.why.known().is_some()
    }

    /// The diagnoses of the target with this index, if they were made.
    pub(super) fn known_why(&self, index: usize) -> &[Diagnosis] {
        let why = self.why.known().and_then(|why| why.get(index)?.known());
        why.map_or(&[], Vec::as_slice)
    }

    pub(super) fn trail(&self, sample: impl FnOnce() -> Vec<Vec3>) -> &[Vec3] {
        self.trail.get(sample)
    }

    /// The joint with the greatest weight at the point of the shown skin that a ray meets first, in
    /// the pose at the playhead; `None` if the skin is hidden or the ray meets none. A root without
    /// a bone, such as a pelvis, shares its skin with the bones on it, and wins where it has at
    /// least half of their weight.
    pub fn joint_on_skin(&self, posed: &Posed, ray: Ray) -> Option<JointId> {
        /// Weight of a root without a bone, as a fraction of the greatest one, from which the skin
        /// is its own.
        const SHARED: f32 = 0.5;
        let Document { skeleton_rig, display, .. } = posed.document();
        let skin = skeleton_rig.skin.as_ref().filter(|_| display.shows(Overlay::Skin))?;
        let mesh = &skin.mesh().ok()?.mesh;
        let pose = || mesh.posed(&mesh.pose(posed.skeleton()), skin.skinning);
        let hit = self.posed_skin.get(pose).hit(ray.origin, ray.direction)?;
        let weights = mesh.weights_at(&hit);
        let least = SHARED * weights.of(weights.first());
        let is_root = |joint| skeleton_rig.skeleton.joint(joint).is_some_and(Joint::is_root_point);
        let root = weights.iter().find(|(joint, _)| is_root(*joint));
        Some(root.filter(|(_, weight)| *weight >= least).map_or(weights.first(), |it| it.0))
    }

    /// The areas of the skin over the timeline.
    pub(super) fn skin_areas(
        &self,
        compute: impl FnOnce() -> Option<SkinAreas>,
    ) -> Option<&SkinAreas> {
        self.skin_areas.get(compute).as_ref()
    }

    /// Updates the values to other poses.
    pub(super) fn update(&mut self, posed: &Posed, cause: CursorMove) {
        self.transport_path.advance(posed.arm());
        self.pops.record(posed, cause);
        posed.skeleton().write_pose(&mut self.skeleton_pose);
        self.posed_skin.clear();
        self.why.clear();
    }

    pub(super) fn reset_transport(&mut self, posed: &Posed) {
        self.transport_path = TransportPath::new(posed);
    }

    pub(super) fn reset_pops(&mut self, posed: &Posed) {
        self.pops = Pops::new(posed);
    }

    /// Discards the trail and the areas of the skin; both are computed again
    /// when they are next needed.
    pub(super) fn forget_trail(&mut self) {
        self.trail.clear();
        self.skin_areas.clear();
    }
}

/// A value derived from other state, computed when it is first read. All cached values compare
/// equal, so that comparing sessions ignores them.
#[derive(Clone, Debug)]
pub(super) struct Cached<T>(OnceCell<T>);

impl<T> Cached<T> {
    pub fn get(&self, compute: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(compute)
    }

    /// The value, if it was computed.
    pub fn known(&self) -> Option<&T> {
        self.0.get()
    }

    /// Discards the value; the next [`Self::get`] computes it again.
    pub fn clear(&mut self) {
        self.0.take();
    }
}

impl<T> Default for Cached<T> {
    fn default() -> Self {
        Self(OnceCell::new())
    }
}

impl<T> PartialEq for Cached<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
