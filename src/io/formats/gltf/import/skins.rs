use std::collections::{BTreeSet, HashSet};

use super::file::{GltfFile, GltfNode, GltfSkin, index_rule};
use super::nodes::NodeTree;
use crate::io::formats::gltf::names::UniqueNames;
use crate::io::json::FieldError;
use crate::io::json::JsonPath;
use crate::kinematics::skeleton::{Skeleton, SkeletonError};

/// The joints of a skeleton, parents before their children: those of a skin, and other nodes of its
/// hierarchy that animations move.
pub struct SkinJoints {
    /// The node of each joint.
    pub nodes: Vec<usize>,
    /// The parent of each joint: the joint of its nearest ancestor node that is a joint. Nodes
    /// between the two joints are skipped. `None` for a root.
    pub parents: Vec<Option<usize>>,
    /// For each joint in the order of the file's skin, its index in `nodes`.
    pub order: Vec<usize>,
    /// The joints that the skin does not list, in the order of the file's nodes.
    pub added: Vec<usize>,
}

/// Returns a unique name for each skin: its own name, otherwise the name of the first node with the
/// skin, otherwise `skin_` and its number. A file without skins has one skeleton if nodes move,
/// with the name of the first root of the `moving` nodes.
pub fn names(file: &GltfFile<'_>, nodes: &NodeTree, moving: &BTreeSet<usize>) -> Vec<String> {
    if file.skins.0.is_empty() {
        let roots = nodes.roots();
        let root = moving.first().and_then(|node| file.nodes.0.get(roots[*node]));
        let name = |root: &GltfNode| root.name.clone().filter(|name| !name.trim().is_empty());
        let name = root.map(|root| name(root).unwrap_or_else(|| "skeleton".to_owned()));
        return name.into_iter().collect();
    }
    let mut users = vec![None; file.skins.0.len()];
    for node in &file.nodes.0 {
        let user = node.skin.and_then(|skin| users.get_mut(skin.0 as usize));
        if let Some(user) = user {
            *user = user.or(node.name.as_deref());
        }
    }
    let mut names = UniqueNames::default();
    let name = |(index, (skin, user)): (usize, (&GltfSkin, Option<&str>))| {
        let name = skin.name.as_deref().or(user).filter(|name| !name.trim().is_empty());
        names.free(name.unwrap_or(&format!("skin_{index}")))
    };
    file.skins.0.iter().zip(users).enumerate().map(name).collect()
}

pub fn at_skin(skin: usize) -> JsonPath {
    JsonPath::root().key("skins").index(skin)
}

impl SkinJoints {
    /// The joints of a skin, and those `moving` nodes that have a root in common with one of them.
    pub fn new(
        file: &GltfFile<'_>,
        nodes: &NodeTree,
        index: usize,
        skin: &GltfSkin,
        moving: &BTreeSet<usize>,
    ) -> Result<Self, FieldError> {
        let at = at_skin(index).key("joints");
        if skin.joints.is_empty() {
            return Err(FieldError::new(at, "must have at least one joint"));
        }
        // The maximum is doubled, because tips of bones are joints in the file, but not in the
        // skeleton.
        if skin.joints.len() > 2 * Skeleton::MOST_JOINTS {
            return Err(FieldError::new(at, SkeletonError::TooMany.to_string()));
        }
        let mut seen = HashSet::new();
        for (position, joint) in skin.joints.iter().enumerate() {
            let joint = joint.0 as usize;
            let error = |reason| FieldError::new(at.clone().index(position), reason);
            if joint >= file.nodes.0.len() {
                return Err(error(index_rule("nodes", file.nodes.0.len(), joint)));
            }
            if !seen.insert(joint) {
                return Err(error(format!("joints must be unique, got node {joint} twice")));
            }
        }
        let listed: Vec<usize> = skin.joints.iter().map(|joint| joint.0 as usize).collect();
        let roots = nodes.roots();
        let own: HashSet<usize> = listed.iter().map(|node| roots[*node]).collect();
        let is_added = |node: &usize| own.contains(&roots[*node]) && !seen.contains(node);
        let added: Vec<usize> = moving.iter().copied().filter(is_added).collect();
        if listed.len() + added.len() > 2 * Skeleton::MOST_JOINTS {
            return Err(FieldError::new(at, SkeletonError::TooMany.to_string()));
        }
        Ok(Self::sorted(nodes, &listed, &added))
    }

    /// For a file without a skin, the `moving` nodes with their ancestors up to the nearest one
    /// that all moving nodes of a tree have in common. `None` if no node moves.
    pub fn of_moving(nodes: &NodeTree, moving: &BTreeSet<usize>) -> Option<Self> {
        let mut below = vec![0_usize; nodes.parents.len()];
        for node in nodes.order.iter().rev().copied() {
            below[node] += usize::from(moving.contains(&node));
            if let Some(parent) = nodes.parents[node] {
                below[parent] += below[node];
            }
        }
        let roots = nodes.roots();
        // An ancestor above which all moving nodes of the tree are in one branch is left out.
        let is_above = |node: usize| {
            let all = below[roots[node]];
            let mut children = nodes.children[node].iter();
            !moving.contains(&node) && children.any(|child| below[*child] == all)
        };
        let is_joint = |node: &usize| below[*node] > 0 && !is_above(*node);
        let added: Vec<usize> = (0..nodes.parents.len()).filter(is_joint).collect();
        (!added.is_empty()).then(|| Self::sorted(nodes, &[], &added))
    }

    /// Sorts the joints so that parents come before their children, otherwise in the listed order.
    fn sorted(nodes: &NodeTree, skin: &[usize], added: &[usize]) -> Self {
        let listed: Vec<usize> = skin.iter().chain(added).copied().collect();
        let parent_of = nearest_listed_ancestors(nodes, &listed);
        let mut joint_of = vec![None; nodes.parents.len()];
        let mut joints =
            Self { nodes: Vec::new(), parents: Vec::new(), order: Vec::new(), added: Vec::new() };
        for &node in &listed {
            let unplaced = |node: &usize| joint_of[*node].is_none();
            let path =
                std::iter::successors(Some(node), |node| parent_of[*node]).take_while(unplaced);
            for node in path.collect::<Vec<_>>().into_iter().rev() {
                joint_of[node] = Some(joints.nodes.len());
                joints.parents.push(parent_of[node].and_then(|parent| joint_of[parent]));
                joints.nodes.push(node);
            }
        }
        joints.order = skin.iter().filter_map(|node| joint_of[*node]).collect();
        joints.added = added.iter().filter_map(|node| joint_of[*node]).collect();
        joints
    }
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
