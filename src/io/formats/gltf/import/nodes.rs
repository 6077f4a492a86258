use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};

use super::file::{GltfFile, GltfNode, index_rule};
use crate::io::json::FieldError;
use crate::io::json::JsonNumbers;
use crate::io::json::JsonPath;

/// The nodes of a file as a tree.
pub struct NodeTree {
    pub parents: Vec<Option<usize>>,
    pub children: Vec<Vec<usize>>,
    /// All nodes, parents before their children.
    pub order: Vec<usize>,
    /// Transforms of the nodes relative to their parents, without animation.
    pub locals: Vec<NodeTransform>,
}

/// The transform of a node relative to its parent, in the form that the file has.
#[derive(Clone, Copy)]
pub enum NodeTransform {
    TransformParts(TransformParts),
    Matrix(DAffine3),
}

/// A transform in parts, which animations can change one by one.
#[derive(Clone, Copy)]
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
