use std::collections::{HashMap, HashSet};

use glam::{DMat3, DVec3, Mat3, Vec3};

use super::transform::SkeletonTransform;
use crate::document::{Document, Posed, RigKind};
use crate::kinematics::skeleton::{Joint, JointId, Skeleton, exact_angles};

/// The nodes of a hierarchy in the order of the file: each node is followed by its descendants.
pub struct BvhRig {
    pub names: Vec<String>,
    pub parents: Vec<Option<usize>>,
    /// The joints of a skeleton or the limbs of the arm that the nodes stand for.
    kind: BvhRigKind,
}

enum BvhRigKind {
    Arm,
    /// The joint of each node; `None` for the root added above several roots.
    Skeleton(Vec<Option<usize>>),
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
    /// The hierarchy of the shown rig; `None` for a skeleton without joints.
    pub fn new(document: &Document) -> Option<Self> {
        match document.rig {
            RigKind::Arm => Some(Self {
                names: ["upper", "lower"].map(str::to_owned).into(),
                parents: vec![None, Some(0)],
                kind: BvhRigKind::Arm,
            }),
            RigKind::Skeleton => Self::of_skeleton(document.skeleton()),
        }
    }

    fn of_skeleton(skeleton: &Skeleton) -> Option<Self> {
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
        (!nodes.is_empty()).then_some(Self { names, parents, kind: BvhRigKind::Skeleton(nodes) })
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
        match &self.kind {
            BvhRigKind::Arm => arm(posed),
            BvhRigKind::Skeleton(nodes) => self.skeleton(nodes, posed.skeleton(), transform),
        }
    }

    fn skeleton(
        &self,
        nodes: &[Option<usize>],
        skeleton: &Skeleton,
        transform: &SkeletonTransform,
    ) -> BvhPose {
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

/// The pose of the arm as two bones along +x, with the elbow as a hinge about z.
fn arm(posed: &Posed) -> BvhPose {
    let (arm, pose) = (posed.arm(), posed.arm_pose());
    let (along, out) = (f64::from(pose.along), f64::from(pose.out));
    let upper = out.atan2(along);
    let lower = (-out).atan2(f64::from(pose.distance) - along);
    let limb = pose.pointer.limb_frame().as_dmat3();
    let socket = DMat3::from_rotation_x(f64::from(pose.twist));
    let bones = arm.bones.stretched(pose.stretch);
    let bone = |length: f32| Vec3::new(length, 0.0, 0.0).as_dvec3();
    BvhPose {
        offsets: vec![arm.root.as_dvec3(), bone(bones.upper())],
        ends: vec![None, Some(bone(bones.lower()))],
        rotations: vec![
            limb * socket * DMat3::from_rotation_z(upper),
            DMat3::from_rotation_z(lower - upper),
        ],
    }
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
}
