use std::collections::BTreeMap;

use glam::{Vec3, Vec3A};

use super::balance_target::BalanceTarget;
use super::carried::Posture;
use super::follow_path::{FollowPath, PathKind};
use super::skin::{Skin, SkinSource};
use super::target::{LimbSettings, MovedJoints, Target, TargetKind};
use crate::Shared;
use crate::chain_ik::{ChainTarget, SolverOptions};
use crate::limb_ik::{self, Limb};
use crate::skeleton::{JointId, JointRemap, Skeleton, SkeletonPose};
use crate::spline::Spline;
use crate::twist::TwistReferenceKind;

/// The skeleton with its targets and the options of its solver.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonRig {
    /// The joints.
    pub skeleton: Shared<Skeleton>,
    /// Targets for the tips of joints, at most one per joint.
    pub targets: Vec<Target>,
    /// Options of the solver.
    pub solver: SolverOptions,
    /// Number of solver iterations per displayed frame during a solver run.
    pub iterations_per_frame: u32,
    /// Paths that the chains of roots follow over time, instead of their own angles; at most one
    /// per root.
    pub follow_paths: Vec<FollowPath>,
    /// By root, the keys of a head's offset with [`PathKind::Head`], of the target's home with
    /// [`PathKind::Target`]. The evaluation of a document sets them; there are none in a document
    /// that is not evaluated, and they are never saved.
    pub head_tracks: BTreeMap<JointId, Shared<Spline<Vec3>>>,
    /// True if each frame of a motion continues from the one before; false if each is solved by
    /// itself, from its FK pose.
    pub is_tracked: bool,
    /// True if limb targets that are out of reach pull the rest of the body along: see
    /// [`SkeletonRig::pulls_body`].
    pub body_follows: bool,
    /// Where the centre of mass of the figure should be; `None` for anywhere.
    pub balance: Option<BalanceTarget>,
    /// The posture with which the motion begins; `None` for the one that is solved from the FK
    /// pose.
    pub posture: Option<Shared<Posture>>,
    /// The mesh that follows the joints; `None` for bones alone.
    pub skin: Option<Skin>,
}

impl SkeletonRig {
    /// Maximum of [`Self::iterations_per_frame`].
    pub const MAX_ITERATIONS_PER_FRAME: u32 = 1000;

    /// A skeleton without targets.
    pub fn new(skeleton: Skeleton) -> Self {
        Self {
            skeleton: Shared::from(skeleton),
            targets: Vec::new(),
            solver: SolverOptions::default(),
            iterations_per_frame: 1,
            follow_paths: Vec::new(),
            head_tracks: BTreeMap::new(),
            is_tracked: true,
            body_follows: false,
            balance: None,
            posture: None,
            skin: None,
        }
    }

    /// Distance in world units within which a tip counts as at its target.
    pub fn tolerance(&self) -> f32 {
        self.solver.tolerance.unwrap_or_else(|| 1e-4 * self.reach())
    }

    /// The joints, for editing. They are copied first if other rigs share them.
    pub fn skeleton_mut(&mut self) -> &mut Skeleton {
        self.skeleton.make_mut()
    }

    /// Index of a joint's target in [`Self::targets`]; `None` if the joint has none.
    pub fn target(&self, joint: JointId) -> Option<usize> {
        self.targets.iter().position(|target| target.joint == joint)
    }

    /// For each joint the greatest influence of the targets that turn it; 0 for a joint that has
    /// its FK angles.
    pub fn influences(&self) -> Vec<f32> {
        let mut influences = Vec::new();
        self.write_influences(&mut influences);
        influences
    }

    /// Writes [`SkeletonRig::influences`] into a list, reusing its memory.
    pub fn write_influences(&self, influences: &mut Vec<f32>) {
        influences.clear();
        influences.resize(self.skeleton.joints().len(), 0.0);
        for target in self.targets.iter().filter(|target| self.is_solved_for(target)) {
            for joint in MovedJoints::turned(&self.skeleton, self.solver.root, target) {
                let influence = &mut influences[joint.index()];
                *influence = influence.max(target.influence);
            }
        }
    }

    /// The posing target that turns a joint, of several the one with the greatest influence; `None`
    /// if the joint has its FK angles.
    pub fn target_that_turns(&self, joint: JointId) -> Option<&Target> {
        let turns = |target: &&Target| {
            self.is_solved_for(target) && self.moved_by(target).turned.contains(&joint)
        };
        let posing = self.targets.iter().filter(turns);
        posing.max_by(|one, other| one.influence.total_cmp(&other.influence))
    }

    /// The joints that a target turns if it poses the skeleton.
    pub(super) fn moved_by(&self, target: &Target) -> MovedJoints {
        MovedJoints::new(&self.skeleton, self.solver.root, target)
    }

    /// True if the pose by a target depends on the pose before it: by a whole-body target, and by a
    /// limb target that pulls the body, that carries the elbow's direction or whose limb can bend to more than one side.
    pub fn is_carried(&self, target: &Target) -> bool {
        let Some(settings) = target.limb() else { return !self.leads_path(target) };
        if self.pulls_body(target) {
            return true;
        }
        let limb = Limb::ending_at(&self.skeleton, target.joint);
        settings.reference == TwistReferenceKind::Transport
            || limb.is_ok_and(|limb| limb_ik::bends_to_several_sides(&self.skeleton, limb))
    }

    /// The joint that a target is named after: the hand of its limb, or the joint whose tip it
    /// brings to the target.
    pub fn end_of(&self, target: &Target) -> JointId {
        target.limb_in(&self.skeleton).and_then(|limb| limb.hand).unwrap_or(target.joint)
    }

    /// [`Self::end_of`] the target of a joint; `None` if the joint has none.
    pub fn end_of_target(&self, joint: JointId) -> Option<JointId> {
        self.target(joint).map(|index| self.end_of(&self.targets[index]))
    }

    /// Index in [`Self::targets`] of the target that a joint is posed by as an end: the joint's
    /// own, or that of the limb whose hand it is.
    pub fn target_of_end(&self, joint: JointId) -> Option<usize> {
        let ends_at = |target: &Target| self.end_of(target) == joint;
        self.target(joint).or_else(|| self.targets.iter().position(ends_at))
    }

    /// The joints of the limb of a joint's target, from the upper joint's to the end's; none for
    /// another target.
    pub fn limb_joints(&self, target: JointId) -> impl Iterator<Item = JointId> + use<> {
        let target = self.target(target).map(|index| &self.targets[index]);
        let limb = target.and_then(|target| target.limb_in(&self.skeleton));
        limb.into_iter().flat_map(Limb::joints)
    }

    /// The targets that move a limb.
    pub fn limb_targets(&self) -> impl Iterator<Item = &Target> {
        self.targets.iter().filter(|target| target.limb().is_some())
    }

    /// Index in [`Self::targets`] of the limb target whose limb has a joint, as the upper joint's
    /// bone, the lower one's, one between them, or the end.
    pub fn limb_target_of(&self, joint: JointId) -> Option<usize> {
        let has = |target: &Target| {
            target.limb_in(&self.skeleton).is_some_and(|limb| {
                limb.bones(&self.skeleton).chain(limb.hand).any(|it| it == joint)
            })
        };
        self.targets.iter().position(has)
    }

    /// The target of a rig that is one limb: the only target, if it moves a limb, and every joint is
    /// one of the limb's or above them. `None` for any other figure.
    pub fn sole_limb(&self) -> Option<&Target> {
        let [target] = &self.targets[..] else { return None };
        let limb = target.limb_in(&self.skeleton)?;
        let chain = self.skeleton.ancestors(limb.hand.unwrap_or(limb.lower));
        (chain.count() == self.skeleton.joints().len()).then_some(target)
    }

    /// A target with full influence at the tip of a joint in a pose: for a hand or foot, or the
    /// bone above it, of the limb of two bones that ends there; otherwise for the whole body.
    /// `None` if the joint is missing or has a target.
    pub fn new_target(&self, joint: JointId, pose: &Skeleton) -> Option<Target> {
        self.skeleton.joint(joint)?;
        let limb = Limb::for_end(&self.skeleton, joint);
        let (joint, kind) = match limb {
            Some(limb) => (limb.lower, TargetKind::Limb(LimbSettings::default())),
            None => (joint, TargetKind::WholeBody),
        };
        let target = Target::new(joint, pose.tip(joint), self.default_path_radius());
        self.target(joint).is_none().then_some(Target { kind, influence: 1.0, ..target })
    }

    /// The enabled targets at a time in seconds, for a solver of the whole body, without those that
    /// lead a path and, beside others, those of chains; those on joints are where the FK pose has
    /// them.
    pub fn targets_at(&self, time: f64) -> Vec<ChainTarget> {
        let fk = self.fk_at(time);
        let enabled = self.targets.iter().filter(|it| it.enabled && !self.leads_path(it));
        let (chains, others): (Vec<_>, Vec<_>) = enabled.partition(|target| target.kind.is_chain());
        let targets = if others.is_empty() { chains } else { others };
        targets.into_iter().map(|target| self.tip_target(target, &fk, time)).collect()
    }

    /// Writes the pose of [`SkeletonRig::skeleton_at`] into an existing pose, reusing its memory.
    pub fn write_pose(&self, time: f64, pose: &mut SkeletonPose) {
        let is_solved = self.targets.iter().any(|target| self.is_solved_for(target));
        if is_solved || self.active_balance().is_some() || self.fk_stretches().next().is_some() {
            self.skeleton_at(time).write_pose(pose);
        } else {
            self.write_fk(time, pose);
        }
    }

    /// True if an enabled target or the skeleton moves over time without keys.
    pub fn is_moving(&self) -> bool {
        let moves = |target: &Target| target.enabled && target.is_moving();
        let mut paths = self.follow_paths.iter();
        paths.any(|path| matches!(path.kind, PathKind::Ring(_))) || self.targets.iter().any(moves)
    }

    /// True if any joint has a bone, that is, an axis of non-zero length.
    pub fn has_bones(&self) -> bool {
        self.skeleton.joints().iter().any(|joint| joint.axis != Vec3::ZERO)
    }

    /// Renumbers the joints of targets, paths and the skin after an edit of the skeleton; drops the
    /// targets of removed joints, and the paths of joints that are no roots any more.
    pub fn remap(&mut self, remap: &JointRemap) {
        self.targets = self.targets.iter().filter_map(|target| target.remapped(remap)).collect();
        self.posture = self.posture.as_ref().map(|posture| posture.remapped(remap).into());
        self.skin = self.skin.as_ref().map(|skin| skin.remapped(remap, &self.skeleton));
        let is_root =
            |root: &JointId| self.skeleton.joint(*root).is_some_and(|it| it.parent.is_none());
        self.follow_paths = self
            .follow_paths
            .iter()
            .filter_map(|path| {
                Some(FollowPath { root: remap.get(path.root).filter(is_root)?, ..*path })
            })
            .collect();
    }

    /// The weight of a morph target of the skin; `None` if there is no such target.
    pub fn morph_weight(&self, morph: usize) -> Option<f32> {
        self.skin.as_ref()?.mesh_skin()?.morph_weight(morph)
    }

    /// Sets the weight of a morph target of the skin; ignored if there is no such target.
    pub fn set_morph_weight(&mut self, morph: usize, weight: f32) {
        if let Some(Skin { source: SkinSource::Mesh(mesh), .. }) = &mut self.skin {
            mesh.set_morph_weight(morph, weight);
        }
    }

    /// Makes a skin from bones again if the bind pose or its shape have changed since it was made,
    /// and measures one from a file again if the bones have.
    pub fn refresh_skin(&mut self) {
        let refreshed = self.skin.as_ref().and_then(|skin| skin.refreshed(&self.skeleton));
        if refreshed.is_some() {
            self.skin = refreshed;
        }
    }
}

/// Size of the skeleton, and the grid and bounding spheres that fit it.
impl SkeletonRig {
    /// Radius of the path of a new target, in world units.
    pub fn default_path_radius(&self) -> f32 {
        const FRACTION: f32 = 0.15;
        FRACTION * self.reach()
    }

    /// Length in the world of the longest chain from a root to a tip along bones and offsets: a
    /// measure of the skeleton's size. It is 1 if that length is 0 or overflows.
    pub fn reach(&self) -> f32 {
        self.reach_in(&mut Vec::new())
    }

    /// Length in the world of the path from a joint's root to its tip, along bones and offsets, by
    /// the transform's mean scale; 0 for a missing joint.
    pub fn length_to(&self, joint: JointId) -> f32 {
        let Some(last) = self.skeleton.joint(joint) else { return 0.0 };
        let above = self.skeleton.ancestors(joint).map(|joint| &self.skeleton[joint]);
        let offsets = above.filter(|joint| joint.parent.is_some()).map(|it| it.offset.length());
        (last.axis.length() + offsets.sum::<f32>()) * self.scale()
    }

    /// The mean scale of the skeleton's transform.
    pub(super) fn scale(&self) -> f32 {
        self.skeleton.transform().matrix3.determinant().abs().cbrt()
    }

    /// [`SkeletonRig::reach`] with a buffer for intermediate results.
    pub fn reach_in(&self, reach: &mut Vec<f32>) -> f32 {
        let joints = self.skeleton.joints();
        reach.clear();
        reach.resize(joints.len(), 0.0);
        let mut farthest = 0.0_f32;
        for (index, joint) in joints.iter().enumerate() {
            let above =
                joint.parent.map_or(0.0, |parent| reach[parent.index()] + joint.offset.length());
            reach[index] = above;
            farthest = farthest.max(above + joint.axis.length());
        }
        let axes = self.skeleton.transform().matrix3;
        let scale = [axes.x_axis, axes.y_axis, axes.z_axis].map(Vec3A::length);
        let reach = farthest * scale.into_iter().fold(0.0, f32::max);
        if reach.is_finite() && reach > 0.0 { reach } else { 1.0 }
    }

    /// Width of a cell of the grid around a skeleton of this reach: the largest power of ten that
    /// is at most half the reach.
    pub fn grid_cell_for(reach: f32) -> f32 {
        let cell = 10_f32.powf((reach * 0.5).log10().floor());
        if cell.is_normal() { cell } else { 1.0 }
    }

    /// Centre and radius of a bounding sphere of a pose, the targets at a time in seconds, the
    /// followed path and a skin from a file, in the world. The radius is at least a quarter of the
    /// reach.
    pub fn bounds(&self, pose: &SkeletonPose, time: f64) -> (Vec3, f32) {
        self.bounds_with_reach(self.reach(), pose, time)
    }

    /// [`SkeletonRig::bounds`] for a `reach` that the caller has already computed.
    pub fn bounds_with_reach(&self, reach: f32, pose: &SkeletonPose, time: f64) -> (Vec3, f32) {
        let place = |target: &Target| match target.present_space().joint() {
            Some(joint) => pose.full(joint).transform_point3(target.at(time)),
            None => target.at(time),
        };
        let targets = self.targets.iter().map(place);
        let path = self.path_points();
        // A skin from bones is about as large as the bones, and may not have been made yet.
        let skin = self.skin.as_ref().and_then(Skin::file_mesh);
        let skin = skin.into_iter().flat_map(|mesh| mesh.corners(pose));
        let points = pose.points().chain(targets).chain(path).chain(skin);
        let (centre, radius) = bounding_sphere(points).unwrap_or_default();
        // Joints without bones have no reach, but a mesh has a size.
        let least = if self.has_bones() || radius == 0.0 { 0.25 * reach } else { 0.0 };
        (centre, radius.max(least))
    }

    /// Centre and radius of a bounding sphere of the bones of some joints, in the world; `None`
    /// without joints.
    pub fn bounds_of(&self, pose: &SkeletonPose, joints: &[JointId]) -> Option<(Vec3, f32)> {
        let ends = joints.iter().flat_map(|joint| [pose.base(*joint), pose.tip(*joint)]);
        let (centre, radius) = bounding_sphere(ends)?;
        Some((centre, radius.max(0.05 * self.reach())))
    }
}

/// Centre and radius of the sphere around the bounding box of the finite points; `None` without
/// finite points.
fn bounding_sphere(points: impl Iterator<Item = Vec3>) -> Option<(Vec3, f32)> {
    let (low, high) = points
        .filter(|point| point.is_finite())
        .map(|point| (point, point))
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    // Halved first, so that the sum does not overflow.
    let (low, high) = (low * 0.5, high * 0.5);
    Some((low + high, low.distance(high).min(f32::MAX)))
}

impl Default for SkeletonRig {
    /// A new skeleton: one root to add joints to.
    fn default() -> Self {
        Self::new(Skeleton::with_root("root"))
    }
}
