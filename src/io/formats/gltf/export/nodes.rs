use glam::{DMat3, DQuat, DVec3};

use super::error::GlbError;
use super::rig::{BonePlacement, GltfRig};
use crate::io::formats::gltf::names::UniqueNames;

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
