use glam::Vec3;

use crate::document::{Document, Overlay, Posed, Ray, Track};
use crate::kinematics::diagnosis::Diagnosis;
use crate::kinematics::skeleton::{Joint, JointId, Skeleton, SkeletonPose};
use crate::kinematics::skin::{MeshSection, SkinPose, SkinnedMesh, Skinning, TriangleMesh};
use crate::session::cached::Cached;
use crate::session::limb::ShownLimb;
use crate::session::pops::{CursorMove, Pops, TransportPath};
use crate::session::trail::Trail;

/// Values derived from the poses at the playhead.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    skeleton_pose: SkeletonPose,
    /// The shown limb, which the two measurements below are about.
    limb: Option<ShownLimb>,
    transport_path: Option<TransportPath>,
    pops: Pops,
    /// Why each target is not reached.
    why: Cached<Vec<Cached<Vec<Diagnosis>>>>,
    trail: Cached<Trail>,
    posed_skin: Cached<TriangleMesh>,
    skin_areas: Cached<Option<SkinAreas>>,
}

impl Evaluated {
    pub(super) fn new(posed: &Posed) -> Self {
        Self {
            skeleton_pose: posed.skeleton().pose(),
            limb: None,
            transport_path: None,
            pops: Pops::default(),
            why: Cached::default(),
            trail: Cached::default(),
            posed_skin: Cached::default(),
            skin_areas: Cached::default(),
        }
    }

    pub(super) fn skeleton_pose(&self) -> &SkeletonPose {
        &self.skeleton_pose
    }

    /// The limb that pages and guides are about: that of the selected joint, else the first; `None`
    /// without a limb.
    pub fn limb(&self) -> Option<&ShownLimb> {
        self.limb.as_ref()
    }

    /// Transport of a frame along the path of the limb's Pointer; `None` without a limb.
    pub fn transport_path(&self) -> Option<&TransportPath> {
        self.transport_path.as_ref()
    }

    /// Ratios of elbow speed to Cursor speed in the latest steps of the limb.
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

    pub(super) fn trail(&self, sample: impl FnOnce() -> Trail) -> &Trail {
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
        let hit = self.skin_in_world(posed)?.hit(ray.origin, ray.direction)?;
        let rig = &posed.document().rig;
        let weights = rig.skin.as_ref()?.mesh().ok()?.mesh.weights_at(&hit);
        let least = SHARED * weights.of(weights.first());
        let is_root = |joint| rig.skeleton.joint(joint).is_some_and(Joint::is_root_point);
        let root = weights.iter().find(|(joint, _)| is_root(*joint));
        Some(root.filter(|(_, weight)| *weight >= least).map_or(weights.first(), |it| it.0))
    }

    /// The middle of the body of the shown skin that a ray enters; `None` if the skin is hidden or the
    /// ray meets none.
    pub fn middle_of_skin(&self, posed: &Posed, ray: Ray) -> Option<Vec3> {
        self.skin_in_world(posed)?.middle(ray.origin, ray.direction)
    }

    /// The shown skin in the pose at the playhead; `None` if it is hidden or has no mesh.
    fn skin_in_world(&self, posed: &Posed) -> Option<&TriangleMesh> {
        let Document { rig, display, .. } = posed.document();
        let skin = rig.skin.as_ref().filter(|_| display.shows(Overlay::Skin))?;
        let mesh = &skin.mesh().ok()?.mesh;
        Some(self.posed_skin.get(|| mesh.posed(&mesh.pose(posed.skeleton()), skin.skinning)))
    }

    /// The areas of the skin over the timeline.
    pub(super) fn skin_areas(
        &self,
        compute: impl FnOnce() -> Option<SkinAreas>,
    ) -> Option<&SkinAreas> {
        self.skin_areas.get(compute).as_ref()
    }

    /// Updates the values to other poses.
    pub(super) fn update(&mut self, posed: &Posed) {
        posed.skeleton().write_pose(&mut self.skeleton_pose);
        if posed.document().display.shows(Overlay::ByItself) {
            // Solved here, since drawing takes no memory.
            posed.skeleton_by_itself();
        }
        self.posed_skin.clear();
        self.why.clear();
    }

    /// Measures the step to another pose of the limb, at a time in seconds; of another limb, its
    /// first pose.
    pub(super) fn follow_limb(&mut self, limb: Option<ShownLimb>, cause: CursorMove, time: f64) {
        let before = std::mem::replace(&mut self.limb, limb);
        let is_same = before.map(|it| it.target) == limb.map(|it| it.target);
        match (&limb, &mut self.transport_path) {
            (Some(limb), Some(path)) if is_same => {
                path.advance(&limb.frames);
                self.pops.record(limb.frames.posed, cause, time);
            }
            _ => {
                self.reset_transport();
                self.reset_pops(time);
            }
        }
    }

    pub(super) fn reset_transport(&mut self) {
        self.transport_path = self.limb.map(|limb| TransportPath::new(&limb.frames));
    }

    pub(super) fn reset_pops(&mut self, time: f64) {
        let new = |limb: ShownLimb| Pops::new(limb.frames.posed, time);
        self.pops = self.limb.map(new).unwrap_or_default();
    }

    /// Discards the trail and the areas of the skin; both are computed again
    /// when they are next needed.
    pub(super) fn forget_trail(&mut self) {
        self.trail.clear();
        self.skin_areas.clear();
    }
}

/// Area of the cross-section of a skin at the base of a joint over the timeline, once for each way
/// of blending joints.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinAreas {
    /// The joint.
    pub joint: JointId,
    /// Times in seconds.
    pub times: Vec<f64>,
    /// For each way of blending, in the order of [`Skinning::ALL`], the areas at these times as
    /// fractions of that in the pose in which the skin was attached.
    pub areas: [Vec<f32>; Skinning::ALL.len()],
}

impl SkinAreas {
    /// The areas of the skin of a document; `None` if the display does not compare ways of
    /// blending, or there is no closed section. Without a joint, the section is at the one with the
    /// greatest roll in the timeline.
    pub(super) fn new(track: &Track, joint: Option<JointId>) -> Option<Self> {
        const MOST_TIMES: usize = 121;
        let document = track.document();
        let skin = document.rig.skin.as_ref();
        let skin = skin.filter(|_| document.display.shows(Overlay::CompareSkinning))?;
        let mesh = &skin.mesh().ok()?.mesh;
        let timeline = document.timeline;
        let count = if document.is_animated() { timeline.frames().clamp(2, MOST_TIMES) } else { 2 };
        let time =
            |index: usize| timeline.start + timeline.duration() * index as f64 / (count - 1) as f64;
        let pose = |posed: &Posed| (posed.time(), mesh.pose(posed.skeleton()));
        let (times, poses): (Vec<f64>, Vec<SkinPose>) =
            track.sample(count, time, pose).into_iter().unzip();
        let joint = joint.or_else(|| most_rolled(&poses))?;
        let section = section(mesh, document.skeleton(), joint)?;
        let plain = section.area(|vertex| mesh.mesh().positions[vertex as usize]);
        // The skeleton's transform scales areas too.
        let scale = document.skeleton().transform().matrix3.determinant().abs().powf(2.0 / 3.0);
        let areas = Skinning::ALL.map(|skinning| {
            let area = |pose: &SkinPose| {
                section.area(|vertex| mesh.posed_vertex(pose, skinning, vertex)) / (plain * scale)
            };
            poses.iter().map(area).collect()
        });
        Some(Self { joint, times, areas })
    }

    /// The areas at a time in seconds, by linear interpolation, in the order of [`Skinning::ALL`].
    pub fn at(&self, time: f64) -> [f32; Skinning::ALL.len()] {
        let after = self.times.partition_point(|sample| *sample <= time);
        let (from, to) = (after.saturating_sub(1), after.min(self.times.len() - 1));
        let step = self.times[to] - self.times[from];
        let share = if step > 0.0 { ((time - self.times[from]) / step) as f32 } else { 0.0 };
        let share = share.clamp(0.0, 1.0);
        std::array::from_fn(|way| {
            let areas = &self.areas[way];
            areas[from] + (areas[to] - areas[from]) * share
        })
    }
}

fn most_rolled(poses: &[SkinPose]) -> Option<JointId> {
    let rolls = poses.iter().flat_map(|pose| pose.joints().iter().enumerate());
    let greatest = rolls.max_by(|(_, one), (_, other)| one.roll.abs().total_cmp(&other.roll.abs()));
    greatest.map(|(joint, _)| JointId::new(joint))
}

/// The section across a joint's bone at its base.
fn section(mesh: &SkinnedMesh, skeleton: &Skeleton, joint: JointId) -> Option<MeshSection> {
    let bind = mesh.inverse_binds().get(joint.index())?.inverse();
    let normal = bind.transform_vector3(skeleton.joint(joint)?.axis);
    MeshSection::new(mesh.mesh(), bind.translation.into(), normal.try_normalize()?)
}
