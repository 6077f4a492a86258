use glam::{DAffine3, DMat3, DVec3};

use super::nodes::{NodeTransform, NodeTree, at_node};
use super::skins::SkinJoints;
use super::tracks::NodeTracks;
use crate::io::formats::gltf::conversions::frame;
use crate::io::json::FieldError;

/// The placement of a joint in the world, in metres.
#[derive(Clone, Copy)]
pub struct JointPlacement {
    pub base: DVec3,
    /// The joint's axes, orthonormalized.
    pub frame: DMat3,
}

/// Computes the placements of the joints from the transforms of their nodes and of all ancestors.
pub struct NodePoser<'a> {
    nodes: &'a NodeTree,
    joints: &'a SkinJoints,
    /// The nodes of the joints and their ancestors, parents before their children.
    needed: Vec<usize>,
    locals: Vec<NodeTransform>,
    worlds: Vec<DAffine3>,
}

impl<'a> NodePoser<'a> {
    pub fn new(nodes: &'a NodeTree, joints: &'a SkinJoints) -> Self {
        let mut is_needed = vec![false; nodes.parents.len()];
        joints.nodes.iter().for_each(|node| is_needed[*node] = true);
        for node in nodes.order.iter().rev().copied() {
            if let Some(parent) = nodes.parents[node].filter(|_| is_needed[node]) {
                is_needed[parent] = true;
            }
        }
        Self {
            nodes,
            joints,
            needed: nodes.order.iter().copied().filter(|node| is_needed[*node]).collect(),
            locals: nodes.locals.clone(),
            worlds: vec![DAffine3::IDENTITY; nodes.parents.len()],
        }
    }

    /// The node of each joint.
    pub fn joints(&self) -> &[usize] {
        &self.joints.nodes
    }

    /// Number of nodes that are posed.
    pub fn len(&self) -> usize {
        self.needed.len()
    }

    /// For each node of the file, whether it is posed.
    pub fn is_needed(&self) -> Vec<bool> {
        let mut is_needed = vec![false; self.nodes.parents.len()];
        self.needed.iter().for_each(|node| is_needed[*node] = true);
        is_needed
    }

    /// Placements of the joints in the bind pose.
    pub fn bind_pose(&mut self) -> Result<Vec<JointPlacement>, FieldError> {
        self.placements()
    }

    /// Placements of the joints in the animation `tracks` at `time`, in seconds.
    pub fn at(
        &mut self,
        tracks: &NodeTracks<'_>,
        time: f64,
    ) -> Result<Vec<JointPlacement>, FieldError> {
        tracks.pose(time, &mut self.locals);
        self.placements()
    }

    fn placements(&mut self) -> Result<Vec<JointPlacement>, FieldError> {
        for &node in &self.needed {
            let parent = self.nodes.parents[node];
            let parent_world = parent.map_or(DAffine3::IDENTITY, |parent| self.worlds[parent]);
            self.worlds[node] = parent_world * self.locals[node].affine();
        }
        let placement = |node: &usize| {
            let DAffine3 { matrix3, translation: base } = self.worlds[*node];
            if !base.as_vec3().is_finite() {
                let reason = "must be within ±3.4028235e38 m in the world";
                return Err(FieldError::new(at_node(*node), reason));
            }
            Ok(JointPlacement { base, frame: frame(matrix3.y_axis, matrix3.x_axis) })
        };
        self.joints.nodes.iter().map(placement).collect()
    }
}
