use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3A, Vec3A};

use super::{EndEffector, KinematicTree, Link, Problem};
use crate::chain_ik::{Method, Root, SolveError, SolverOptions, TipTarget};
use crate::skeleton::{Joint, JointId, Skeleton};

/// The space of a joint, relative to the link to which it is attached or, without a link, to its
/// tree.
#[derive(Clone, Copy)]
struct Attachment {
    link: Option<usize>,
    to_link: Affine3A,
    tree: usize,
    /// Length of the path from the root, in the problem's units.
    path: f64,
}

/// Builds the problem of moving the tips of a skeleton to targets.
pub fn build(
    skeleton: &Skeleton,
    targets: &[TipTarget],
    options: &SolverOptions,
) -> Result<Problem, SolveError> {
    check_targets(skeleton, targets)?;
    let transform = skeleton.transform();
    let (to_world, to_skeleton) = with_inverse(transform).ok_or(SolveError::Singular)?;
    let on_path = on_paths(skeleton, targets);
    let length = longest_path(skeleton, targets);
    let unit = if length > 0.0 { (-length.log2().floor()).exp2() } else { 1.0 };
    let mut problem = Problem {
        links: Vec::new(),
        effectors: Vec::new(),
        trees: Vec::new(),
        below: Vec::new(),
        free_roots: options.root == Root::Free,
        length: (length * unit) as f32,
        inertia: 0.0,
        to_skeleton,
        to_world,
        unit,
    };
    let attachments = problem.add_links(skeleton, &on_path, options.root);
    problem.add_effectors(skeleton, targets, &attachments, options.method);
    problem.list_below();
    problem.inertia = problem.bind_inertia(skeleton);
    problem.set_targets(targets);
    Ok(problem)
}

impl Problem {
    fn add_links(
        &mut self,
        skeleton: &Skeleton,
        on_path: &[bool],
        root: Root,
    ) -> Vec<Option<Attachment>> {
        let mut attachments: Vec<Option<Attachment>> = vec![None; on_path.len()];
        for (id, joint) in skeleton.iter().filter(|(id, _)| on_path[id.index()]) {
            let base = match joint.parent.and_then(|parent| attachments[parent.index()]) {
                Some(parent) => self.at_offset(joint, parent),
                None => self.add_tree(id, joint),
            };
            let is_locked = joint.locked || (root == Root::Locked && joint.parent.is_none());
            attachments[id.index()] = Some(if is_locked {
                Self::fuse_joint(joint, base)
            } else {
                self.add_link(id, joint, base)
            });
        }
        attachments
    }

    fn add_tree(&mut self, root: JointId, joint: &Joint) -> Attachment {
        self.trees.push(KinematicTree { root, origin: joint.offset.as_dvec3() });
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
            below: (0, 0),
            start: joint.rotation,
        });
        let to_link = Affine3A { matrix3: frame.transpose(), translation: Vec3A::ZERO };
        Attachment { link: Some(self.links.len() - 1), to_link, ..base }
    }

    fn add_effectors(
        &mut self,
        skeleton: &Skeleton,
        targets: &[TipTarget],
        attachments: &[Option<Attachment>],
        method: Method,
    ) {
        let heaviest = targets.iter().map(|target| target.weight).fold(0.0, f32::max);
        for target in targets {
            let Some(attachment) = attachments[target.joint.index()] else { continue };
            let axis = self.scaled(skeleton[target.joint].axis);
            let reach = attachment.path as f32 + axis.length();
            // Of a target out of reach only the direction counts, unless it loses the tip's
            // position to rounding or the method is not stable that far away.
            let stable_distance = method.row().stable_distance;
            let max_distance = if stable_distance.is_finite() && !self.free_roots {
                stable_distance * f64::from(reach)
            } else {
                1e4 * f64::from(self.length.max(1.0))
            };
            self.effectors.push(EndEffector {
                joint: target.joint,
                link: attachment.link,
                tree: attachment.tree,
                tip: attachment.to_link.transform_point3a(axis),
                target: Vec3A::ZERO,
                requested: DVec3::ZERO,
                weight: (target.weight / heaviest).max(f32::MIN_POSITIVE),
                max_distance,
            });
        }
    }

    fn list_below(&mut self) {
        let mut lists = vec![Vec::new(); self.links.len()];
        for (index, effector) in self.effectors.iter().enumerate() {
            let parent = |link: &usize| self.links[*link].parent;
            for link in std::iter::successors(effector.link, parent) {
                lists[link].push(index);
            }
        }
        for (link, list) in self.links.iter_mut().zip(lists) {
            let from = self.below.len();
            self.below.extend(list);
            link.below = (from, self.below.len());
        }
    }

    fn bind_inertia(&self, skeleton: &Skeleton) -> f32 {
        let bind = skeleton.bind_pose_in_skeleton();
        let mut sum = 0.0;
        for link in &self.links {
            for effector in self.below(link) {
                let effector = &self.effectors[*effector];
                let arm = bind.tip(effector.joint).as_dvec3() - bind.base(link.joint).as_dvec3();
                sum += f64::from(effector.weight) * (arm * self.unit).length_squared();
            }
        }
        if self.free_roots {
            let weights: f64 =
                self.effectors.iter().map(|effector| f64::from(effector.weight)).sum();
            sum += weights * f64::from(self.length).powi(2);
        }
        sum as f32
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

/// True if each joint is a target's joint or an ancestor of one.
fn on_paths(skeleton: &Skeleton, targets: &[TipTarget]) -> Vec<bool> {
    let mut on_path = vec![false; skeleton.joints().len()];
    for target in targets {
        for joint in skeleton.ancestors(target.joint) {
            on_path[joint.index()] = true;
        }
    }
    on_path
}

/// Length of the longest path from a root to a tip, in skeleton units.
fn longest_path(skeleton: &Skeleton, targets: &[TipTarget]) -> f64 {
    let path = |target: &TipTarget| {
        let inner =
            skeleton.ancestors(target.joint).filter(|joint| skeleton[*joint].parent.is_some());
        let offsets: f64 = inner.map(|joint| skeleton[joint].offset.as_dvec3().length()).sum();
        offsets + skeleton[target.joint].axis.as_dvec3().length()
    };
    targets.iter().map(path).fold(0.0, f64::max)
}

pub(super) fn check_targets(skeleton: &Skeleton, targets: &[TipTarget]) -> Result<(), SolveError> {
    let mut targeted = vec![false; skeleton.joints().len()];
    for target in targets {
        if skeleton.joint(target.joint).is_none() {
            return Err(SolveError::NoJoint(target.joint));
        }
        if std::mem::replace(&mut targeted[target.joint.index()], true) {
            return Err(SolveError::TwoTargets(target.joint));
        }
        check_target(target)?;
    }
    Ok(())
}

/// Checks that a target's point is finite, and its weight finite and above 0.
pub fn check_target(&TipTarget { joint, point, weight }: &TipTarget) -> Result<(), SolveError> {
    if !point.is_finite() {
        return Err(SolveError::Point { joint, point });
    }
    if !(weight.is_finite() && weight > 0.0) {
        return Err(SolveError::Weight { joint, weight });
    }
    Ok(())
}
