use glam::{DAffine3, DMat3, DVec3, Mat3A, Vec3};

use super::nodes::{NodeTransform, NodeTree, at_node};
use super::skins::SkinJoints;
use super::tracks::NodeTracks;
use crate::document::Timeline;
use crate::io::field_error::FieldError;
use crate::io::gltf::frame::frame;
use crate::kinematics::skeleton::Joint;

/// The placement of a joint in the world.
#[derive(Clone, Copy)]
pub struct JointPlacement {
    pub base: DVec3,
    /// Its axes, orthonormalized.
    pub frame: DMat3,
}

/// Poses the joints and their ancestors.
pub struct NodePoser<'a> {
    nodes: &'a NodeTree,
    joints: &'a SkinJoints,
    /// Parents before their children.
    needed: Vec<usize>,
    locals: Vec<NodeTransform>,
    worlds: Vec<DAffine3>,
}

/// The motion of a joint, frame by frame.
#[derive(Default)]
pub struct JointMotion {
    /// Unwrapped angles.
    pub rotations: Vec<Vec3>,
    pub offsets: Vec<Vec3>,
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

    /// Number of nodes that are posed.
    pub fn len(&self) -> usize {
        self.needed.len()
    }

    /// Whether each node is posed.
    pub fn is_needed(&self) -> Vec<bool> {
        let mut is_needed = vec![false; self.nodes.parents.len()];
        self.needed.iter().for_each(|node| is_needed[*node] = true);
        is_needed
    }

    /// Placements of the joints without an animation.
    pub fn rest(&mut self) -> Result<Vec<JointPlacement>, FieldError> {
        self.placed()
    }

    /// Placements of the joints in an animation at a time, in seconds.
    pub fn at(
        &mut self,
        tracks: &NodeTracks<'_>,
        time: f64,
    ) -> Result<Vec<JointPlacement>, FieldError> {
        tracks.pose(time, &mut self.locals);
        self.placed()
    }

    fn placed(&mut self) -> Result<Vec<JointPlacement>, FieldError> {
        for &node in &self.needed {
            let above = self.nodes.parents[node];
            let above = above.map_or(DAffine3::IDENTITY, |parent| self.worlds[parent]);
            self.worlds[node] = above * self.locals[node].affine();
        }
        let place = |node: &usize| {
            let DAffine3 { matrix3, translation: base } = self.worlds[*node];
            if !base.as_vec3().is_finite() {
                let reason = "is beyond 3.4028235e38 m in the world; bring it nearer to 0";
                return Err(FieldError::new(at_node(*node), reason));
            }
            Ok(JointPlacement { base, frame: frame(matrix3.y_axis, matrix3.x_axis) })
        };
        self.joints.nodes.iter().map(place).collect()
    }
}

/// Motions of all joints, frame by frame.
pub fn sample(
    stage: &mut NodePoser<'_>,
    tracks: &NodeTracks<'_>,
    timeline: Timeline,
    frames: usize,
    joints: &mut [Joint],
    rest: &[JointPlacement],
) -> Result<Vec<JointMotion>, FieldError> {
    let mut motions: Vec<JointMotion> = joints.iter().map(|_| JointMotion::default()).collect();
    for frame in 0..frames {
        let placed = stage.at(tracks, timeline.time(frame))?;
        let turns: Vec<DMat3> =
            placed.iter().zip(rest).map(|(now, rest)| now.frame * rest.frame.transpose()).collect();
        for (index, motion) in motions.iter_mut().enumerate() {
            let joint = &mut joints[index];
            let (above, origin) = match joint.parent {
                Some(parent) => (turns[parent.index()].transpose(), placed[parent.index()].base),
                None => (DMat3::IDENTITY, DVec3::ZERO),
            };
            let offset = (above * (placed[index].base - origin)).as_vec3();
            if !offset.is_finite() {
                let reason = "is beyond 3.4028235e38 m from its parent; bring it nearer";
                return Err(FieldError::new(at_node(stage.joints.nodes[index]), reason));
            }
            // Unwrapped: the angles nearest to those of the last frame.
            joint.rotation = joint.angles_of(Mat3A::from((above * turns[index]).as_mat3()));
            motion.rotations.push(joint.rotation);
            motion.offsets.push(offset);
        }
    }
    Ok(motions)
}
