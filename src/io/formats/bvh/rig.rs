use std::collections::{HashMap, HashSet};

use glam::{Affine3A, DMat3, DVec3, Mat3};
use nalgebra::Matrix3;

use crate::document::{Document, Posed};
use crate::kinematics::skeleton::{Joint, JointId, exact_angles};

/// The nodes of a hierarchy in the order of the file: each node is followed by its descendants.
pub struct BvhRig {
    pub names: Vec<String>,
    pub parents: Vec<Option<usize>>,
    /// The joint of each node; `None` for the root added above several roots.
    joints: Vec<Option<usize>>,
}

/// The pose of a rig in one frame, in units of the scene.
#[derive(Clone, Debug)]
pub struct BvhPose {
    /// The offset of each node from its parent, in the parent's axes; for the first node its
    /// position in the world.
    pub offsets: Vec<DVec3>,
    /// The tip of each leaf's bone relative to its base, in its own axes; `None` for other nodes.
    pub ends: Vec<Option<DVec3>>,
    /// The rotation of each node relative to its parent, in world axes.
    pub rotations: Vec<DMat3>,
}

impl BvhRig {
    /// The hierarchy of the rig; `None` for a skeleton without joints.
    pub fn new(document: &Document) -> Option<Self> {
        let skeleton = document.skeleton();
        let joints = skeleton.joints();
        let mut children = vec![Vec::new(); joints.len()];
        let mut roots = Vec::new();
        for (index, joint) in joints.iter().enumerate() {
            match joint.parent {
                Some(parent) => children[parent.index()].push(index),
                None => roots.push(index),
            }
        }
        let has_several_roots = roots.len() > 1;
        let (mut nodes, mut parents, mut names) = (Vec::new(), Vec::new(), Vec::new());
        if has_several_roots {
            (nodes, parents, names) =
                (vec![None], vec![None], vec![skeleton.free_name("skeleton")]);
        }
        let added_root = has_several_roots.then_some(0);
        let mut next: Vec<_> = roots.iter().rev().map(|root| (*root, added_root)).collect();
        while let Some((joint, parent)) = next.pop() {
            let node = nodes.len();
            nodes.push(Some(joint));
            parents.push(parent);
            names.push(word(&joints[joint].name));
            next.extend(children[joint].iter().rev().map(|child| (*child, Some(node))));
        }
        let names = distinct(&names);
        (!nodes.is_empty()).then_some(Self { names, parents, joints: nodes })
    }

    /// The longest distance from the root along the bones of a pose.
    pub fn reach(&self, pose: &BvhPose) -> f64 {
        let mut along = vec![0.0; pose.offsets.len()];
        let mut longest = 0.0_f64;
        for (node, parent) in self.parents.iter().enumerate() {
            if let Some(parent) = parent {
                along[node] = along[*parent] + pose.offsets[node].length();
            }
            longest = longest.max(along[node] + pose.ends[node].map_or(0.0, DVec3::length));
        }
        longest
    }

    /// The pose of the rig in a frame.
    pub fn pose(&self, posed: &Posed, transform: &SkeletonTransform) -> BvhPose {
        let (nodes, skeleton) = (&self.joints, posed.skeleton());
        let joint =
            |node: &Option<usize>| node.and_then(|joint| skeleton.joint(JointId::new(joint)));
        let local = |node| joint(node).map_or(DMat3::IDENTITY, local_rotation);
        let locals: Vec<DMat3> = nodes.iter().map(local).collect();
        let spaces = transform.nodes(&self.parents, &locals);
        let offset = |(node, parent): (_, &Option<usize>)| match (joint(node), parent) {
            (None, _) => transform.origin(),
            (Some(joint), None) => transform.vector(joint.offset.as_dvec3()),
            (Some(joint), Some(parent)) => spaces[*parent].vectors * joint.offset.as_dvec3(),
        };
        let mut offsets: Vec<DVec3> = nodes.iter().zip(&self.parents).map(offset).collect();
        if let (Some(Some(_)), Some(first)) = (nodes.first(), offsets.first_mut()) {
            *first += transform.origin();
        }
        let mut is_leaf = vec![true; nodes.len()];
        for parent in self.parents.iter().flatten() {
            is_leaf[*parent] = false;
        }
        let ends = nodes.iter().zip(is_leaf).zip(&spaces).map(|((node, is_leaf), space)| {
            let joint = joint(node).filter(|_| is_leaf)?;
            Some(space.vectors * joint.axis.as_dvec3())
        });
        let ends = ends.collect();
        BvhPose { offsets, ends, rotations: spaces.into_iter().map(|it| it.rotation).collect() }
    }
}

/// The rotation of [`Joint::local_rotation`], but computed in f64.
fn local_rotation(joint: &Joint) -> DMat3 {
    let rotation = exact_angles::matrix(joint.rotation.as_dvec3());
    if joint.frame == Mat3::IDENTITY {
        return rotation;
    }
    let frame = joint.frame.as_dmat3();
    frame * rotation * frame.transpose()
}

/// Makes names unique: of equal names, the first stays, and the others get a number as suffix.
pub fn distinct(names: &[String]) -> Vec<String> {
    let mut taken: HashSet<&str> = HashSet::new();
    let is_first: Vec<bool> = names.iter().map(|name| taken.insert(name)).collect();
    let mut taken: HashSet<String> = names.iter().cloned().collect();
    let mut numbers: HashMap<&str, usize> = HashMap::new();
    let mut numbered = |name: &str, number: &mut usize| loop {
        *number += 1;
        let candidate = format!("{name}_{number}");
        if taken.insert(candidate.clone()) {
            return candidate;
        }
    };
    let pairs = names.iter().zip(is_first);
    pairs
        .map(|(stem, is_first)| {
            if is_first {
                return stem.clone();
            }
            numbered(stem, numbers.entry(stem).or_insert(1))
        })
        .collect()
}

/// Converts a name to one word of a BVH file: trims it, and replaces space, control characters and
/// braces by `_`.
pub fn word(name: &str) -> String {
    let is_plain = |c: char| !(c.is_whitespace() || c.is_control() || "{}".contains(c));
    name.trim().chars().map(|c| if is_plain(c) { c } else { '_' }).collect()
}

/// A skeleton's transform M · p + t, decomposed for BVH, which has rotations but no scale and
/// shear.
///
/// If M = s·Q with Q orthogonal (possibly a mirror), a rotation R in the skeleton is the rotation
/// Q·R·Qᵀ in the world. If M has uneven scale, shear or zero scale, no such rotation exists. A
/// joint then gets the rotation W for which W·M is nearest to M·G, where G is the joint's rotation
/// in the skeleton. The joints' positions are exact all the same: they are written as offsets that
/// change over time.
pub struct SkeletonTransform {
    matrix: DMat3,
    translation: DVec3,
    /// The orthogonal Q of M = s·Q; `None` if M has uneven scale, shear or zero scale.
    orthogonal: Option<DMat3>,
}

impl SkeletonTransform {
    pub fn new(transform: Affine3A) -> Self {
        let matrix = Mat3::from(transform.matrix3).as_dmat3();
        let translation = transform.translation.as_dvec3();
        Self { matrix, translation, orthogonal: orthogonal(matrix) }
    }

    /// Returns whether the transform makes every rotation in the skeleton a rotation in the world,
    /// as it does without uneven scale, shear and zero scale.
    pub fn is_even(&self) -> bool {
        self.orthogonal.is_some()
    }

    pub fn origin(&self) -> DVec3 {
        self.translation
    }

    /// Converts a vector of the space in which a joint without a parent has its offset.
    pub fn vector(&self, vector: DVec3) -> DVec3 {
        self.matrix * vector
    }

    /// Converts the joints' rotations relative to their parents from the skeleton's axes to world
    /// axes. Parents come before their children.
    pub fn nodes(&self, parents: &[Option<usize>], locals: &[DMat3]) -> Vec<BvhNodeTransform> {
        if let Some(orthogonal) = self.orthogonal {
            let node = |local: &DMat3| BvhNodeTransform {
                rotation: orthogonal * *local * orthogonal.transpose(),
                vectors: self.matrix,
            };
            return locals.iter().map(node).collect();
        }
        let (mut globals, mut worlds, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
        for (local, parent) in locals.iter().zip(parents) {
            let parent_of = |all: &[DMat3]| parent.map_or(DMat3::IDENTITY, |parent| all[parent]);
            let global = parent_of(&globals) * *local;
            let world = nearest(self.matrix * global * self.matrix.transpose());
            nodes.push(BvhNodeTransform {
                rotation: parent_of(&worlds).transpose() * world,
                vectors: world.transpose() * self.matrix * global,
            });
            globals.push(global);
            worlds.push(world);
        }
        nodes
    }
}

/// The transform of a node of the file in one frame.
pub struct BvhNodeTransform {
    /// Rotation relative to the parent, in world axes.
    pub rotation: DMat3,
    /// Converts a vector of the joint's space to the node's space: an offset of a child, or the
    /// bone.
    pub vectors: DMat3,
}

/// The orthogonal Q of a matrix s·Q; `None` if the matrix has uneven scale, shear or zero scale.
fn orthogonal(matrix: DMat3) -> Option<DMat3> {
    /// Tolerance for right angles and equal lengths; the same as for the frames of joints.
    const EVEN: f64 = 1e-5;
    let square = matrix.transpose() * matrix;
    let size = (square.x_axis.x + square.y_axis.y + square.z_axis.z) / 3.0;
    let is_even = size > 0.0 && (square * size.recip()).abs_diff_eq(DMat3::IDENTITY, EVEN);
    // The matrix was rounded to f32 and is orthogonal only nearly. The nearest rotation is
    // orthogonal in f64.
    let sign = matrix.determinant().signum();
    is_even.then(|| nearest(matrix * (sign / size.sqrt())) * sign)
}

/// The rotation W that minimizes ‖W − matrix‖; the identity for a zero or non-finite matrix.
fn nearest(matrix: DMat3) -> DMat3 {
    const PRECISION: f64 = 1e-15;
    const STEPS: usize = 1000;
    let size = matrix.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
    if !(size.is_normal() && size.recip().is_normal()) {
        return DMat3::IDENTITY;
    }
    let unit = matrix * size.recip();
    let decomposed = Matrix3::from_column_slice(&unit.to_cols_array())
        .try_svd(true, true, PRECISION, STEPS)
        .and_then(|svd| Some((svd.u?, svd.v_t?)));
    let Some((u, v_t)) = decomposed else {
        return DMat3::IDENTITY;
    };
    // The singular values are in descending order. The mirror is applied to the last, smallest one.
    let mirror = (u * v_t).determinant().signum();
    let rotation = u * Matrix3::from_diagonal(&[1.0, 1.0, mirror].into()) * v_t;
    let rotation = DMat3::from_cols_slice(rotation.as_slice());
    if rotation.is_finite() { rotation } else { DMat3::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_there_twice_get_numbers_that_are_free() {
        let names = ["a", "a", "a_2", "b", "a", "a_2"].map(str::to_owned);
        assert_eq!(distinct(&names), ["a", "a_3", "a_2", "b", "a_4", "a_2_2"]);
    }

    #[test]
    fn a_word_has_no_space_and_no_brace() {
        assert_eq!(word(" left arm\t{1}"), "left_arm__1_");
    }

    #[test]
    fn the_nearest_rotation_to_a_rotation_is_itself() {
        let rotation = DMat3::from_rotation_z(1.0) * DMat3::from_rotation_x(-2.0);
        assert!(nearest(rotation * 7.0).abs_diff_eq(rotation, 1e-12));
        assert_eq!(nearest(DMat3::ZERO), DMat3::IDENTITY);
    }

    #[test]
    fn a_mirrored_and_scaled_transform_is_even_and_a_stretched_one_is_not() {
        let turned = Affine3A::from_rotation_x(0.7) * Affine3A::from_rotation_z(2.0);
        let scaled = |x, y, z| Affine3A::from_scale((x, y, z).into()) * turned;
        assert!(SkeletonTransform::new(scaled(-0.3, 0.3, 0.3)).is_even());
        assert!(!SkeletonTransform::new(scaled(0.3, 0.3, 0.301)).is_even());
        assert!(!SkeletonTransform::new(scaled(0.0, 1.0, 1.0)).is_even());
        assert!(!SkeletonTransform::new(scaled(0.0, 0.0, 0.0)).is_even());
    }
}
