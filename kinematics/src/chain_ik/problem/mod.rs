//! A skeleton in the form on which solvers work: it has only the joints between targets and roots,
//! every locked joint is fused with its parent, and lengths are scaled to near 1.
//!
//! A link rotates about its pivot by E = R_z · R_y · R_x alone: the frame A of its joint is
//! absorbed into the constant transforms before and after E. With G the orientation of a link in
//! skeleton space,
//!
//! ```text
//! G = G(parent) · mount · E        base = base(parent) + G(parent) · pivot
//! ```
//!
//! Points are in problem space: skeleton space relative to the tree's origin (its root's offset),
//! times a power of two that brings the chain's length to 1 … 2, so that huge and tiny skeletons
//! solve like others.

mod build;

use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3A, Quat, Vec3, Vec3A};

use crate::skeleton::{JointId, JointLimits, RotationAxis};

pub(super) use build::{Builder, check_target};

/// A target for a joint: a place for the tip of its bone, and an orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ChainTarget {
    /// The joint.
    pub joint: JointId,
    /// Place for the joint's tip, in the world.
    pub point: Vec3,
    /// Weight of the place relative to other targets; 0 lets the tip be anywhere, if there is an
    /// orientation.
    pub weight: f32,
    /// Orientation of the joint; `None` for any.
    pub orientation: Option<Orientation>,
    /// Weight of the orientation relative to other weights, 0 or more. A turn by 1 radian counts
    /// like a distance of a quarter of the chain's length.
    pub orientation_weight: f32,
}

/// An orientation that a joint is to have.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Orientation {
    /// The rotation of the joint's space in skeleton space, that of
    /// [`Skeleton::pose_in_skeleton`](crate::skeleton::Skeleton::pose_in_skeleton).
    Rotation(Quat),
    /// The line from the joint's base along an axis goes through a point.
    Aim {
        /// Axis in the joint's space, of any length above 0.
        axis: Vec3,
        /// The point in the world.
        point: Vec3,
    },
}

impl ChainTarget {
    /// A place for the tip of a joint, in the world, with the weight 1.
    #[must_use]
    pub const fn at(joint: JointId, point: Vec3) -> Self {
        Self { joint, point, weight: 1.0, orientation: None, orientation_weight: 1.0 }
    }

    /// An orientation of a joint, with the weight 1, and any place for its tip.
    #[must_use]
    pub const fn turned(joint: JointId, orientation: Orientation) -> Self {
        Self { weight: 0.0, ..Self::at(joint, Vec3::ZERO).with_orientation(orientation) }
    }

    /// This target with another weight of the place.
    #[must_use]
    pub const fn with_weight(self, weight: f32) -> Self {
        Self { weight, ..self }
    }

    /// This target with an orientation.
    #[must_use]
    pub const fn with_orientation(self, orientation: Orientation) -> Self {
        Self { orientation: Some(orientation), ..self }
    }

    /// This target with another weight of the orientation.
    #[must_use]
    pub const fn with_orientation_weight(self, orientation_weight: f32) -> Self {
        Self { orientation_weight, ..self }
    }
}

/// A joint that rotates, with everything that is rigidly attached to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    pub joint: JointId,
    /// Index of the parent link; `None` if all joints above are locked.
    pub parent: Option<usize>,
    pub tree: usize,
    /// Position of the link's joint in the parent link's space; without a parent link, relative to
    /// the tree's origin.
    pub pivot: Vec3A,
    pub mount: Mat3A,
    pub limits: JointLimits,
    /// 1 − k with the stiffness k of each angle: the turns about x, y and z by the same effort.
    pub compliance: Vec3A,
    /// End effectors at the link and below, as a range of [`Problem::below`].
    pub below: (usize, usize),
    /// Euler angles before the run, in radians.
    pub start: Vec3,
}

impl Link {
    /// The compliance of all angles that the limits let change; `None` if they differ.
    pub fn uniform_compliance(&self) -> Option<f32> {
        let movable = RotationAxis::ALL.into_iter().filter(|axis| !self.limits.is_fixed(*axis));
        let mut compliances = movable.map(|axis| self.compliance[axis.index()]);
        let first = compliances.next().unwrap_or(1.0);
        compliances.all(|other| other == first).then_some(first)
    }

    /// The fraction of a turn that a method makes of this link that turns joints as a whole.
    pub fn part_of_turn(&self) -> f32 {
        self.uniform_compliance().unwrap_or(1.0)
    }

    /// True if an angle is stiff.
    pub fn is_stiff(&self) -> bool {
        self.compliance != Vec3A::ONE
    }
}

/// A joint with its target.
#[derive(Clone, Debug, PartialEq)]
pub struct EndEffector {
    pub joint: JointId,
    /// Index of the link that moves the tip; `None` if the joint and all joints above are locked.
    pub link: Option<usize>,
    pub tree: usize,
    /// Position of the tip in the link's space; without a link, relative to the tree's origin.
    pub tip: Vec3A,
    /// Position to which solvers move the tip, in problem space: `requested`, or, if that is
    /// farther than `max_distance` from the tree's origin, the point at `max_distance` in the same
    /// direction.
    pub target: Vec3A,
    /// Position of the caller's target, in problem space.
    pub requested: DVec3,
    /// Weight of the place as a fraction of the greatest weight, at most 1; 0 if the place is free.
    pub weight: f32,
    /// The joint's space from the link's space; without a link, relative to the tree's origin.
    pub space: Affine3A,
    pub orientation: Option<Orienting>,
    /// Maximum distance of `target` from the tree's origin, in the problem's units.
    pub max_distance: f64,
}

/// The orientation that a target asks for, in problem space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orienting {
    pub wanted: Wanted,
    /// w ℓ², with the weight as a fraction of the greatest weight.
    pub stiffness: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// The orientation G of the link.
    Rotation(Quat),
    /// The line from the joint's base along a unit vector in the link's space goes through a point.
    Aim { axis: Vec3A, point: Vec3A },
}

/// A root and its descendants.
#[derive(Clone, Debug, PartialEq)]
pub struct KinematicTree {
    pub root: JointId,
    /// The root's offset in the FK pose, in skeleton space.
    pub offset: DVec3,
    /// Origin of the tree's points, in skeleton space: the root's offset before the run, until
    /// [`Problem::approach`] moves the origin.
    pub origin: DVec3,
}

/// A skeleton with targets, in the form on which solvers work: see the module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// All links, parents before children.
    pub links: Vec<Link>,
    pub effectors: Vec<EndEffector>,
    pub trees: Vec<KinematicTree>,
    /// Indices of the end effectors at each link and below, one list after the other.
    pub below: Vec<usize>,
    pub free_roots: bool,
    /// Length of the longest path from a root to a tip, in the problem's units.
    pub length: f32,
    /// Σ w r² in the bind pose, the reciprocal of the transpose method's step τ.
    pub inertia: f32,
    to_skeleton: DAffine3,
    to_world: DMat3,
    /// Factor from skeleton units to the problem's units.
    unit: f64,
    /// The greatest weight of a target.
    heaviest: f32,
    /// True if a target asks for an orientation.
    pub orients: bool,
    /// Sum of the weights of places and orientations, above 0.
    pub weights: f64,
}

/// The length ℓ by which turns are compared with distances, in lengths of the chain: a turn by one
/// radian counts like this distance.
const TURN_LENGTH: f64 = 0.25;

impl Problem {
    /// True if a target asks for an aim.
    pub fn aims(&self) -> bool {
        let is_aim = |orienting: &Orienting| matches!(orienting.wanted, Wanted::Aim { .. });
        self.effectors.iter().any(|effector| effector.orientation.as_ref().is_some_and(is_aim))
    }

    /// Distance beyond which points lose the tips' positions to rounding, in the problem's units.
    fn farthest(&self) -> f64 {
        1e4 * f64::from(self.length.max(1.0))
    }

    /// ℓ in the problem's units.
    pub fn turn_length(&self) -> f64 {
        TURN_LENGTH * f64::from(self.length)
    }

    /// ℓ in world units.
    pub fn turn_length_in_world(&self) -> f64 {
        TURN_LENGTH * self.world_length()
    }

    /// Indices of the end effectors at a link and below.
    pub fn below(&self, link: &Link) -> &[usize] {
        &self.below[link.below.0..link.below.1]
    }

    /// Length of the longest path from a root to a tip in world units, by the transform's mean
    /// scale.
    pub fn world_length(&self) -> f64 {
        f64::from(self.length) / self.unit * self.scale()
    }

    /// Factor from skeleton units to the problem's units.
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// Converts a length from the world's units to the problem's, by the transform's mean scale.
    pub fn length_from_world(&self, length: f64) -> f64 {
        length / self.scale() * self.unit
    }

    fn scale(&self) -> f64 {
        self.to_world.determinant().abs().cbrt()
    }

    /// Converts a length from the problem's units to the world's, by the transform's mean scale.
    pub fn length_to_world(&self, length: f64) -> f64 {
        length / self.unit * self.scale()
    }

    /// Vectors from all requested places to their tips, in the world; zero for free places.
    pub fn residuals<'a>(&'a self, tips: &'a [Vec3A]) -> impl Iterator<Item = DVec3> + 'a {
        self.effectors.iter().zip(tips).map(|(effector, tip)| match effector.weight {
            0.0 => DVec3::ZERO,
            _ => self.to_world * ((tip.as_dvec3() - effector.requested) / self.unit),
        })
    }

    /// Keeps the ways of free roots from their offsets in the FK pose in a problem before this one,
    /// which was built anew for other offsets.
    pub fn carry_origins(&mut self, before: &Self) {
        for (tree, before) in self.trees.iter_mut().zip(&before.trees) {
            tree.origin = before.origin + (tree.offset - before.offset);
        }
    }

    pub fn set_targets(&mut self, targets: &[ChainTarget]) {
        let (farthest, square) = (self.farthest(), self.turn_length().powi(2));
        for (effector, target) in self.effectors.iter_mut().zip(targets) {
            let origin = self.trees[effector.tree].origin;
            let place = |point: Vec3| {
                (self.to_skeleton.transform_point3(point.as_dvec3()) - origin) * self.unit
            };
            effector.requested = place(target.point);
            effector.target = effector.requested.clamp_length_max(effector.max_distance).as_vec3a();
            effector.orientation = target.orientation.map(|orientation| Orienting {
                wanted: match orientation {
                    Orientation::Rotation(rotation) => {
                        let space = Quat::from_mat3a(&effector.space.matrix3);
                        Wanted::Rotation(rotation.normalize() * space.inverse())
                    }
                    Orientation::Aim { axis, point } => {
                        let axis = axis.as_dvec3().normalize_or_zero().as_vec3a();
                        let point = place(point).clamp_length_max(farthest);
                        let axis = effector.space.matrix3 * axis;
                        Wanted::Aim { axis, point: point.as_vec3a() }
                    }
                },
                stiffness: target.orientation_weight / self.heaviest * square as f32,
            });
        }
        self.orients = self.effectors.iter().any(|effector| effector.orientation.is_some());
        let square = square.max(f64::MIN_POSITIVE);
        let weight = |effector: &EndEffector| {
            let stiffness = effector.orientation.map_or(0.0, |it| f64::from(it.stiffness));
            f64::from(effector.weight) + stiffness / square
        };
        let weights: f64 = self.effectors.iter().map(weight).sum();
        self.weights = weights.max(f64::MIN_POSITIVE);
    }

    /// Rotations from links' spaces to their parents', without the links' own rotations.
    pub fn mounts(&self) -> impl Iterator<Item = Quat> + '_ {
        self.links.iter().map(|link| Quat::from_mat3a(&link.mount))
    }

    /// Sets the targets. If a tree is farther than two chain lengths from its targets, moves its
    /// origin to one chain length from them, within the range of f32, because coordinates are exact
    /// near the origin only.
    pub fn approach(&mut self, targets: &[ChainTarget], tips: &[Vec3A]) {
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

    /// Weighted mean vector from the tips of a tree to their requested targets, in the problem's
    /// units; zero if all places are free.
    fn mean_residual(&self, tree: usize, tips: &[Vec3A]) -> DVec3 {
        let of_tree = self.effectors.iter().zip(tips).filter(|(effector, _)| effector.tree == tree);
        let (sum, weight) = of_tree.fold((DVec3::ZERO, 0.0), |(sum, all), (effector, tip)| {
            let weight = f64::from(effector.weight);
            (sum + (effector.requested - tip.as_dvec3()) * weight, all + weight)
        });
        if weight > 0.0 { sum / weight } else { DVec3::ZERO }
    }

    /// True if the offset of a tree's root, shifted by `shift`, is finite in f32.
    pub fn can_shift(&self, tree: usize, shift: Vec3A) -> bool {
        (self.trees[tree].origin + shift.as_dvec3() / self.unit).as_vec3().is_finite()
    }

    /// Offset of a tree's root, shifted by `shift`, in skeleton space.
    pub fn root_offset(&self, tree: usize, shift: Vec3A) -> Vec3 {
        let offset = self.trees[tree].origin + shift.as_dvec3() / self.unit;
        clamp_to_f32(offset).as_vec3()
    }

    /// Shift of a tree that brings its root to an offset in skeleton space.
    pub fn shift_to(&self, tree: usize, offset: Vec3) -> Vec3A {
        ((offset.as_dvec3() - self.trees[tree].origin) * self.unit).as_vec3a()
    }

    fn scaled(&self, v: Vec3) -> Vec3A {
        (v.as_dvec3() * self.unit).as_vec3a()
    }
}

fn clamp_to_f32(point: DVec3) -> DVec3 {
    point.clamp(Vec3::MIN.as_dvec3(), Vec3::MAX.as_dvec3())
}
