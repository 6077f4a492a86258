use core::iter;
use std::collections::{BTreeSet, HashMap, HashSet};

use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};

use crate::io::formats::gltf::extras::Extras;
use crate::io::formats::gltf::file::{GltfFile, GltfNode, index_rule};
use crate::io::json::{FieldError, JsonNumbers, JsonPath, Whole};
use crate::kinematics::skeleton::{Skeleton, SkeletonError};

/// The nodes of a file as a tree.
#[derive(Clone)]
pub struct NodeTree {
    pub parents: Vec<Option<usize>>,
    pub children: Vec<Vec<usize>>,
    /// All nodes, parents before their children.
    pub order: Vec<usize>,
    /// Transforms of the nodes relative to their parents, without animation.
    pub locals: Vec<NodeTransform>,
}

/// The transform of a node relative to its parent, in the form that the file has.
#[derive(Clone, Copy, PartialEq)]
pub enum NodeTransform {
    TransformParts(TransformParts),
    Matrix(DAffine3),
}

/// A transform in parts, which animations can change one by one.
#[derive(Clone, Copy, PartialEq)]
pub struct TransformParts {
    pub translation: DVec3,
    /// A unit quaternion.
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl NodeTransform {
    pub fn affine(&self) -> DAffine3 {
        match *self {
            Self::TransformParts(TransformParts { translation, rotation, scale }) => {
                DAffine3::from_scale_rotation_translation(scale, rotation, translation)
            }
            Self::Matrix(matrix) => matrix,
        }
    }
}

pub fn at_node(index: usize) -> JsonPath {
    JsonPath::root().key("nodes").index(index)
}

impl NodeTree {
    pub fn new(file: &GltfFile<'_>) -> Result<Self, FieldError> {
        let nodes = &file.nodes.0;
        let parents = parents(nodes)?;
        let order = order(nodes, &parents)?;
        let locals = nodes.iter().enumerate().map(|(index, node)| local(index, node));
        let mut children = vec![Vec::new(); nodes.len()];
        for (node, parent) in parents.iter().enumerate() {
            if let Some(parent) = parent {
                children[*parent].push(node);
            }
        }
        Ok(Self { order, locals: locals.collect::<Result<_, _>>()?, children, parents })
    }

    /// For each node, whether it is one of `nodes` or above one of them.
    pub fn with_ancestors(&self, nodes: impl IntoIterator<Item = usize>) -> Vec<bool> {
        let mut is_in = vec![false; self.parents.len()];
        nodes.into_iter().for_each(|node| is_in[node] = true);
        for node in self.order.iter().rev().copied() {
            if let Some(parent) = self.parents[node].filter(|_| is_in[node]) {
                is_in[parent] = true;
            }
        }
        is_in
    }

    /// For each node, the number of nodes that are counted, of itself and those below.
    fn count_below(&self, is_counted: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut below = vec![0_usize; self.parents.len()];
        for node in self.order.iter().rev().copied() {
            below[node] += usize::from(is_counted(node));
            if let Some(parent) = self.parents[node] {
                below[parent] += below[node];
            }
        }
        below
    }

    /// For each node, the root of its tree.
    pub fn roots(&self) -> Vec<usize> {
        let mut roots: Vec<usize> = (0..self.parents.len()).collect();
        for &node in &self.order {
            if let Some(parent) = self.parents[node] {
                roots[node] = roots[parent];
            }
        }
        roots
    }

    /// Transforms of all nodes to the world, without animation.
    pub fn worlds(&self) -> Vec<DAffine3> {
        let mut worlds = vec![DAffine3::IDENTITY; self.parents.len()];
        for &node in &self.order {
            let parent = self.parents[node].map_or(DAffine3::IDENTITY, |parent| worlds[parent]);
            worlds[node] = parent * self.locals[node].affine();
        }
        worlds
    }
}

fn parents(nodes: &[GltfNode]) -> Result<Vec<Option<usize>>, FieldError> {
    let mut parents = vec![None; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for (position, child) in node.children.iter().flatten().enumerate() {
            let error =
                |reason| FieldError::new(at_node(index).key("children").index(position), reason);
            let child = child.0 as usize;
            match parents.get_mut(child) {
                None => return Err(error(index_rule("nodes", nodes.len(), child))),
                Some(Some(other)) => {
                    let reason =
                        format!("node {child} must have one parent, got {other} and {index}");
                    return Err(error(reason));
                }
                Some(parent) => *parent = Some(index),
            }
        }
    }
    Ok(parents)
}

/// Returns the indices of all nodes, parents before their children. Fails if a node is its own
/// ancestor.
fn order(nodes: &[GltfNode], parents: &[Option<usize>]) -> Result<Vec<usize>, FieldError> {
    let mut order: Vec<usize> = (0..nodes.len()).filter(|node| parents[*node].is_none()).collect();
    let mut done = 0;
    while let Some(node) = order.get(done).and_then(|node| nodes.get(*node)) {
        order.extend(node.children.iter().flatten().map(|child| child.0 as usize));
        done += 1;
    }
    if order.len() < nodes.len() {
        let mut is_placed = vec![false; nodes.len()];
        order.iter().for_each(|node| is_placed[*node] = true);
        let node = is_placed.iter().position(|is_placed| !is_placed).unwrap_or_default();
        return Err(FieldError::new(at_node(node), "must not be its own ancestor"));
    }
    Ok(order)
}

fn local(index: usize, node: &GltfNode) -> Result<NodeTransform, FieldError> {
    if let Some(matrix) = &node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.0.map(f64::from));
        if matrix.row(3) != DVec4::W {
            let row = matrix.row(3).to_array();
            let reason = format!("last row must be [0, 0, 0, 1], got {row:?}");
            return Err(FieldError::new(at_node(index).key("matrix"), reason));
        }
        return Ok(NodeTransform::Matrix(DAffine3::from_mat4(matrix)));
    }
    let rotation = match node.rotation {
        None => DQuat::IDENTITY,
        Some(JsonNumbers(rotation)) => unit(rotation.map(f64::from)).ok_or_else(|| {
            let reason = "must not be four zeros; the identity is [0, 0, 0, 1]";
            FieldError::new(at_node(index).key("rotation"), reason)
        })?,
    };
    let translation = node.translation.unwrap_or_default().0.as_dvec3();
    let scale = node.scale.map_or(DVec3::ONE, |scale| scale.0.as_dvec3());
    Ok(NodeTransform::TransformParts(TransformParts { translation, rotation, scale }))
}

/// The normalized quaternion; `None` if its length is almost 0 or not finite.
pub fn unit(rotation: [f64; 4]) -> Option<DQuat> {
    const SHORTEST: f64 = 1e-6;
    let rotation = DVec4::from_array(rotation);
    let length = rotation.length();
    (length > SHORTEST && length.is_finite()).then(|| DQuat::from_vec4(rotation / length))
}

/// The joints of a figure, parents before their children: those of its skins, and other nodes of its
/// hierarchy that animations move.
pub struct SkinJoints {
    /// The node of each joint.
    pub nodes: Vec<usize>,
    /// For each joint the node that moves the skin: that of the joint, or in files of this program
    /// one below it that stretches the skin.
    pub skin_nodes: Vec<usize>,
    /// The parent of each joint: the joint of its nearest ancestor node that is a joint. Nodes
    /// between the two joints are skipped. `None` for a root.
    pub parents: Vec<Option<usize>>,
    /// For each skin of the figure, for each of its joints in the order of the file, the index in
    /// `nodes`.
    pub of_skins: Vec<Vec<usize>>,
    /// The joints that no skin lists, in the order of the file's nodes.
    pub added: Vec<usize>,
}

pub fn at_skin(skin: usize) -> JsonPath {
    JsonPath::root().key("skins").index(skin)
}

impl SkinJoints {
    /// The joints of the skins of a figure, and those `parts` that have a root in common with one of
    /// them and are no joints of other skins.
    pub fn new(
        file: &GltfFile<'_>,
        nodes: &NodeTree,
        skins: &[usize],
        parts: &BTreeSet<usize>,
    ) -> Result<Self, FieldError> {
        let mut listed = Vec::new();
        let mut all = HashSet::new();
        let mut stretching = HashMap::new();
        for &skin in skins {
            for node in listed_joints(file, skin)? {
                let joint = stretched_joint(file, nodes, node);
                if all.insert(joint) {
                    listed.push(joint);
                }
                stretching.insert(joint, node);
            }
            // The maximum is doubled, because tips of bones are joints in the file, but not in the
            // skeleton.
            if listed.len() > 2 * Skeleton::MOST_JOINTS {
                let reason = SkeletonError::TooMany.to_string();
                return Err(FieldError::new(at_skin(skin).key("joints"), reason));
            }
        }
        let roots = nodes.roots();
        let own: HashSet<usize> = listed.iter().map(|node| roots[*node]).collect();
        let own_skins: HashSet<usize> = skins.iter().copied().collect();
        let others = (0..file.skins.0.len()).filter(|skin| !own_skins.contains(skin));
        let others = others.flat_map(|skin| &file.skins.0[skin].joints);
        let of_others: HashSet<usize> = others.map(|joint| joint.0 as usize).collect();
        let is_added = |node: &usize| {
            own.contains(&roots[*node]) && !all.contains(node) && !of_others.contains(node)
        };
        let added: Vec<usize> = parts.iter().copied().filter(is_added).collect();
        if listed.len() + added.len() > 2 * Skeleton::MOST_JOINTS {
            let at = at_skin(skins.first().copied().unwrap_or_default()).key("joints");
            return Err(FieldError::new(at, SkeletonError::TooMany.to_string()));
        }
        let mut joints = Self::sorted(nodes, &listed, &added);
        let places = joints.nodes.iter().enumerate();
        let places: HashMap<usize, usize> = places.map(|(joint, node)| (*node, joint)).collect();
        for &skin in skins {
            let of_skin = file.skins.0[skin].joints.iter();
            let joint = |node: &Whole| stretched_joint(file, nodes, node.0 as usize);
            joints.of_skins.push(of_skin.map(|node| places[&joint(node)]).collect());
        }
        for (node, skin_node) in joints.nodes.iter().zip(&mut joints.skin_nodes) {
            *skin_node = stretching.get(node).copied().unwrap_or(*node);
        }
        Ok(joints)
    }

    /// The joints in the order of the file: those that skins list, each once, and then others.
    pub fn in_order_of_file(&self) -> impl Iterator<Item = usize> {
        let mut seen = HashSet::new();
        let listed = self.of_skins.iter().flatten().chain(&self.added).copied();
        listed.filter(move |joint| seen.insert(*joint))
    }

    /// The nodes below joints that only stretch the skin.
    pub fn stretching<'a>(&'a self, nodes: &'a NodeTree) -> impl Iterator<Item = usize> + 'a {
        self.nodes.iter().zip(&self.skin_nodes).flat_map(|(joint, skin_node)| {
            let upwards = iter::successors(Some(*skin_node), |node| nodes.parents[*node]);
            upwards.take_while(move |node| node != joint)
        })
    }

    /// For a file without a skin, these `parts` with their ancestors, up to the nearest one that all
    /// parts and meshes of a tree have in common, so that meshes beside moving nodes have a joint
    /// to stay at. A tree with meshes and without parts has its root as a joint.
    pub fn of_parts(file: &GltfFile<'_>, nodes: &NodeTree, parts: &BTreeSet<usize>) -> Self {
        let has_mesh = |node: usize| file.nodes.0[node].mesh.is_some();
        let parts_below = nodes.count_below(|node| parts.contains(&node));
        let all_below = nodes.count_below(|node| parts.contains(&node) || has_mesh(node));
        let roots = nodes.roots();
        // An ancestor above which all of the tree is in one branch is left out.
        let is_above = |node: usize| {
            let all = all_below[roots[node]];
            let mut children = nodes.children[node].iter();
            let is_one = parts.contains(&node) || has_mesh(node);
            !is_one && children.any(|child| all_below[*child] == all)
        };
        let is_joint = |node: &usize| match parts_below[*node] {
            0 => roots[*node] == *node && all_below[*node] > 0,
            _ => !is_above(*node),
        };
        let added: Vec<usize> = (0..nodes.parents.len()).filter(is_joint).collect();
        Self::sorted(nodes, &[], &added)
    }

    /// Sorts the joints so that parents come before their children, otherwise in the listed order.
    fn sorted(nodes: &NodeTree, of_skins: &[usize], added: &[usize]) -> Self {
        let listed: Vec<usize> = of_skins.iter().chain(added).copied().collect();
        let parent_of = nearest_listed_ancestors(nodes, &listed);
        let mut joint_of = vec![None; nodes.parents.len()];
        let mut joints = Self {
            nodes: Vec::new(),
            skin_nodes: Vec::new(),
            parents: Vec::new(),
            of_skins: Vec::new(),
            added: Vec::new(),
        };
        for &node in &listed {
            let unplaced = |node: &usize| joint_of[*node].is_none();
            let path = iter::successors(Some(node), |node| parent_of[*node]).take_while(unplaced);
            for node in path.collect::<Vec<_>>().into_iter().rev() {
                joint_of[node] = Some(joints.nodes.len());
                joints.parents.push(parent_of[node].and_then(|parent| joint_of[parent]));
                joints.nodes.push(node);
            }
        }
        joints.skin_nodes.clone_from(&joints.nodes);
        joints.added = added.iter().filter_map(|node| joint_of[*node]).collect();
        joints
    }
}

/// The joint whose skin a node stretches, in a file of this program: the nearest node above it that
/// does not; else the node itself.
pub fn stretched_joint(file: &GltfFile<'_>, nodes: &NodeTree, node: usize) -> usize {
    let stretches = |node: usize| {
        let extras = file.nodes.0[node].extras.as_ref().and_then(Extras::own);
        extras.is_some_and(|extras| extras.stretches_skin())
    };
    let mut joint = node;
    while let Some(above) = nodes.parents[joint].filter(|_| stretches(joint)) {
        joint = above;
    }
    if file.asset.0.is_of_this_program() { joint } else { node }
}

/// The nodes that are joints of a skin.
fn listed_joints(file: &GltfFile<'_>, skin: usize) -> Result<Vec<usize>, FieldError> {
    let at = at_skin(skin).key("joints");
    let joints = &file.skins.0[skin].joints;
    if joints.is_empty() {
        return Err(FieldError::new(at, "must have at least one joint"));
    }
    if joints.len() > 2 * Skeleton::MOST_JOINTS {
        return Err(FieldError::new(at, SkeletonError::TooMany.to_string()));
    }
    let mut seen = HashSet::new();
    for (position, joint) in joints.iter().enumerate() {
        let joint = joint.0 as usize;
        let error = |reason| FieldError::new(at.clone().index(position), reason);
        if joint >= file.nodes.0.len() {
            return Err(error(index_rule("nodes", file.nodes.0.len(), joint)));
        }
        if !seen.insert(joint) {
            return Err(error(format!("joints must be unique, got node {joint} twice")));
        }
    }
    Ok(joints.iter().map(|joint| joint.0 as usize).collect())
}

/// For each node, its nearest ancestor that is in `listed`; `None` if no ancestor is.
fn nearest_listed_ancestors(nodes: &NodeTree, listed: &[usize]) -> Vec<Option<usize>> {
    let mut is_listed = vec![false; nodes.parents.len()];
    listed.iter().for_each(|node| is_listed[*node] = true);
    let mut ancestors = vec![None; nodes.parents.len()];
    for &node in &nodes.order {
        ancestors[node] = nodes.parents[node]
            .and_then(|parent| if is_listed[parent] { Some(parent) } else { ancestors[parent] });
    }
    ancestors
}
