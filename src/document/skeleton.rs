use core::f32::consts::TAU;

use glam::{Vec3, Vec3A};
use serde::{Deserialize, Serialize};

use super::{Camera, FollowPath, Shared};
use crate::kinematics::chain_ik::{self, SolverOptions};
use crate::kinematics::skeleton::{JointId, JointRemap, Skeleton, SkeletonPose};

/// A skeleton with its targets, and how it is brought to them.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonRig {
    pub skeleton: Shared<Skeleton>,
    /// At most one for a joint.
    pub targets: Vec<Target>,
    pub solver: SolverOptions,
    /// How many iterations a running solver makes between two pictures.
    pub iterations_per_frame: u32,
    /// The first root's chain follows its head along a path, as a function of time.
    pub follow_path: Option<FollowPath>,
}

/// Where the tip of a joint's bone is asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    pub joint: JointId,
    /// Where it is at time 0, in the world.
    pub home: Vec3,
    pub weight: f32,
    pub enabled: bool,
    pub motion: TargetMotion,
}

/// How a target moves by itself: a curve in the plane that faces +z, through the target's home.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetMotion {
    pub path: TargetPath,
    /// In the world.
    pub radius: f32,
    /// How long once around takes, in seconds.
    pub period: f32,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TargetPath {
    #[default]
    Still,
    Circle,
    FigureEight,
}

impl TargetMotion {
    /// A target that stays, and would go around at such a radius if it went.
    pub fn still(radius: f32) -> Self {
        Self { path: TargetPath::Still, radius, period: 4.0 }
    }

    /// How far from home, at a time in seconds; nothing at 0.
    pub fn offset(&self, time: f64) -> Vec3 {
        let turn = (time / f64::from(self.period)).fract() as f32 * TAU;
        let (sin, cos) = turn.sin_cos();
        self.radius
            * match self.path {
                TargetPath::Still => Vec3::ZERO,
                TargetPath::Circle => Vec3::new(sin, cos - 1.0, 0.0),
                // The lemniscate of Gerono.
                TargetPath::FigureEight => Vec3::new(sin, sin * cos, 0.0),
            }
    }
}

impl Target {
    /// An enabled target that stays.
    pub fn new(joint: JointId, home: Vec3, radius: f32) -> Self {
        Self { joint, home, weight: 1.0, enabled: true, motion: TargetMotion::still(radius) }
    }

    pub fn at(&self, time: f64) -> Vec3 {
        self.home + self.motion.offset(time)
    }
}

impl SkeletonRig {
    /// How many iterations a frame can have.
    pub const MOST_ITERATIONS_PER_FRAME: u32 = 1000;

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

    /// The joints, to change; copied first if other rigs share them.
    pub fn skeleton_mut(&mut self) -> &mut Skeleton {
        self.skeleton.make_mut()
    }

    /// From where all of it is seen at time 0.
    pub fn first_view(&self) -> Camera {
        let (centre, radius) = self.bounds(&self.at(0.0).pose(), 0.0);
        Camera::default().framing(centre, radius, 1.0)
    }

    /// How large the circle of a new target is.
    pub fn circle(&self) -> f32 {
        const PART: f32 = 0.15;
        PART * self.reach()
    }

    /// Whether any joint is more than a point.
    pub fn has_bones(&self) -> bool {
        self.skeleton.joints().iter().any(|joint| joint.axis != Vec3::ZERO)
    }

    /// The target of a joint.
    pub fn target(&self, joint: JointId) -> Option<usize> {
        self.targets.iter().position(|target| target.joint == joint)
    }

    /// What a solver is asked for at a time: the targets that are switched on.
    pub fn goals(&self, time: f64) -> Vec<chain_ik::TipTarget> {
        let enabled = self.targets.iter().filter(|target| target.enabled);
        let goal = |target: &Target| chain_ik::TipTarget {
            joint: target.joint,
            point: target.at(time),
            weight: target.weight,
        };
        enabled.map(goal).collect()
    }

    /// The skeleton as it stands at a time.
    pub fn at(&self, time: f64) -> Shared<Skeleton> {
        match &self.follow_path {
            None => self.skeleton.clone(),
            Some(follow_path) => Shared::from(follow_path.pose(&self.skeleton, time)),
        }
    }

    /// Writes the transforms of all joints at a time into another pose, in its memory.
    pub fn write_pose(&self, time: f64, pose: &mut SkeletonPose) {
        match &self.follow_path {
            None => self.skeleton.write_pose(pose),
            Some(follow_path) => follow_path.write_pose(&self.skeleton, time, pose),
        }
    }

    /// Whether anything moves by itself.
    pub fn is_moving(&self) -> bool {
        let moves = |target: &Target| target.enabled && target.motion.path != TargetPath::Still;
        self.follow_path.is_some() || self.targets.iter().any(moves)
    }

    /// Lets the targets follow their joints to new places; those whose joints are gone go too.
    pub fn follow(&mut self, moved: &JointRemap) {
        self.targets.retain_mut(|target| {
            moved.get(target.joint).map(|joint| target.joint = joint).is_some()
        });
    }

    /// How far the skeleton's bones and the offsets between them reach from its roots, in the world:
    /// what its size is measured by.
    pub fn reach(&self) -> f32 {
        self.reach_in(&mut Vec::new())
    }

    /// [`SkeletonRig::reach`], worked out in some memory.
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
        let scale = self.skeleton.transform().matrix3;
        let stretch = [scale.x_axis, scale.y_axis, scale.z_axis].map(Vec3A::length);
        let reach = farthest * stretch.into_iter().fold(0.0, f32::max);
        if reach.is_finite() && reach > 0.0 { reach } else { 1.0 }
    }

    /// How wide a grid's cells are around a skeleton that reaches so far: the power of ten that goes 2
    /// to 20 times into it.
    pub(crate) fn cell(reach: f32) -> f32 {
        let cell = 10_f32.powf((reach * 0.5).log10().floor());
        if cell.is_normal() { cell } else { 1.0 }
    }

    /// A sphere around a pose and the targets, in the world: centre and radius.
    pub fn bounds(&self, pose: &SkeletonPose, time: f64) -> (Vec3, f32) {
        self.bounds_with(self.reach(), pose, time)
    }

    /// [`SkeletonRig::bounds`] of one whose reach is known.
    pub(crate) fn bounds_with(&self, reach: f32, pose: &SkeletonPose, time: f64) -> (Vec3, f32) {
        let targets = self.targets.iter().map(|target| target.at(time));
        let way =
            self.follow_path.iter().flat_map(|follow_path| follow_path.corners(&self.skeleton));
        let all = pose.points().chain(targets).chain(way);
        let (centre, radius) = around(all).unwrap_or_default();
        (centre, radius.max(0.25 * reach))
    }

    /// A sphere around the bones of some joints, if there are any.
    pub fn bounds_of(&self, pose: &SkeletonPose, joints: &[JointId]) -> Option<(Vec3, f32)> {
        let ends = joints.iter().flat_map(|joint| [pose.base(*joint), pose.tip(*joint)]);
        let (centre, radius) = around(ends)?;
        Some((centre, radius.max(0.05 * self.reach())))
    }
}

/// The sphere around the box around points.
fn around(points: impl Iterator<Item = Vec3>) -> Option<(Vec3, f32)> {
    let (low, high) = points
        .filter(|point| point.is_finite())
        .map(|point| (point, point))
        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    // Halved first: a sum would be beyond numbers where they end.
    let (low, high) = (low * 0.5, high * 0.5);
    Some((low + high, low.distance(high).min(f32::MAX)))
}

impl Default for SkeletonRig {
    /// A new skeleton: a root to hang joints from.
    fn default() -> Self {
        Self::new(Skeleton::with_root("root"))
    }
}
