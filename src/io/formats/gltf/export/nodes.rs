use std::rc::Rc;

use glam::{DMat3, DQuat, DVec3, Vec3};

use super::GlbError;
use super::quaternion_spline::same_side;
use super::rig::{BonePlacement, GltfRig};
use super::stretch::{StretchKind, StretchParts};
use crate::document::Timeline;
use crate::io::formats::gltf::UniqueNames;
use crate::io::formats::gltf::file::KeyCurve;
use crate::kinematics::spline::Knot;

/// The joint nodes of a file: a node at the base of every bone, in the order of the bones, then the
/// nodes at tips of bones, then those that stretch the skin.
pub struct JointNodes {
    pub nodes: Vec<JointNode>,
    /// For each bone the frame of its joint's angles relative to its node.
    frames: Vec<DQuat>,
    /// Transforms of the nodes relative to their parents, in the bind pose.
    pub bind_pose: Vec<LocalTransform>,
}

pub struct JointNode {
    /// Name of the node, unique in the file.
    pub name: String,
    pub parent: Option<usize>,
    /// The bone at whose base or tip the node is.
    pub bone: usize,
    pub role: NodeRole,
}

/// What a node is to its bone.
#[derive(Clone, Copy, PartialEq)]
pub enum NodeRole {
    Base,
    Tip,
    /// Below the base: turns to the axes of the joint's frame, and stretches the skin along these or
    /// others.
    Stretch(StretchKind),
    /// Below a node that stretches along other axes: turns back from these.
    StretchAxes,
}

/// A transform relative to the parent, in metres.
#[derive(Clone, Copy)]
pub struct LocalTransform {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl LocalTransform {
    pub const IDENTITY: Self =
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
}

impl JointNodes {
    /// Name of the node above all joints.
    pub const ARMATURE: &str = "Armature";
    /// Name of the node with the mesh.
    pub const MESH: &str = "Limbs";

    /// The nodes of a rig; those that stretch the skin if it `has_skin`.
    pub fn new(rig: &GltfRig, has_skin: bool) -> Result<Self, GlbError> {
        let mut names = UniqueNames::from([Self::ARMATURE, Self::MESH]);
        let joints = rig.bones.iter().enumerate().map(|(bone, joint)| JointNode {
            name: names.free(&joint.name),
            parent: joint.parent,
            bone,
            role: NodeRole::Base,
        });
        let mut nodes: Vec<JointNode> = joints.collect();
        for bone in (0..nodes.len()).filter(|bone| rig.bones[*bone].has_tip) {
            let name = names.free(&format!("{}_tip", nodes[bone].name));
            nodes.push(JointNode { name, parent: Some(bone), bone, role: NodeRole::Tip });
        }
        for (bone, kind) in rig.bones.iter().enumerate().filter(|_| has_skin) {
            let Some(kind) = kind.stretches else { continue };
            let roles = [NodeRole::Stretch(kind), NodeRole::StretchAxes];
            let mut parent = bone;
            for role in &roles[..if kind == StretchKind::Shear { 2 } else { 1 }] {
                let name = names.free(&format!("{}_skin", nodes[bone].name));
                nodes.push(JointNode { name, parent: Some(parent), bone, role: *role });
                parent = nodes.len() - 1;
            }
        }
        let frames = rig.bones.iter().map(|bone| bone.frame).collect();
        let mut bones = Self { nodes, frames, bind_pose: Vec::new() };
        bones.bind_pose = bones.locals(&rig.bind_pose, &mut bones.level_axes(), None)?;
        Ok(bones)
    }

    /// The nodes of joints that stretch the skin, with the frames of these joints' angles.
    pub fn stretched_frames(&self) -> impl Iterator<Item = (usize, DQuat)> {
        let stretched = self.nodes.iter().filter(|node| matches!(node.role, NodeRole::Stretch(_)));
        stretched.map(|node| (node.bone, self.frames[node.bone]))
    }

    /// For each bone, the axes along which it stretches the skin before any stretch.
    pub fn level_axes(&self) -> Vec<DMat3> {
        vec![DMat3::IDENTITY; self.frames.len()]
    }

    /// For each bone's base and then for each tip, the node that the skin follows there.
    pub fn of_skin(&self) -> Vec<usize> {
        let mut followed: Vec<usize> = Vec::with_capacity(self.nodes.len());
        for (node, JointNode { bone, role, .. }) in self.nodes.iter().enumerate() {
            match role {
                NodeRole::Base | NodeRole::Tip => followed.push(node),
                NodeRole::Stretch(_) | NodeRole::StretchAxes => followed[*bone] = node,
            }
        }
        followed
    }

    /// The node at the tip of each bone; `None` if the bone has no such node.
    pub fn tips(&self) -> Vec<Option<usize>> {
        let mut tips = vec![None; self.nodes.len()];
        for (node, tip) in
            self.nodes.iter().enumerate().filter(|(_, node)| node.role == NodeRole::Tip)
        {
            tips[tip.bone] = Some(node);
        }
        tips
    }

    /// Transforms of the nodes relative to their parents, computed from the placements of the
    /// bones. `axes` has the axes of stretches in the frame before, and gets those of this one.
    /// `time`, in seconds, appears in errors; `None` stands for the bind pose.
    pub fn locals(
        &self,
        placements: &[BonePlacement],
        axes: &mut [DMat3],
        time: Option<f64>,
    ) -> Result<Vec<LocalTransform>, GlbError> {
        let frames: Vec<DMat3> = placements.iter().map(BonePlacement::frame).collect();
        let local = |node: &JointNode| {
            let BonePlacement { base, along, stretch, .. } = placements[node.bone];
            let local = match node.parent {
                _ if node.role == NodeRole::Tip => LocalTransform {
                    translation: DVec3::Y * along.length(),
                    ..LocalTransform::IDENTITY
                },
                _ if node.role == NodeRole::StretchAxes => LocalTransform {
                    rotation: DQuat::from_mat3(&axes[node.bone]).normalize().conjugate(),
                    ..LocalTransform::IDENTITY
                },
                _ if let NodeRole::Stretch(kind) = node.role => {
                    let parts = StretchParts::new(stretch, kind, axes[node.bone]);
                    axes[node.bone] = parts.axes;
                    let turn = DQuat::from_mat3(&parts.turn);
                    LocalTransform {
                        rotation: (self.frames[node.bone] * turn).normalize(),
                        scale: parts.scale,
                        ..LocalTransform::IDENTITY
                    }
                }
                Some(parent) => {
                    let parent_inverse = frames[parent].transpose();
                    LocalTransform {
                        translation: parent_inverse * (base - placements[parent].base),
                        rotation: DQuat::from_mat3(&(parent_inverse * frames[node.bone]))
                            .normalize(),
                        scale: DVec3::ONE,
                    }
                }
                None => LocalTransform {
                    translation: base,
                    rotation: DQuat::from_mat3(&frames[node.bone]).normalize(),
                    scale: DVec3::ONE,
                },
            };
            let fits = [base, base + along, local.translation].map(|v| v.as_vec3().is_finite());
            if fits != [true; 3] {
                return Err(GlbError::TooFar { joint: node.name.clone(), time });
            }
            Ok(local)
        };
        self.nodes.iter().map(local).collect()
    }
}

/// Times of the file for times of the document.
#[derive(Clone, Copy)]
pub struct ClipTimes {
    start: f64,
    /// Time of the first frame in the file.
    first: f64,
}

impl ClipTimes {
    /// The first frame is at its time in the document, unless that is below 0, which glTF does not
    /// allow, or so late that single precision cannot tell the frames apart. Then it is at 0.
    pub fn new(timeline: Timeline) -> Self {
        let rounding = timeline.end * f64::from(f32::EPSILON);
        let is_exact = timeline.start >= 0.0 && rounding < 0.1 / timeline.frame_rate;
        Self { start: timeline.start, first: if is_exact { timeline.start } else { 0.0 } }
    }

    /// Time of the file in seconds for one of the document.
    pub fn of(self, time: f64) -> f64 {
        (self.first + (time - self.start)).max(0.0)
    }
}

/// The values of one node over time.
pub struct JointTrack<const N: usize> {
    pub node: usize,
    /// Times of the keys in the document, in seconds.
    pub times: Rc<[f64]>,
    pub curve: KeyCurve,
    /// One value for each key; for cubic splines the arriving slope, the value and the leaving
    /// slope.
    pub values: Vec<[f32; N]>,
    /// The arriving and leaving slopes that a cubic spline gets as its values are recorded.
    pub slopes: Vec<[[f32; N]; 2]>,
    /// The keys whose curve a cubic spline is, as the file has them in `extras`; none for other
    /// curves.
    pub keys: Vec<Knot<Vec3>>,
}

impl<const N: usize> JointTrack<N> {
    /// A track without values.
    pub fn new(node: usize, times: Rc<[f64]>, curve: KeyCurve) -> Self {
        Self { node, times, curve, values: Vec::new(), slopes: Vec::new(), keys: Vec::new() }
    }

    /// Adds the value if the next key is at this time of the document.
    pub fn record(&mut self, time: f64, value: [f32; N]) {
        let key = self.values.len() / self.curve.values_per_key();
        if self.times.get(key) != Some(&time) {
            return;
        }
        match self.slopes.get(key) {
            Some([arriving, leaving]) => self.values.extend([*arriving, value, *leaving]),
            None => self.values.push(value),
        }
    }
}

/// Changes below this count as rounding errors: in radians for a rotation, relative to its length for a
/// translation or scale.
const LEAST: f64 = 1e-6;

impl JointTrack<4> {
    /// Returns whether the rotation ever leaves the bind pose.
    pub fn turns(&self, bind_pose: &LocalTransform) -> bool {
        let turns = |value: &[f32; 4]| {
            let rotation = DQuat::from_array(value.map(f64::from));
            let difference = same_side(bind_pose.rotation, rotation) - bind_pose.rotation;
            2.0 * difference.length() > LEAST
        };
        if self.curve == KeyCurve::CubicSpline {
            // Between two keys, a spline without slopes stays on the shortest way.
            let slope = |slope: &[f32; 4]| slope.iter().any(|it| f64::from(it.abs()) > LEAST);
            return self
                .values
                .chunks(3)
                .any(|key| slope(&key[0]) || turns(&key[1]) || slope(&key[2]));
        }
        self.values.iter().any(turns)
    }
}

impl JointTrack<3> {
    /// Returns whether a translation or scale ever differs from that in the bind pose.
    pub fn differs(&self, bind_pose: DVec3) -> bool {
        if self.curve == KeyCurve::CubicSpline {
            return true;
        }
        self.values.iter().any(|value| {
            let value = DVec3::from_array(value.map(f64::from));
            let size = value.length().max(bind_pose.length());
            value.distance(bind_pose) > LEAST * size
        })
    }
}
