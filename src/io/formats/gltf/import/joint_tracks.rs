//! The motions of joints, and their samples at every frame.

use glam::{DAffine3, DMat3, DVec3, Mat3, Mat3A, Vec3};

use super::animations::NodeTracks;
use super::nodes::{NodeTransform, NodeTree, SkinJoints, at_node};
use crate::document::Timeline;
use crate::io::formats::gltf::frame;
use crate::io::json::FieldError;
use crate::kinematics::skeleton::Joint;
use crate::kinematics::spline::{Knot, Spline};

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

/// The keys of a joint; a spline without knots if the value is constant.
#[derive(Clone, Debug, Default)]
pub struct JointTracks {
    /// Angles about x, y and z in radians.
    pub rotation: Spline<Vec3>,
    pub offset: Spline<Vec3>,
    /// The frame of the angles relative to the node; `None` for the node's axes.
    pub frame: Option<Mat3>,
}

/// Changes below this count as rounding errors: in radians for an angle, relative to its length for
/// an offset.
const LEAST: f32 = 1e-6;

impl JointTracks {
    /// Returns whether the joint turns.
    pub fn turns(&self) -> bool {
        changes(&self.rotation, |_| 2.0 * LEAST)
    }

    /// Returns whether the joint's offset changes. `size` is the length of the skeleton's longest
    /// offset.
    pub fn moves(&self, size: f32) -> bool {
        changes(&self.offset, |first| LEAST * first.length().max(1e-3 * size))
    }
}

/// Returns whether a value changes by more than `least` of its first key, or a slope leads away
/// from it.
fn changes(track: &Spline<Vec3>, least: impl Fn(Vec3) -> f32) -> bool {
    let Some(first) = track.knots().first().map(|knot| knot.value) else { return false };
    let least = least(first);
    let leads_away = |knot: &Knot<Vec3>| {
        let slopes = knot.slopes.iter().flat_map(|it| [it.arriving, it.leaving]);
        track.knots().len() > 1 && slopes.into_iter().any(|slope| slope.length() > least)
    };
    track.knots().iter().any(|knot| knot.value.distance(first) > least || leads_away(knot))
}

/// Samples the motions of all joints in the first `frames` frames of `timeline`: keys at every
/// frame, with angles unwrapped from frame to frame. Leaves the angles of the last frame in
/// `joints`.
pub fn sample(
    poser: &mut NodePoser<'_>,
    tracks: &NodeTracks<'_>,
    timeline: Timeline,
    frames: usize,
    joints: &mut [Joint],
    bind_pose: &[JointPlacement],
) -> Result<Vec<JointTracks>, FieldError> {
    let mut motions: Vec<JointTracks> = joints.iter().map(|_| JointTracks::default()).collect();
    for frame in 0..frames {
        let time = timeline.time(frame);
        let placements = poser.at(tracks, time)?;
        let rotations: Vec<DMat3> = placements
            .iter()
            .zip(bind_pose)
            .map(|(now, bind)| now.frame * bind.frame.transpose())
            .collect();
        for (index, motion) in motions.iter_mut().enumerate() {
            let joint = &mut joints[index];
            let (parent_inverse, origin) = match joint.parent {
                Some(parent) => {
                    (rotations[parent.index()].transpose(), placements[parent.index()].base)
                }
                None => (DMat3::IDENTITY, DVec3::ZERO),
            };
            let offset = (parent_inverse * (placements[index].base - origin)).as_vec3();
            if !offset.is_finite() {
                let reason = "must be within ±3.4028235e38 m of its parent";
                return Err(FieldError::new(at_node(poser.joints()[index]), reason));
            }
            // Unwrapped: the angles nearest to those of the previous frame.
            joint.rotation =
                joint.angles_of(Mat3A::from((parent_inverse * rotations[index]).as_mat3()));
            motion.rotation.insert(time, joint.rotation);
            motion.offset.insert(time, offset);
        }
    }
    Ok(motions)
}
