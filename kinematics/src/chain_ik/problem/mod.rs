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
mod masses;

use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3A, Quat, Vec3, Vec3A};

use crate::normalize;
use crate::skeleton::{JointId, JointLimits, RotationAxis, Skeleton, centre_of_mass_below};

pub(super) use build::{Builder, check_target};
pub(crate) use masses::HeldLimb;
pub(super) use masses::{MassOnLink, Masses};

/// A target for a joint: a place for the tip of its bone, another of its points or the centre of
/// mass below it, and an orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ChainTarget {
    /// The joint.
    pub joint: JointId,
    /// The place, in the world.
    pub point: Vec3,
    /// What goes to the place.
    pub effector: Effector,
    /// Least and greatest distance from the place, in skeleton units, at which it counts as
    /// reached; `[0, 0]` for the place itself.
    pub distances: [f32; 2],
    /// Weight of the place relative to other targets; 0 lets the tip be anywhere, if there is an
    /// orientation.
    pub weight: f32,
    /// Orientation of the joint; `None` for any.
    pub orientation: Option<Orientation>,
    /// Weight of the orientation relative to other weights, 0 or more. A turn by 1 radian counts
    /// like a distance of a quarter of the chain's length.
    pub orientation_weight: f32,
}

/// The point of a joint that goes to the place of a target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum Effector {
    /// The tip of its bone.
    #[default]
    Tip,
    /// A point in the joint's space.
    Grip(Vec3),
    /// The centre of mass of the joint's bone and all bones below it, as
    /// [`Balance`](crate::skeleton::Balance) weighs them. It goes above or below the place: along
    /// the world's y it may be anywhere. Bones whose joints are not between a target and a root move
    /// rigidly with those above.
    CentreOfMass,
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
        Self {
            joint,
            point,
            effector: Effector::Tip,
            distances: [0.0; 2],
            weight: 1.0,
            orientation: None,
            orientation_weight: 1.0,
        }
    }

    /// An orientation of a joint, with the weight 1, and any place for its tip.
    #[must_use]
    pub const fn turned(joint: JointId, orientation: Orientation) -> Self {
        Self { weight: 0.0, ..Self::at(joint, Vec3::ZERO).with_orientation(orientation) }
    }

    /// A place above or below which the centre of mass of a joint and all joints below it is, with
    /// the weight 1: the balance of a body on the ground.
    #[must_use]
    pub const fn balanced(joint: JointId, over: Vec3) -> Self {
        Self { effector: Effector::CentreOfMass, ..Self::at(joint, over) }
    }

    /// True if the centre of mass goes to the place.
    pub(crate) fn is_of_mass(&self) -> bool {
        self.effector == Effector::CentreOfMass
    }

    /// The point in the joint's space that goes to the place; for the centre of mass, the joint's
    /// base.
    pub(super) fn grip_in(&self, skeleton: &Skeleton) -> Vec3 {
        match self.effector {
            Effector::Tip => skeleton[self.joint].axis,
            Effector::Grip(point) => point,
            Effector::CentreOfMass => Vec3::ZERO,
        }
    }

    /// The point that goes to the place, in a pose, in the world.
    pub(crate) fn effector_in(&self, pose: &Skeleton) -> Vec3 {
        match self.effector {
            Effector::CentreOfMass => centre_of_mass_below(pose, self.joint),
            _ => pose.point_in_world(self.joint, self.grip_in(pose)),
        }
    }

    /// Distance in the world from the effector in a pose to the nearest place at which the target is
    /// reached; 0 for a free place.
    pub(super) fn distance_in(&self, pose: &Skeleton) -> f32 {
        pose.transform().transform_vector3(self.residual_in(pose)).length().min(f32::MAX)
    }

    /// Vector from the effector in a pose to the nearest place at which the target is reached, in
    /// skeleton space; zero for a free place.
    pub(super) fn residual_in(&self, pose: &Skeleton) -> Vec3 {
        if self.weight == 0.0 {
            return Vec3::ZERO;
        }
        let to_skeleton = pose.transform().inverse();
        let effector = self.effector_in(pose);
        let mut place = self.point;
        if self.is_of_mass() {
            place.y = effector.y;
        }
        let tip = to_skeleton.transform_point3(effector);
        let point = to_skeleton.transform_point3(place).as_dvec3();
        let nearest = match self.distances {
            [0.0, 0.0] => Some(point),
            distances => nearest_in_shell(point, distances, tip.as_dvec3()),
        };
        nearest.map_or(Vec3::ZERO, |nearest| (nearest - tip.as_dvec3()).as_vec3())
    }

    /// This target for another point of the joint than the tip of its bone, in the joint's space.
    #[must_use]
    pub const fn with_grip(self, grip: Vec3) -> Self {
        Self { effector: Effector::Grip(grip), ..self }
    }

    /// This target reached at any of these distances from its place, in skeleton units.
    #[must_use]
    pub const fn with_distances(self, least: f32, most: f32) -> Self {
        Self { distances: [least, most], ..self }
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

    /// True if the limits let one angle change at most.
    pub fn is_hinge(&self) -> bool {
        let is_movable = |axis: &RotationAxis| !self.limits.is_fixed(*axis);
        RotationAxis::ALL.iter().filter(|axis| is_movable(axis)).count() <= 1
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
    /// Index of the link of the joint; `None` if the joint and all joints above are locked.
    pub link: Option<usize>,
    pub tree: usize,
    /// Position of the tip, or of the grip that stands for it, in the link's space; without a link,
    /// relative to the tree's origin. A centre of mass has none: see [`Masses`].
    pub tip: Vec3A,
    /// The direction in which the tip may be anywhere, a unit vector: the vertical of a centre of
    /// mass; zero for others.
    pub free_direction: Vec3A,
    /// Position to which solvers move the tip, in problem space: `requested`, or, if that is
    /// farther than `max_distance` from the tree's origin, the point at `max_distance` in the same
    /// direction. With `distances`, the middle of a shell: see [`EndEffector::destination`].
    pub target: Vec3A,
    /// Position of the caller's target, in problem space.
    pub requested: DVec3,
    /// Least and greatest distance from the target at which it is reached, in the problem's units.
    pub distances: [f32; 2],
    /// Weight of the place as a fraction of the greatest weight, at most 1; 0 if the place is free.
    pub weight: f32,
    /// The joint's space from the link's space; without a link, relative to the tree's origin.
    pub space: Affine3A,
    pub orientation: Option<Orienting>,
    /// Maximum distance of `target` from the tree's origin, in the problem's units.
    pub max_distance: f64,
}

impl EndEffector {
    /// True if the target is reached at several distances, so that its places form a shell.
    pub fn has_shell(&self) -> bool {
        self.distances != [0.0; 2]
    }

    /// True if a centre of mass goes to the target.
    pub fn is_of_mass(&self) -> bool {
        self.free_direction != Vec3A::ZERO
    }

    /// A vector without its part in the direction in which the tip may be anywhere.
    pub fn counted(&self, vector: DVec3) -> DVec3 {
        if !self.is_of_mass() {
            return vector;
        }
        vector.reject_from_normalized(self.free_direction.as_dvec3().normalize())
    }

    /// The position to which methods move a tip: the target, or the place that is nearest to the tip
    /// of those at which it is reached.
    pub fn destination(&self, tip: Vec3A) -> Vec3A {
        if self.is_of_mass() {
            let way = self.counted((tip - self.target).as_dvec3());
            let nearest = nearest_in_shell(DVec3::ZERO, self.distances, way);
            return nearest.map_or(tip, |it| tip + (it - way).as_vec3a());
        }
        if !self.has_shell() {
            return self.target;
        }
        let nearest = nearest_in_shell(self.target.as_dvec3(), self.distances, tip.as_dvec3());
        nearest.map_or(tip, |it| it.clamp_length_max(self.max_distance).as_vec3a())
    }

    /// Distance from the border of the shell, of a tip within it.
    pub fn depth(&self, tip: Vec3A) -> f32 {
        let distance = tip.distance(self.target);
        let [least, most] = self.distances;
        // The inner border of a ball is a point, which is none.
        let from_inside = if least > 0.0 { distance - least } else { most };
        (most - distance).min(from_inside)
    }

    /// The radial direction in which a tip with this velocity comes nearer to a border of its shell;
    /// `None` in the middle.
    pub fn way_out(&self, tip: Vec3A, velocity: Vec3A) -> Option<Vec3A> {
        let radial = normalize(tip - self.target)?;
        let is_outwards = velocity.dot(radial) >= 0.0;
        (is_outwards || self.distances[0] > 0.0).then_some(if is_outwards {
            radial
        } else {
            -radial
        })
    }

    /// Length of the way that is left to a tip in its shell until it leaves the shell in the
    /// direction `out`, which is radial.
    pub fn room(&self, tip: Vec3A, out: Vec3A) -> f32 {
        let way = tip - self.target;
        let [least, most] = self.distances;
        if out.dot(way) >= 0.0 { most - way.length() } else { way.length() - least }
    }

    /// Vector from the requested point to a tip, in problem space.
    fn offset(&self, tip: Vec3A) -> DVec3 {
        self.counted(tip.as_dvec3() - self.requested)
    }

    /// Vector from the nearest requested place to a tip, in problem space.
    fn residual(&self, tip: Vec3A) -> DVec3 {
        let offset = self.offset(tip);
        if !self.has_shell() {
            return offset;
        }
        let nearest = nearest_in_shell(DVec3::ZERO, self.distances, offset);
        nearest.map_or(DVec3::ZERO, |it| offset - it)
    }
}

/// The point of a shell that is nearest to a point outside it; `None` for a point of the shell.
fn nearest_in_shell(middle: DVec3, [least, most]: [f32; 2], point: DVec3) -> Option<DVec3> {
    let (way, distance) = (point - middle).normalize_and_length();
    let nearest = distance.clamp(f64::from(least), f64::from(most));
    let way = if distance > 0.0 { way } else { DVec3::Y };
    (nearest != distance).then(|| middle + way * nearest)
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
    /// Shift of a free root that takes as much effort as a turn of a joint by one radian: the
    /// length, or less for stiff roots.
    pub shift_unit: f32,
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
    /// True if a target is reached at several distances.
    pub has_shells: bool,
    /// What the centre of mass depends on; `None` if no target asks for it.
    pub masses: Option<Masses>,
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

    /// Weight of an orientation as a fraction of the greatest weight.
    pub fn weight_of(&self, orienting: &Orienting) -> f32 {
        let square = self.turn_length().powi(2).max(f64::MIN_POSITIVE);
        (f64::from(orienting.stiffness) / square) as f32
    }

    /// ℓ in the problem's units.
    pub fn turn_length(&self) -> f64 {
        TURN_LENGTH * f64::from(self.length)
    }

    /// ℓ in world units.
    pub fn turn_length_in_world(&self) -> f64 {
        TURN_LENGTH * self.world_length()
    }

    /// The part of a shift of its tree by which an end effector moves: all of it, but for a centre of
    /// mass of which a part stays in place.
    pub fn part_of_shift(&self, effector: usize) -> f32 {
        self.masses_of(effector).map_or(1.0, Masses::part_of_shift)
    }

    /// The masses on links if the end effector is the centre of mass.
    pub fn masses_of(&self, effector: usize) -> Option<&Masses> {
        self.masses.as_ref().filter(|masses| masses.effector == effector)
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

    /// Vectors from the nearest requested places to their tips, in the world; zero for free places.
    pub fn residuals<'a>(&'a self, tips: &'a [Vec3A]) -> impl Iterator<Item = DVec3> + 'a {
        self.effectors.iter().zip(tips).map(|(effector, tip)| match effector.weight {
            0.0 => DVec3::ZERO,
            _ => self.in_world(effector, effector.residual(*tip)),
        })
    }

    /// Vectors from the points of all targets to their tips, in the world; zero for free places.
    pub fn offsets<'a>(&'a self, tips: &'a [Vec3A]) -> impl Iterator<Item = DVec3> + 'a {
        self.effectors.iter().zip(tips).map(|(effector, tip)| match effector.weight {
            0.0 => DVec3::ZERO,
            _ => self.in_world(effector, effector.offset(*tip)),
        })
    }

    /// A vector of problem space in the world; without its vertical part for a centre of mass.
    fn in_world(&self, effector: &EndEffector, vector: DVec3) -> DVec3 {
        let in_world = self.to_world * (vector / self.unit);
        if effector.is_of_mass() { in_world.with_y(0.0) } else { in_world }
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
            // Of the points on a vertical line, that which is nearest to the origin.
            effector.requested = effector.counted(place(target.point));
            // The middle of a shell is not where its nearest place is.
            let most = if effector.has_shell() { farthest } else { effector.max_distance };
            effector.target = effector.requested.clamp_length_max(most).as_vec3a();
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
        let weight = |effector: &EndEffector| {
            let turn = effector.orientation.as_ref().map_or(0.0, |it| self.weight_of(it));
            f64::from(effector.weight) + f64::from(turn)
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
            (sum - effector.residual(*tip) * weight, all + weight)
        });
        if weight > 0.0 { sum / weight } else { DVec3::ZERO }
    }

    /// The part of a shift of a free root that methods make which move all roots at once.
    pub fn part_of_root(&self) -> f32 {
        if self.length > 0.0 { (self.shift_unit / self.length).powi(2) } else { 1.0 }
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

    /// A point of a tree in problem space, in skeleton space.
    pub fn point_in_skeleton(&self, tree: usize, point: Vec3A) -> DVec3 {
        self.trees[tree].origin + point.as_dvec3() / self.unit
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
