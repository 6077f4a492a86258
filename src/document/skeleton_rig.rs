use glam::{Vec3, Vec3A};

use super::camera::Camera;
use super::follow_path::FollowPath;
use super::target::{Target, TargetPath};
use crate::kinematics::Shared;
use crate::kinematics::chain_ik::{SolverOptions, TipTarget};
use crate::kinematics::skeleton::{JointId, JointRemap, Skeleton, SkeletonPose};

/// The skeleton with its targets and the options of its solver.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonRig {
    /// The joints.
    pub skeleton: Shared<Skeleton>,
    /// Targets of tips, at most one for a joint.
    pub targets: Vec<Target>,
    /// Options of the solver.
    pub solver: SolverOptions,
    /// Iterations of a solver run per frame.
    pub iterations_per_frame: u32,
    /// A path that the chain of the first root follows in time; there are no targets to solve for then.
    pub follow_path: Option<FollowPath>,
}

impl SkeletonRig {
    /// Maximum of `iterations_per_frame`.
    pub const MAX_ITERATIONS_PER_FRAME: u32 = 1000;

    /// A skeleton without targets.
    pub fn new(skeleton: Skeleton) -> Self {
        Self {
            skeleton: Shared::from(skeleton),
            targets: Vec::new(),
            solver: SolverOptions::default(),
            iterations_per_frame: 1,
            follow_path: None,
        }
    }

    /// The joints for an edit; copied first if other rigs share them.
    pub fn skeleton_mut(&mut self) -> &mut Skeleton {
        self.skeleton.make_mut()
    }

    /// Index of a joint's target.
    pub fn target(&self, joint: JointId) -> Option<usize> {
        self.targets.iter().position(|target| target.joint == joint)
    }

    /// The enabled targets at a time in seconds, for a solver.
    pub fn targets_at(&self, time: f64) -> Vec<TipTarget> {
        let enabled = self.targets.iter().filter(|target| target.enabled);
        let target_at = |target: &Target| TipTarget {
            joint: target.joint,
            point: target.at(time),
            weight: target.weight,
        };
        enabled.map(target_at).collect()
    }

    /// The skeleton at a time in seconds: on its path, if it follows one.
    pub fn skeleton_at(&self, time: f64) -> Shared<Skeleton> {
        match &self.follow_path {
            None => self.skeleton.clone(),
            Some(follow_path) => Shared::from(follow_path.pose(&self.skeleton, time)),
        }
    }

    /// Writes the pose of [`SkeletonRig::skeleton_at`] into another pose, in its memory.
    pub fn write_pose(&self, time: f64, pose: &mut SkeletonPose) {
        match &self.follow_path {
            None => self.skeleton.write_pose(pose),
            Some(follow_path) => follow_path.write_pose(&self.skeleton, time, pose),
        }
    }

    /// Whether a target or the skeleton moves without keys.
    pub fn is_moving(&self) -> bool {
        let moves = |target: &Target| target.enabled && target.motion.path != TargetPath::Still;
        self.follow_path.is_some() || self.targets.iter().any(moves)
    }

    /// Whether any joint has a bone rather than being a point.
    pub fn has_bones(&self) -> bool {
        self.skeleton.joints().iter().any(|joint| joint.axis != Vec3::ZERO)
    }

    /// Renumbers the joints of the targets; drops the targets of removed joints.
    pub fn remap(&mut self, remap: &JointRemap) {
        self.targets.retain_mut(|target| {
            remap.get(target.joint).map(|joint| target.joint = joint).is_some()
        });
    }
}

/// Sizes and views.
impl SkeletonRig {
    /// A camera that frames the skeleton and its targets at time 0.
    pub fn default_camera(&self) -> Camera {
        let (centre, radius) = self.bounds(&self.skeleton_at(0.0).pose(), 0.0);
        Camera::default().framing(centre, radius, 1.0)
    }

    /// Radius of the path of a new target.
    pub fn default_path_radius(&self) -> f32 {
        const FRACTION: f32 = 0.15;
        FRACTION * self.reach()
    }

    /// Maximum length of a chain from a root to a tip along bones and offsets, in the world: the size of
    /// the skeleton.
    pub fn reach(&self) -> f32 {
        self.reach_in(&mut Vec::new())
    }

    /// [`SkeletonRig::reach`], computed in `reach`.
    pub(crate) fn reach_in(&self, reach: &mut Vec<f32>) -> f32 {
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

    /// Width of a cell of the grid around a skeleton of this reach: the power of ten that fits into it 2
    /// to 20 times.
    pub(crate) fn grid_cell_for(reach: f32) -> f32 {
        let cell = 10_f32.powf((reach * 0.5).log10().floor());
        if cell.is_normal() { cell } else { 1.0 }
    }

    /// Bounding sphere of a pose, the targets at a time and the path, in the world: centre and radius.
    pub fn bounds(&self, pose: &SkeletonPose, time: f64) -> (Vec3, f32) {
        self.bounds_with_reach(self.reach(), pose, time)
    }

    /// [`SkeletonRig::bounds`] with a reach that is known.
    pub(crate) fn bounds_with_reach(
        &self,
        reach: f32,
        pose: &SkeletonPose,
        time: f64,
    ) -> (Vec3, f32) {
        let targets = self.targets.iter().map(|target| target.at(time));
        let path = self.follow_path.iter().flat_map(|path| path.corners(&self.skeleton));
        let (centre, radius) =
            bounding_sphere(pose.points().chain(targets).chain(path)).unwrap_or_default();
        (centre, radius.max(0.25 * reach))
    }

    /// Bounding sphere of the bones of some joints; `None` without joints.
    pub fn bounds_of(&self, pose: &SkeletonPose, joints: &[JointId]) -> Option<(Vec3, f32)> {
        let ends = joints.iter().flat_map(|joint| [pose.base(*joint), pose.tip(*joint)]);
        let (centre, radius) = bounding_sphere(ends)?;
        Some((centre, radius.max(0.05 * self.reach())))
    }
}

/// The sphere around the bounding box of the finite points.
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
