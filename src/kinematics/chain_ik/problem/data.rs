use glam::{DAffine3, DMat3, DVec3, Mat3A, Vec3, Vec3A};

use crate::kinematics::chain_ik::TipTarget;
use crate::kinematics::skeleton::{JointId, Limit};

/// A joint that rotates, and all that is rigidly attached to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    pub joint: JointId,
    /// `None` if all joints above are locked.
    pub parent: Option<usize>,
    pub tree: usize,
    /// In the parent's space.
    pub pivot: Vec3A,
    pub mount: Mat3A,
    pub limits: [Option<Limit>; 3],
    /// The end effectors at and below it, as a range of [`Problem::below`].
    pub below: (usize, usize),
    /// Angles before the solve.
    pub start: Vec3,
}

impl Link {
    pub fn is_limited(&self) -> bool {
        self.limits.iter().any(Option::is_some)
    }
}

/// A tip with its target.
#[derive(Clone, Debug, PartialEq)]
pub struct EndEffector {
    pub joint: JointId,
    /// `None` if the joint and all above are locked.
    pub link: Option<usize>,
    pub tree: usize,
    /// In the link's space.
    pub tip: Vec3A,
    /// The target, pulled in to `max_distance` from the tree's origin.
    pub target: Vec3A,
    /// The target before it is pulled in.
    pub requested: DVec3,
    /// At most 1.
    pub weight: f32,
    pub max_distance: f64,
}

/// A root and its descendants.
#[derive(Clone, Debug, PartialEq)]
pub struct KinematicTree {
    pub root: JointId,
    /// The root's offset before it moves, in skeleton space.
    pub origin: DVec3,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Parents before children.
    pub links: Vec<Link>,
    pub effectors: Vec<EndEffector>,
    pub trees: Vec<KinematicTree>,
    /// End effectors at and below every link, one list after the other.
    pub below: Vec<usize>,
    pub free_roots: bool,
    /// Length of the longest path from a root to a tip.
    pub length: f32,
    /// τ⁻¹ of the transpose: Σ w r² in the bind pose.
    pub inertia: f32,
    pub(super) to_skeleton: DAffine3,
    pub(super) to_world: DMat3,
    /// Factor from skeleton units to the problem's.
    pub(super) unit: f64,
}

impl Problem {
    /// The end effectors at and below a link.
    pub fn below(&self, link: &Link) -> &[usize] {
        &self.below[link.below.0..link.below.1]
    }

    /// Length of the chain in the world, by the transform's mean scale.
    pub fn world_length(&self) -> f64 {
        f64::from(self.length) / self.unit * self.scale()
    }

    /// Converts a length from the world's units to the problem's, by the transform's mean scale.
    pub fn length_from_world(&self, length: f64) -> f64 {
        length / self.scale() * self.unit
    }

    fn scale(&self) -> f64 {
        self.to_world.determinant().abs().cbrt()
    }

    /// Distance from a tip to its requested target, in the world.
    pub fn error(&self, effector: &EndEffector, tip: Vec3A) -> f64 {
        let residual = (tip.as_dvec3() - effector.requested) / self.unit;
        (self.to_world * residual).length()
    }

    pub fn set_targets(&mut self, targets: &[TipTarget]) {
        for (effector, target) in self.effectors.iter_mut().zip(targets) {
            let point = self.to_skeleton.transform_point3(target.point.as_dvec3());
            effector.requested = (point - self.trees[effector.tree].origin) * self.unit;
            effector.target = effector.requested.clamp_length_max(effector.max_distance).as_vec3a();
        }
    }

    /// Sets targets and moves the origins of trees out of reach to one chain length from them, within
    /// the range of f32: coordinates near the origin are exact.
    pub fn approach(&mut self, targets: &[TipTarget], tips: &[Vec3A]) {
        for tree in 0..self.trees.len() {
            let residual = self.mean_residual(tree, tips);
            let most = f64::from(self.length);
            let distance = residual.length();
            if distance > 2.0 * most {
                let by = residual * ((distance - most) / distance / self.unit);
                let origin = &mut self.trees[tree].origin;
                *origin = clamp_to_f32(*origin + by);
            }
        }
        self.set_targets(targets);
    }

    /// Mean vector from the tips of a tree to their requested targets.
    fn mean_residual(&self, tree: usize, tips: &[Vec3A]) -> DVec3 {
        let of_tree = self.effectors.iter().zip(tips).filter(|(effector, _)| effector.tree == tree);
        let (sum, weight) = of_tree.fold((DVec3::ZERO, 0.0), |(sum, all), (effector, tip)| {
            let weight = f64::from(effector.weight);
            (sum + (effector.requested - tip.as_dvec3()) * weight, all + weight)
        });
        sum / weight
    }

    /// Whether the offset of a shifted root is finite in f32.
    pub fn can_shift(&self, tree: usize, shift: Vec3A) -> bool {
        (self.trees[tree].origin + shift.as_dvec3() / self.unit).as_vec3().is_finite()
    }

    /// Offset of a shifted root, in skeleton space.
    pub fn root_offset(&self, tree: usize, shift: Vec3A) -> Vec3 {
        let offset = self.trees[tree].origin + shift.as_dvec3() / self.unit;
        clamp_to_f32(offset).as_vec3()
    }

    pub(super) fn scaled(&self, v: Vec3) -> Vec3A {
        (v.as_dvec3() * self.unit).as_vec3a()
    }
}

fn clamp_to_f32(point: DVec3) -> DVec3 {
    point.clamp(Vec3::MIN.as_dvec3(), Vec3::MAX.as_dvec3())
}
