use std::rc::Rc;

use glam::{DMat3, DQuat, DVec3, Vec3};

use super::GlbError;
use super::rig::{BonePlacement, GltfRig};
use crate::document::Timeline;
use crate::io::formats::gltf::UniqueNames;
use crate::io::formats::gltf::file::KeyCurve;
use crate::kinematics::spline::Knot;

/// The joint nodes of a file: a node at the base of every bone, in the order of the bones, then the
/// nodes at tips of bones.
pub struct JointNodes {
    pub nodes: Vec<JointNode>,
    /// Transforms of the nodes relative to their parents, in the bind pose.
    pub bind_pose: Vec<RigidTransform>,
}

pub struct JointNode {
    /// Name of the node, unique in the file.
    pub name: String,
    pub parent: Option<usize>,
    /// The bone at whose base or tip the node is.
    pub bone: usize,
    pub is_tip: bool,
}

/// A rigid transform relative to the parent, in metres.
#[derive(Clone, Copy)]
pub struct RigidTransform {
    pub translation: DVec3,
    pub rotation: DQuat,
}

impl JointNodes {
    /// Name of the node above all joints.
    pub const ARMATURE: &str = "Armature";
    /// Name of the node with the mesh.
    pub const MESH: &str = "Limbs";

    pub fn new(rig: &GltfRig) -> Result<Self, GlbError> {
        let mut names = UniqueNames::from([Self::ARMATURE, Self::MESH]);
        let joints = rig.bones.iter().enumerate().map(|(bone, joint)| JointNode {
            name: names.free(&joint.name),
            parent: joint.parent,
            bone,
            is_tip: false,
        });
        let mut nodes: Vec<JointNode> = joints.collect();
        for bone in (0..nodes.len()).filter(|bone| rig.bones[*bone].has_tip) {
            let name = names.free(&format!("{}_tip", nodes[bone].name));
            nodes.push(JointNode { name, parent: Some(bone), bone, is_tip: true });
        }
        let mut bones = Self { nodes, bind_pose: Vec::new() };
        bones.bind_pose = bones.locals(&rig.bind_pose, None)?;
        Ok(bones)
    }

    /// The node at the tip of each bone; `None` if the bone has no such node.
    pub fn tips(&self) -> Vec<Option<usize>> {
        let mut tips = vec![None; self.nodes.len()];
        for (node, tip) in self.nodes.iter().enumerate().filter(|(_, node)| node.is_tip) {
            tips[tip.bone] = Some(node);
        }
        tips
    }

    /// Transforms of the nodes relative to their parents, computed from the placements of the
    /// bones. `time`, in seconds, appears in errors; `None` stands for the bind pose.
    pub fn locals(
        &self,
        placements: &[BonePlacement],
        time: Option<f64>,
    ) -> Result<Vec<RigidTransform>, GlbError> {
        let frames: Vec<DMat3> = placements.iter().map(BonePlacement::frame).collect();
        let local = |node: &JointNode| {
            let BonePlacement { base, along, .. } = placements[node.bone];
            let local = match node.parent {
                _ if node.is_tip => RigidTransform {
                    translation: DVec3::Y * along.length(),
                    rotation: DQuat::IDENTITY,
                },
                Some(parent) => {
                    let parent_inverse = frames[parent].transpose();
                    RigidTransform {
                        translation: parent_inverse * (base - placements[parent].base),
                        rotation: DQuat::from_mat3(&(parent_inverse * frames[node.bone]))
                            .normalize(),
                    }
                }
                None => RigidTransform {
                    translation: base,
                    rotation: DQuat::from_mat3(&frames[node.bone]).normalize(),
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

/// Changes below this count as rounding errors: in radians for a rotation, relative to the distance
/// from the parent for a translation.
const LEAST: f64 = 1e-6;

impl JointTrack<4> {
    /// Returns whether the rotation ever leaves the bind pose.
    pub fn turns(&self, bind_pose: &RigidTransform) -> bool {
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
    /// Returns whether the node ever leaves the bind pose.
    pub fn moves(&self, bind_pose: &RigidTransform) -> bool {
        if self.curve == KeyCurve::CubicSpline {
            return true;
        }
        self.values.iter().any(|value| {
            let translation = DVec3::from_array(value.map(f64::from));
            let size = translation.length().max(bind_pose.translation.length());
            translation.distance(bind_pose.translation) > LEAST * size
        })
    }
}

/// Returns `rotation` or its negative, which is the same rotation, whichever is nearer to
/// `previous`.
pub fn same_side(previous: DQuat, rotation: DQuat) -> DQuat {
    if previous.dot(rotation) < 0.0 { -rotation } else { rotation }
}
