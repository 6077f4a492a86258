//! A skeleton as solvers see it: only what lies between targets and roots, every locked joint fused
//! with what it hangs from, lengths near 1.
//!
//! A body turns about its pivot by E = R_z · R_y · R_x alone: the frame A of its joint is absorbed
//! into the constants around it. With G the orientation of a body in skeleton space,
//!
//! ```text
//! G = G(parent) · mount · E        base = base(parent) + G(parent) · pivot
//! ```
//!
//! Points are in skeleton space less the tree's origin (where its root stands), times a power of
//! two that brings the chain's length to 1 … 2: huge and tiny skeletons solve as others do.

use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3A, Vec3, Vec3A};

use super::{Method, Root, SolveError, SolverOptions, TipTarget};
use crate::kinematics::skeleton::{Joint, JointId, Limit, Skeleton};

/// A joint that turns, and all that is rigidly attached to it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Body {
    pub joint: JointId,
    /// None for what hangs from the root's place itself.
    pub parent: Option<usize>,
    pub tree: usize,
    /// In the parent's space.
    pub pivot: Vec3A,
    pub mount: Mat3A,
    pub limits: [Option<Limit>; 3],
    /// The goals at and below it, as a range of [`Problem::below`].
    pub below: (usize, usize),
    /// Angles before the solve.
    pub start: Vec3,
}

impl Body {
    pub fn is_limited(&self) -> bool {
        self.limits.iter().any(Option::is_some)
    }
}

/// A target, brought into the rig.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Goal {
    pub joint: JointId,
    pub body: Option<usize>,
    pub tree: usize,
    /// The tip that is to come there, in the body's space.
    pub tip: Vec3A,
    /// Where the tip is to come, pulled in to [`Goal::far`] of the tree's origin.
    pub point: Vec3A,
    /// As it was asked for.
    pub asked: DVec3,
    /// The heaviest has 1.
    pub weight: f32,
    far: f64,
}

/// What hangs from one root.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tree {
    pub root: JointId,
    /// Where the root stands before it moves, in skeleton space.
    pub origin: DVec3,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Problem {
    /// Parents before children.
    pub bodies: Vec<Body>,
    pub goals: Vec<Goal>,
    pub trees: Vec<Tree>,
    /// Goals at and below bodies.
    pub below: Vec<usize>,
    /// Whether trees may move.
    pub free: bool,
    /// The longest path from a root to a tip.
    pub length: f32,
    /// τ⁻¹ of the transpose: Σ w r² from the bind pose.
    pub inertia: f32,
    to_skeleton: DAffine3,
    to_world: DMat3,
    /// From skeleton units to the rig's.
    unit: f64,
}

/// Where a joint's own space is: in a body, or on the ground.
#[derive(Clone, Copy)]
struct Place {
    body: Option<usize>,
    to_body: Affine3A,
    tree: usize,
    /// Lengths on the way from the root.
    path: f64,
}

impl Problem {
    pub fn new(
        skeleton: &Skeleton,
        targets: &[TipTarget],
        options: &SolverOptions,
    ) -> Result<Self, SolveError> {
        check(skeleton, targets)?;
        let transform = skeleton.transform();
        let (to_world, to_skeleton) = both_ways(transform).ok_or(SolveError::Flat)?;
        let on_path = on_paths(skeleton, targets);
        let length = longest(skeleton, targets);
        let unit = if length > 0.0 { (-length.log2().floor()).exp2() } else { 1.0 };
        let mut rig = Self {
            bodies: Vec::new(),
            goals: Vec::new(),
            trees: Vec::new(),
            below: Vec::new(),
            free: options.root == Root::Free,
            length: (length * unit) as f32,
            inertia: 0.0,
            to_skeleton,
            to_world,
            unit,
        };
        let places = rig.add_bodies(skeleton, &on_path);
        rig.add_goals(skeleton, targets, &places, options.method);
        rig.list_below();
        rig.inertia = rig.bind_inertia(skeleton);
        rig.aim(targets);
        Ok(rig)
    }

    /// The chain's length in the world, under the transform's mean scale.
    pub fn world_length(&self) -> f64 {
        f64::from(self.length) / self.unit * self.scale()
    }

    /// From the world's lengths to the rig's, under the transform's mean scale.
    pub fn to_rig(&self, length: f64) -> f64 {
        length / self.scale() * self.unit
    }

    fn scale(&self) -> f64 {
        self.to_world.determinant().abs().cbrt()
    }

    /// How far a tip is from what was asked, in the world.
    pub fn error(&self, goal: &Goal, tip: Vec3A) -> f64 {
        let missing = (tip.as_dvec3() - goal.asked) / self.unit;
        (self.to_world * missing).length()
    }

    /// Takes the targets' points.
    pub fn aim(&mut self, targets: &[TipTarget]) {
        for (goal, target) in self.goals.iter_mut().zip(targets) {
            let point = self.to_skeleton.transform_point3(target.point.as_dvec3());
            goal.asked = (point - self.trees[goal.tree].origin) * self.unit;
            goal.point = goal.asked.clamp_length_max(goal.far).as_vec3a();
        }
    }

    /// Moves trees whose targets are beyond reach until they are not, as far as numbers go: what is
    /// left is near the origin, where numbers are fine.
    pub fn approach(&mut self, targets: &[TipTarget], tips: &[Vec3A]) {
        for tree in 0..self.trees.len() {
            let missing = self.missing(tree, tips);
            let most = f64::from(self.length);
            let distance = missing.length();
            if distance > 2.0 * most {
                let by = missing * ((distance - most) / distance / self.unit);
                let origin = &mut self.trees[tree].origin;
                *origin = within_numbers(*origin + by);
            }
        }
        self.aim(targets);
    }

    /// From the tips of a tree to what was asked of them, in the mean.
    fn missing(&self, tree: usize, tips: &[Vec3A]) -> DVec3 {
        let of_tree = self.goals.iter().zip(tips).filter(|(goal, _)| goal.tree == tree);
        let (sum, weight) = of_tree.fold((DVec3::ZERO, 0.0), |(sum, all), (goal, tip)| {
            let weight = f64::from(goal.weight);
            (sum + (goal.asked - tip.as_dvec3()) * weight, all + weight)
        });
        sum / weight
    }

    /// Whether a number says where a tree's root is then.
    pub fn can_go(&self, tree: usize, shift: Vec3A) -> bool {
        (self.trees[tree].origin + shift.as_dvec3() / self.unit).as_vec3().is_finite()
    }

    /// Where a tree's root has gone, in skeleton space.
    pub fn root_offset(&self, tree: usize, shift: Vec3A) -> Vec3 {
        let offset = self.trees[tree].origin + shift.as_dvec3() / self.unit;
        within_numbers(offset).as_vec3()
    }

    fn add_bodies(&mut self, skeleton: &Skeleton, on_path: &[bool]) -> Vec<Option<Place>> {
        let mut places: Vec<Option<Place>> = vec![None; on_path.len()];
        for (id, joint) in skeleton.iter().filter(|(id, _)| on_path[id.index()]) {
            let place = match joint.parent.and_then(|parent| places[parent.index()]) {
                Some(above) => self.hang(joint, above),
                None => self.plant(id, joint),
            };
            places[id.index()] = Some(self.release(id, joint, place));
        }
        places
    }

    fn plant(&mut self, root: JointId, joint: &Joint) -> Place {
        self.trees.push(Tree { root, origin: joint.offset.as_dvec3() });
        let tree = self.trees.len() - 1;
        Place { body: None, to_body: Affine3A::IDENTITY, tree, path: 0.0 }
    }

    fn hang(&self, joint: &Joint, above: Place) -> Place {
        let offset = self.scaled(joint.offset);
        let translation = above.to_body.transform_point3a(offset);
        let path = above.path + f64::from(offset.length());
        Place { to_body: Affine3A { translation, ..above.to_body }, path, ..above }
    }

    /// From the joint's base to its own space: through a new body if it can turn.
    fn release(&mut self, id: JointId, joint: &Joint, at: Place) -> Place {
        if joint.locked {
            let matrix3 = at.to_body.matrix3 * joint.local_rotation();
            return Place { to_body: Affine3A { matrix3, ..at.to_body }, ..at };
        }
        let frame = Mat3A::from(joint.frame);
        self.bodies.push(Body {
            joint: id,
            parent: at.body,
            tree: at.tree,
            pivot: at.to_body.translation,
            mount: at.to_body.matrix3 * frame,
            limits: joint.limits,
            below: (0, 0),
            start: joint.rotation,
        });
        let to_body = Affine3A { matrix3: frame.transpose(), translation: Vec3A::ZERO };
        Place { body: Some(self.bodies.len() - 1), to_body, ..at }
    }

    fn add_goals(
        &mut self,
        skeleton: &Skeleton,
        targets: &[TipTarget],
        places: &[Option<Place>],
        method: Method,
    ) {
        let heaviest = targets.iter().map(|target| target.weight).fold(0.0, f32::max);
        for target in targets {
            let Some(place) = places[target.joint.index()] else { continue };
            let axis = self.scaled(skeleton[target.joint].axis);
            let reach = place.path as f32 + axis.length();
            // Beyond reach only the direction counts. The fixed step is stable as long as the
            // target is less than about twice as far as the tip can be; others bear all that
            // leaves the tip some digits beside it.
            let far = match method {
                Method::TransposeFixed if !self.free => 1.25 * f64::from(reach),
                _ => 1e4 * f64::from(self.length.max(1.0)),
            };
            self.goals.push(Goal {
                joint: target.joint,
                body: place.body,
                tree: place.tree,
                tip: place.to_body.transform_point3a(axis),
                point: Vec3A::ZERO,
                asked: DVec3::ZERO,
                weight: (target.weight / heaviest).max(f32::MIN_POSITIVE),
                far,
            });
        }
    }

    fn list_below(&mut self) {
        let mut lists = vec![Vec::new(); self.bodies.len()];
        for (index, goal) in self.goals.iter().enumerate() {
            let above = |body: &usize| self.bodies[*body].parent;
            for body in std::iter::successors(goal.body, above) {
                lists[body].push(index);
            }
        }
        for (body, list) in self.bodies.iter_mut().zip(lists) {
            let from = self.below.len();
            self.below.extend(list);
            body.below = (from, self.below.len());
        }
    }

    fn bind_inertia(&self, skeleton: &Skeleton) -> f32 {
        let bind = skeleton.bind_pose_in_skeleton();
        let mut sum = 0.0;
        for body in &self.bodies {
            for goal in &self.below[body.below.0..body.below.1] {
                let goal = &self.goals[*goal];
                let arm = bind.tip(goal.joint).as_dvec3() - bind.base(body.joint).as_dvec3();
                sum += f64::from(goal.weight) * (arm * self.unit).length_squared();
            }
        }
        if self.free {
            let weights: f64 = self.goals.iter().map(|goal| f64::from(goal.weight)).sum();
            sum += weights * f64::from(self.length).powi(2);
        }
        sum as f32
    }

    fn scaled(&self, v: Vec3) -> Vec3A {
        (v.as_dvec3() * self.unit).as_vec3a()
    }
}

/// As near as f32 can say where a point is.
fn within_numbers(point: DVec3) -> DVec3 {
    point.clamp(Vec3::MIN.as_dvec3(), Vec3::MAX.as_dvec3())
}

pub(super) fn check(skeleton: &Skeleton, targets: &[TipTarget]) -> Result<(), SolveError> {
    for (index, &TipTarget { joint, point, weight }) in targets.iter().enumerate() {
        if skeleton.joint(joint).is_none() {
            return Err(SolveError::NoJoint(joint));
        }
        if targets[..index].iter().any(|other| other.joint == joint) {
            return Err(SolveError::TwoTargets(joint));
        }
        check_numbers(joint, point, weight)?;
    }
    Ok(())
}

pub(super) fn check_numbers(joint: JointId, point: Vec3, weight: f32) -> Result<(), SolveError> {
    if !point.is_finite() {
        return Err(SolveError::Point { joint, point });
    }
    if !(weight.is_finite() && weight > 0.0) {
        return Err(SolveError::Weight { joint, weight });
    }
    Ok(())
}

/// To the world without translation, and back; in f64, which squares and cubes any f32.
fn both_ways(transform: Affine3A) -> Option<(DMat3, DAffine3)> {
    // What rounding leaves of a determinant of 0, with room.
    const FLAT: f64 = 1e-6;
    let matrix = transform.matrix3.as_dmat3();
    let sides = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    if matrix.determinant().abs() <= FLAT * sides {
        return None;
    }
    let translation = transform.translation.as_dvec3();
    let inverse = DAffine3::from_mat3_translation(matrix, translation).inverse();
    inverse.is_finite().then_some((matrix, inverse))
}

fn on_paths(skeleton: &Skeleton, targets: &[TipTarget]) -> Vec<bool> {
    let mut on_path = vec![false; skeleton.joints().len()];
    for target in targets {
        for joint in skeleton.ancestors(target.joint) {
            on_path[joint.index()] = true;
        }
    }
    on_path
}

/// Of the paths from roots to tips.
fn longest(skeleton: &Skeleton, targets: &[TipTarget]) -> f64 {
    let path = |target: &TipTarget| {
        let inner =
            skeleton.ancestors(target.joint).filter(|joint| skeleton[*joint].parent.is_some());
        let offsets: f64 = inner.map(|joint| skeleton[joint].offset.as_dvec3().length()).sum();
        offsets + skeleton[target.joint].axis.as_dvec3().length()
    };
    targets.iter().map(path).fold(0.0, f64::max)
}
