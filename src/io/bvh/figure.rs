use glam::{DMat3, DVec3, Mat3, Vec3};

use super::angles;
use super::names::{distinct, word};
use super::place::Place;
use crate::document::{Arm, Document, RigKind};
use crate::kinematics::skeleton::{Joint, Skeleton};

/// The nodes of a hierarchy: parents before their children, and what hangs from a node right after
/// it.
pub struct Figure {
    pub names: Vec<String>,
    pub parents: Vec<Option<usize>>,
    /// What the nodes are.
    kind: Kind,
}

enum Kind {
    Arm,
    /// For every node the joint that it is; none for the one that holds several roots.
    Skeleton(Vec<Option<usize>>),
}

/// How a figure stands, in units of the scene.
#[derive(Clone, Debug)]
pub struct Stance {
    /// For every node, where its base is from its parent's when nothing is turned; of the first one
    /// where it is in the world.
    pub offsets: Vec<DVec3>,
    /// For every node where its bone ends when nothing is turned, if nothing hangs from it.
    pub ends: Vec<Option<DVec3>>,
    /// For every node what turns it against its parent, in the world.
    pub turns: Vec<DMat3>,
}

impl Figure {
    /// What a document shows; nothing of a skeleton without joints.
    pub fn new(document: &Document) -> Option<Self> {
        match document.rig {
            RigKind::Arm => Some(Self {
                names: ["upper", "lower"].map(str::to_owned).into(),
                parents: vec![None, Some(0)],
                kind: Kind::Arm,
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
                Some(parent) => children[parent].push(index),
                None => roots.push(index),
            }
        }
        let is_held = roots.len() > 1;
        let (mut nodes, mut parents, mut names) = (Vec::new(), Vec::new(), Vec::new());
        if is_held {
            (nodes, parents, names) =
                (vec![None], vec![None], vec![skeleton.free_name("skeleton")]);
        }
        let holder = is_held.then_some(0);
        let mut next: Vec<_> = roots.iter().rev().map(|root| (*root, holder)).collect();
        while let Some((joint, parent)) = next.pop() {
            let node = nodes.len();
            nodes.push(Some(joint));
            parents.push(parent);
            names.push(word(&joints[joint].name));
            next.extend(children[joint].iter().rev().map(|child| (*child, Some(node))));
        }
        let names = distinct(&names);
        (!nodes.is_empty()).then_some(Self { names, parents, kind: Kind::Skeleton(nodes) })
    }

    /// How it stands in a document that is brought to a time.
    pub fn stance(&self, document: &Document, place: &Place, time: f64) -> Stance {
        match &self.kind {
            Kind::Arm => arm(&document.arm),
            Kind::Skeleton(nodes) => self.skeleton(nodes, &document.skeleton_rig.at(time), place),
        }
    }

    fn skeleton(&self, nodes: &[Option<usize>], skeleton: &Skeleton, place: &Place) -> Stance {
        let joint = |node: &Option<usize>| node.and_then(|joint| skeleton.joint(joint));
        let offset = |node| match joint(node) {
            None => place.origin(),
            Some(joint) => place.vector(joint.offset.as_dvec3()),
        };
        let mut offsets: Vec<DVec3> = nodes.iter().map(offset).collect();
        if let (Some(Some(_)), Some(first)) = (nodes.first(), offsets.first_mut()) {
            *first += place.origin();
        }
        let mut is_leaf = vec![true; nodes.len()];
        for parent in self.parents.iter().flatten() {
            is_leaf[*parent] = false;
        }
        let end = |joint: &Joint| place.vector(joint.axis.as_dvec3());
        let ends = nodes.iter().zip(is_leaf);
        let ends = ends.map(|(node, is_leaf)| joint(node).filter(|_| is_leaf).map(end)).collect();
        let local = |node| joint(node).map_or(DMat3::IDENTITY, local_rotation);
        let locals: Vec<DMat3> = nodes.iter().map(local).collect();
        Stance { offsets, ends, turns: place.turns(&self.parents, &locals) }
    }
}

/// As [`Joint::local_rotation`], in f64.
fn local_rotation(joint: &Joint) -> DMat3 {
    let turned = angles::matrix(joint.rotation.as_dvec3());
    if joint.frame == Mat3::IDENTITY {
        return turned;
    }
    let frame = joint.frame.as_dmat3();
    frame * turned * frame.transpose()
}

/// Two bones along +x; the elbow is a hinge about z.
fn arm(arm: &Arm) -> Stance {
    let pose = arm.pose();
    let (along, out) = (f64::from(pose.along), f64::from(pose.out));
    let upper = out.atan2(along);
    let lower = (-out).atan2(f64::from(pose.distance) - along);
    let limb = pose.facing.limb_frame().as_dmat3();
    let socket = DMat3::from_rotation_x(f64::from(pose.spin));
    let bones = arm.bones.stretched(pose.stretch);
    let bone = |length: f32| Vec3::new(length, 0.0, 0.0).as_dvec3();
    Stance {
        offsets: vec![arm.root.as_dvec3(), bone(bones.upper())],
        ends: vec![None, Some(bone(bones.lower()))],
        turns: vec![
            limb * socket * DMat3::from_rotation_z(upper),
            DMat3::from_rotation_z(lower - upper),
        ],
    }
}
