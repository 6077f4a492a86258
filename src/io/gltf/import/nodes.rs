use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};

use super::file::{File, Node};
use crate::io::field_error::FieldError;
use crate::io::json_path::JsonPath;
use crate::io::value::Numbers;

/// The tree of nodes.
pub struct Nodes {
    pub parents: Vec<Option<usize>>,
    /// All of them, parents before their children.
    pub order: Vec<usize>,
    /// Each in its parent, at rest.
    pub locals: Vec<Local>,
}

/// A transform in the parent's space, as a file has it.
#[derive(Clone, Copy)]
pub enum Local {
    Parts(Parts),
    Matrix(DAffine3),
}

/// What animations change.
#[derive(Clone, Copy)]
pub struct Parts {
    pub translation: DVec3,
    /// A unit quaternion.
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl Local {
    pub fn affine(&self) -> DAffine3 {
        match *self {
            Self::Parts(Parts { translation, rotation, scale }) => {
                DAffine3::from_scale_rotation_translation(scale, rotation, translation)
            }
            Self::Matrix(matrix) => matrix,
        }
    }
}

pub fn at_node(index: usize) -> JsonPath {
    JsonPath::root().key("nodes").index(index)
}

impl Nodes {
    pub fn new(file: &File) -> Result<Self, FieldError> {
        let nodes = &file.nodes.0;
        let parents = parents(nodes)?;
        let order = order(nodes, &parents)?;
        let locals = nodes.iter().enumerate().map(|(index, node)| local(index, node));
        Ok(Self { order, locals: locals.collect::<Result<_, _>>()?, parents })
    }
}

fn parents(nodes: &[Node]) -> Result<Vec<Option<usize>>, FieldError> {
    let mut parents = vec![None; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for (place, child) in node.children.iter().flatten().enumerate() {
            let wrong =
                |reason| FieldError::new(at_node(index).key("children").index(place), reason);
            let child = child.0 as usize;
            match parents.get_mut(child) {
                None => return Err(wrong(format!("there is no node {child}"))),
                Some(Some(other)) => {
                    let reason = format!("node {child} already hangs from node {other}");
                    return Err(wrong(reason));
                }
                Some(parent) => *parent = Some(index),
            }
        }
    }
    Ok(parents)
}

/// Every node after its parent, which there is unless nodes hang from each other in a ring.
fn order(nodes: &[Node], parents: &[Option<usize>]) -> Result<Vec<usize>, FieldError> {
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
        return Err(FieldError::new(at_node(node), "hangs from itself, by way of others or not"));
    }
    Ok(order)
}

fn local(index: usize, node: &Node) -> Result<Local, FieldError> {
    if let Some(matrix) = &node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.0.map(f64::from));
        if matrix.row(3) != DVec4::W {
            let reason =
                "the last number of its first three columns must be 0, that of the fourth 1";
            return Err(FieldError::new(at_node(index).key("matrix"), reason));
        }
        return Ok(Local::Matrix(DAffine3::from_mat4(matrix)));
    }
    let rotation = match node.rotation {
        None => DQuat::IDENTITY,
        Some(Numbers(rotation)) => unit(rotation.map(f64::from)).ok_or_else(|| {
            let reason = "four zeros turn nothing; no rotation is [0, 0, 0, 1]";
            FieldError::new(at_node(index).key("rotation"), reason)
        })?,
    };
    let translation = node.translation.unwrap_or_default().0.as_dvec3();
    let scale = node.scale.map_or(DVec3::ONE, |scale| scale.0.as_dvec3());
    Ok(Local::Parts(Parts { translation, rotation, scale }))
}

/// The unit quaternion that turns as one of any length does; none if it has no length.
pub fn unit(rotation: [f64; 4]) -> Option<DQuat> {
    const SHORTEST: f64 = 1e-6;
    let rotation = DVec4::from_array(rotation);
    let length = rotation.length();
    (length > SHORTEST && length.is_finite()).then(|| DQuat::from_vec4(rotation / length))
}
