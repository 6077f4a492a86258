use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3A, Vec3, Vec3A};

use super::{EndEffector, HeldLimb, KinematicTree, Link, Masses, Problem};
use crate::chain_ik::{
    ChainTarget, Effector, Method, Orientation, Root, SolveError, SolverOptions,
};
use crate::skeleton::{Joint, JointId, Skeleton, SkeletonPose, bone_masses};

/// The space of a joint, relative to the link to which it is attached or, without a link, to its
/// tree.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Attachment {
    link: Option<usize>,
    to_link: Affine3A,
    tree: usize,
    /// Length of the path from the root, in the problem's units.
    path: f64,
}

/// Builds problems of moving the tips of one skeleton to targets of the same joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Builder {
    root: Root,
    /// 1 − k with the stiffness k of free roots.
    root_compliance: f32,
    method: Method,
    /// Joints between targets and roots, parents before children.
    path: Vec<PathJoint>,
    /// The spaces of all joints; `None` for joints on no path.
    attachments: Vec<Option<Attachment>>,
    /// The limbs whose tips are held in place, for a centre of mass.
    pub held_limbs: Vec<HeldLimb>,
    bind: SkeletonPose,
}

/// The properties of a joint on a path that decide which links a problem has.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PathJoint {
    id: JointId,
    parent: Option<JointId>,
    is_locked: bool,
}

impl PathJoint {
    fn new(id: JointId, joint: &Joint, root: Root) -> Self {
        let is_locked = joint.locked || (root == Root::Locked && joint.parent.is_none());
        Self { id, parent: joint.parent, is_locked }
    }
}

impl Builder {
    /// # Errors
    ///
    /// [`SolveError::NoJoint`] and the errors of targets.
    pub fn new(
        skeleton: &Skeleton,
        targets: &[ChainTarget],
        options: &SolverOptions,
    ) -> Result<Self, SolveError> {
        check_targets(skeleton, targets)?;
        let joints = targets.iter().map(|target| target.joint);
        let path = path(skeleton, joints, options.root);
        let SolverOptions { root, method, root_stiffness, .. } = *options;
        let root_compliance = 1.0 - root_stiffness;
        Ok(Self { root, root_compliance, method, path, ..Self::default() })
    }

    /// Fills a problem in its memory. The targets must be on the same joints, in the same order, as
    /// those for which the builder was made.
    ///
    /// # Errors
    ///
    /// [`SolveError::OtherJoint`] for a skeleton in which a joint between a target and a root has
    /// another parent or lock; [`SolveError::Singular`]. The problem is unchanged.
    pub fn fill(
        &mut self,
        problem: &mut Problem,
        skeleton: &Skeleton,
        targets: &[ChainTarget],
    ) -> Result<(), SolveError> {
        let is_same = |joint: &&PathJoint| {
            let found = skeleton.joint(joint.id);
            found.is_some_and(|found| PathJoint::new(joint.id, found, self.root) == **joint)
        };
        if let Some(other) = self.path.iter().find(|joint| !is_same(joint)) {
            return Err(SolveError::OtherJoint(other.id));
        }
        let transform = skeleton.transform();
        let (to_world, to_skeleton) = with_inverse(transform).ok_or(SolveError::Singular)?;
        let length = longest_path(skeleton, targets);
        let unit = if length > 0.0 { (-length.log2().floor()).exp2() } else { 1.0 };
        problem.links.clear();
        problem.effectors.clear();
        problem.trees.clear();
        problem.free_roots = self.root == Root::Free;
        problem.length = (length * unit) as f32;
        problem.shift_unit = problem.length * self.root_compliance.sqrt();
        (problem.to_skeleton, problem.to_world, problem.unit) = (to_skeleton, to_world, unit);
        self.add_links(problem, skeleton);
        problem.add_effectors(skeleton, targets, &self.attachments, self.method);
        problem.masses = self.masses(problem, skeleton, targets);
        problem.has_shells = problem.effectors.iter().any(EndEffector::has_shell);
        problem.list_below();
        problem.set_targets(targets);
        skeleton.write_bind_pose_in_skeleton(&mut self.bind);
        problem.inertia = problem.bind_inertia(skeleton, targets, &self.bind);
        Ok(())
    }

    /// What the centre of mass of a target depends on: attaches the joints below that are on no path
    /// to those above.
    fn masses(
        &mut self,
        problem: &Problem,
        skeleton: &Skeleton,
        targets: &[ChainTarget],
    ) -> Option<Masses> {
        let effector = targets.iter().position(ChainTarget::is_of_mass)?;
        for (id, joint) in skeleton.iter() {
            let parent = joint.parent.and_then(|parent| self.attachments[parent.index()]);
            if let (None, Some(parent)) = (self.attachments[id.index()], parent) {
                let base = problem.at_offset(joint, parent);
                self.attachments[id.index()] = Some(Problem::fuse_joint(joint, base));
            }
        }
        let mut masses = Masses::new(effector, problem.links.len());
        for limb in &self.held_limbs {
            if let Some(base) = self.base_of(problem, skeleton, limb.upper) {
                masses.add(base.link, limb.with_base, base.to_link.translation);
                masses.hold(limb.held, limb.moment);
            }
        }
        let mut is_below = vec![false; skeleton.joints().len()];
        for ((id, joint), (mass, centre)) in skeleton.iter().zip(bone_masses(skeleton)) {
            let is_parent_below = joint.parent.is_some_and(|parent| is_below[parent.index()]);
            let is_held = self.held_limbs.iter().any(|limb| limb.upper == id);
            is_below[id.index()] = (id == targets[effector].joint || is_parent_below) && !is_held;
            if let (true, Some(at)) = (is_below[id.index()], self.attachments[id.index()]) {
                let centre = at.to_link.transform_point3a((centre * problem.unit).as_vec3a());
                masses.add(at.link, mass, centre);
            }
        }
        let parents = problem.links.iter().map(|link| (link.parent, link.pivot.length()));
        masses.sum_up(&parents.collect::<Vec<_>>());
        Some(masses)
    }

    /// The space of a joint's base; `None` for a root.
    fn base_of(
        &self,
        problem: &Problem,
        skeleton: &Skeleton,
        joint: JointId,
    ) -> Option<Attachment> {
        let joint = &skeleton[joint];
        let parent = self.attachments[joint.parent?.index()]?;
        Some(problem.at_offset(joint, parent))
    }

    fn add_links(&mut self, problem: &mut Problem, skeleton: &Skeleton) {
        self.attachments.clear();
        self.attachments.resize(skeleton.joints().len(), None);
        for PathJoint { id, parent, is_locked } in &self.path {
            let joint = &skeleton[*id];
            let base = match parent.and_then(|parent| self.attachments[parent.index()]) {
                Some(parent) => problem.at_offset(joint, parent),
                None => problem.add_tree(*id, joint),
            };
            self.attachments[id.index()] = Some(if *is_locked {
                Problem::fuse_joint(joint, base)
            } else {
                problem.add_link(*id, joint, base)
            });
        }
    }
}

impl Problem {
    fn add_tree(&mut self, root: JointId, joint: &Joint) -> Attachment {
        let offset = joint.offset.as_dvec3();
        self.trees.push(KinematicTree { root, offset, origin: offset });
        let tree = self.trees.len() - 1;
        Attachment { link: None, to_link: Affine3A::IDENTITY, tree, path: 0.0 }
    }

    /// The space of a joint's base, before the joint's rotation, from its parent's space.
    fn at_offset(&self, joint: &Joint, parent: Attachment) -> Attachment {
        let offset = self.scaled(joint.offset);
        let translation = parent.to_link.transform_point3a(offset);
        let path = parent.path + f64::from(offset.length());
        Attachment { to_link: Affine3A { translation, ..parent.to_link }, path, ..parent }
    }

    /// The space of a locked joint from the space of its base.
    fn fuse_joint(joint: &Joint, base: Attachment) -> Attachment {
        let matrix3 = base.to_link.matrix3 * joint.local_rotation();
        Attachment { to_link: Affine3A { matrix3, ..base.to_link }, ..base }
    }

    /// Adds a link for a joint. Returns the space of the joint from the space of its base.
    fn add_link(&mut self, id: JointId, joint: &Joint, base: Attachment) -> Attachment {
        let frame = Mat3A::from(joint.frame);
        self.links.push(Link {
            joint: id,
            parent: base.link,
            tree: base.tree,
            pivot: base.to_link.translation,
            mount: base.to_link.matrix3 * frame,
            limits: joint.limits,
            compliance: (Vec3::ONE - joint.stiffness).into(),
            below: (0, 0),
            start: joint.rotation,
        });
        let to_link = Affine3A { matrix3: frame.transpose(), translation: Vec3A::ZERO };
        Attachment { link: Some(self.links.len() - 1), to_link, ..base }
    }

    fn add_effectors(
        &mut self,
        skeleton: &Skeleton,
        targets: &[ChainTarget],
        attachments: &[Option<Attachment>],
        method: Method,
    ) {
        let orientation_weight = |target: &ChainTarget| match target.orientation {
            Some(_) => target.orientation_weight,
            None => 0.0,
        };
        let weights = targets.iter().map(|target| target.weight.max(orientation_weight(target)));
        self.heaviest = weights.fold(0.0, f32::max);
        for target in targets {
            let Some(attachment) = attachments[target.joint.index()] else { continue };
            let axis = self.scaled(target.grip_in(skeleton));
            let reach = match target.is_of_mass() {
                true => self.length,
                false => attachment.path as f32 + axis.length(),
            };
            // Of a target out of reach only the direction counts, unless it loses the tip's
            // position to rounding or the method is not stable that far away.
            let stable_distance = method.row().stable_distance;
            let max_distance = if stable_distance.is_finite() && !self.free_roots {
                stable_distance * f64::from(reach)
            } else {
                self.farthest()
            };
            self.effectors.push(EndEffector {
                joint: target.joint,
                link: attachment.link,
                tree: attachment.tree,
                tip: attachment.to_link.transform_point3a(axis),
                free_direction: if target.is_of_mass() { self.vertical() } else { Vec3A::ZERO },
                target: Vec3A::ZERO,
                requested: DVec3::ZERO,
                distances: target.distances.map(|it| (f64::from(it) * self.unit) as f32),
                weight: match target.weight {
                    0.0 => 0.0,
                    weight => (weight / self.heaviest).max(f32::MIN_POSITIVE),
                },
                space: attachment.to_link,
                orientation: None,
                max_distance,
            });
        }
    }

    /// The world's y as a unit vector in problem space.
    fn vertical(&self) -> Vec3A {
        self.to_skeleton.transform_vector3(DVec3::Y).normalize_or(DVec3::Y).as_vec3a()
    }

    /// Lists the end effectors at each link and below, in their order.
    fn list_below(&mut self) {
        let Self { links, effectors, below, masses, .. } = self;
        let masses = masses.as_ref();
        // Counts them first, in place of the end of each list.
        for_each_moved(effectors, masses, links, |link, _| link.below.1 += 1);
        let mut from = 0;
        for link in links.iter_mut() {
            let count = link.below.1;
            link.below = (from, from);
            from += count;
        }
        below.clear();
        below.resize(from, 0);
        for_each_moved(effectors, masses, links, |link, effector| {
            below[link.below.1] = effector;
            link.below.1 += 1;
        });
    }

    fn bind_inertia(
        &self,
        skeleton: &Skeleton,
        targets: &[ChainTarget],
        bind: &SkeletonPose,
    ) -> f32 {
        let mut sum = 0.0;
        for (index, link) in self.links.iter().enumerate() {
            let compliance = f64::from(link.compliance.max_element());
            for effector in self.below(link) {
                let of_mass = self.masses.as_ref().and_then(|it| it.longest_arm(*effector, index));
                let target = &targets[*effector];
                let tip = bind.full(target.joint).transform_point3(target.grip_in(skeleton));
                let effector = &self.effectors[*effector];
                let arm = (tip.as_dvec3() - bind.base(link.joint).as_dvec3()) * self.unit;
                let arm = of_mass.map_or(arm.length(), f64::from);
                let of_place = f64::from(effector.weight) * arm * arm;
                let of_turn = effector.orientation.map_or(0.0, |it| f64::from(it.stiffness));
                sum += compliance * (of_place + of_turn);
            }
        }
        sum as f32 + self.inertia_of_shifts()
    }

    /// The part of Σ w r² that the shifts of free roots have, each with
    /// [`Problem::shift_unit`] as r.
    pub fn inertia_of_shifts(&self) -> f32 {
        let weights: f32 = self.effectors.iter().map(|effector| effector.weight).sum();
        if self.free_roots { weights * self.shift_unit.powi(2) } else { 0.0 }
    }
}

/// Calls `each` with every link and the index of every end effector that it moves.
fn for_each_moved(
    effectors: &[EndEffector],
    masses: Option<&Masses>,
    links: &mut [Link],
    mut each: impl FnMut(&mut Link, usize),
) {
    for (index, effector) in effectors.iter().enumerate() {
        if let Some(masses) = masses.filter(|masses| masses.effector == index) {
            let moved = links.iter_mut().enumerate().filter(|(link, _)| masses.is_moved_by(*link));
            moved.for_each(|(_, link)| each(link, index));
            continue;
        }
        let mut above = effector.link;
        while let Some(link) = above {
            each(&mut links[link], index);
            above = links[link].parent;
        }
    }
}

/// The linear part of a transform and the inverse of the whole transform; `None` if the transform
/// is singular. Computed in f64, where squares and cubes of any f32 are finite.
fn with_inverse(transform: Affine3A) -> Option<(DMat3, DAffine3)> {
    // Rounding of a determinant that is 0, relative to the lengths of the columns; with a margin.
    const SINGULAR: f64 = 1e-6;
    let matrix = transform.matrix3.as_dmat3();
    let sides = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    if matrix.determinant().abs() <= SINGULAR * sides {
        return None;
    }
    let translation = transform.translation.as_dvec3();
    let inverse = DAffine3::from_mat3_translation(matrix, translation).inverse();
    inverse.is_finite().then_some((matrix, inverse))
}

/// The joints of targets and their ancestors, parents first.
fn path(skeleton: &Skeleton, targets: impl Iterator<Item = JointId>, root: Root) -> Vec<PathJoint> {
    let mut on_path = vec![false; skeleton.joints().len()];
    for joint in targets.flat_map(|target| skeleton.ancestors(target)) {
        on_path[joint.index()] = true;
    }
    let joints = skeleton.iter().filter(|(id, _)| on_path[id.index()]);
    joints.map(|(id, joint)| PathJoint::new(id, joint, root)).collect()
}

/// Length of the longest path from a root to a tip, in skeleton units.
fn longest_path(skeleton: &Skeleton, targets: &[ChainTarget]) -> f64 {
    let to_base = |joint: JointId| {
        let inner = skeleton.ancestors(joint).filter(|joint| skeleton[*joint].parent.is_some());
        inner.map(|joint| skeleton[joint].offset.as_dvec3().length()).sum::<f64>()
    };
    let path =
        |target: &ChainTarget| to_base(target.joint) + target.grip_in(skeleton).as_dvec3().length();
    let longest = targets.iter().map(path).fold(0.0, f64::max);
    if longest > 0.0 || !targets.iter().any(ChainTarget::is_of_mass) {
        return longest;
    }
    // Nothing but a centre of mass is moved.
    let paths = skeleton.iter().map(|(id, joint)| to_base(id) + joint.axis.as_dvec3().length());
    paths.fold(0.0, f64::max)
}

pub(super) fn check_targets(
    skeleton: &Skeleton,
    targets: &[ChainTarget],
) -> Result<(), SolveError> {
    let mut last = vec![None; skeleton.joints().len()];
    for (index, target) in targets.iter().enumerate() {
        if skeleton.joint(target.joint).is_none() {
            return Err(SolveError::NoJoint(target.joint));
        }
        // Several targets of a joint must have several effectors.
        let others = last[target.joint.index()].replace(index).map_or(0..0, |_| 0..index);
        let is_same = |it: &ChainTarget| (it.joint, it.effector) == (target.joint, target.effector);
        let is_second = |it: &ChainTarget| it.is_of_mass() && target.is_of_mass();
        if targets[others].iter().any(is_same) || targets[..index].iter().any(is_second) {
            return Err(SolveError::TwoTargets(target.joint));
        }
        check_target(target)?;
    }
    Ok(())
}

/// Checks that a target's place, grip and orientation are finite, its distances in order, and its
/// weights finite and not negative, with one above 0.
pub fn check_target(target: &ChainTarget) -> Result<(), SolveError> {
    let &ChainTarget { joint, point, effector, distances, weight, .. } = target;
    let &ChainTarget { orientation, orientation_weight, .. } = target;
    let grip = if let Effector::Grip(grip) = effector { grip } else { Vec3::ZERO };
    if let Some(point) = [point, grip].into_iter().find(|it| !it.is_finite()) {
        return Err(SolveError::Point { joint, point });
    }
    let [least, most] = distances;
    if !(least >= 0.0 && least <= most && most.is_finite()) {
        return Err(SolveError::Distances { joint, least, most });
    }
    let is_weight = |weight: f32| weight.is_finite() && weight >= 0.0;
    let is_free = weight == 0.0 && (orientation.is_none() || orientation_weight == 0.0);
    if !is_weight(weight) || is_free {
        return Err(SolveError::Weight { joint, weight });
    }
    let is_orientation = |orientation| match orientation {
        Orientation::Rotation(rotation) => {
            rotation.is_finite() && rotation.length_squared().is_normal()
        }
        Orientation::Aim { axis, point } => {
            axis.is_finite() && axis != Vec3::ZERO && point.is_finite()
        }
    };
    match orientation {
        Some(orientation) if !is_orientation(orientation) || target.is_of_mass() => {
            Err(SolveError::Orientation { joint, orientation })
        }
        Some(_) if !is_weight(orientation_weight) => {
            Err(SolveError::Weight { joint, weight: orientation_weight })
        }
        _ => Ok(()),
    }
}
